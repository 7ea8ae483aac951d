//! The chosen pad of a kit: its body, its name, pitch, level, place, choke group and output.

use super::edit::{EDITS, change, edited, name_of, pad, set};
use super::pads::Deed;
use crate::editor::body::face;
use crate::editor::body::numbers::written;
use crate::editor::controls::gestures::touch;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::Field;
use crate::editor::widgets::number::{HEIGHT, Number};
use crate::editor::widgets::text::{line, name_field, paragraph};
use crate::loaded::Loaded;
use egui::{Align2, Id, Key, Rect, TextEdit, Ui, UiBuilder, pos2, vec2};
use sprung::internals::editor::{CHOKE_GROUPS, GAINS_DB, with_ending};
use sprung::params::Param;
use sprung::preset::Preset;
use sprung::sound::{OUTPUTS, Pad};
use sprung::units::{note_name, number_in_unit, parse_key};
use sprung_picture::Figure;
use std::sync::Arc;

/// Height of a row with a name and a choice, and width of the name.
const ROW: f32 = 26.0;
const NAMES: f32 = 52.0;
/// Range of the pitch in keys.
const PITCHES: [f64; 2] = [0.0, 127.0];

/// The state of the panel.
#[derive(Default)]
pub(super) struct Detail {
    /// The key whose number is being dragged or typed, and the name of the step.
    turning: Option<(u8, String)>,
    /// The name that is being typed for the pad of a key of a kit.
    name: Option<(Arc<Loaded>, u8, String)>,
}

impl Detail {
    /// Ends what the user is doing with a number.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.name = None;
        self.leave_number(controls);
    }

    /// Shows the pad of a key.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        key: u8,
        (shown, figures): (&Shown, &[Figure]),
        controls: &mut Controls,
    ) -> Option<Deed> {
        let palette = controls.palette;
        let kit = shown.kit()?;
        if self.turning.as_ref().is_some_and(|(turned, _)| *turned != key) {
            self.leave(controls);
        }
        let Some(now) = pad(kit, key) else {
            let text = format!("{} is empty. Drag a sound to it, or click one.", note_name(key));
            paragraph(ui.painter(), rect, &text, TEXT, palette.muted);
            return None;
        };
        let preset = &kit.sounds.get(now.sound)?.1;
        self.title(ui, rect.with_max_y(rect.top() + 22.0), (key, shown.loaded()), (now, &preset.name), controls);
        let feet = rect.with_min_y(rect.bottom() - 24.0);
        let rows = |place: f32| {
            let top = feet.top() - (2.0 - place) * ROW - 2.0;
            Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), ROW - 4.0))
        };
        let numbers =
            Rect::from_min_size(pos2(rect.left(), rows(0.0).top() - HEIGHT - 4.0), vec2(rect.width(), HEIGHT));
        let picture = Rect::from_min_max(pos2(rect.left(), rect.top() + 26.0), numbers.right_top() - vec2(0.0, 4.0));
        if let Some(figure) = figures.get(now.sound).filter(|_| picture.height() >= 24.0) {
            let height = picture.height().min(0.6 * picture.width());
            let place =
                Rect::from_center_size(picture.center(), vec2(0.8 * picture.width().min(2.0 * height), 0.8 * height));
            face::paint_still(ui.painter(), place, figure, palette);
        }
        // Fields of their own for each pad: what is typed belongs to one.
        let mut fields = ui.new_child(UiBuilder::new().id_salt(("pad numbers", key)).max_rect(numbers));
        self.numbers(&mut fields, numbers, key, (now, preset), controls);
        let chosen = choices(ui, [rows(0.0), rows(1.0)], shown, now, controls);
        if let Some((changed, what)) = chosen {
            self.leave(controls);
            change(format!("{} {what}", name_of(key)), controls, |kit| set(kit, key, Some(changed)));
        }
        let [open, empty] = [0.0, 1.0].map(|place| {
            let width = (feet.width() - 4.0) / 2.0;
            Rect::from_min_size(feet.min + vec2(place * (width + 4.0), 0.0), vec2(width, feet.height()))
        });
        let response = button(ui, open, "Edit", "Edit this pad", Look::Plain, palette);
        if response.hovered() {
            *controls.hint = Hint::new("Edit", EDITS);
        }
        if response.clicked() {
            return Some(Deed::Edit(key));
        }
        let look = if kit.pads.len() > 1 { Look::Plain } else { Look::Disabled };
        button(ui, empty, "Empty", "Empty this pad", look, palette).clicked().then_some(Deed::Empty(key))
    }

    /// Shows the pad's name, which can be typed.
    fn title(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        (key, loaded): (u8, &Arc<Loaded>),
        (pad, sound): (&Pad, &str),
        controls: &mut Controls,
    ) {
        let note = rect.with_min_x(rect.right() - 34.0);
        line(ui.painter(), note, Align2::RIGHT_CENTER, &note_name(key), SMALL, controls.palette.muted);
        let typed = self.name.take().filter(|(kit, own, _)| Arc::ptr_eq(kit, loaded) && *own == key);
        let mut text = typed.map_or(pad.name.clone(), |(.., text)| text);
        let edit = TextEdit::singleline(&mut text).id(Id::unique(("pad name", key))).hint_text(sound);
        let response = ui.put(rect.with_max_x(note.left() - 4.0), edit.font(font(TEXT)).margin(vec2(6.0, 3.0)));
        name_field(&response, "Name of the pad", &text);
        if response.has_focus() {
            self.name = Some((loaded.clone(), key, text));
        } else if response.lost_focus() && !ui.input(|input| input.key_pressed(Key::Escape)) {
            let named = Pad { name: with_ending(&text, ""), ..pad.clone() };
            if named != *pad {
                change(format!("{} name", name_of(key)), controls, |kit| set(kit, key, Some(named)));
            }
        }
    }

    fn numbers(&mut self, ui: &mut Ui, rect: Rect, key: u8, (now, preset): (&Pad, &Preset), controls: &mut Controls) {
        let a4_hz = f64::from(preset.patch.get(Param::Tuning));
        let width = rect.width() / 3.0;
        let cell = |place: f32| Rect::from_min_size(rect.min + vec2(place * width, 0.0), vec2(width, HEIGHT));
        let pitch = Number {
            title: "Pitch",
            help: "The note that the sound plays: lower is a larger drum.",
            value: now.pitch.unwrap_or(f64::from(key)),
            range: PITCHES,
            speed: 0.1,
            is_whole: false,
            written: &|pitch| match pitch.fract() == 0.0 && (0.0..128.0).contains(&pitch) {
                true => note_name(pitch as u8),
                false => format!("{pitch:.2}"),
            },
            read: &|text| parse_key(text, a4_hz).ok(),
        };
        let level = Number {
            title: "Level",
            help: "Louder or softer than the sound is by itself.",
            value: now.gain_db.into(),
            range: [*GAINS_DB.start(), *GAINS_DB.end()].map(f64::from),
            speed: 0.1,
            is_whole: false,
            written: &|level| written(level, "dB"),
            read: &|text| number_in_unit("dB", text),
        };
        let pan = Number {
            title: "Pan",
            help: "Place between left (−100 %) and right (100 %).",
            value: f64::from(now.pan) * 100.0,
            range: [-100.0, 100.0],
            speed: 1.0,
            is_whole: true,
            written: &|pan| format!("{pan:.0} %"),
            read: &|text| number_in_unit("%", text),
        };
        let mut is_held = false;
        for (place, (number, set_number)) in [
            (pitch, (|pad: &mut Pad, value| pad.pitch = Some(value)) as fn(&mut Pad, f64)),
            (level, |pad, value| pad.gain_db = value as f32),
            (pan, |pad, value| pad.pan = value as f32 / 100.0),
        ]
        .into_iter()
        .enumerate()
        {
            let (response, value) = number.show(ui, cell(place as f32), controls);
            is_held |= response.dragged() || response.has_focus();
            if response.changed() && value != number.value {
                if self.turning.is_none() {
                    controls.release();
                    controls.history.begin(controls.params);
                }
                let what = format!("{} {} {}", name_of(key), number.title.to_lowercase(), (number.written)(value));
                self.turning = Some((key, what));
                let mut turned = now.clone();
                set_number(&mut turned, value);
                // The host is told at the end.
                controls.params.change(|state| edited(state, |kit| set(kit, key, Some(turned))));
            }
        }
        if !is_held {
            self.leave_number(controls);
        }
    }

    fn leave_number(&mut self, controls: &mut Controls) {
        if let Some((_, what)) = self.turning.take() {
            controls.history.end_of(&[], what, controls.params);
            touch(controls.params, controls.host);
        }
    }
}

