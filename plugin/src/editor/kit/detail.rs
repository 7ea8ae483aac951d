//! The chosen pad of a kit: its body, its name, pitch, level, place, choke group and output, and what else can be done with it.

use super::chips::Chips;
use super::edit::{EDITS, change, name_of, pad, set};
use super::live::{About, place};
use super::mates;
use super::pads::{Deed, paint_glow};
use super::turn::Turn;
use crate::editor::body::face;
use crate::editor::body::numbers::written;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{CELL_HEIGHT, RADIUS, SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::number::{HEIGHT, Number};
use crate::editor::widgets::outline;
use crate::editor::widgets::text::{fitting, line, name_field, paragraph, width};
use crate::loaded::Loaded;
use egui::{Align2, Id, Key, Rect, Role, Sense, Stroke, StrokeKind, TextEdit, Ui, UiBuilder, WidgetInfo, pos2, vec2};
use sprung::internals::editor::{CHOKE_GROUPS, GAINS_DB, with_ending};
use sprung::params::Param;
use sprung::preset::Preset;
use sprung::sound::{OUTPUTS, Pad};
use sprung::units::{note_name, number_in_unit, parse_key};
use sprung_picture::Pose;
use std::sync::Arc;

/// Height from which on the panel has knobs, and a line above each choice.
const TALL: f32 = 400.0;
/// Heights of the rows below the body, of a panel that is tall and of one that is not: numbers, choke group, the pads of that, output,
/// sounding, what can be done, effects.
const ROWS: [[f32; 7]; 2] =
    [[CELL_HEIGHT, 38.0, 22.0, 38.0, 14.0, 24.0, 16.0], [HEIGHT, 21.0, 0.0, 21.0, 0.0, 22.0, 14.0]];
const SPACES: [f32; 2] = [7.0, 3.0];
/// Height of the name.
const TITLE: f32 = 22.0;
/// Height of a line above a choice, and width of one beside it.
const LINE: f32 = 15.0;
const BESIDE: f32 = 42.0;
/// Range of the pitch in keys.
const PITCHES: [f64; 2] = [0.0, 127.0];

/// The state of the panel.
#[derive(Default)]
pub(super) struct Detail {
    /// The number that is being dragged or typed.
    turning: Option<Turn>,
    /// The name that is being typed for the pad of a key of a kit.
    name: Option<(Arc<Loaded>, u8, String)>,
}

impl Detail {
    /// Ends what the user is doing with a number.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.name = None;
        self.leave_number(controls);
    }

    fn leave_number(&mut self, controls: &mut Controls) {
        if let Some(turn) = self.turning.take() {
            turn.end(controls);
        }
    }

    /// Shows a pad.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, about: &About, controls: &mut Controls) -> Option<Deed> {
        let (palette, key, shown) = (controls.palette, about.key, about.shown);
        let kit = shown.kit()?;
        if self.turning.as_ref().is_some_and(|turn| turn.key() != key) {
            self.leave(controls);
        }
        if self.turning.take_if(|turn| !turn.is_of(shown.loaded())).is_some() {
            controls.history.cancel();
        }
        let Some(now) = self.turning.as_ref().and_then(Turn::pad).or(pad(kit, key)).cloned() else {
            let text = format!("{} is empty. Drag a sound to it, or click one.", note_name(key));
            paragraph(ui.painter(), rect, &text, TEXT, palette.muted);
            return None;
        };
        let preset = &kit.sounds.get(now.sound)?.1;
        let is_tall = rect.height() >= TALL;
        self.title(ui, rect.with_max_y(rect.top() + TITLE), about, (&now, preset), controls);
        let (heights, space) = (ROWS[usize::from(!is_tall)], SPACES[usize::from(!is_tall)]);
        let below: f32 = heights.iter().filter(|height| **height > 0.0).map(|height| height + space).sum();
        let mut top = rect.bottom() - below;
        let picture = rect.with_min_y(rect.top() + TITLE + 4.0).with_max_y(top);
        let [numbers, choke, mates, output, sounding, deeds, effects] = heights.map(|height| {
            let row = Rect::from_min_size(pos2(rect.left(), top + space), vec2(rect.width(), height));
            top += if height > 0.0 { height + space } else { 0.0 };
            row
        });
        let mut deed = body(ui, picture, now.sound, about, controls);
        // Fields of their own for each pad: what is typed belongs to one.
        let mut fields = ui.new_child(UiBuilder::new().id_salt(("pad numbers", key)).max_rect(numbers));
        self.numbers(&mut fields, (numbers, is_tall), about, (&now, preset), controls);
        let chosen = choke_group(ui, titled(ui, choke, is_tall, GROUPS, controls), shown, &now, controls);
        if is_tall {
            deed = mates::show(ui, mates, about, controls).map(Deed::Choose).or(deed);
        }
        let sent = outputs(ui, titled(ui, output, is_tall, GOES, controls), &now, controls);
        if let Some((changed, what)) = chosen.or(sent) {
            self.leave(controls);
            change(format!("{} {what}", name_of(key)), controls, |kit| set(kit, key, Some(changed)));
        }
        if is_tall {
            level(ui, sounding, about, controls);
        }
        let is_last = kit.pads.len() < 2;
        deed = buttons(ui, deeds, about, is_last, controls).or(deed);
        if space_link(ui, effects, controls) { Some(Deed::Effects) } else { deed }
    }

    /// Shows the pad's name, which can be typed.
    fn title(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        about: &About,
        (pad, preset): (&Pad, &Preset),
        controls: &mut Controls,
    ) {
        let (key, loaded) = (about.key, about.shown.loaded());
        let family =
            preset.guide.family.map_or(String::new(), |family| format!(" · {}", family.name().replace('_', " ")));
        let (note, whole) = (note_name(key), format!("{}{family}", note_name(key)));
        let says = fitting(ui.painter(), &[&whole, &note], SMALL, 0.3 * rect.width());
        let place = rect.with_min_x(rect.right() - width(ui.painter(), says, SMALL).ceil() - 2.0);
        line(ui.painter(), place, Align2::RIGHT_CENTER, says, SMALL, controls.palette.muted);
        let typed = self.name.take().filter(|(kit, own, _)| Arc::ptr_eq(kit, loaded) && *own == key);
        let mut text = typed.map_or(pad.name.clone(), |(.., text)| text);
        let edit = TextEdit::singleline(&mut text).id(Id::unique(("pad name", key))).hint_text(&preset.name);
        let response = ui.put(rect.with_max_x(place.left() - 6.0), edit.font(font(TEXT)).margin(vec2(6.0, 3.0)));
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

    fn numbers(
        &mut self,
        ui: &mut Ui,
        (rect, are_knobs): (Rect, bool),
        about: &About,
        (now, preset): (&Pad, &Preset),
        controls: &mut Controls,
    ) {
        let a4_hz = f64::from(preset.patch.get(Param::Tuning));
        let width = rect.width() / 3.0;
        let cell = |place: f32| Rect::from_min_size(rect.min + vec2(place * width, 0.0), vec2(width, rect.height()));
        let home = f64::from(preset.guide.home);
        let pitch = Number {
            title: "Pitch",
            help: "The note that the sound plays: lower is a larger drum.",
            value: now.pitch.unwrap_or(f64::from(about.key)),
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
        let (mut is_held, time) = (false, ui.input(|input| input.time));
        for (place, (number, knob, set_number)) in [
            (pitch, [1.0, home], (|pad: &mut Pad, value| pad.pitch = Some(value)) as fn(&mut Pad, f64)),
            (level, [0.1, 0.0], |pad, value| pad.gain_db = value as f32),
            (pan, [1.0, 0.0], |pad, value| pad.pan = value as f32 / 100.0),
        ]
        .into_iter()
        .enumerate()
        {
            let (is_in_hand, value) = match are_knobs {
                true => number.show_knob(ui, cell(place as f32), knob, controls),
                false => {
                    let (response, value) = number.show(ui, cell(place as f32), controls);
                    let value = if response.changed() { value } else { number.value };
                    (response.dragged() || response.has_focus(), value)
                }
            };
            is_held |= is_in_hand;
            if value != number.value {
                let what =
                    format!("{} {} {}", name_of(about.key), number.title.to_lowercase(), (number.written)(value));
                let mut turned = now.clone();
                set_number(&mut turned, value);
                let turn =
                    self.turning.take().unwrap_or_else(|| Turn::begin(about.key, about.shown.loaded(), controls));
                self.turning = Some(turn.to(turned, what, (!is_in_hand).then_some(time)));
            }
        }
        let Some(turn) = &mut self.turning else { return };
        turn.write(time, controls);
        // Nor may an undo come between.
        let is_left = !is_held && ui.input(|input| input.pointer.any_pressed() || input.modifiers.command);
        match turn.rest(time, is_held).filter(|_| !is_left) {
            Some(rest) if rest.is_finite() => ui.ctx().request_repaint_after_secs(rest as f32),
            Some(_) => {}
            None => self.leave_number(controls),
        }
    }
}

/// What is written above a choice, or beside it.
const GROUPS: [&str; 2] = ["Choked by the pads of group", "Choke"];
const GOES: [&str; 2] = ["Goes out at", "Output"];

/// Writes the title of a choice above it or, in less room, beside it. Returns the place of the choice.
fn titled(ui: &Ui, row: Rect, is_tall: bool, [long, short]: [&str; 2], controls: &Controls) -> Rect {
    let (text, place, rest) = match is_tall {
        true => (long, row.with_max_y(row.top() + LINE), row.with_min_y(row.top() + LINE)),
        false => (short, row.with_max_x(row.left() + BESIDE), row.with_min_x(row.left() + BESIDE)),
    };
    line(ui.painter(), place, Align2::LEFT_CENTER, text, SMALL, controls.palette.muted);
    rest
}

/// Shows the body as large as there is room for, as it moves, with the place where it is struck. A click strikes it.
fn body(ui: &Ui, rect: Rect, sound: usize, about: &About, controls: &mut Controls) -> Option<Deed> {
    let shape = about.bodies.shape(sound).filter(|_| rect.height() >= 24.0)?;
    let response = ui.interact(rect, Id::unique("pad body"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Strike this pad"));
    if response.hovered() {
        *controls.hint = Hint::new("A click strikes it", &shape.caption);
    }
    let sounding = about.live.of(about.key);
    paint_glow(ui.painter(), rect, sounding.map_or(0.0, |pad| pad.strength), controls.palette);
    let height = rect.height().min(0.6 * rect.width());
    let within = Rect::from_center_size(rect.center(), vec2(0.86 * rect.width(), 0.86 * height));
    let at = place(within);
    let moved = sounding.map_or(Vec::new(), |pad| pad.displacements(shape.figure.form, at));
    let strike = shape.origin.body().map(|body| body.strike);
    let pose = Pose { displacements: &moved, nodal: None, strike };
    if let Some(struck) = face::paint(ui.painter(), at, &shape.figure, &pose, controls.palette) {
        face::paint_ring(ui.painter(), struck, face::Look::SMALL, controls.palette);
    }
    outline(ui, &response, rect, RADIUS, controls.palette);
    response.clicked().then_some(Deed::Strike(about.key))
}

/// Shows the choke group of a pad. Returns the changed pad and what has changed.
fn choke_group(ui: &Ui, rect: Rect, shown: &Shown, pad: &Pad, controls: &mut Controls) -> Option<(Pad, String)> {
    let choke = |pad: &Pad| shown.loaded().kit.choke(pad, controls.value(Param::Choke.info()));
    let (now, own) = (choke(pad), choke(&Pad { choke: None, ..pad.clone() }));
    let written = |group: u8| if group == 0 { "none".to_owned() } else { group.to_string() };
    let texts: Vec<String> = (0..=CHOKE_GROUPS).map(written).collect();
    let names = [vec![format!("the sound’s: {}", written(own))], texts.clone()].concat();
    let chips = Chips {
        title: "Choke",
        help: "Pads of one group silence each other.",
        names: &names,
        chosen: pad.choke.map_or(0, |group| usize::from(group) + 1),
        first: 1,
        texts: &texts,
        lit: usize::from(now) + 1,
    };
    let place = chips.show(ui, rect, controls)?;
    let choke = place.checked_sub(1).map(|group| group as u8);
    Some((Pad { choke, ..pad.clone() }, format!("choke {}", names[place])))
}

/// Shows the output of a pad, as [`choke_group`] shows that.
fn outputs(ui: &Ui, rect: Rect, pad: &Pad, controls: &mut Controls) -> Option<(Pad, String)> {
    // Those of the main output are the first two.
    let channels = |output: usize| format!("{}–{}", 2 * output + 1, 2 * output + 2);
    let texts: Vec<String> =
        (0..=OUTPUTS).map(|output| if output == 0 { "Main".to_owned() } else { channels(output) }).collect();
    let name = |output: usize| format!("{output}: channels {}", channels(output));
    let names: Vec<String> =
        (0..=OUTPUTS).map(|output| if output == 0 { "main".to_owned() } else { name(output) }).collect();
    let chips = Chips {
        title: "Output",
        help: "The stereo output in Sprung Multi; other plugins have the main one only.",
        names: &names,
        chosen: pad.output.into(),
        first: 0,
        texts: &texts,
        lit: pad.output.into(),
    };
    let place = chips.show(ui, rect, controls)?;
    Some((Pad { output: place as u8, ..pad.clone() }, format!("output {}", names[place])))
}

/// Shows how strongly the pad sounds, in the colour of the levels.
fn level(ui: &Ui, rect: Rect, about: &About, controls: &mut Controls) {
    let palette = controls.palette;
    let named =
        line(ui.painter(), rect.with_max_x(rect.left() + 60.0), Align2::LEFT_CENTER, "Sounding", SMALL, palette.muted);
    let bar = Rect::from_center_size(rect.center(), vec2(rect.width(), 6.0)).with_min_x(named.right() + 8.0);
    let strength = about.live.of(about.key).map_or(0.0, |pad| pad.strength);
    let edge = Stroke::new(1.0, palette.empty_edge());
    ui.painter().rect(bar, 3.0, palette.raised, edge, StrokeKind::Inside);
    ui.painter().rect_filled(bar.with_max_x(bar.left() + strength * bar.width()), 3.0, palette.level);
    let response = ui.interact(rect, Id::unique("pad sounding"), Sense::hover());
    response.widget_info(|| WidgetInfo {
        value: Some(100.0 * f64::from(strength)),
        ..WidgetInfo::labeled(Role::ProgressIndicator, true, "Sounding")
    });
    if response.hovered() {
        let help = "How far the pad’s body swings, of the farthest since it was at rest; not the level of an output.";
        *controls.hint = Hint::new("Sounding", help);
    }
}

/// Shows what can be done with the pad; the last one of a kit cannot be emptied.
fn buttons(ui: &Ui, rect: Rect, about: &About, is_last: bool, controls: &mut Controls) -> Option<Deed> {
    let palette = controls.palette;
    let width = (rect.width() - 8.0) / 3.0;
    let cell =
        |place: f32| Rect::from_min_size(rect.min + vec2(place * (width + 4.0), 0.0), vec2(width, rect.height()));
    let swap = fitting(ui.painter(), &["Swap with …", "Swap …"], TEXT, width - 6.0);
    let looks = [(about.is_swapping, Look::On), (is_last, Look::Disabled)]
        .map(|(is, look)| if is { look } else { Look::Plain });
    let mut deed = None;
    for (place, (text, name, look, help, wanted)) in [
        ("Edit", "Edit this pad", Look::Plain, EDITS, Deed::Edit(about.key)),
        (
            swap,
            "Swap with another pad",
            looks[0],
            "A click on another pad then swaps the two. Esc cancels.",
            Deed::Swapping,
        ),
        ("Empty", "Empty this pad", looks[1], "Takes the sound off this pad.", Deed::Empty(about.key)),
    ]
    .into_iter()
    .enumerate()
    {
        let response = button(ui, cell(place as f32), text, name, look, palette);
        if response.hovered() {
            *controls.hint = Hint::new(text, help);
        }
        if response.clicked() {
            deed = Some(wanted);
        }
    }
    deed
}

/// Shows the effects behind all pads. Returns whether these are to be shown.
fn space_link(ui: &Ui, rect: Rect, controls: &mut Controls) -> bool {
    let palette = controls.palette;
    let [space, mix] = [Param::Space, Param::SpaceMix].map(|param| controls.text(param.info()));
    let now = if controls.value(Param::Space.info()) > 0.0 { format!("{space}, {mix}") } else { "no space".to_owned() };
    let response = ui.interact(rect, Id::unique("pad effects"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Link, true, format!("Effects behind all pads: {now}")));
    if response.hovered() {
        *controls.hint =
            Hint::new("Effects behind all pads", "Turns to Space, on the page Sound. The kit has its effects once.");
    }
    let link = line(ui.painter(), rect, Align2::RIGHT_CENTER, "Space", SMALL, palette.accent_text);
    if response.hovered() || response.has_focus() {
        ui.painter().hline(link.x_range(), link.bottom(), Stroke::new(1.0, palette.accent_text));
    }
    let room = rect.with_max_x(link.left() - 6.0);
    let texts = [format!("Effects behind all pads: {now}"), format!("Effects: {now}"), now];
    let texts = [&texts[0], &texts[1], &texts[2]].map(String::as_str);
    let text = fitting(ui.painter(), &texts, SMALL, room.width());
    line(ui.painter(), room, Align2::LEFT_CENTER, text, SMALL, palette.muted);
    outline(ui, &response, rect, 3, palette);
    response.clicked()
}
