//! The wheels beside the keys: one bends the pitch and springs back, the other is the modulation wheel and stays.

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, Palette, SMALL};
use crate::editor::widgets::outline;
use crate::editor::widgets::text::line;
use crate::link::{Link, Touch};
use egui::{Align2, EventFilter, Id, Key, Painter, Rect, Response, Sense, Ui, WidgetInfo, pos2, vec2};
use std::time::Duration;

/// Height of the names below, and thickness of the line where a wheel stands.
const NAME: f32 = 14.0;
const MARK: f32 = 3.0;
/// Share of the way for one press of an arrow key.
const STEP: f32 = 0.05;
/// Time after which the audio thread has taken what was played here.
const SOON: Duration = Duration::from_millis(50);

/// A wheel: its name, what it does, where its way begins, and the touch that moves it.
struct Wheel {
    name: &'static str,
    help: &'static str,
    lowest: f32,
    touch: fn(f32) -> Touch,
}

const WHEELS: [Wheel; 2] = [
    Wheel { name: "Bend", help: "Bends the pitch while it is held.", lowest: -1.0, touch: Touch::Bend },
    Wheel {
        name: "Wheel",
        help: "Moves what follows the modulation wheel; Motion says what.",
        lowest: 0.0,
        touch: Touch::Wheel,
    },
];

/// The state of the wheels.
#[derive(Default)]
pub(crate) struct Wheels {
    /// The wheel that the mouse holds, and where it stands.
    held: Option<(usize, f32)>,
}

impl Wheels {
    /// Shows the wheels where they were moved last, here or on the player's keyboard.
    pub(crate) fn show(&mut self, ui: &Ui, rect: Rect, controls: &mut Controls) {
        if rect.width() <= 0.0 {
            return;
        }
        let (palette, link) = (controls.palette, controls.params.link());
        let width = (rect.width() - 2.0 * GAP) / 2.0;
        for (number, (wheel, place)) in WHEELS.iter().zip(link.telemetry.wheels()).enumerate() {
            let corner = rect.min + vec2(number as f32 * (width + GAP), 0.0);
            let column = Rect::from_min_size(corner, vec2(width, rect.height()));
            let (way, name) = column.split_top_bottom_at_y(column.bottom() - NAME);
            let response = ui.interact(way, Id::unique(wheel.name), Sense::click_and_drag());
            let place = self.turn(ui, &response, number, place, link);
            response.widget_info(|| WidgetInfo::slider(true, place.into(), wheel.name));
            if response.hovered() || response.dragged() {
                *controls.hint = Hint::new(format!("{} {:.0} %", wheel.name, 100.0 * place), wheel.help);
            }
            paint(ui.painter(), way, place, wheel, palette);
            outline(ui, &response, way, 3, palette);
            // A name is wider than its wheel.
            line(
                ui.painter(),
                name.expand2(vec2(0.45 * GAP, 0.0)),
                Align2::CENTER_CENTER,
                wheel.name,
                SMALL,
                palette.muted,
            );
        }
    }

    /// Lets the user move a wheel that stands at `place`, by mouse or arrow keys. Returns where it stands then.
    fn turn(&mut self, ui: &Ui, response: &Response, number: usize, place: f32, link: &Link) -> f32 {
        let wheel = &WHEELS[number];
        let touched = response.is_pointer_button_down_on().then(|| response.interact_pointer_pos()).flatten();
        let before = self.held.filter(|(held, _)| *held == number).map(|(_, place)| place);
        match (touched, before) {
            (Some(at), _) => {
                let way = response.rect.shrink2(vec2(0.0, MARK));
                let share = ((way.bottom() - at.y) / way.height()).clamp(0.0, 1.0);
                let place = wheel.lowest + (1.0 - wheel.lowest) * share;
                if before != Some(place) {
                    self.held = Some((number, place));
                    link.play((wheel.touch)(place));
                }
                return place;
            }
            (None, Some(_)) => {
                self.release(link);
                ui.ctx().request_repaint_after(SOON);
            }
            (None, None) => {}
        }
        if response.has_focus() {
            let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let steps =
                ui.input(|input| input.num_presses(Key::ArrowUp) as f32 - input.num_presses(Key::ArrowDown) as f32);
            if steps != 0.0 {
                link.play((wheel.touch)((place + STEP * steps).clamp(wheel.lowest, 1.0)));
                ui.ctx().request_repaint_after(SOON);
            }
        }
        place
    }

    /// Lets go of the wheel that the mouse holds: the pitch springs back.
    pub(crate) fn release(&mut self, link: &Link) {
        if let Some((number, _)) = self.held.take()
            && WHEELS[number].lowest < 0.0
        {
            link.play((WHEELS[number].touch)(0.0));
        }
    }
}

/// Paints the way of a wheel, filled from where it rests to where it stands.
fn paint(painter: &Painter, way: Rect, place: f32, wheel: &Wheel, palette: &Palette) {
    painter.rect_filled(way, 3.0, palette.panel);
    let inside = way.shrink2(vec2(2.0, MARK));
    let height = |place: f32| inside.bottom() - (place - wheel.lowest) / (1.0 - wheel.lowest) * inside.height();
    let [rest, now] = [0.0, place.clamp(wheel.lowest, 1.0)].map(height);
    let filled = inside.with_min_y(rest.min(now)).with_max_y(rest.max(now));
    painter.rect_filled(filled, 0.0, palette.modulation.gamma_multiply(0.5));
    let mark = Rect::from_center_size(pos2(way.center().x, now), vec2(inside.width(), MARK));
    painter.rect_filled(mark, 1.5, if place == 0.0 { palette.muted } else { palette.modulation });
}
