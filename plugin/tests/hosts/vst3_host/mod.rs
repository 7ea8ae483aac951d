//! A VST3 host of our own that calls the plugin's C interfaces directly, for calls that other hosts do not make on demand.

#![allow(unsafe_code, non_snake_case, reason = "the format is a C interface, and its names are the format's")]

mod block;
#[cfg(target_os = "linux")]
mod frame;
mod handler;
mod library;
mod stream;

#[cfg(target_os = "linux")]
pub(crate) use block::{Automation, Block};
#[cfg(target_os = "linux")]
pub(crate) use frame::{Frame, FrameWithoutLoop};

use crate::host::bundle;
use handler::{Handler, Places};
use library::Library;
use std::ptr::null_mut;
use std::sync::Arc;
use stream::Stream;
use vst3::Steinberg::Vst::{
    BusDirections_, IAudioProcessor, IAudioProcessorTrait, IComponent, IComponentHandler, IComponentTrait,
    IEditController, IEditControllerTrait, MediaTypes_, ParamID, ParameterInfo, ProcessModes_, ProcessSetup,
    SymbolicSampleSizes_,
};
use vst3::Steinberg::{
    IBStream, IPlugView, IPlugViewContentScaleSupport, IPlugViewContentScaleSupportTrait, IPlugViewTrait,
    IPluginBaseTrait, IPluginFactory, IPluginFactoryTrait, ViewRect, kResultOk,
};
use vst3::{ComPtr, ComWrapper, Interface};

/// Frames per block.
pub(crate) const FRAMES: usize = 64;

/// The plugin's class id. Pinned: a host finds a project's plugin by it. On Windows ids have the order of COM's, whose numbers
/// are little-endian, so that hosts of all systems write the same text for it.
const CLASS: &[u8; 16] = if cfg!(windows) { b"urpSgnaMssSpring" } else { b"SprungMassSpring" };

/// The plugin's factory. The library stays open as long as anything of it is in use.
pub(crate) struct Module {
    factory: ComPtr<IPluginFactory>,
    library: Arc<Library>,
}

impl Module {
    pub(crate) fn open() -> Self {
        let library = Library::open(&bundle::vst3_library());
        // SAFETY: the function gives a reference to the caller.
        let factory = unsafe { ComPtr::from_raw(library.factory()) }.expect("a factory");
        Self { factory, library: Arc::new(library) }
    }
}

/// An instance of the plugin. The thread that created it is the host's main thread.
pub(crate) struct Vst3 {
    // Fields are dropped in this order, the library last.
    controller: ComPtr<IEditController>,
    pub(crate) processor: ComPtr<IAudioProcessor>,
    component: ComPtr<IComponent>,
    menus: Places,
    _library: Arc<Library>,
}

impl Vst3 {
    pub(crate) fn new(module: &Module) -> Self {
        let mut component = null_mut();
        // SAFETY: each pointer is for the interface that is requested; the plugin holds a reference to the handler.
        unsafe {
            let result = module.factory.createInstance(
                CLASS.as_ptr().cast(),
                IComponent::IID.as_ptr().cast(),
                &raw mut component,
            );
            assert_eq!(result, kResultOk, "the class is there");
            let component = ComPtr::from_raw(component.cast::<IComponent>()).expect("an instance");
            assert_eq!(component.initialize(null_mut()), kResultOk);
            let controller = component.cast::<IEditController>().expect("a controller");
            let processor = component.cast::<IAudioProcessor>().expect("a processor");
            let menus = Places::default();
            let handler = ComWrapper::new(Handler::new(&menus)).to_com_ptr::<IComponentHandler>().unwrap();
            assert_eq!(controller.setComponentHandler(handler.as_ptr()), kResultOk);
            Self { controller, processor, component, menus, _library: module.library.clone() }
        }
    }

    /// Makes the plugin ready to process blocks of [`FRAMES`].
    pub(crate) fn start(&self) {
        let mut setup = ProcessSetup {
            processMode: ProcessModes_::kRealtime as i32,
            symbolicSampleSize: SymbolicSampleSizes_::kSample32 as i32,
            maxSamplesPerBlock: FRAMES as i32,
            sampleRate: 48_000.0,
        };
        // SAFETY: the calls are in the order that the format requires, and the setup lives until its call returns.
        unsafe {
            assert_eq!(self.processor.setupProcessing(&raw mut setup), kResultOk);
            for (media, direction) in
                [(MediaTypes_::kAudio, BusDirections_::kOutput), (MediaTypes_::kEvent, BusDirections_::kInput)]
            {
                assert_eq!(self.component.activateBus(media as i32, direction as i32, 0, 1), kResultOk);
            }
            assert_eq!(self.component.setActive(1), kResultOk);
            assert_eq!(self.processor.setProcessing(1), kResultOk);
        }
    }

    /// Ends processing.
    pub(crate) fn stop(&self) {
        // SAFETY: the calls are in the order that the format requires.
        unsafe {
            assert_eq!(self.processor.setProcessing(0), kResultOk);
            assert_eq!(self.component.setActive(0), kResultOk);
        }
    }

