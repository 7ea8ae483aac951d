//! Edits of calls between host and plugin: nothing stays borrowed while the host runs, and indices are checked.

use super::edit::{CONTEXT, Edit, INNER, WRAPPER, edit};

pub(super) const EDITS: &[Edit] = &[
    // The host's handler is also called from the window's thread. It is borrowed only while the pointer is copied, and
    // a thread that sets the handler waits for that instead of panicking.
    edit(
        INNER,
        "#[cfg(feature = \"editor\")]
use parking_lot::RwLock;
",
        "use parking_lot::RwLock;
",
    ),
    edit(
        INNER,
        "pub component_handler: AtomicRefCell<Option<ComPtr<IComponentHandler>>>,",
        "pub component_handler: RwLock<Option<ComPtr<IComponentHandler>>>,",
    ),
    edit(INNER, "component_handler: AtomicRefCell::new(None),", "component_handler: RwLock::new(None),"),
    edit(
        INNER,
        "    #[cfg(feature = \"editor\")]
    pub fn make_gui_context(",
        "    /// The host's [`IComponentHandler`], which is not locked while it is being called.
    pub fn component_handler(&self) -> Option<ComPtr<IComponentHandler>> {
        self.component_handler.read().clone()
    }

    #[cfg(feature = \"editor\")]
    pub fn make_gui_context(",
    ),
    edit(INNER, "match &*self.component_handler.borrow() {", "match &self.component_handler() {"),
    Edit {
        file: CONTEXT,
        old: "match &*inner.component_handler.borrow() {",
        new: "match &inner.component_handler() {",
        times: 3,
    },
    edit(WRAPPER, "*self.inner.component_handler.borrow_mut() =", "*self.inner.component_handler.write() ="),
    // The index one past the last parameter must give no parameter.
    edit(
        WRAPPER,
        "if param_index < 0 || param_index > unsafe { self.getParameterCount() } {",
        "if param_index < 0 || param_index >= unsafe { self.getParameterCount() } {",
    ),
];
