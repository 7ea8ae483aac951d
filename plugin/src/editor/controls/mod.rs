//! What all widgets share during a pass: parameters, host, colours, and the user's actions in progress.

pub(super) mod files;
pub(super) mod gestures;
pub(super) mod history;
pub(super) mod naming;
mod offsets;
pub(super) mod shown;

use crate::editor::theme::Palette;
use crate::marks::Mark;
use crate::params::SprungParams;
use egui::{Pos2, Rect};
use gestures::Gestures;
use history::History;
use nice_plug_core::context::PluginApi;
use nice_plug_core::context::gui::GuiContext;
use sprung::engine::SoundingNote;
use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::patch::routes::Source;
use sprung::preset::Playable;
use sprung::sound::Sound;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// Time between two repaints while something moves.
pub(super) const FRAME: Duration = Duration::from_millis(16);

/// What the window says of what was done, or why it could not be done.
pub(super) type Said = Result<String, String>;

/// What is to be chosen in the list of files.
pub(super) enum Pick {
    /// Anything that can be dropped on the window.
    Any,
    /// A scale or a keyboard mapping.
    Scale,
    /// A place to save a sound at.
    Place(Box<Playable>),
}

/// Text that is being typed instead of a parameter's value.
pub(super) struct Typing {
    pub(super) index: usize,
    pub(super) text: String,
    /// Whether the field has taken the focus.
    pub(super) is_open: bool,
    /// Why the text is not a valid value.
    pub(super) complaint: Option<String>,
}

/// A source that a knob has taken, and that is still dragged: its route is there, and its amount follows the pointer.
pub(super) struct Held {
    pub(super) source: Source,
    pub(super) info: &'static ParamInfo,
    /// The place of the route, and whether there was none before.
    pub(super) place: usize,
    pub(super) is_new: bool,
    /// Value and position of the amount before.
    pub(super) before: (f32, f32),
    /// Where the pointer was when the knob took it, and in the last pass.
    pub(super) from: Pos2,
    pub(super) last: Pos2,
    /// The amount in per cent, more precise than the knob's own.
    pub(super) amount: f64,
    /// Whether the pointer has left its place of rest.
    pub(super) is_moved: bool,
}

/// The name of a macro that is being typed.
pub(super) struct Naming {
    pub(super) info: &'static ParamInfo,
    pub(super) text: String,
    /// Whether the field has taken the focus.
    pub(super) is_open: bool,
}

/// A parameter that waits for a source of a route.
pub(super) struct Learning {
    pub(super) info: &'static ParamInfo,
    /// The number of controller movements at the last check.
    pub(super) seen: u64,
    /// The keys that were down then, of all channels, and whether one went down since the beginning.
    pub(super) down: u128,
    pub(super) is_struck: bool,
    /// Whether the user has been asked to move a controller.
    pub(super) is_prompted: bool,
}

