//! Edits of the worker thread that all instances share, and of the end of an instance.

use super::edit::{Edit, WORKER, WRAPPER, edit};

pub(super) const EDITS: &[Edit] = &[
    // The worker is shared by all instances, so a task of an instance that no longer exists must not end it.
    edit(
        WORKER,
        r#"                    nice_trace!(
                        "Received a new task but the executor is no longer alive, shutting down \
                         worker"
                    );
                    return;
"#,
        r#"                    nice_trace!("Received a new task but the executor is no longer alive");
"#,
    ),
    // A worker that holds the last reference to itself cannot wait for its own end. It ends when the channel is
    // disconnected, which happens next. A worker that has already ended is no reason to panic within `release()`.
    edit(
        WORKER,
        r#"        self.tasks_sender
            .send(Message::Shutdown)
            .expect("Failed while sending worker thread shutdown request");
        self.join_handle
            .take()
            // Only possible if the WorkerThread got dropped twice, somehow?
            .expect("Missing Worker thread JoinHandle")
            .join()
            .expect("Worker thread panicked");
"#,
        r#"        let Some(join_handle) = self.join_handle.take() else {
            return;
        };
        if join_handle.thread().id() != thread::current().id() {
            let _ = self.tasks_sender.send(Message::Shutdown);
            let _ = join_handle.join();
        }
"#,
    ),
    // The instance ends on the thread that releases it, not on a worker that still has one of its tasks: hosts may
    // unload the library right afterwards. If the host has forgotten to close the window, it is closed while its thread
    // can still use the instance.
    edit(
        WRAPPER,
        "    inner: Arc<WrapperInner<P>>,
}
",
        "    inner: mem::ManuallyDrop<Arc<WrapperInner<P>>>,
}
",
    ),
    edit(
        WRAPPER,
        "            inner: WrapperInner::new(),
",
        "            inner: mem::ManuallyDrop::new(WrapperInner::new()),
",
    ),
    edit(
        WRAPPER,
        r#"        crate::nice_debug_assert_eq!(Arc::strong_count(&self.inner), 1);
"#,
        r#"        // Safety: the field is not used again
        let mut inner = unsafe { mem::ManuallyDrop::take(&mut self.inner) };
        #[cfg(feature = "editor")]
        inner.close_window();
        let now = Instant::now();
        while let Err(shared) = Arc::try_unwrap(inner) {
            inner = shared;
            if now.elapsed() > Duration::from_secs(1) {
                crate::nice_error!("A task holds on to an instance that is being released");
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
"#,
    ),
];
