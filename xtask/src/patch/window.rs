//! Edits of the window: only the thread that opened it ever borrows it.

use super::edit::{Edit, INNER, VIEW, edit};

pub(super) const EDITS: &[Edit] = &[
    // The window is accessed only through `open_window()`, from the thread that opened it. On any other thread even a
    // shared borrow could collide with `attached()` and `removed()`, which would then panic within a call from the
    // host.
    edit(
        INNER,
        "    /// The host's [`IComponentHandler`] instance, if passed through
",
        "    /// The thread that opened the window, while it is open.
    #[cfg(feature = \"editor\")]
    pub window_thread: AtomicCell<Option<std::thread::ThreadId>>,

    /// The host's [`IComponentHandler`] instance, if passed through
",
    ),
    edit(
        INNER,
        "            component_handler: AtomicRefCell::new(None),
",
        "            #[cfg(feature = \"editor\")]
            window_thread: AtomicCell::new(None),
            component_handler: AtomicRefCell::new(None),
",
    ),
    edit(
        INNER,
        r#"    /// Posts the task to the background task queue using [`EventLoop::schedule_background()`] so it
"#,
        r#"    /// The open window, if this is the thread that opened it. No other thread may so much as borrow
    /// it: that would clash with [`Self::close_window()`] and with the window being opened.
    #[cfg(feature = "editor")]
    #[allow(clippy::type_complexity)]
    pub fn open_window(
        &self,
    ) -> Option<atomic_refcell::AtomicRef<'_, SpawnedEditor<<P::Editor as Editor>::Handle>>> {
        if self.window_thread.load() != Some(std::thread::current().id()) {
            return None;
        }
        let window = self.editor_window.try_borrow().ok()?;
        atomic_refcell::AtomicRef::filter_map(window, |window| {
            window.as_ref().and_then(|window| window.try_get().ok())
        })
    }

    /// Closes the window. Returns whether one was open; it can only be closed by the thread that
    /// opened it.
    #[cfg(feature = "editor")]
    pub fn close_window(&self) -> bool {
        if self.window_thread.load() != Some(std::thread::current().id()) {
            return false;
        }
        let Ok(mut editor_window) = self.editor_window.try_borrow_mut() else {
            return false;
        };
        let Some(window) = editor_window.take() else {
            return false;
        };
        drop(editor_window);
        self.is_editor_open.store(false, Ordering::SeqCst);
        self.window_thread.store(None);
        // A panic in the window's own thread is passed on by the drop, and must not reach the host.
        let _ = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| drop(window)));
        true
    }

    /// Posts the task to the background task queue using [`EventLoop::schedule_background()`] so it
"#,
    ),
    edit(
        INNER,
        r#"                if let Some(editor_window) = self.editor_window.borrow().as_ref() {
                    editor_window.get().handle.state_changed();
"#,
        r#"                if let Some(editor_window) = self.open_window() {
                    editor_window.handle.state_changed();
"#,
    ),
    edit(
        INNER,
        r#"                if let Some(editor_window) = self.editor_window.borrow().as_ref() {
                    let param_id = &self.param_id_by_hash[&param_hash];
                    editor_window
                        .get()
                        .handle
"#,
        r#"                if let Some(editor_window) = self.open_window() {
                    let param_id = &self.param_id_by_hash[&param_hash];
                    editor_window
                        .handle
"#,
    ),
    edit(
        INNER,
        r#"                if let Some(editor_window) = self.editor_window.borrow().as_ref() {
                    let editor_window = editor_window.get();
                    editor_window
                        .handle
                        .host_main_thread_callback(&editor_window.window)
"#,
        r#"                if let Some(editor_window) = self.open_window() {
                    editor_window
                        .handle
                        .host_main_thread_callback(&editor_window.window)
"#,
    ),
    // The same in the view's calls.
    edit(
        VIEW,
        "            && let Some(editor_window) = inner.editor_window.borrow().as_ref()
        {
            if editor_window
                .get()
                .handle
",
        "            && let Some(editor_window) = inner.open_window()
        {
            if editor_window
                .handle
",
    ),
    Edit {
        file: VIEW,
        old: "        if let Some(editor_window) = inner.editor_window.borrow().as_ref() {
            let editor_window = editor_window.get();
",
        new: "        if let Some(editor_window) = inner.open_window() {
",
        times: 3,
    },
    edit(
        VIEW,
        "        let mut window = inner.editor_window.borrow_mut();
        if window.is_none() {
",
        "        let Ok(mut window) = inner.editor_window.try_borrow_mut() else {
            return kResultFalse;
        };
        if window.is_none() {
",
    ),
    edit(
        VIEW,
        "                        *window = Some(Fragile::new(editor_window));
",
        "                        *window = Some(Fragile::new(editor_window));
                        inner.window_thread.store(Some(std::thread::current().id()));
",
    ),
    edit(
        VIEW,
        "        let mut editor_handle = inner.editor_window.borrow_mut();
        if editor_handle.is_some() {
            inner.is_editor_open.store(false, Ordering::SeqCst);
            *editor_handle = None;

            kResultOk
",
        "        if inner.close_window() {
            kResultOk
",
    ),
];
