//! What the plugin asks of its host, counted.

use clack_extensions::gui::{GuiSize, HostGui, HostGuiImpl};
use clack_extensions::latency::{HostLatency, HostLatencyImpl};
use clack_extensions::params::{
    HostParams, HostParamsImplMainThread, HostParamsImplShared, ParamClearFlags, ParamRescanFlags,
};
use clack_extensions::thread_check::{HostThreadCheck, HostThreadCheckImpl};
use clack_extensions::voice_info::{HostVoiceInfo, HostVoiceInfoImpl};
use clack_host::prelude::*;
use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::ThreadId;

/// The host's handlers, for clack.
pub(crate) struct Host;

impl HostHandlers for Host {
    type Shared<'a> = Calls;
    type MainThread<'a> = MainThreadCalls;
    type AudioProcessor<'a> = ();

    fn declare_extensions(builder: &mut HostExtensions<Self>, calls: &Calls) {
        builder.register::<HostParams>().register::<HostGui>().register::<HostLatency>().register::<HostVoiceInfo>();
        if calls.tells_threads {
            builder.register::<HostThreadCheck>();
        }
    }
}

/// Calls that may come from any thread.
pub(crate) struct Calls {
    /// The thread that the instance lives on.
    main: ThreadId,
    /// Whether this host has the extension that tells threads apart.
    tells_threads: bool,
    /// A call on the main thread is wanted.
    pub(crate) callback: AtomicBool,
    /// Restarts asked for.
    pub(crate) restarts: AtomicU32,
    /// Parameter flushes asked for.
    pub(crate) flushes: AtomicU32,
}

impl Calls {
    /// Nothing asked yet; made on the main thread.
    pub(crate) fn new(tells_threads: bool) -> Self {
        Self {
            main: std::thread::current().id(),
            tells_threads,
            callback: AtomicBool::new(false),
            restarts: AtomicU32::new(0),
            flushes: AtomicU32::new(0),
        }
    }
}

/// Calls that come on the main thread only.
#[derive(Default)]
pub(crate) struct MainThreadCalls {
    /// Rescans of parameters asked for.
    pub(crate) rescans: Cell<u32>,
    /// Changes of the latency told.
    pub(crate) latencies: Cell<u32>,
}

impl<'a> MainThreadHandler<'a> for MainThreadCalls {}

impl SharedHandler<'_> for Calls {
    fn request_restart(&self) {
        self.restarts.fetch_add(1, Ordering::Relaxed);
    }

    fn request_process(&self) {}

    fn request_callback(&self) {
        self.callback.store(true, Ordering::Release);
    }
}

impl HostThreadCheckImpl for Calls {
    fn is_main_thread(&self) -> bool {
        std::thread::current().id() == self.main
    }

    fn is_audio_thread(&self) -> bool {
        !self.is_main_thread()
    }
}

impl HostParamsImplShared for Calls {
    fn request_flush(&self) {
        self.flushes.fetch_add(1, Ordering::Relaxed);
    }
}

impl HostParamsImplMainThread for MainThreadCalls {
    fn rescan(&self, _flags: ParamRescanFlags) {
        self.rescans.set(self.rescans.get() + 1);
    }

    fn clear(&self, _param_id: ClapId, _flags: ParamClearFlags) {}
}

impl HostLatencyImpl for MainThreadCalls {
    fn changed(&self) {
        self.latencies.set(self.latencies.get() + 1);
    }
}

impl HostVoiceInfoImpl for MainThreadCalls {
    fn changed(&self) {}
}

impl HostGuiImpl for Calls {
    fn resize_hints_changed(&self) {}

    fn request_resize(&self, _size: GuiSize) -> Result<(), HostError> {
        Ok(())
    }

    fn request_show(&self) -> Result<(), HostError> {
        Ok(())
    }

    fn request_hide(&self) -> Result<(), HostError> {
        Ok(())
    }

    fn closed(&self, _was_destroyed: bool) {}
}
