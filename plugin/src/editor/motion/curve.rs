//! The curve of an envelope or oscillator, drawn by hand: its corners are dragged.

use crate::editor::controls::Controls;
use crate::editor::pages::curves::{self, SUSTAIN, lengths, whole};
use crate::editor::pages::sections::Section;
use crate::editor::theme::SMALL;
use crate::editor::widgets::text::line;
use egui::{Align2, CursorIcon, Id, PointerButton, Pos2, Rect, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2};
use sprung::engine::SoundingNote;
use sprung::params::{Param, ParamInfo};
use sprung::patch::routes::Source;
use sprung::units::note_name;

/// How many rounds of an oscillator are drawn.
const ROUNDS: f64 = 2.0;
/// Side of the place where a corner is taken.
const GRIP: f32 = 18.0;
/// The shortest period to which one is dragged at once, as a share of the picture.
const LEAST_PERIOD: f64 = 0.02;
/// The least distance of two corners at one height.
const APART: f32 = 14.0;
/// The least distance of two notes that are both named, and the height from which on a curve has room for names.
const APART_NAMES: f32 = 24.0;
const LEAST_WITH_NAMES: f32 = 60.0;
/// The width from which on a curve has room for what its corners say.
const LEAST_WITH_LABELS: f32 = 300.0;

/// How a corner's parameter follows the pointer.
#[derive(Clone, Copy)]
enum Law {
    /// A time, whose square root grows with each pixel to the right.
    Root(f64),
    /// A value that grows with each pixel to the right and down.
    Linear([f64; 2]),
    /// A rate: the square root of its period is as wide as the picture.
    Period(f64),
}

/// A corner: the parameter that it moves, and where it is.
#[derive(Clone, Copy)]
struct Corner {
    info: &'static ParamInfo,
    place: Pos2,
    value: f64,
    law: Law,
}

impl Corner {
    /// The value when the corner is dragged so far from where it was.
    fn dragged(&self, by: Vec2) -> f64 {
        let [x, y] = [by.x, by.y].map(f64::from);
        let square = |root: f64| root * root;
        match self.law {
            Law::Root(pixel) => square((self.value.sqrt() + x * pixel).max(0.0)),
            Law::Linear([right, down]) => self.value + x * right + y * down,
            Law::Period(width) => self.value * square(width / (width + x).max(LEAST_PERIOD * width)),
        }
    }
}

/// A corner that is being dragged, as it was at the press.
struct Grab {
    corner: Corner,
    pointer: Pos2,
    /// What the width of the picture was worth: it stays so meanwhile, so that the corner stays under the pointer.
    whole: f64,
}

/// The state of the curve.
#[derive(Default)]
pub(super) struct Curve {
    grab: Option<Grab>,
}

impl Curve {
    /// Lets go of the corner.
    pub(super) fn leave(&mut self) {
        self.grab = None;
    }

