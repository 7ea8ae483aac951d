//! Edits of the handler on the host's run loop: it is removed again, and its file descriptors are closed.

use super::edit::{Edit, VIEW, WRAPPER, edit};

pub(super) const EDITS: &[Edit] = &[
    // The old view is dropped after the lock is released, because dropping it calls the host.
    edit(
        WRAPPER,
        "                *self.inner.plug_view.write() = Some(view);
",
        "                let previous = self.inner.plug_view.write().replace(view);
                drop(previous);
",
    ),
    // The handler no longer holds a reference to itself, which kept it alive for ever. It is removed from the run loop
    // while another reference still exists, since hosts may count references during that call. If there are no file
    // descriptors, or if the host refuses the handler, there is no handler, and changes of parameters are shown only
    // when the window redraws.
    edit(
        VIEW,
        "    pub fn new(inner: Weak<WrapperInner<P>>, run_loop: ComPtr<IRunLoop>) -> ComWrapper<Self> {
        let mut sockets = [0i32; 2];
        assert_eq!(
            unsafe {
                libc::socketpair(
                    libc::AF_UNIX,
                    libc::SOCK_STREAM | libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK,
                    0,
                    sockets.as_mut_ptr(),
                )
            },
            0
        );
",
        "    pub fn new(
        inner: Weak<WrapperInner<P>>,
        run_loop: ComPtr<IRunLoop>,
    ) -> Option<ComWrapper<Self>> {
        let mut sockets = [0i32; 2];
        let result = unsafe {
            libc::socketpair(
                libc::AF_UNIX,
                libc::SOCK_STREAM | libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK,
                0,
                sockets.as_mut_ptr(),
            )
        };
        if result != 0 {
            return None;
        }
",
    ),
    edit(
        VIEW,
        "        let event_handler_ptr = handler.to_com_ptr::<IEventHandler>().unwrap().into_raw();
",
        "        let event_handler_ptr = handler.as_com_ref::<IEventHandler>().unwrap().as_ptr();
",
    ),
    edit(
        VIEW,
        "        assert_eq!(
            unsafe {
                handler
                    .run_loop
                    .registerEventHandler(event_handler_ptr, handler.socket_read_fd)
            },
            kResultOk
        );

        handler
    }
",
        "        let result = unsafe {
            handler
                .run_loop
                .registerEventHandler(event_handler_ptr, handler.socket_read_fd)
        };

        (result == kResultOk).then_some(handler)
    }

    /// Takes the handler off the host's run loop. The host may still hold a reference afterwards.
    pub fn unregister(&self) {
        unsafe {
            self.run_loop
                .unregisterEventHandler(self.event_handler_ptr.0.get());
        }
    }
",
    ),
    edit(
        VIEW,
        "
        unsafe {
            self.run_loop
                .unregisterEventHandler(self.event_handler_ptr.0.get());
        }
    }
}",
        "    }
}

#[cfg(all(target_family = \"unix\", not(target_os = \"macos\")))]
impl<P: Vst3Plugin> WrapperView<P> {
    /// Takes the handler off the host's run loop, if there is one.
    fn leave_run_loop(&self) {
        let handler = self.run_loop_event_handler.write().take();
        if let Some(handler) = handler {
            handler.unregister();
        }
    }
}

#[cfg(all(target_family = \"unix\", not(target_os = \"macos\")))]
impl<P: Vst3Plugin> Drop for WrapperView<P> {
    fn drop(&mut self) {
        self.leave_run_loop();
    }
}",
    ),
    edit(
        VIEW,
        "    // PLEASE FIXME: This drop method never actually gets called for some reason.
",
        "",
    ),
    edit(
        VIEW,
        "        match unsafe { ComRef::from_raw(frame) } {
",
        "        #[cfg(all(target_family = \"unix\", not(target_os = \"macos\")))]
        self.leave_run_loop();

        match unsafe { ComRef::from_raw(frame) } {
",
    ),
    edit(
        VIEW,
        "                        .map(|run_loop| RunLoopEventHandler::new(Arc::downgrade(&inner), run_loop));
",
        "                        .and_then(|run_loop| {
                            RunLoopEventHandler::new(Arc::downgrade(&inner), run_loop)
                        });
",
    ),
    edit(
        VIEW,
        "                #[cfg(all(target_family = \"unix\", not(target_os = \"macos\")))]
                {
                    *self.run_loop_event_handler.write() = None;
                }
                *self.plug_frame.write() = None;
",
        "                *self.plug_frame.write() = None;
",
    ),
];