    /// Id and title of the parameter at an index; `None` if there is none.
    pub(crate) fn parameter(&self, index: i32) -> Option<(ParamID, String)> {
        // SAFETY: all zeros are a valid value of the type, a plain C struct.
        let mut info: ParameterInfo = unsafe { std::mem::zeroed() };
        // SAFETY: the struct lives until the call returns.
        if unsafe { self.controller.getParameterInfo(index, &raw mut info) } != kResultOk {
            return None;
        }
        let title: Vec<u16> = info.title.iter().copied().take_while(|unit| *unit != 0).collect();
        Some((info.id, String::from_utf16(&title).unwrap()))
    }

    /// Number of parameters, including those that stand for controllers.
    pub(crate) fn parameter_count(&self) -> i32 {
        // SAFETY: the call has no preconditions.
        unsafe { self.controller.getParameterCount() }
    }

    /// The parameters whose menus were opened since the last call, and where in the plugin's window.
    pub(crate) fn menus(&self) -> Vec<(ParamID, [i32; 2])> {
        std::mem::take(&mut *self.menus.lock().unwrap())
    }

    /// The position of a parameter, 0–1.
    pub(crate) fn position(&self, id: ParamID) -> f64 {
        // SAFETY: the call has no preconditions.
        unsafe { self.controller.getParamNormalized(id) }
    }

    /// Loads a state. Returns whether the plugin accepted it.
    pub(crate) fn load(&self, state: &[u8]) -> bool {
        let stream = ComWrapper::new(Stream::new(state.to_vec()));
        let stream = stream.to_com_ptr::<IBStream>().unwrap();
        // SAFETY: the stream lives until the call returns.
        unsafe { self.component.setState(stream.as_ptr()) == kResultOk }
    }

    /// The state as it is saved in a project.
    pub(crate) fn save(&self) -> Vec<u8> {
        let stream = ComWrapper::new(Stream::new(Vec::new()));
        let pointer = stream.to_com_ptr::<IBStream>().unwrap();
        // SAFETY: the stream lives until the call returns.
        assert_eq!(unsafe { self.component.getState(pointer.as_ptr()) }, kResultOk);
        stream.bytes()
    }

    /// The view of the plugin's window, which is not open yet.
    pub(crate) fn view(&self) -> View {
        // SAFETY: the call has no preconditions; the caller owns the view.
        View(unsafe { ComPtr::from_raw(self.controller.createView(c"editor".as_ptr())) }.expect("a view"))
    }

    /// Opens the plugin's window inside a window of the host.
    #[cfg(target_os = "linux")]
    pub(crate) fn open_window(&self, frame: &ComPtr<vst3::Steinberg::IPlugFrame>, parent: u32) -> View {
        let view = self.view();
        view.attach(frame, parent);
        view
    }
}

impl Drop for Vst3 {
    fn drop(&mut self) {
        // SAFETY: this is called before the last reference is released.
        unsafe {
            self.controller.setComponentHandler(null_mut());
            self.component.terminate();
        }
    }
}

/// The plugin's open window.
pub(crate) struct View(ComPtr<IPlugView>);

impl View {
    /// Opens the window inside a window of the host.
    #[cfg(target_os = "linux")]
    pub(crate) fn attach(&self, frame: &ComPtr<vst3::Steinberg::IPlugFrame>, parent: u32) {
        // SAFETY: frame and parent outlive the view; the calls are in the order that the format requires.
        unsafe {
            assert_eq!(self.0.setFrame(frame.as_ptr()), kResultOk);
            let parent = std::ptr::without_provenance_mut(parent as usize);
            assert_eq!(
                self.0.attached(parent, vst3::Steinberg::kPlatformTypeX11EmbedWindowID),
                kResultOk,
                "the window opens"
            );
        }
    }

    /// Tells the host's scale.
    pub(crate) fn set_scale(&self, scale: f32) {
        let scaled = self.0.cast::<IPlugViewContentScaleSupport>().expect("it takes scales");
        // SAFETY: the call has no preconditions.
        assert_eq!(unsafe { scaled.setContentScaleFactor(scale) }, kResultOk, "it takes this scale");
    }

    /// Width and height as the host is told.
    pub(crate) fn size(&self) -> [u32; 2] {
        let mut size = ViewRect { left: 0, top: 0, right: 0, bottom: 0 };
        // SAFETY: the size lives until the call returns.
        assert_eq!(unsafe { self.0.getSize(&raw mut size) }, kResultOk);
        [size.right - size.left, size.bottom - size.top].map(|side| side as u32)
    }

    /// Closes the window as most hosts do.
    pub(crate) fn close(self) {
        // SAFETY: the calls are in the order that the format requires.
        unsafe {
            assert_eq!(self.0.removed(), kResultOk, "the window closes");
            assert_eq!(self.0.setFrame(null_mut()), kResultOk);
        }
    }

    /// Closes the window and releases it without removing the frame, as careless hosts do.
    pub(crate) fn close_carelessly(self) {
        // SAFETY: the view is attached.
        assert_eq!(unsafe { self.0.removed() }, kResultOk, "the window closes");
    }
}

/// Number of threads of this process with this name.
#[cfg(target_os = "linux")]
pub(crate) fn threads_called(name: &str) -> usize {
    let tasks = std::fs::read_dir("/proc/self/task").unwrap();
    // Threads may end during the count.
    let names = tasks.filter_map(|task| std::fs::read_to_string(task.unwrap().path().join("comm")).ok());
    names.filter(|found| found.trim() == name).count()
}
