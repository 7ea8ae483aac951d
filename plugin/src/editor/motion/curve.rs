//! The curve of an envelope or oscillator, drawn by hand: its corners are dragged.

use crate::editor::controls::{Controls, Hint};
use crate::editor::pages::curves::{self, SUSTAIN, lengths};
use crate::editor::pages::sections::Section;
use egui::{CursorIcon, Id, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use sprung::params::{Param, ParamInfo};

/// How many rounds of an oscillator are drawn.
const ROUNDS: f64 = 2.0;
/// Side of the place where a corner is taken.
const GRIP: f32 = 18.0;
/// The least distance of two corners at one height.
const APART: f32 = 14.0;

/// A corner: the parameter that it moves, where it is, and the value when it is elsewhere.
struct Corner<'a> {
    info: &'static ParamInfo,
    place: Pos2,
    value: Box<dyn Fn(Pos2) -> f64 + 'a>,
}

/// Shows the curve of a section, if it has one.
pub(super) fn show(ui: &Ui, rect: Rect, section: Section, controls: &mut Controls) {
    curves::paint(ui.painter(), rect, section, controls);
    let values: Vec<f64> = section.iter().map(|info| f64::from(controls.value(info))).collect();
    let corners = match section[0].param {
        Param::Envelope1Delay | Param::Envelope2Delay => of_envelope(rect, section, &values),
        Param::Lfo1Rate | Param::Lfo2Rate | Param::Lfo3Rate => of_oscillator(ui, rect, section, &values, controls),
        _ => return,
    };
    corners.into_iter().for_each(|corner| follow(ui, corner, controls));
}

/// The corners of an envelope. Each stage is as wide as the square root of its time, as a share of all.
fn of_envelope<'a>(rect: Rect, section: Section, values: &[f64]) -> Vec<Corner<'a>> {
    let roots = lengths(&|row| values[row]);
    let [delay, attack, hold, decay, release] = roots;
    let others: f64 = roots.iter().sum();
    let total = others.max(1e-3) / (1.0 - SUSTAIN);
    let x = |time: f64| rect.left() + rect.width() * (time / total) as f32;
    let share = move |at: Pos2| f64::from(((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0)) / (1.0 - SUSTAIN);
    // The end of a stage at a share of the width: `(before + root) / (rest + root)`, solved for the root.
    let end = |before: f64, own: f64| -> Box<dyn Fn(Pos2) -> f64 + 'a> {
        let rest = (others - own).max(1e-3);
        Box::new(move |at| {
            let share = share(at).min(0.99);
            let root = ((share * rest - before) / (1.0 - share)).max(0.0);
            root * root
        })
    };
    let level = |share: f64| rect.bottom() - rect.height() * share as f32;
    let sustain = level(values[4] / 100.0);
    let peak = x(delay + attack);
    let falls = x(delay + attack + hold + decay);
    let released = rect.right() - rect.width() * (release / total) as f32;
    let rest = (others - release).max(1e-3);
    vec![
        Corner { info: &section[0], place: pos2(x(delay), rect.bottom()), value: end(0.0, delay) },
        Corner { info: &section[1], place: pos2(peak, rect.top()), value: end(delay, attack) },
        Corner {
            info: &section[2],
            place: pos2(x(delay + attack + hold).max(peak + APART), rect.top()),
            value: {
                let shift = vec2((peak + APART - x(delay + attack + hold)).max(0.0), 0.0);
                let own = end(delay + attack, hold);
                Box::new(move |at| own(at - shift))
            },
        },
        Corner { info: &section[3], place: pos2(falls, sustain), value: end(delay + attack + hold, decay) },
        Corner {
            info: &section[4],
            place: pos2(0.5 * (falls + released), sustain),
            value: Box::new(move |at| 100.0 * f64::from((rect.bottom() - at.y) / rect.height())),
        },
        Corner {
            info: &section[5],
            place: pos2(released, sustain),
            value: Box::new(move |at| {
                let share = (1.0 / (1.0 - SUSTAIN) - share(at)).clamp(0.0, 0.99);
                let root = share * rest / (1.0 - share);
                root * root
            }),
        },
    ]
}

/// The corners of an oscillator: where it begins, and where it has faded in.
fn of_oscillator<'a>(ui: &Ui, rect: Rect, section: Section, values: &[f64], controls: &Controls) -> Vec<Corner<'a>> {
    let (rate, fade) = (values[0].max(1e-3), values[4]);
    let seconds = ROUNDS / rate;
    let middle = rect.center().y;
    let faded = rect.left() + rect.width() * (fade / seconds).min(1.0) as f32;
    let stroke = Stroke::new(1.0, controls.palette.line);
    for edge in [rect.top(), rect.bottom()] {
        ui.painter().line_segment([pos2(rect.left(), middle), pos2(faded, edge)], stroke);
        ui.painter().line_segment([pos2(faded, edge), pos2(rect.right(), edge)], stroke);
    }
    let start = values[3] / 100.0;
    // The curve is dragged by the place where its first round ends.
    let begins = rect.left() + rect.width() * ((1.0 - start) / ROUNDS) as f32;
    vec![
        Corner {
            info: &section[3],
            place: pos2(begins, middle),
            value: Box::new(move |at| {
                100.0 * (1.0 - ROUNDS * f64::from((at.x - rect.left()) / rect.width())).clamp(0.0, 1.0)
            }),
        },
        Corner {
            info: &section[4],
            place: pos2(faded, rect.top()),
            value: Box::new(move |at| seconds * f64::from((at.x - rect.left()) / rect.width())),
        },
    ]
}

/// Shows a corner, and lets the user drag it.
fn follow(ui: &Ui, corner: Corner, controls: &mut Controls) {
    let Corner { info, place, value } = corner;
    let grip = Rect::from_center_size(place, vec2(GRIP, GRIP));
    let response = ui.interact(grip, Id::unique(("corner", info.id)), Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Corner {}", info.name)));
    if response.dragged()
        && let Some(at) = response.interact_pointer_pos()
    {
        let position = info.normalise(info.clamp(value(at) as f32));
        if position as f32 != controls.position(info) {
            controls.turn(info, position);
        }
    }
    if response.drag_stopped() && controls.interaction.gestures.moving() == Some(info.param as usize) {
        controls.release();
    }
    let is_hot = response.hovered() || response.dragged();
    if is_hot {
        ui.ctx().set_cursor_icon(CursorIcon::Grab);
        *controls.hint = Hint::new(format!("{} {}", info.name, controls.text(info)), info.help);
    }
    let palette = controls.palette;
    let edge = Stroke::new(1.5, if is_hot { palette.text } else { palette.accent });
    ui.painter().circle(place, if is_hot { 5.0 } else { 4.0 }, palette.panel, edge);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::pages::sections::sections;

    #[test]
    fn a_corner_that_stays_where_it_is_keeps_its_value() {
        let rect = Rect::from_min_size(pos2(30.0, 10.0), vec2(400.0, 90.0));
        let values = [0.2, 0.3, 0.5, 0.8, 40.0, 1.5, 20.0];
        for section in sections(&["Envelope 1"]) {
            for (corner, value) in of_envelope(rect, section, &values).into_iter().zip(values) {
                let read = (corner.value)(corner.place);
                assert!((read / value - 1.0).abs() < 1e-4, "{}: {value} {read}", corner.info.name);
                let farther = (corner.value)(corner.place + vec2(15.0, -15.0));
                assert_eq!(farther > value, corner.info.param != Param::Envelope1Release, "{}", corner.info.name);
            }
        }
    }
}
