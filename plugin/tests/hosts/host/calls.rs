//! Counts the requests of the plugin to its host.

use clack_extensions::context_menu::{ContextMenuBuilder, ContextMenuTarget, HostContextMenu, HostContextMenuImpl};
use clack_extensions::gui::{GuiSize, HostGui, HostGuiImpl};
use clack_extensions::latency::{HostLatency, HostLatencyImpl};
use clack_extensions::note_name::{HostNoteName, HostNoteNameImpl};
use clack_extensions::params::{
    HostParams, HostParamsImplMainThread, HostParamsImplShared, ParamClearFlags, ParamRescanFlags,
};
use clack_extensions::preset_discovery::HostPresetLoadImpl;
use clack_extensions::preset_discovery::prelude::{HostPresetLoad, Location};
use clack_extensions::thread_check::{HostThreadCheck, HostThreadCheckImpl};
use clack_extensions::voice_info::{HostVoiceInfo, HostVoiceInfoImpl};
use clack_host::prelude::*;
use std::cell::{Cell, RefCell};
use std::ffi::CStr;
use std::sync::Mutex;
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
        builder.register::<HostContextMenu>().register::<HostNoteName>().register::<HostPresetLoad>();
        if calls.tells_threads {
            builder.register::<HostThreadCheck>();
        }
    }
}

/// Requests that may come from any thread.
pub(crate) struct Calls {
    /// The main thread of the instance.
    main: ThreadId,
    /// Whether this host has CLAP's thread-check extension.
    tells_threads: bool,
    /// Whether the plugin has requested a call on the main thread.
    pub(crate) callback: AtomicBool,
    /// Number of requested restarts.
    pub(crate) restarts: AtomicU32,
    /// Number of requested parameter flushes.
    pub(crate) flushes: AtomicU32,
    /// The last size that was requested for the window.
    pub(crate) resize: Mutex<Option<[u32; 2]>>,
    /// Whether the host keeps its window as it is.
    pub(crate) refuses_sizes: AtomicBool,
}

impl Calls {
    /// No requests yet. To be called on the main thread.
    pub(crate) fn new(tells_threads: bool) -> Self {
        Self {
            main: std::thread::current().id(),
            tells_threads,
            callback: AtomicBool::new(false),
            restarts: AtomicU32::new(0),
            flushes: AtomicU32::new(0),
            resize: Mutex::new(None),
            refuses_sizes: AtomicBool::new(false),
        }
    }
}

/// Requests that only come from the main thread.
#[derive(Default)]
pub(crate) struct MainThreadCalls {
    /// Number of requested rescans of parameters.
    pub(crate) rescans: Cell<u32>,
    /// Number of reported latency changes.
    pub(crate) latencies: Cell<u32>,
    /// The parameters for which the plugin has asked for a menu, and where in its window.
    pub(crate) menus: RefCell<Vec<(u32, [i32; 2])>>,
    /// How often the plugin has said that keys have other names.
    pub(crate) renamings: Cell<u32>,
    /// What the plugin has said of presets that it was to load, in the order in which it was said.
    pub(crate) presets: RefCell<Vec<PresetCall>>,
}

/// What a plugin says of a preset that it was to load.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PresetCall {
    /// It is loaded from this file, or from the plugin, by this key.
    Loaded(Option<String>, Option<String>),
    /// It is not, for a reason with the system's number.
    Failed(i32, String),
}

/// A text of C.
pub(crate) fn text(string: &CStr) -> String {
    string.to_str().expect("texts are UTF-8").to_owned()
}

impl HostNoteNameImpl for MainThreadCalls {
    fn changed(&self) {
        self.renamings.set(self.renamings.get() + 1);
    }
}

impl HostPresetLoadImpl for MainThreadCalls {
    fn on_error(&self, _: Location, _: Option<&CStr>, os_error: i32, message: Option<&CStr>) {
        let message = text(message.expect("an error has a message"));
        self.presets.borrow_mut().push(PresetCall::Failed(os_error, message));
    }

    fn loaded(&self, location: Location, key: Option<&CStr>) {
        let path = location.file_path().map(text);
        self.presets.borrow_mut().push(PresetCall::Loaded(path, key.map(text)));
    }
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

impl HostContextMenuImpl for MainThreadCalls {
    fn populate(&self, _: ContextMenuTarget, _: &mut ContextMenuBuilder) -> Result<(), HostError> {
        Ok(())
    }

    fn perform(&self, _: ContextMenuTarget, _: ClapId) -> Result<(), HostError> {
        Ok(())
    }

    fn can_popup(&self) -> bool {
        true
    }

    fn popup(&self, target: ContextMenuTarget, _screen: i32, x: i32, y: i32) -> Result<(), HostError> {
        let ContextMenuTarget::Param(id) = target else { panic!("a menu of a parameter") };
        self.menus.borrow_mut().push((id.get(), [x, y]));
        Ok(())
    }
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

    fn request_resize(&self, size: GuiSize) -> Result<(), HostError> {
        *self.resize.lock().unwrap() = Some([size.width, size.height]);
        if self.refuses_sizes.load(Ordering::Relaxed) {
            return Err(HostError::Message("this host resizes nothing"));
        }
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
