//! What every widget of the window needs: the parameters, the host, the colours, and what the user is doing.

use super::gestures::Gestures;
use super::history::History;
use super::theme::Palette;
use crate::params::SprungParams;
use nice_plug_core::context::gui::GuiContext;
use sprung::engine::SoundingNote;
use sprung::params::{PARAMS, ParamInfo};

/// Text that is being typed instead of a parameter's value.
pub(super) struct Typing {
    pub(super) index: usize,
    pub(super) text: String,
    /// Whether the field has taken the focus.
    pub(super) is_open: bool,
    /// Why the text is no value.
    pub(super) complaint: Option<String>,
}

/// A parameter that waits for a controller.
pub(super) struct Learning {
    pub(super) info: &'static ParamInfo,
    /// How many movements there were when it was last looked.
    pub(super) seen: u64,
    /// Whether the user was told what to do.
    pub(super) is_told: bool,
}

/// What the user is doing with parameters.
#[derive(Default)]
pub(super) struct Hands {
    pub(super) gestures: Gestures,
    /// Position of the knob that is dragged, which has more digits than the knob's own.
    pub(super) dragged: f64,
    pub(super) typing: Option<Typing>,
    /// The parameter that waits for a controller.
    pub(super) learning: Option<Learning>,
}

/// What the status line says of the thing under the pointer.
pub(super) struct Hint {
    pub(super) title: String,
    pub(super) help: String,
}

impl Hint {
    pub(super) fn new(title: impl Into<String>, help: impl Into<String>) -> Option<Self> {
        Some(Self { title: title.into(), help: help.into() })
    }
}

/// What every widget needs, during one pass.
pub(super) struct Controls<'a> {
    pub(super) params: &'a SprungParams,
    pub(super) host: &'a GuiContext,
    pub(super) palette: &'static Palette,
    pub(super) hands: &'a mut Hands,
    pub(super) history: &'a mut History,
    pub(super) hint: &'a mut Option<Hint>,
    /// The notes that sound, the newest first.
    pub(super) notes: &'a [SoundingNote],
}

impl Controls<'_> {
    /// The value of a parameter.
    pub(super) fn value(&self, info: &ParamInfo) -> f32 {
        let index = info.param as usize;
        self.params.loaded().value(index, self.params.knobs()[index].position())
    }

    /// The value of a parameter as text.
    pub(super) fn text(&self, info: &ParamInfo) -> String {
        info.format(self.value(info))
    }

    /// The values that a parameter has in the notes that sound and modulate it, the newest note's first.
    pub(super) fn modulated(&self, info: &ParamInfo) -> impl Iterator<Item = f32> {
        let of = |note: &SoundingNote| note.moved.iter().flatten().find(|(param, _)| *param == info.param).copied();
        self.notes.iter().filter_map(of).map(|(_, value)| value)
    }

    /// Moves a knob; [`Controls::release`] ends the gesture.
    pub(super) fn turn(&mut self, info: &ParamInfo, position: f64) {
        let index = info.param as usize;
        if self.hands.gestures.moving() != Some(index) {
            self.release();
            self.history.begin(self.params);
        }
        self.hands.gestures.turn(self.params, self.host, index, position as f32);
    }

    /// Ends a knob's gesture, if there is one.
    pub(super) fn release(&mut self) {
        let Some(index) = self.hands.gestures.moving() else { return };
        self.hands.gestures.end(self.params, self.host);
        let info = &PARAMS[index];
        self.history.end(format!("{} {}", info.name, self.text(info)), self.params);
    }

    /// Gives a parameter a value, as one gesture.
    pub(super) fn set(&mut self, info: &ParamInfo, value: f32) {
        self.turn(info, info.normalise(value));
        self.release();
    }
}
