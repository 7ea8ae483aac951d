//! The plugin's window.
//!
//! | folder | what one sees there |
//! |---|---|
//! | `window` | the whole: header, status line, and what they ask for |
//! | `theme` | colours, sizes and fonts; the places of the parts |
//! | `play` | the page it opens with: the body large, what moves it, what it is, what it stands on, macros |
//! | `pages` | *Sound*: the way of the sound as a picture, its chosen part with knobs in groups, the line of sources, tuning |
//! | `modes`, `displays`, `body` | pictures of the body there: its modes, its motion; what it is made of |
//! | `motion`, `routes` | what moves: sources, envelopes and oscillators as curves; routes as sentences, also learnt and dragged |
//! | `kit` | the pads of a kit, the sounds that are put on them, and the chosen pad; all keys of a preset |
//! | `keyboard` | the piano and its wheels, and whatever else plays a key |
//! | `browser`, `manual`, `drops`, `picker` | over the window: sounds to find and save, the manual, fits of dropped recordings, files |
//! | `widgets` | what all of these are made of |
//! | `background` | not seen: work of seconds on a thread of its own |
//! | `binding` | in the menus of knobs: controllers that turn them |
//! | `controls` | not seen: what widgets share, changes that hosts see, undo, the sound that is shown |
//! | `host` | not seen: the window's size, focus and screen readers at its host |
//!
//! Widgets draw themselves in egui's shapes. `tests` draws the window without a GPU, by the rules of egui's own shader,
//! and compares pictures; it also computes the contrast (WCAG 2.2) of each text.
//!
//! **Painting on a CPU.** With Mesa's llvmpipe a picture took 46 ms and now takes 23 (debug build, 1100 × 700, a bell
//! that rings, beside other work). Dithering was a computation for each pixel of a window without gradients. The ground
//! is the colour with which the window is cleared, and was painted twice over that. At 100 %, heads of modes are two
//! discs of the font's texture (4 triangles instead of 150), and arcs have half as many corners. `glxgears` in a window
//! of that size takes 3 ms of CPU per picture on the same machine, without the X server: 17 % of a core at 60 pictures
//! per second, so no picture of a whole window can cost less. The plugin's own library takes at most 1.7 ms of that (release build,
//! `perf`, the body moving; the sound itself is in it). `plugin/tests/hosts/cpu` prints the costs, and fails if a
//! silent window is drawn.

mod background;
mod binding;
mod body;
mod browser;
mod controls;
mod devices;
mod displays;
mod drops;
pub(crate) mod host;
mod keyboard;
mod kit;
mod lamps;
mod manual;
mod modes;
mod motion;
mod pages;
mod picker;
mod play;
mod routes;
#[cfg(test)]
mod tests;
pub(crate) mod theme;
mod widgets;
mod window;

use crate::params::SprungParams;
use egui_baseview::GraphicsConfig;
use host::extent;
use nice_plug_core::context::gui::GuiContext;
use nice_plug_core::editor::dpi::{LogicalSize, NativeSize};
use nice_plug_core::editor::{Editor, HostMethods, ParentWindowHandle, ResizeHint, SpawnedEditor};
use nice_plug_egui::{EguiEditorHandle, EguiEditorState, EguiNiceSettings, create_egui_editor};
use sprung::internals::library::Library;
use std::error::Error;
use std::sync::Arc;
use theme::LEAST_SIZE;
use window::{Past, Window};

/// Opens windows. Each opens in the size of the last one.
pub struct SprungEditor {
    params: Arc<SprungParams>,
    past: Past,
}

impl SprungEditor {
    pub(crate) fn new(params: Arc<SprungParams>) -> Self {
        Self { params, past: Past::default() }
    }
}

#[cfg(feature = "standalone")]
impl SprungEditor {
    /// Opens a window of its own, with this context for a host, and waits until it is closed.
    pub(crate) fn run(&self, context: GuiContext) -> Result<(), Box<dyn Error>> {
        let SpawnedEditor { handle, window } = self.spawn(None, false, None, context, None)?;
        let ended = <EguiEditorHandle as nice_plug_core::editor::EditorHandle>::run_until_closed(window);
        drop(handle);
        Ok(ended?)
    }
}

impl Editor for SprungEditor {
    type Handle = EguiEditorHandle;

    fn spawn(
        &self,
        parent: Option<ParentWindowHandle>,
        wait_for_parent: bool,
        fallback_scale_factor: Option<f64>,
        gui_context: GuiContext,
        host: Option<HostMethods>,
    ) -> Result<SpawnedEditor<Self::Handle>, Box<dyn Error>> {
        // The size that the host was told is at this scale, so the window must open with it too.
        let extent = self.params.extent();
        let scale_factor = extent.set_scale(fallback_scale_factor);
        if !extent.is_open() {
            extent.look();
            let screen = extent.screen();
            self.params.set_view(|view| *view = extent::fitted(*view, screen));
        }
        let view = self.params.view();
        let [width, height] = view.size.map(|side| side as f32);
        let state = EguiEditorState::from_size(LogicalSize { width, height }, extent::factor(view));
        // The window has no gradients that would need dithering, which costs time for each pixel.
        let graphics = GraphicsConfig { dithering: false, ..GraphicsConfig::default() };
        let settings = EguiNiceSettings::new().with_tile("Sprung").with_resize_hint(self.resize_hint());
        let settings = settings.with_graphics_config(graphics);
        create_egui_editor(
            state,
            self.params.link().repaint.clone(),
            settings,
            Window::new(self.params.clone(), Library::of_user(), self.past.clone()),
        )
        .ok_or("the window cannot be made")?
        .spawn(parent, wait_for_parent, scale_factor, gui_context, host)
    }

    fn size(&self) -> NativeSize<u32> {
        self.params.extent().size(self.params.view())
    }

    fn scale_factor_suggested(&self, scale_factor: f64) {
        self.params.extent().set_scale(Some(scale_factor));
    }

    fn resize_hint(&self) -> ResizeHint {
        let [width, height] = LEAST_SIZE.map(|side| side as f32);
        ResizeHint::resizable().with_min_logical_size(LogicalSize { width, height })
    }
}
