//! Edits for the host’s menu of a parameter, by CLAP’s context-menu extension and VST3’s `IComponentHandler3`.
//!
//! Hosts show menus only from their main thread, and a menu may run the host's event loop until it is closed. So the request
//! must never be carried out within the window's own pass: it is a task for later. In VST3 that is possible on Linux alone, where
//! the window has a thread of its own; elsewhere a VST3 window has no such entry.

use super::edit::{CLAP_CONTEXT, CLAP_WRAPPER, CONTEXT, Edit, INNER, WRAPPER, edit};

/// The interface of the window's context, in nice-plug-core.
pub(super) const INTERFACE: &[Edit] = &[
    edit(
        GUI,
        "    /// Serialize the plugin's current state to a serde-serializable object. Useful for implementing
    /// preset handling within a plugin's GUI.
    pub fn get_state(&self) -> PluginState {
",
        "    /// Whether the host can show a menu of its own for a parameter.
    pub fn has_host_menu(&self) -> bool {
        self.inner.has_host_menu()
    }

    /// Ask the host to show its menu for a parameter, at a place in the window in the units of the
    /// host's window system. The menu opens later, on the host's main thread.
    ///
    /// # Safety
    ///
    /// The implementing function still needs to check if `param` actually exists.
    pub unsafe fn raw_show_host_menu(&self, param: ParamPtr, x: i32, y: i32) {
        unsafe { self.inner.raw_show_host_menu(param, x, y) };
    }

    /// Serialize the plugin's current state to a serde-serializable object. Useful for implementing
    /// preset handling within a plugin's GUI.
    pub fn get_state(&self) -> PluginState {
",
    ),
    edit(
        GUI,
        "    /// Serialize the plugin's current state to a serde-serializable object. Useful for implementing
    /// preset handling within a plugin's GUI.
    fn get_state(&self) -> PluginState;
",
        "    /// Whether the host can show a menu of its own for a parameter.
    fn has_host_menu(&self) -> bool {
        false
    }

    /// Ask the host to show its menu for a parameter, at a place in the window.
    ///
    /// # Safety
    ///
    /// The implementing function still needs to check if `param` actually exists.
    unsafe fn raw_show_host_menu(&self, _param: ParamPtr, _x: i32, _y: i32) {}

    /// Serialize the plugin's current state to a serde-serializable object. Useful for implementing
    /// preset handling within a plugin's GUI.
    fn get_state(&self) -> PluginState;
",
    ),
];

const GUI: &str = "src/context/gui.rs";

pub(super) const EDITS: &[Edit] = &[
    // CLAP: the extension is asked for with the others.
    edit(
        CLAP_WRAPPER,
        "#[cfg(feature = \"editor\")]
use clap_sys::ext::gui::{clap_host_gui, clap_plugin_gui};
",
        "#[cfg(feature = \"editor\")]
use clap_sys::ext::context_menu::{
    CLAP_CONTEXT_MENU_TARGET_KIND_PARAM, CLAP_EXT_CONTEXT_MENU, CLAP_EXT_CONTEXT_MENU_COMPAT,
    clap_context_menu_target, clap_host_context_menu,
};
#[cfg(feature = \"editor\")]
use clap_sys::ext::gui::{clap_host_gui, clap_plugin_gui};
",
    ),
    edit(
        CLAP_WRAPPER,
        "    host_voice_info: AtomicRefCell<Option<ClapPtr<clap_host_voice_info>>>,
",
        "    host_voice_info: AtomicRefCell<Option<ClapPtr<clap_host_voice_info>>>,
    #[cfg(feature = \"editor\")]
    host_context_menu: AtomicRefCell<Option<ClapPtr<clap_host_context_menu>>>,
    /// Whether the host can show its menu over the open window.
    #[cfg(feature = \"editor\")]
    pub has_host_menu: AtomicBool,
",
    ),
    edit(
        CLAP_WRAPPER,
        "            host_voice_info: AtomicRefCell::new(None),
",
        "            host_voice_info: AtomicRefCell::new(None),
            #[cfg(feature = \"editor\")]
            host_context_menu: AtomicRefCell::new(None),
            #[cfg(feature = \"editor\")]
            has_host_menu: AtomicBool::new(false),
",
    ),
    edit(
        CLAP_WRAPPER,
        "                *wrapper.host_track_info.borrow_mut() = query_host_extension::<clap_host_track_info>(
",
        "                *wrapper.host_context_menu.borrow_mut() =
                    [CLAP_EXT_CONTEXT_MENU, CLAP_EXT_CONTEXT_MENU_COMPAT]
                        .into_iter()
                        .find_map(|name| query_host_extension(&wrapper.host_callback, name));

                *wrapper.host_track_info.borrow_mut() = query_host_extension::<clap_host_track_info>(
",
    ),
    edit(
        CLAP_WRAPPER,
        "    /// Tell the host that it should rescan the current parameter values.
    RescanParamValues,
}
",
        "    /// Tell the host that it should rescan the current parameter values.
    RescanParamValues,
    /// Ask the host to show its menu for a parameter.
    #[cfg(feature = \"editor\")]
    ShowHostMenu { param_hash: u32, x: i32, y: i32 },
}
",
    ),
    edit(
        CLAP_WRAPPER,
        "            Task::VoiceInfoChanged => match &*self.host_voice_info.borrow() {
",
        "            #[cfg(feature = \"editor\")]
            Task::ShowHostMenu { param_hash, x, y } => {
                let menu = self.host_context_menu.borrow().clone();
                let target = clap_context_menu_target {
                    kind: CLAP_CONTEXT_MENU_TARGET_KIND_PARAM,
                    id: param_hash,
                };
                if let Some(popup) = menu.and_then(|menu| menu.popup) {
                    // A host that refuses shows nothing.
                    let _ = unsafe { popup(&*self.host_callback, &target, 0, x, y) };
                }
            }
            Task::VoiceInfoChanged => match &*self.host_voice_info.borrow() {
",
    ),
    edit(
        CLAP_WRAPPER,
        "    pub fn request_restart(&self) {
        unsafe_clap_call! { &*self.host_callback=>request_restart(&*self.host_callback) };
    }
",
        "    pub fn request_restart(&self) {
        unsafe_clap_call! { &*self.host_callback=>request_restart(&*self.host_callback) };
    }

    /// Asks the host whether it can show its menu. To be called on the main thread, with a window.
    #[cfg(feature = \"editor\")]
    fn ask_for_host_menu(&self) {
        let menu = self.host_context_menu.borrow().clone();
        let can_popup = menu.and_then(|menu| menu.can_popup);
        let has_menu = can_popup.is_some_and(|can_popup| unsafe { can_popup(&*self.host_callback) });
        self.has_host_menu.store(has_menu, Ordering::Relaxed);
    }

    /// Makes the host show its menu for a parameter later, even if this is the main thread.
    #[cfg(feature = \"editor\")]
    pub fn show_host_menu(&self, param: ParamPtr, x: i32, y: i32) {
        if let Some(param_hash) = self.param_ptr_to_hash.get(&param).copied()
            && self.tasks.push(Task::ShowHostMenu { param_hash, x, y }).is_ok()
        {
            let host = &self.host_callback;
            unsafe_clap_call! { host=>request_callback(&**host) };
        }
    }
",
    ),
    edit(
        CLAP_WRAPPER,
        "                crate::nice_error!(\"Failed to set editor parent window: {}\", e);

                false
            } else {
                true
",
        "                crate::nice_error!(\"Failed to set editor parent window: {}\", e);

                false
            } else {
                wrapper.ask_for_host_menu();
                true
",
    ),
    edit(
        CLAP_CONTEXT,
        "    fn get_state(&self) -> nice_plug_core::plugin::PluginState {
",
        "    fn has_host_menu(&self) -> bool {
        let wrapper = self.wrapper.upgrade().unwrap();
        wrapper.has_host_menu.load(std::sync::atomic::Ordering::Relaxed)
    }

    unsafe fn raw_show_host_menu(&self, param: ParamPtr, x: i32, y: i32) {
        self.wrapper.upgrade().unwrap().show_host_menu(param, x, y);
    }

    fn get_state(&self) -> nice_plug_core::plugin::PluginState {
",
    ),
    // VST3: the host's handler may have a further interface that makes menus.
    edit(
        INNER,
        "#[cfg(feature = \"editor\")]
use vst3::ComWrapper;
",
        "#[cfg(feature = \"editor\")]
use vst3::ComWrapper;
#[cfg(feature = \"editor\")]
use vst3::Steinberg::IPlugView;
#[cfg(feature = \"editor\")]
use vst3::Steinberg::Vst::{IComponentHandler3, IComponentHandler3Trait, IContextMenuTrait};
",
    ),
    edit(
        INNER,
        "    #[cfg(feature = \"editor\")]
    CallMainThread,
}
",
        "    #[cfg(feature = \"editor\")]
    CallMainThread,
    /// Ask the host to show its menu for a parameter.
    #[cfg(feature = \"editor\")]
    ShowHostMenu { param_hash: u32, x: i32, y: i32 },
}
",
    ),
    edit(
        INNER,
        "            #[cfg(feature = \"editor\")]
            Task::CallMainThread => {
",
        "            #[cfg(feature = \"editor\")]
            Task::ShowHostMenu { param_hash, x, y } => {
                let view = self.plug_view.read().clone();
                // A host without a run loop has tasks done by the worker, where it may not show a menu.
                if is_gui_thread
                    && let (Some(handler), Some(view)) = (self.menu_handler(), view)
                    && let Some(view) = view.to_com_ptr::<IPlugView>()
                {
                    unsafe {
                        let menu = handler.createContextMenu(view.as_ptr(), &param_hash);
                        if let Some(menu) = ComPtr::from_raw(menu) {
                            menu.popup(x, y);
                        }
                    }
                }
            }
            #[cfg(feature = \"editor\")]
            Task::CallMainThread => {
",
    ),
    edit(
        INNER,
        "    /// The thread that opened the window, while it is open.
",
        "    /// Whether the host can show menus of parameters, and the window's thread may ask for them.
    #[cfg(feature = \"editor\")]
    pub has_host_menu: AtomicBool,

    /// The thread that opened the window, while it is open.
",
    ),
    edit(
        INNER,
        "            window_thread: AtomicCell::new(None),
",
        "            window_thread: AtomicCell::new(None),
            #[cfg(feature = \"editor\")]
            has_host_menu: AtomicBool::new(false),
",
    ),
    edit(
        WRAPPER,
        "            unsafe { ComRef::from_raw(handler) }.map(|r| r.to_com_ptr());

        kResultOk
",
        "            unsafe { ComRef::from_raw(handler) }.map(|r| r.to_com_ptr());
        #[cfg(feature = \"editor\")]
        {
            let has_menu = cfg!(target_os = \"linux\") && self.inner.menu_handler().is_some();
            self.inner.has_host_menu.store(has_menu, std::sync::atomic::Ordering::Relaxed);
        }

        kResultOk
",
    ),
    edit(
        INNER,
        "    /// The host's [`IComponentHandler`], which is not locked while it is being called.
",
        "    /// The host's interface for menus of parameters, if it has one.
    #[cfg(feature = \"editor\")]
    pub fn menu_handler(&self) -> Option<ComPtr<IComponentHandler3>> {
        self.component_handler()?.cast()
    }

    /// The host's [`IComponentHandler`], which is not locked while it is being called.
",
    ),
    edit(
        CONTEXT,
        "    fn get_state(&self) -> PluginState {
",
        "    fn has_host_menu(&self) -> bool {
        let inner = self.inner.upgrade().unwrap();
        inner.has_host_menu.load(std::sync::atomic::Ordering::Relaxed)
    }

    unsafe fn raw_show_host_menu(&self, param: ParamPtr, x: i32, y: i32) {
        let inner = self.inner.upgrade().unwrap();
        if let Some(param_hash) = inner.param_ptr_to_hash.get(&param).copied() {
            let task_posted = inner.schedule_gui(Task::ShowHostMenu { param_hash, x, y });
            crate::nice_debug_assert!(task_posted, \"The task queue is full, dropping task...\");
        }
    }

    fn get_state(&self) -> PluginState {
",
    ),
];
