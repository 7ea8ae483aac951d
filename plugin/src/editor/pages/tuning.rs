//! The page of the tuning: its scale, and the frequency of each key.

use super::scales::SCALES;
use crate::editor::controls::gestures::change;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint, Pick, Said};
use crate::editor::keyboard::grid::{Cell, KeyGrid};
use crate::editor::theme::{GAP, SMALL, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::Field;
use crate::editor::widgets::text::{is_entered, line, name_field, paragraph};
use crate::files;
use egui::{Align2, Id, Rect, TextEdit, Ui, pos2, vec2};
use sprung::params::Param;
use sprung::preset::OwnTuning;
use sprung::sound::Tuning;
use sprung::units::{frequency_from_key, note_name, semitones_from_ratio};
use std::io::Read as _;
use std::path::Path;

/// Width of the description of the scale.
const SIDE: f32 = 216.0;
/// Largest file that is read, in bytes.
const LARGEST: u64 = 1 << 20;
/// Twelve equal steps, for a mapping without a scale of its own.
const EQUAL: &str = "Twelve equal steps\n12\n100.\n200.\n300.\n400.\n500.\n600.\n700.\n800.\n900.\n1000.\n1100.\n2/1\n";

const EQUAL_NAME: &str = "Equal temperament";

/// The page's state.
#[derive(Default)]
pub(super) struct TuningPage {
    path: String,
    pub(super) grid: KeyGrid,
}

impl TuningPage {
    /// Shows the page; `down` has one bit for each held key. Returns a message.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: &Shown,
        down: u128,
        controls: &mut Controls,
    ) -> Option<Said> {
        let palette = controls.palette;
        let inner = rect;
        let side = inner.with_max_x(inner.left() + SIDE);
        let own = shown.tuning();
        let (name, steps) = own.map_or((EQUAL_NAME.to_owned(), "12 steps".to_owned()), about);
        let mut message = None;
        let names: Vec<&str> = std::iter::once(EQUAL_NAME).chain(SCALES.map(|(name, _)| name)).collect();
        let known = SCALES.into_iter().find(|(_, text)| own.is_some_and(|own| own.scale() == *text));
        let value = known.map_or(&*name, |(name, _)| name);
        let field = Field { id: Id::unique("scale"), name: "Scale", value, is_default: own.is_none() };
        let (response, picked) = field.show(ui, side.with_max_y(side.top() + 20.0), &names, palette);
        if response.hovered() {
            *controls.hint =
                Hint::new(format!("Scale: {name}"), "One of the program’s, or one of your own by Open below.");
        }
        if let Some(place) = picked {
            message = Some(tune(place.checked_sub(1).map(|place| SCALES[place].1), controls));
        }
        let mapped = if own.is_some_and(|own| own.keymap().is_some()) { "mapped" } else { "on keys in a row" };
        let second = side.with_min_y(side.top() + 22.0).with_max_y(side.top() + 38.0);
        line(ui.painter(), second, Align2::LEFT_CENTER, &format!("{steps} {mapped}, in Hz"), SMALL, palette.muted);
        let bottom = Rect::from_min_max(pos2(side.left(), side.bottom() - 22.0), side.max);
        let field = bottom.with_max_x(bottom.right() - 102.0);
        let edit = TextEdit::singleline(&mut self.path).id(Id::unique("scale path")).hint_text(".scl or .kbm");
        let response = ui.put(field, edit.font(font(SMALL)).margin(vec2(4.0, 4.0)));
        name_field(&response, "Path of a scale or mapping", &self.path);
        if is_entered(&response) {
            message = Some(take(Path::new(self.path.trim()), controls));
        }
        let look = if own.is_some() { Look::Plain } else { Look::Disabled };
        let list = bottom.with_min_x(field.right() + 4.0).with_max_x(field.right() + 48.0);
        if button(ui, list, "Open", "Open a scale or mapping", Look::Plain, palette).clicked() {
            controls.interaction.pick = Some(Pick::Scale);
        }
        let equal = bottom.with_min_x(list.right() + 4.0);
        if button(ui, equal, "Equal", "Tune to equal temperament", look, palette).clicked() {
            message = Some(tune(None, controls));
        }
        let help = Rect::from_min_max(second.left_bottom() + vec2(0.0, 6.0), pos2(side.right(), field.top() - 4.0));
        if help.height() > 40.0 {
            let text = "Drop a Scala scale (.scl) or a keyboard mapping (.kbm) anywhere on the window, or choose it with Open. The scale becomes a part of the sound.";
            paragraph(ui.painter(), help, text, SMALL, palette.muted);
        }
        let a4 = f64::from(controls.value(Param::Tuning.info()));
        let tuning = own.map_or(Tuning::EQUAL, |own| *own.tuning());
        let hertz = |key: u8| tuning.pitch(key).map(|pitch| frequency_from_key(pitch.semitones(a4), a4));
        let cell = |key: u8| match hertz(key) {
            Some(hertz) => Cell { text: written(hertz), is_on: true, ..Cell::default() },
            None => Cell::default(),
        };
        let keys = inner.with_min_x(side.right() + GAP);
        self.grid.show(ui, keys, "Key", down, &cell, controls);
        if let Some(key) = self.grid.hovered() {
            let help = hertz(key).map_or("not mapped: silent".to_owned(), |hertz| {
                let cents = 100.0 * semitones_from_ratio(hertz / frequency_from_key(f64::from(key), a4));
                format!("{hertz:.3} Hz   {cents:+.1} ct from equal temperament")
            });
            *controls.hint = Hint::new(note_name(key), help);
        }
        message
    }
}