    /// Shows the curve of a section, if it has one, and where the notes are on it.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        section: Section,
        notes: &[SoundingNote],
        controls: &mut Controls,
    ) {
        let values: Vec<f64> = section.iter().map(|info| f64::from(controls.heard(info))).collect();
        let roots = lengths(&|row| values[row]);
        let whole = self.grab.as_ref().map_or(whole(roots), |grab| grab.whole);
        // While the rate is dragged, the picture keeps its scale: shorter rounds end further to the left.
        let turned = self.grab.as_ref().filter(|grab| grab.corner.info.param == section[0].param);
        let stretch = turned.map_or(1.0, |grab| (grab.corner.value / values[0]).sqrt().max(LEAST_PERIOD)) as f32;
        let rounds = rect.with_max_x(rect.left() + stretch * rect.width());
        let corners = match section[0].param {
            Param::Envelope1Delay | Param::Envelope2Delay => {
                curves::paint_envelope(ui.painter(), rect, &|row| values[row], whole, controls.palette);
                let corners = of_envelope(rect, section, &values, whole);
                // The handle of the hold is drawn beside the peak while the hold is 0: a line joins them.
                let [_, peak, held, ..] = &corners[..] else { return };
                ui.painter().line_segment([peak.place, held.place], Stroke::new(1.5, controls.palette.modulation));
                corners
            }
            Param::Lfo1Rate | Param::Lfo2Rate | Param::Lfo3Rate => {
                let painter = ui.painter().with_clip_rect(rect.expand(2.0).intersect(ui.clip_rect()));
                let mut next = rounds;
                while next.left() < rect.right() {
                    curves::paint(&painter, next, section, controls);
                    next = next.translate(vec2(next.width(), 0.0));
                }
                of_oscillator(ui, [rect, rounds], section, &values, controls)
            }
            _ => return,
        };
        // What a longer stage pushes out of the picture waits there until the corner is let go.
        let is_held =
            |corner: &Corner| self.grab.as_ref().is_some_and(|grab| grab.corner.info.param == corner.info.param);
        let shown: Vec<Corner> = corners
            .into_iter()
            .filter(|corner| is_held(corner) || rect.expand(GRIP / 2.0).contains(corner.place))
            .collect();
        let with_labels =
            is_oscillator(section) && rect.height() > LEAST_WITH_NAMES && rect.width() > LEAST_WITH_LABELS;
        for corner in shown {
            if with_labels {
                paint_label(ui, rect, &corner, controls);
            }
            self.follow(ui, corner, whole, controls);
        }
        paint_notes(ui, rounds, section, notes, controls);
    }

    /// Shows a corner, and lets the user drag it.
    fn follow(&mut self, ui: &Ui, corner: Corner, whole: f64, controls: &mut Controls) {
        let Corner { info, place, .. } = corner;
        let grip = Rect::from_center_size(place, vec2(GRIP, GRIP));
        // By keys, the knobs beside the curve are turned.
        let response = ui.interact(grip, Id::unique(("corner", info.id)), Sense::DRAG);
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Corner {}", info.name)));
        let pointer = response.interact_pointer_pos();
        if response.drag_started_by(PointerButton::Primary) {
            self.grab = pointer.map(|pointer| Grab { corner, pointer, whole });
        }
        let grab = self.grab.as_ref().filter(|grab| grab.corner.info.param == info.param);
        if let (Some(grab), Some(pointer), true) = (grab, pointer, response.dragged_by(PointerButton::Primary)) {
            let by = pointer - grab.pointer;
            let position = controls.position_for(info, info.clamp(grab.corner.dragged(by) as f32));
            let is_moving = controls.interaction.gestures.moving() == Some(info.param as usize);
            if (by != Vec2::ZERO || is_moving) && position as f32 != controls.position(info) {
                controls.turn(info, position);
            }
        }
        if response.drag_stopped() {
            self.grab = None;
            if controls.interaction.gestures.moving() == Some(info.param as usize) {
                controls.release();
            }
        }
        let is_hot = response.hovered() || response.dragged();
        if is_hot {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
            controls.explain(format!("{} {}", info.name, controls.text(info)), info);
        }
        let palette = controls.palette;
        let (radius, fill) = if is_hot { (5.5, palette.modulation) } else { (4.5, palette.panel) };
        ui.painter().circle(place, radius, fill, Stroke::new(1.5, palette.text));
    }
}

/// Whether a section is that of an oscillator, whose corners say what they are: those of an envelope are known by their places.
fn is_oscillator(section: Section) -> bool {
    matches!(section[0].param, Param::Lfo1Rate | Param::Lfo2Rate | Param::Lfo3Rate)
}

/// Writes what a corner of an oscillator is beside it: within the picture.
fn paint_label(ui: &Ui, rect: Rect, corner: &Corner, controls: &Controls) {
    let name = corner.info.name.strip_prefix(corner.info.section).unwrap_or(corner.info.name).trim();
    let text = format!("{name} {}", controls.text(corner.info));
    let size = vec2(110.0, 14.0);
    // Beside the curve: that begins at the left end, and mostly comes to the right end from below.
    let (by, align) = match corner.place {
        Pos2 { y, .. } if y <= rect.top() => (vec2(32.0, -15.0), Align2::LEFT_CENTER),
        Pos2 { x, .. } if x <= rect.left() => (vec2(10.0, 7.0), Align2::LEFT_CENTER),
        _ => (vec2(-size.x - 10.0, -21.0), Align2::RIGHT_CENTER),
    };
    // The end of a long fade-in has no room at its right.
    let by = if corner.place.x + by.x + size.x > rect.right() { vec2(-size.x - 10.0, by.y) } else { by };
    let place = Rect::from_min_size(corner.place + by, size);
    line(ui.painter(), place, align, &text, SMALL, controls.palette.muted);
}