/// Shows choke group and output of a pad. Returns the changed pad and what has changed.
fn choices(ui: &Ui, rows: [Rect; 2], shown: &Shown, pad: &Pad, controls: &mut Controls) -> Option<(Pad, String)> {
    let own = shown.loaded().kit.choke(&Pad { choke: None, ..pad.clone() }, controls.value(Param::Choke.info()));
    let own = if own == 0 { "none".to_owned() } else { own.to_string() };
    let up_to = |last: usize| (1..=last).map(|number| number.to_string());
    let groups = [format!("the sound’s: {own}"), "none".to_owned()].into_iter().chain(up_to(CHOKE_GROUPS.into()));
    let outputs = std::iter::once("main".to_owned()).chain(up_to(OUTPUTS));
    let (groups, outputs): (Vec<String>, Vec<String>) = (groups.collect(), outputs.collect());
    let place = pad.choke.map_or(0, |group| usize::from(group) + 1);
    let group = choice(ui, rows[0], ("Choke", "Pads of one group silence each other."), (&groups, place), controls);
    let help = "The stereo output in Sprung Multi; other plugins have the main one only.";
    let output = choice(ui, rows[1], ("Output", help), (&outputs, pad.output.into()), controls);
    let grouped = |place: usize| {
        let choke = place.checked_sub(1).map(|group| group as u8);
        (Pad { choke, ..pad.clone() }, format!("choke {}", groups[place]))
    };
    let sent = |place: usize| (Pad { output: place as u8, ..pad.clone() }, format!("output {}", outputs[place]));
    group.map(grouped).or(output.map(sent))
}

/// Shows a choice of the pad under its title. Returns the place that was picked.
fn choice(
    ui: &Ui,
    row: Rect,
    (title, help): (&str, &str),
    (names, place): (&[String], usize),
    controls: &mut Controls,
) -> Option<usize> {
    let palette = controls.palette;
    let name = row.with_max_x(row.left() + NAMES);
    line(ui.painter(), name, Align2::LEFT_CENTER, title, SMALL, palette.muted);
    let words: Vec<&str> = names.iter().map(String::as_str).collect();
    let label = format!("{title} of the pad");
    let field = Field { id: Id::unique(("pad", title)), name: &label, value: words[place], is_default: place == 0 };
    let (response, picked) = field.show(ui, row.with_min_x(name.right()), &words, palette);
    if response.hovered() {
        *controls.hint = Hint::new(format!("{title} {}", words[place]), help);
    }
    picked
}
