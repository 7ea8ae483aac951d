//! The wheels beside the keys: one bends the pitch and springs back, the other is the modulation wheel and stays.

use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, Palette, SMALL};
use crate::editor::widgets::outline;
use crate::editor::widgets::text::line;
use crate::link::{Link, Touch};
use egui::{Align2, EventFilter, Id, Key, Painter, Rect, Response, Sense, Ui, WidgetInfo, pos2, vec2};

/// Height of the names below, and thickness of the line where a wheel stands.
const NAME: f32 = 14.0;
const MARK: f32 = 3.0;
/// Share of the track for one press of an arrow key.
const STEP: f32 = 0.05;

/// A wheel: its name, what it does, where its track begins, and the touch that moves it.
struct Wheel {
    name: &'static str,
    help: &'static str,
    lowest: f32,
    touch: fn(f32) -> Touch,
}

impl Wheel {
    /// Whether it goes back to the middle when it is let go.
    fn springs_back(&self) -> bool {
        self.lowest < 0.0
    }
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
    /// The wheel that mouse or key hold, and where it stands.
    held: Option<(usize, f32)>,
}

impl Wheels {
    /// Shows the wheels of the channel that the window plays where they were moved last, here or on the player's keyboard.
    pub(crate) fn show(&mut self, ui: &Ui, rect: Rect, controls: &mut Controls) {
        let (palette, link) = (controls.palette, controls.params.link());
        if rect.width() <= 0.0 {
            self.release(link);
            return;
        }
        let width = (rect.width() - 2.0 * GAP) / 2.0;
        for (number, (wheel, position)) in WHEELS.iter().zip(link.telemetry.wheels(0)).enumerate() {
            let corner = rect.min + vec2(number as f32 * (width + GAP), 0.0);
            let column = Rect::from_min_size(corner, vec2(width, rect.height()));
            let (track, name) = column.split_top_bottom_at_y(column.bottom() - NAME);
            let response = ui.interact(track, Id::unique(wheel.name), Sense::click_and_drag());
            let position = self.turn(ui, &response, number, position, link);
            response.widget_info(|| WidgetInfo::slider(true, position.into(), wheel.name));
            if response.hovered() || response.dragged() {
                *controls.hint = Hint::new(format!("{} {:.0} %", wheel.name, 100.0 * position), wheel.help);
            }
            paint(ui.painter(), track, position, wheel, palette);
            outline(ui, &response, track, 3, palette);
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

    /// Lets the user move a wheel that stands at `position`, by mouse or arrow keys. Returns where it stands then.
    fn turn(&mut self, ui: &Ui, response: &Response, number: usize, position: f32, link: &Link) -> f32 {
        let wheel = &WHEELS[number];
        let pointed = response.is_pointer_button_down_on().then(|| response.interact_pointer_pos()).flatten();
        let mut wanted = pointed.map(|at| {
            let track = response.rect.shrink2(vec2(0.0, MARK));
            let share = ((track.bottom() - at.y) / track.height().max(1.0)).clamp(0.0, 1.0);
            wheel.lowest + (1.0 - wheel.lowest) * share
        });
        if response.has_focus() {
            let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let [up, down] = [Key::ArrowUp, Key::ArrowDown];
            if wheel.springs_back() {
                let is_down = |key| ui.input(|input| input.key_down(key));
                wanted = wanted.or(is_down(up).then_some(1.0)).or(is_down(down).then_some(-1.0));
            } else {
                let steps = ui.input(|input| input.num_presses(up) as f32 - input.num_presses(down) as f32);
                if steps != 0.0 {
                    link.play((wheel.touch)((position + STEP * steps).clamp(wheel.lowest, 1.0)));
                }
            }
        }
        let held = self.held.filter(|(held, _)| *held == number).map(|(_, position)| position);
        match wanted {
            Some(now) if held != Some(now) => {
                self.held = Some((number, now));
                link.play((wheel.touch)(now));
            }
            None if held.is_some() => self.release(link),
            _ => {}
        }
        wanted.unwrap_or(position)
    }

    /// Lets go of the wheel that is held: the pitch springs back.
    pub(crate) fn release(&mut self, link: &Link) {
        if let Some((number, _)) = self.held.take()
            && WHEELS[number].springs_back()
        {
            link.play((WHEELS[number].touch)(0.0));
        }
    }
}

/// Paints the track of a wheel, filled from where it rests to where it stands.
fn paint(painter: &Painter, track: Rect, position: f32, wheel: &Wheel, palette: &Palette) {
    painter.rect_filled(track, 3.0, palette.panel);
    let inside = track.shrink2(vec2(2.0, MARK));
    let height = |position: f32| inside.bottom() - (position - wheel.lowest) / (1.0 - wheel.lowest) * inside.height();
    let [rest, now] = [0.0, position].map(height);
    let filled = inside.with_min_y(rest.min(now)).with_max_y(rest.max(now));
    painter.rect_filled(filled, 0.0, palette.modulation.gamma_multiply(0.5));
    let mark = Rect::from_center_size(pos2(track.center().x, now), vec2(inside.width(), MARK));
    painter.rect_filled(mark, 1.5, if position == 0.0 { palette.muted } else { palette.modulation });
}