/// What is to become of a parameter's controller.
pub(super) enum Binding {
    /// The next one that moves turns its knob; whether the user has been asked to move it.
    Learn { info: &'static ParamInfo, is_prompted: bool },
    /// It has none.
    Forget(&'static ParamInfo),
}

/// The user's actions on parameters in progress.
#[derive(Default)]
pub(super) struct Interaction {
    pub(super) gestures: Gestures,
    /// Position of the dragged knob, more precise than the knob's own.
    pub(super) dragged: f64,
    pub(super) typing: Option<Typing>,
    pub(super) naming: Option<Naming>,
    /// The parameter that waits for a source of a route.
    pub(super) learning: Option<Learning>,
    pub(super) binding: Option<Binding>,
    /// A message about what the user has done in this pass.
    pub(super) said: Option<Said>,
    /// What is to be chosen in the list of files, which opens for it.
    pub(super) pick: Option<Pick>,
    /// The knob under a source that is being dragged, in this pass.
    pub(super) aim: Option<&'static ParamInfo>,
    pub(super) held: Option<Held>,
    /// What the wheel has scrolled of a step over a knob that has whole ones, and that knob.
    pub(super) scrolled: Option<(usize, f64)>,
    /// Whether the wheel has scrolled a page since the pointer moved last.
    pub(super) is_scrolling: bool,
    /// The place over which it is held, to show what is behind it, and since when.
    pub(super) dwell: Option<(Rect, f64)>,
    /// The values that parts had when they were switched off, by sound and section.
    pub(super) switched_off: HashMap<(String, &'static str), Vec<(Param, f32)>>,
}

impl Interaction {
    /// Whether a field or a lesson waits for the user, and takes Escape for itself.
    pub(super) fn waits(&self) -> bool {
        self.typing.is_some() || self.naming.is_some() || self.learning.is_some() || self.binding.is_some()
    }
}

/// The text of the status line about the thing under the pointer.
pub(super) struct Hint {
    pub(super) title: String,
    pub(super) help: String,
}

impl Hint {
    pub(super) fn new(title: impl Into<String>, help: impl Into<String>) -> Option<Self> {
        Some(Self { title: title.into(), help: help.into() })
    }
}

/// The context of every widget, during one pass.
pub(super) struct Controls<'a> {
    pub(super) params: &'a SprungParams,
    /// Whether a preset is shown, and not a kit.
    pub(super) is_preset: bool,
    /// In a kit of several sounds, whose own values the knobs move, the one that is shown.
    pub(super) moved: Option<Arc<Sound>>,
    pub(super) host: &'a GuiContext,
    pub(super) palette: &'static Palette,
    pub(super) interaction: &'a mut Interaction,
    pub(super) history: &'a mut History,
    pub(super) hint: &'a mut Option<Hint>,
    /// Seconds since the last pass, as they really passed: egui's own number is a guess unless a pass was asked for at once.
    pub(super) seconds: f32,
    /// The notes that sound, the newest first.
    pub(super) notes: &'a [SoundingNote],
}

impl Controls<'_> {
    /// The position of a parameter's knob.
    pub(super) fn position(&self, info: &ParamInfo) -> f32 {
        self.params.knobs()[info.param as usize].position()
    }

    /// The value of a parameter.
    pub(super) fn value(&self, info: &ParamInfo) -> f32 {
        self.params.loaded().value(info.param as usize, self.position(info))
    }

    /// The value of a parameter as text; of a knob that moves each pad's own value, what it does to that.
    pub(super) fn text(&self, info: &ParamInfo) -> String {
        self.written(info, self.value(info))
    }

    /// Another value, as [`Controls::text`] writes the present one.
    pub(super) fn written(&self, info: &ParamInfo, value: f32) -> String {
        if self.own(info).is_some() { offsets::written(info, value) } else { info.format(value) }
    }

    /// Reads a value as [`Controls::text`] writes it. The error says what was expected.
    pub(super) fn read(&self, info: &ParamInfo, text: &str) -> Result<f32, String> {
        if self.own(info).is_some() { offsets::read(info, text) } else { info.parse(text) }
    }

    /// The value that the shown pad itself has of a parameter, if the knob only moves those of all pads.
    pub(super) fn own(&self, info: &ParamInfo) -> Option<f32> {
        let is_of_all = info.param.is_behind_voices() || info.param.is_of_kit();
        self.moved.as_ref().filter(|_| !is_of_all).map(|sound| sound.patch().get(info.param))
    }

    /// The value with which the shown sound is heard.
    pub(super) fn heard(&self, info: &ParamInfo) -> f32 {
        let value = self.value(info);
        self.own(info).map_or(value, |own| info.moved(own, info.travel(value)))
    }

    /// What the line at the bottom tells of a parameter under `title`.
    pub(super) fn explain(&mut self, title: String, info: &ParamInfo) {
        let help = match self.own(info) {
            Some(_) => format!(
                "Moves what each pad has itself; this one comes to {}. {}",
                info.format(self.heard(info)),
                info.help
            ),
            None => info.help.to_owned(),
        };
        *self.hint = Hint::new(title, help);
    }

    /// The position of a knob at which the shown sound is heard with this value.
    pub(super) fn position_for(&self, info: &ParamInfo, heard: f32) -> f64 {
        let own = self.own(info).map_or(0.0, |own| info.normalise(info.default) - info.normalise(own));
        (info.normalise(heard) + own).clamp(0.0, 1.0)
    }

    /// What the host says of a parameter; the same in words, and its controller, to be put behind others.
    pub(super) fn mark(&self, info: &ParamInfo) -> (Option<Mark>, String) {
        let mark = self.params.mark_of(info.param as usize);
        let words = mark.as_ref().map(Mark::text).into_iter().chain(self.controller(info));
        let text = words.map(|words| format!("   {words}")).collect();
        (mark, text)
    }

    /// The controller of a parameter in words, if it has one.
    pub(super) fn controller(&self, info: &ParamInfo) -> Option<String> {
        // There, controllers reach the plugin as parameters, and none is bound.
        if self.host.plugin_api() == PluginApi::Vst3 {
            return None;
        }
        let controller = self.params.learned().controller_of(info.param)?;
        Some(format!("CC {controller} on any channel"))
    }

    /// The modulated values of a parameter in the sounding notes, the newest note's first. Notes that do not modulate
    /// it are skipped.
    pub(super) fn modulated(&self, info: &ParamInfo) -> impl Iterator<Item = f32> {
        self.notes.iter().filter_map(|note| moved_in(note, info))
    }

    /// Moves a knob; [`Controls::release`] ends the gesture.
    pub(super) fn turn(&mut self, info: &ParamInfo, position: f64) {
        let index = info.param as usize;
        if self.interaction.gestures.moving() != Some(index) {
            self.release();
            self.history.begin(self.params);
        }
        self.interaction.gestures.turn(self.params, self.host, index, position as f32);
    }

    /// Ends a knob's gesture, if there is one.
    pub(super) fn release(&mut self) {
        if let Some((index, name)) = self.end_gesture() {
            self.history.end_of(&[index], name, self.params);
        }
    }

    /// Moves a knob by wheel or key: turns that follow each other are one step.
    pub(super) fn nudge(&mut self, info: &ParamInfo, position: f64) {
        self.turn(info, position);
        if let Some((index, name)) = self.end_gesture() {
            self.history.end_of_turn(index, name, self.params);
        }
    }

    /// Ends a knob's gesture, if there is one. Returns the knob, and what was done in words.
    fn end_gesture(&mut self) -> Option<(usize, String)> {
        let index = self.interaction.gestures.moving()?;
        self.interaction.gestures.end(self.params, self.host);
        let info = &PARAMS[index];
        Some((index, format!("{} {}", info.name, self.text(info))))
    }

    /// Gives parameters values, as one step of this name.
    pub(super) fn set_all(&mut self, name: String, values: Vec<(Param, f32)>) {
        self.release();
        self.history.begin(self.params);
        for (param, value) in &values {
            let position = param.info().normalise(*value) as f32;
            self.interaction.gestures.set(self.params, self.host, *param as usize, position);
        }
        let moved: Vec<usize> = values.iter().map(|(param, _)| *param as usize).collect();
        self.history.end_of(&moved, name, self.params);
    }

    /// Gives a parameter a value, as one gesture.
    pub(super) fn set(&mut self, info: &ParamInfo, value: f32) {
        self.turn(info, info.normalise(value));
        self.release();
    }
}

/// The modulated value of a parameter in a note, if that modulates it.
pub(super) fn moved_in(note: &SoundingNote, info: &ParamInfo) -> Option<f32> {
    note.moved.iter().flatten().find(|(param, _)| *param == info.param).map(|(_, value)| *value)
}
