//! The frame around a plugin's window in the host: with a run loop that counts its handlers, or without one.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use vst3::Steinberg::Linux::{
    FileDescriptor, IEventHandler, IEventHandlerTrait, IRunLoop, IRunLoopTrait, ITimerHandler, TimerInterval,
};
use vst3::Steinberg::{
    IPlugFrame, IPlugFrameTrait, IPlugView, IPlugViewTrait, ViewRect, kInvalidArgument, kNotImplemented, kResultFalse,
    kResultOk, tresult,
};
use vst3::{Class, ComPtr, ComRef};

/// A frame with a run loop. It holds references to its handlers, as the example in the SDK does.
#[derive(Default)]
pub(crate) struct Frame {
    handlers: Mutex<Vec<(ComPtr<IEventHandler>, FileDescriptor)>>,
    registered: AtomicUsize,
    handled: AtomicUsize,
    /// The last size that a view has requested.
    resize: Mutex<Option<[u32; 2]>>,
    /// Whether the host keeps its window as it is.
    refuses_sizes: AtomicBool,
}

impl Class for Frame {
    type Interfaces = (IPlugFrame, IRunLoop);
}

impl Frame {
    /// How many handlers have been registered in total, and how many are registered now.
    pub(crate) fn registered(&self) -> (usize, usize) {
        (self.registered.load(Ordering::Relaxed), self.handlers.lock().unwrap().len())
    }

    /// How often handlers have been called.
    pub(crate) fn handled(&self) -> usize {
        self.handled.load(Ordering::Relaxed)
    }

    /// From now on, the host refuses to resize its window.
    pub(crate) fn refuse_sizes(&self) {
        self.refuses_sizes.store(true, Ordering::Relaxed);
    }

    /// The size that a view has requested since the last call of this method.
    pub(crate) fn requested_size(&self) -> Option<[u32; 2]> {
        self.resize.lock().unwrap().take()
    }

    /// Calls the handlers whose file descriptors become readable within this many milliseconds.
    pub(crate) fn turn(&self, milliseconds: i32) {
        let handlers = self.handlers.lock().unwrap().clone();
        let mut polled: Vec<_> =
            handlers.iter().map(|(_, fd)| libc::pollfd { fd: *fd, events: libc::POLLIN, revents: 0 }).collect();
        // SAFETY: the list lives until the call returns and has the given length.
        unsafe { libc::poll(polled.as_mut_ptr(), polled.len() as libc::nfds_t, milliseconds) };
        for ((handler, fd), poll) in handlers.iter().zip(&polled) {
            assert_eq!(poll.revents & libc::POLLNVAL, 0, "file descriptor {fd} is closed and still on the run loop");
            if poll.revents != 0 {
                self.handled.fetch_add(1, Ordering::Relaxed);
                // SAFETY: this list holds a reference to the handler.
                unsafe { handler.onFDIsSet(*fd) };
            }
        }
    }
}

impl IRunLoopTrait for Frame {
    unsafe fn registerEventHandler(&self, handler: *mut IEventHandler, fd: FileDescriptor) -> tresult {
        // SAFETY: the plugin passes a handler or null.
        let Some(handler) = (unsafe { ComRef::from_raw(handler) }) else { return kInvalidArgument };
        self.registered.fetch_add(1, Ordering::Relaxed);
        self.handlers.lock().unwrap().push((handler.to_com_ptr(), fd));
        kResultOk
    }

    unsafe fn unregisterEventHandler(&self, handler: *mut IEventHandler) -> tresult {
        let mut handlers = self.handlers.lock().unwrap();
        let Some(place) = handlers.iter().position(|(known, _)| known.as_ptr() == handler) else {
            return kInvalidArgument;
        };
        let removed = handlers.swap_remove(place);
        // This may drop the last reference, which may call back.
        drop(handlers);
        drop(removed);
        kResultOk
    }

    unsafe fn registerTimer(&self, _: *mut ITimerHandler, _: TimerInterval) -> tresult {
        kNotImplemented
    }

    unsafe fn unregisterTimer(&self, _: *mut ITimerHandler) -> tresult {
        kNotImplemented
    }
}

impl IPlugFrameTrait for Frame {
    unsafe fn resizeView(&self, view: *mut IPlugView, size: *mut ViewRect) -> tresult {
        // SAFETY: the plugin passes a size that lives until the call returns.
        let ViewRect { left, top, right, bottom } = unsafe { *size };
        *self.resize.lock().unwrap() = Some([right - left, bottom - top].map(|side| side as u32));
        if self.refuses_sizes.load(Ordering::Relaxed) {
            return kResultFalse;
        }
        // SAFETY: the same conditions as for the caller.
        unsafe { resize(view, size) }
    }
}

/// A frame without a run loop.
pub(crate) struct FrameWithoutLoop;

impl Class for FrameWithoutLoop {
    type Interfaces = (IPlugFrame,);
}

impl IPlugFrameTrait for FrameWithoutLoop {
    unsafe fn resizeView(&self, view: *mut IPlugView, size: *mut ViewRect) -> tresult {
        // SAFETY: the same conditions as for the caller.
        unsafe { resize(view, size) }
    }
}

/// Gives a view the size that it requests.
unsafe fn resize(view: *mut IPlugView, size: *mut ViewRect) -> tresult {
    // SAFETY: the plugin passes its view or null, and a size that lives until the call returns.
    unsafe { ComRef::from_raw(view).map_or(kInvalidArgument, |view| view.onSize(size)) }
}