/// A frequency with about four digits.
fn written(hertz: f64) -> String {
    match hertz {
        ..100.0 => format!("{hertz:.2}"),
        100.0..1000.0 => format!("{hertz:.1}"),
        _ => format!("{hertz:.0}"),
    }
}

/// The name of a scale, and its number of steps.
pub(super) fn about(own: &OwnTuning) -> (String, String) {
    let mut lines = own.scale().lines().filter(|line| !line.starts_with('!')).map(str::trim);
    let name = lines.next().filter(|name| !name.is_empty()).unwrap_or("A scale without a name");
    (name.to_owned(), format!("{} steps", lines.next().unwrap_or_default()))
}

/// Tunes the sound to a scale without a mapping, or to equal temperament. Returns a message.
fn tune(scale: Option<&str>, controls: &mut Controls) -> Said {
    let own = scale.map(|scale| OwnTuning::from_scala(scale.to_owned(), None)).transpose();
    let own = own.map_err(|error| error.to_string())?;
    let name = own.as_ref().map_or("equal temperament".to_owned(), |own| about(own).0);
    set(own, &format!("tuning {name}"), controls);
    Ok(format!("tuned to {name}"))
}

/// Tunes the sound by a scale or mapping file. Returns a message.
pub(crate) fn take(path: &Path, controls: &mut Controls) -> Said {
    let read = || -> sprung::Result<String> {
        let mut text = String::new();
        let name = path.display().to_string();
        let failed = |source| sprung::Error::io(name.as_str(), source);
        files::open(path, &name, "a scale or mapping")?.take(LARGEST + 1).read_to_string(&mut text).map_err(failed)?;
        if text.len() as u64 > LARGEST {
            let message = format!("it is too large: expected a scale or mapping of at most {LARGEST} bytes");
            return Err(sprung::Error::format(name.as_str(), message));
        }
        Ok(text)
    };
    let failed = |error: String| Err(format!("{}: {error}", path.display()));
    let is_map = match path.extension().and_then(|ending| ending.to_str()) {
        Some(ending) if ending.eq_ignore_ascii_case("scl") => false,
        Some(ending) if ending.eq_ignore_ascii_case("kbm") => true,
        _ => return failed("expected the whole path of a .scl or .kbm file".to_owned()),
    };
    let text = read().map_err(|error| error.to_string())?;
    let state = controls.params.state();
    let mut playable = state.playable;
    let before = playable.presets_mut().into_iter().find_map(|preset| preset.tuning.clone());
    let own = if is_map {
        let scale = before.as_ref().map_or(EQUAL, OwnTuning::scale).to_owned();
        OwnTuning::from_scala(scale, Some(text))
    } else {
        OwnTuning::from_scala(text, before.and_then(|before| before.keymap().map(str::to_owned)))
    };
    match own {
        Ok(own) => {
            let name = about(&own).0;
            set(Some(own), &format!("tuning {name}"), controls);
            Ok(format!("tuned to {name}"))
        }
        Err(error) => failed(error.to_string()),
    }
}

/// Sets the tuning of every preset, as one undo step.
fn set(own: Option<OwnTuning>, name: &str, controls: &mut Controls) {
    controls.history.begin(controls.params);
    change(controls.params, controls.host, |mut state| {
        state.playable.presets_mut().into_iter().for_each(|preset| preset.tuning.clone_from(&own));
        Some(state)
    });
    controls.history.end(name, controls.params);
}