/// Paints where notes are on the curve of a section, the newest last, with names where there is room.
pub(super) fn paint_notes(ui: &Ui, rect: Rect, section: Section, notes: &[SoundingNote], controls: &Controls) {
    if notes.is_empty() {
        return;
    }
    let values: Vec<f64> = section.iter().map(|info| f64::from(controls.heard(info))).collect();
    let palette = controls.palette;
    let places: Vec<Option<Pos2>> = notes.iter().map(|note| place_of(rect, section[0].param, &values, note)).collect();
    for (order, note) in notes.iter().enumerate().rev() {
        let Some(at) = places[order] else { continue };
        let large = if rect.height() > LEAST_WITH_NAMES { 1.0 } else { 0.0 };
        let radius = large + if order == 0 { 3.5 } else { 2.5 };
        ui.painter().circle(at, radius, palette.modulation, Stroke::new(1.0, palette.panel));
        // Of notes side by side, the newer one is named.
        let is_free = places[..order].iter().flatten().all(|other: &Pos2| (other.x - at.x).abs() > APART_NAMES);
        if is_free && rect.height() > LEAST_WITH_NAMES {
            let place = Rect::from_center_size(at - vec2(0.0, 12.0), vec2(40.0, 12.0));
            line(ui.painter(), place, Align2::CENTER_CENTER, &note_name(note.key), SMALL, palette.muted);
        }
    }
}

/// Where a note is on the curve of an envelope or oscillator, whose first parameter is given; none once an envelope is over, and for a
/// note that began before its first route was made.
fn place_of(rect: Rect, first: Param, values: &[f64], note: &SoundingNote) -> Option<Pos2> {
    let at = |x: f64| rect.left() + rect.width() * x as f32;
    match first {
        Param::Envelope1Delay | Param::Envelope2Delay => {
            let number = usize::from(first == Param::Envelope2Delay);
            let level = note.sources[Source::Envelope1 as usize + number];
            let progress = Some(note.progress[3 + number]).filter(|progress| *progress >= 0.0)?;
            let [delay, attack, hold, decay, release] = lengths(&|row| values[row]);
            let total = whole([delay, attack, hold, decay, release]);
            let stages = [delay, attack, hold, decay, SUSTAIN * total, release];
            let length = stages.get(progress as usize)?;
            let passed: f64 = stages[..progress as usize].iter().sum();
            let x = (passed + f64::from(progress.fract()) * length) / total;
            Some(pos2(at(x), rect.bottom() - rect.height() * level))
        }
        Param::Lfo1Rate | Param::Lfo2Rate | Param::Lfo3Rate => {
            let number = [Param::Lfo1Rate, Param::Lfo2Rate, Param::Lfo3Rate].iter().position(|own| *own == first)?;
            let value = note.sources[Source::Lfo1 as usize + number];
            let phase = Some(note.progress[number]).filter(|phase| *phase >= 0.0)?;
            let round = f64::from(phase) - values[3] / 100.0;
            Some(pos2(at((round - round.floor()) / ROUNDS), rect.center().y - curves::AROUND * rect.height() * value))
        }
        _ => None,
    }
}

