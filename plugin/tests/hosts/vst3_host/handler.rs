//! The host's side of edits and menus: what the plugin reports of its parameters, and the menus that it asks for.

use std::cell::Cell;
use std::sync::{Arc, Mutex};
use std::thread::ThreadId;
use vst3::Steinberg::Vst::{
    IComponentHandler, IComponentHandler3, IComponentHandler3Trait, IComponentHandlerTrait, IContextMenu,
    IContextMenuItem, IContextMenuTarget, IContextMenuTrait, ParamID, ParamValue,
};
use vst3::Steinberg::{IPlugView, kInvalidArgument, kResultOk, tresult};
use vst3::{Class, ComWrapper};

/// Parameters with places in the plugin's window.
pub(super) type Places = Arc<Mutex<Vec<(ParamID, [i32; 2])>>>;

/// Receives the plugin's reports of edits in its window, and makes menus.
pub(super) struct Handler {
    /// The menus that were opened.
    menus: Places,
    /// The thread of the host's menus.
    main: ThreadId,
}

impl Handler {
    /// A handler whose menus are listed in `menus`. To be called on the host's main thread.
    pub(super) fn new(menus: &Places) -> Self {
        Self { menus: menus.clone(), main: std::thread::current().id() }
    }
}

impl Class for Handler {
    type Interfaces = (IComponentHandler, IComponentHandler3);
}

impl IComponentHandler3Trait for Handler {
    unsafe fn createContextMenu(&self, view: *mut IPlugView, parameter: *const ParamID) -> *mut IContextMenu {
        assert!(!view.is_null() && std::thread::current().id() == self.main);
        // SAFETY: the plugin passes a parameter, which lives until the call returns.
        let menu = Menu { parameter: unsafe { *parameter }, place: Cell::default(), opened: self.menus.clone() };
        ComWrapper::new(menu).to_com_ptr::<IContextMenu>().unwrap().into_raw()
    }
}

/// A menu of a parameter.
struct Menu {
    parameter: ParamID,
    /// Where it was opened.
    place: Cell<[i32; 2]>,
    opened: Places,
}

impl Class for Menu {
    type Interfaces = (IContextMenu,);
}

impl IContextMenuTrait for Menu {
    unsafe fn getItemCount(&self) -> i32 {
        0
    }

    unsafe fn getItem(&self, _: i32, _: *mut IContextMenuItem, _: *mut *mut IContextMenuTarget) -> tresult {
        kInvalidArgument
    }

    unsafe fn addItem(&self, _: *const IContextMenuItem, _: *mut IContextMenuTarget) -> tresult {
        kResultOk
    }

    unsafe fn removeItem(&self, _: *const IContextMenuItem, _: *mut IContextMenuTarget) -> tresult {
        kResultOk
    }

    unsafe fn popup(&self, x: i32, y: i32) -> tresult {
        self.place.set([x, y]);
        kResultOk
    }
}

/// Menus are listed when the plugin has released them.
impl Drop for Menu {
    fn drop(&mut self) {
        self.opened.lock().unwrap().push((self.parameter, self.place.get()));
    }
}

impl IComponentHandlerTrait for Handler {
    unsafe fn beginEdit(&self, _: ParamID) -> tresult {
        kResultOk
    }

    unsafe fn performEdit(&self, _: ParamID, _: ParamValue) -> tresult {
        kResultOk
    }

    unsafe fn endEdit(&self, _: ParamID) -> tresult {
        kResultOk
    }

    unsafe fn restartComponent(&self, _: i32) -> tresult {
        kResultOk
    }
}
