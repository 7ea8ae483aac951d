//! The plugin's window.
//!
//! | module | holds |
//! |---|---|
//! | `window` | an open window: what it shows, and the user's requests |
//! | `theme`, `fonts`, `layout`, `extent` | colours and sizes; the fonts; the places of the parts; the size that hosts are told |
//! | `controls`, `gestures`, `history`, `learn` | the context of every widget; changes that hosts see; undo and redo; MIDI learn |
//! | `header`, `sections`, `routes`, `curves`, `outlines`, `status` | the parts of the window; menus of routes; small pictures in sections |
//! | `modes`, `modes_face`, `mode_drag`, `mode_axes`, `mode_table`, `snap` | the modes: changes by the user, their picture, a drag in progress, the axes, their table, series of ratios |
//! | `motion`, `phase`, `scope`, `spectrum`, `ringing` | moving pictures: the phase plane; waveform and spectrum; the decay of the modes |
//! | `body_view`, `body_face`, `body_shape`, `body_form` | the moving body: changes by the user, its picture, the shapes of its modes, its form |
//! | `body_page`, `body_numbers`, `body_edit`, `made` | the page of the body; its numbers; a change in progress; the body from which the modes are made |
//! | `audition` | a key that the window plays by itself, so that the user hears a change |
//! | `piano`, `key_piano`, `held_key`, `meter` | the piano keyboard; the computer's keyboard as one; the key that the mouse holds; levels |
//! | `pages`, `kit_page`, `tuning_page`, `voices_panel`, `devices_page`, `key_grid` | the tabs and their pages: a kit's keys, the tuning, the voices, the program's devices; all keys as a grid |
//! | `manual`, `manual_text` | the manual over the window; its pages split into blocks |
//! | `drops`, `recordings`, `fitting` | files dropped on the window; fitting recordings in the background; its progress |
//! | `browser`, `details`, `star`, `sounds`, `files` | the page on which the user finds and saves sounds; the list of sounds; reading files |
//! | `knob`, `knob_face`, `knob_menu`, `typing`, `choice`, `buttons`, `text`, `disc` | widgets and their painting |
//! | `variation` | random variations of a sound, with locks |
//! | `focus`, `accessibility`, `x11` | keyboard focus: the host keeps it, except while the user types; screen readers; the X11 display |
//! | `shown` | the sound that is shown |
//!
//! Widgets draw themselves in egui's shapes. `tests` draws the window without a GPU, by the rules of egui's own shader,
//! and compares pictures; it also computes the contrast (WCAG 2.2) of each text.
//!
//! **Painting on a CPU.** With Mesa's llvmpipe a picture took 46 ms and now takes 23 (debug build, 1100 × 700, a bell
//! that rings, beside other work). Dithering was a computation for each pixel of a window without gradients. The ground
//! is the colour with which the window is cleared, and was painted twice over that. At 100 %, heads of modes are two
//! discs of the font's texture (4 triangles instead of 150), and arcs have half as many corners. `glxgears` in a window
//! of that size takes 3 ms of CPU per picture on the same machine, without the X server: 17 % of a core at 60 pictures
//! per second, so no picture of a whole window can cost less. `plugin/tests/hosts/cpu` prints the costs, and fails if a
//! silent window is drawn.

#[cfg(target_os = "linux")]
mod accessibility;
mod audition;
mod body_edit;
mod body_face;
mod body_form;
mod body_numbers;
mod body_page;
mod body_shape;
mod body_view;
mod browser;
mod buttons;
mod choice;
mod controls;
mod curves;
mod details;
mod devices_page;
mod disc;
mod drops;
pub(crate) mod extent;
mod files;
mod fitting;
mod focus;
mod fonts;
mod gestures;
mod header;
mod held_key;
mod history;
mod key_grid;
mod key_piano;
mod kit_page;
mod knob;
mod knob_face;
mod knob_menu;
mod layout;
mod learn;
mod made;
mod manual;
mod manual_text;
mod meter;
mod mode_axes;
mod mode_drag;
mod mode_table;
mod modes;
mod modes_face;
mod motion;
mod outlines;
mod pages;
mod phase;
mod piano;
mod recordings;
mod ringing;
mod routes;
mod scope;
mod sections;
mod shown;
mod snap;
mod sounds;
mod spectrum;
mod star;
mod status;
#[cfg(test)]
mod tests;
mod text;
pub(crate) mod theme;
mod tuning_page;
mod typing;
mod variation;
mod voices_panel;
mod window;
#[cfg(target_os = "linux")]
mod x11;

use crate::params::SprungParams;
use egui_baseview::GraphicsConfig;
use nice_plug_core::context::gui::GuiContext;
use nice_plug_core::editor::dpi::{LogicalSize, NativeSize};
use nice_plug_core::editor::{Editor, HostMethods, ParentWindowHandle, ResizeHint, SpawnedEditor};
use nice_plug_egui::{EguiEditorHandle, EguiEditorState, EguiNiceSettings, create_egui_editor};
use sprung::preset::library::Library;
use std::error::Error;
use std::sync::Arc;
use theme::LEAST_SIZE;
use window::Window;

/// Opens windows. Each opens in the size of the last one.
pub struct SprungEditor {
    params: Arc<SprungParams>,
}

impl SprungEditor {
    pub(crate) fn new(params: Arc<SprungParams>) -> Self {
        Self { params }
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
        let view = self.params.view();
        let [width, height] = view.size.map(|side| side as f32);
        let state = EguiEditorState::from_size(LogicalSize { width, height }, extent::factor(view));
        // The size that the host was told is at this scale, so the window must open with it too.
        let scale_factor = self.params.extent().tell(fallback_scale_factor);
        // The window has no gradients that would need dithering, which costs time for each pixel.
        let graphics = GraphicsConfig { dithering: false, ..GraphicsConfig::default() };
        let settings = EguiNiceSettings::new().with_tile("Sprung").with_resize_hint(self.resize_hint());
        let settings = settings.with_graphics_config(graphics);
        create_egui_editor(
            state,
            self.params.link().repaint.clone(),
            settings,
            Window::new(self.params.clone(), Library::of_user()),
        )
        .ok_or("the window cannot be made")?
        .spawn(parent, wait_for_parent, scale_factor, gui_context, host)
    }

    fn size(&self) -> NativeSize<u32> {
        self.params.extent().size(self.params.view())
    }

    fn scale_factor_suggested(&self, scale_factor: f64) {
        self.params.extent().tell(Some(scale_factor));
    }

    fn resize_hint(&self) -> ResizeHint {
        let [width, height] = LEAST_SIZE.map(|side| side as f32);
        ResizeHint::resizable().with_min_logical_size(LogicalSize { width, height })
    }
}