/// The corners of an envelope. Each stage is as wide as the square root of its time, as a share of `whole`.
fn of_envelope(rect: Rect, section: Section, values: &[f64], whole: f64) -> Vec<Corner> {
    let [delay, attack, hold, decay, release] = lengths(&|row| values[row]);
    let width = f64::from(rect.width());
    let x = |root: f64| rect.left() + (width * root / whole) as f32;
    let sustain = rect.bottom() - rect.height() * (values[4] / 100.0) as f32;
    let [peak, held, falls] = [delay + attack, delay + attack + hold, delay + attack + hold + decay].map(x);
    let rests = falls + (SUSTAIN * width) as f32;
    let corner = |row: usize, place: Pos2, law: Law| Corner { info: &section[row], place, value: values[row], law };
    let pixel = Law::Root(whole / width);
    let lifts = Law::Linear([0.0, -100.0 / f64::from(rect.height())]);
    vec![
        corner(0, pos2(x(delay), rect.bottom()), pixel),
        corner(1, pos2(peak, rect.top()), pixel),
        corner(2, pos2(held.max(peak + APART), rect.top()), pixel),
        corner(3, pos2(falls, sustain), pixel),
        corner(4, pos2(0.5 * (falls + rests), sustain), lifts),
        corner(5, pos2(rests + (width * release / whole) as f32, rect.bottom()), pixel),
    ]
}

/// The corners of an oscillator in its picture, whose two rounds have a place of their own: where it begins, how long it fades in, over
/// the whole range of that, and how fast it is, unless the song says so.
fn of_oscillator(
    ui: &Ui,
    [rect, rounds]: [Rect; 2],
    section: Section,
    values: &[f64],
    controls: &Controls,
) -> Vec<Corner> {
    let (width, middle, [phase, fade]) = (f64::from(rect.width()), rect.center().y, [&section[3], &section[4]]);
    let whole = f64::from(fade.max).sqrt();
    let faded = rect.left() + (width * values[4].sqrt() / whole) as f32;
    let stroke = Stroke::new(1.0, controls.palette.line);
    for edge in [rect.top(), rect.bottom()] {
        ui.painter().line_segment([pos2(rect.left(), middle), pos2(faded, edge)], stroke);
        ui.painter().line_segment([pos2(faded, edge), pos2(rect.right(), edge)], stroke);
    }
    // The curve itself is dragged: what is left of the picture is over when a note begins.
    let slides = Law::Linear([-100.0 * ROUNDS / width, 0.0]);
    let ends = rounds.right().min(rect.right());
    let mut corners = vec![
        Corner { info: phase, place: pos2(rect.left(), middle), value: values[3], law: slides },
        Corner { info: fade, place: pos2(faded, rect.top()), value: values[4], law: Law::Root(whole / width) },
    ];
    if values[1] == 0.0 {
        let law = Law::Period(width);
        corners.push(Corner { info: &section[0], place: pos2(ends, middle), value: values[0], law });
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::pages::sections::sections;

    #[test]
    fn a_rate_follows_the_end_of_its_rounds() {
        let info = Param::Lfo1Rate.info();
        let corner = Corner { info, place: Pos2::ZERO, value: 2.0, law: Law::Period(400.0) };
        for (by, rate) in [(0.0, 2.0), (-200.0, 8.0), (400.0, 0.5)] {
            assert!((corner.dragged(vec2(by, 0.0)) - rate).abs() < 1e-9, "{by}");
        }
        assert!(corner.dragged(vec2(-4000.0, 0.0)).is_finite(), "beyond the left end");
    }

    #[test]
    fn a_corner_is_where_the_pointer_has_dragged_it() {
        let rect = Rect::from_min_size(pos2(30.0, 10.0), vec2(400.0, 90.0));
        for values in [[0.2, 0.3, 0.5, 0.8, 40.0, 1.5, 20.0], [0.0, 0.005, 0.0, 60.0, 50.0, 0.001, 0.0]] {
            let scale = whole(lengths(&|row| values[row]));
            for section in sections(&["Envelope 1"]) {
                let before = of_envelope(rect, section, &values, scale);
                for (row, corner) in before.iter().enumerate() {
                    assert!((corner.dragged(Vec2::ZERO) - values[row]).abs() < 1e-9, "{}", corner.info.name);
                    let by = vec2(15.0, -15.0);
                    let mut moved = values;
                    moved[row] = corner.dragged(by);
                    assert!(moved[row] > values[row], "{}", corner.info.name);
                    let now = of_envelope(rect, section, &moved, scale)[row].place - corner.place;
                    let is_apart = row != 2 || values[row] > 0.0;
                    let off = if row == 4 { now.y - by.y } else { now.x - by.x };
                    assert!(!is_apart || off.abs() < 0.01, "{}: {now:?}", corner.info.name);
                }
            }
        }
    }
}
