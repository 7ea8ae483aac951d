//! The way of the sound as one picture: keys, what moves the body, the body or two joined ones, effects on a wire, space, output.

use super::bodies::{Bodies, Drawn};
use super::parts::Part;
use super::spot::{LAMP, Spot};
use super::{sections, tuning};
use crate::editor::body::face;
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::displays::scope;
use crate::editor::lamps::{self, MOVERS};
use crate::editor::theme::{GAP, SMALL, TEXT, paint_panel};
use crate::editor::widgets::text::{line, width};
use egui::{Align2, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use sprung::params::Param;
use std::f32::consts::TAU;

/// Widths of the picture at which its columns have their least and their greatest width; beyond, the bodies have what is left.
const WIDTHS: [f32; 2] = [884.0, 1084.0];
/// These widths: keys, what moves the body, effects, space, output; and the gaps before each of the others and before the bodies.
const COLUMNS: [[f32; 2]; 5] = [[92.0, 104.0], [120.0, 148.0], [96.0, 108.0], [110.0, 146.0], [92.0, 108.0]];
const GAPS: [[f32; 2]; 5] = [[18.0, 26.0], [26.0, 36.0], [20.0, 28.0], [16.0, 20.0], [14.0, 20.0]];
/// The widest tile of a body, and the shares of two bodies and of the joint between them.
const WIDEST: f32 = 300.0;
const SHARES: [f32; 2] = [0.5, 0.7];
/// Height of the titles, of the name in a tile, and of a line of small words.
const TITLE: f32 = 18.0;
const NAME: f32 = 24.0;
const LINE: f32 = 14.0;
/// Height of what moves the body while it is off, and the greatest while it is on.
const EXCITERS: [f32; 2] = [22.0, 48.0];
/// What the sound passes on its wire.
const EFFECTS: [Part; 5] = ["Soundbox", "Strings", "Tremolo", "Drive", "Tone"];

/// The picture while it is made.
struct Way<'a, 'b> {
    ui: &'a Ui,
    chosen: Part,
    /// The part that is clicked, and where the middle of the chosen one is.
    clicked: Option<Part>,
    middle: f32,
    /// Whether sound flows.
    flows: bool,
    controls: &'a mut Controls<'b>,
}

/// Shows the path of a preset, or of a kit, which has no lamps, with one part chosen. Returns the part that is clicked, and where the
/// middle of the chosen one is.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    chosen: Part,
    (shown, bodies): (&Shown, &Bodies),
    controls: &mut Controls,
) -> (Option<Part>, f32) {
    let flows = !controls.is_preset || MOVERS.iter().any(|mover| mover.is_on(controls));
    let mut way = Way { ui, chosen, clicked: None, middle: rect.center().x, flows, controls };
    let share = ((rect.width() - WIDTHS[0]) / (WIDTHS[1] - WIDTHS[0])).clamp(0.0, 1.0);
    let between = |[least, most]: [f32; 2]| (least + share * (most - least)).round();
    let ([keys, movers, effects, space, output], gaps) = (COLUMNS.map(between), GAPS.map(between));
    let area = rect.with_min_y(rect.top() + TITLE);
    let column = |left: f32, width: f32| area.with_min_x(left).with_max_x(left + width);
    let keys = column(area.left(), keys);
    let movers = column(keys.right() + gaps[0], movers);
    let output = column(area.right() - output, output);
    let space = column(output.left() - gaps[4] - space, space);
    let effects = column(space.left() - gaps[3] - effects, effects);
    let middle = area.with_min_x(movers.right() + gaps[1]).with_max_x(effects.left() - gaps[2]);
    for (title, at) in [("Keys", keys), ("What moves it", movers), ("What it is", middle), ("Where it goes", effects)] {
        let place = rect.with_min_x(at.left()).with_max_x(at.right()).with_max_y(rect.top() + LINE);
        way.words(place, Align2::LEFT_CENTER, title);
    }
    let mut bodies_are = middle;
    if bodies.second.is_none() {
        bodies_are = Rect::from_center_size(middle.center(), vec2(middle.width().min(WIDEST), middle.height()));
    }
    way.wires([keys, movers, bodies_are, effects, space, output]);
    way.keys(keys, shown);
    way.movers(movers, bodies);
    way.bodies(bodies_are, bodies);
    way.effects(effects);
    way.space(space, bodies);
    way.output(output);
    (way.clicked, way.middle)
}

/// The places of what moves the body: more room for what is on.
fn exciters(rect: Rect, is_on: &[bool]) -> Vec<Rect> {
    let [least, most] = EXCITERS;
    let on = is_on.iter().filter(|is_on| **is_on).count() as f32;
    let off = is_on.len() as f32 - on;
    let height = ((rect.height() - off * least) / on.max(1.0) - 4.0).min(most);
    let gap = ((rect.height() - on * height - off * least) / (is_on.len() - 1) as f32).clamp(0.0, GAP);
    let mut top = rect.top();
    let mut next = |is_on: bool| {
        let place = rect.with_min_y(top).with_max_y(top + if is_on { height } else { least });
        top = place.bottom() + gap;
        place
    };
    is_on.iter().map(|is_on| next(*is_on)).collect()
}

impl Way<'_, '_> {
    /// Shows a part in its place, with its name at the top left.
    fn spot(&mut self, part: Part, title: &'static str, rect: Rect, name: Rect, is_tile: bool) {
        let lamp = lamps::of(part).filter(|_| self.controls.is_preset);
        let spot = Spot { part, title, rect, name, size: TEXT, is_tile, lamp };
        if spot.show(self.ui, part == self.chosen, self.controls) {
            self.clicked = Some(part);
        }
        if part == self.chosen {
            self.middle = rect.center().x;
        }
    }

    /// Shows a part as a tile. Returns the place below its name.
    fn tile(&mut self, part: Part, title: &'static str, rect: Rect) -> Rect {
        let (head, rest) = rect.shrink2(vec2(GAP, 3.0)).split_top_bottom_at_y(rect.top() + NAME);
        let has_lamp = lamps::of(part).is_some() && self.controls.is_preset;
        self.spot(part, title, rect, head.with_min_x(head.left() + if has_lamp { LAMP - 2.0 } else { 0.0 }), true);
        rest
    }

    fn is_on(&self, part: Part) -> bool {
        !self.controls.is_preset || lamps::of(part).is_none_or(|lamp| lamp.is_on(self.controls))
    }

    fn words(&self, rect: Rect, align: Align2, words: &str) {
        line(self.ui.painter(), rect, align, words, SMALL, self.controls.palette.muted);
    }

    /// Writes words at the foot of a tile, in two lines if they do not fit into one. Returns what is left above.
    fn foot(&self, rect: Rect, [first, second]: &[String; 2]) -> Rect {
        let one = if second.is_empty() { first.clone() } else { format!("{first}, {second}") };
        let fits = second.is_empty() || width(self.ui.painter(), &one, SMALL) <= rect.width();
        let lines = if fits { vec![one.as_str()] } else { vec![first.as_str(), second.as_str()] };
        let top = rect.bottom() - lines.len() as f32 * LINE;
        for (row, words) in lines.iter().enumerate() {
            let place = rect.with_min_y(top + row as f32 * LINE).with_max_y(top + (row + 1) as f32 * LINE);
            self.words(place, Align2::CENTER_CENTER, words);
        }
        rect.with_max_y(top)
    }

    fn wire(&self, points: Vec<Pos2>, flows: bool) {
        let palette = self.controls.palette;
        let colour = if flows { palette.accent } else { palette.line };
        self.ui.painter().add(Shape::line(points, Stroke::new(2.0, colour)));
    }

    /// Draws the wires between these columns, under what is on them.
    fn wires(&self, [keys, movers, bodies, effects, space, output]: [Rect; 6]) {
        let y = bodies.center().y;
        let trunk = (movers.right() + 14.0).min(bodies.left() - 4.0);
        let is_on: Vec<bool> = MOVERS.iter().map(|mover| self.is_on(mover.section)).collect();
        for (place, is_on) in exciters(movers, &is_on).into_iter().zip(is_on) {
            if is_on {
                let at = place.center().y;
                self.wire(vec![pos2(keys.right(), at), pos2(movers.left(), at)], true);
                self.wire(vec![pos2(movers.right(), at), pos2(trunk, at), pos2(trunk, y)], true);
            }
        }
        self.wire(vec![pos2(trunk, y), pos2(bodies.left(), y)], self.flows);
        let [before, lamps, after] = [effects.left() - 8.0, effects.left() + LAMP / 2.0, effects.right() + 4.0];
        let [top, bottom] = [effects.top() + 4.0, effects.bottom() - 4.0];
        let corners = [(bodies.right(), y), (before, y), (before, top), (lamps, top), (lamps, bottom), (after, bottom)];
        let corners = corners.into_iter().chain([(after, y), (space.left(), y)]);
        self.wire(corners.map(|(x, y)| pos2(x, y)).collect(), self.flows);
        self.wire(vec![pos2(space.right(), y), pos2(output.left(), y)], self.flows);
    }

    fn keys(&mut self, rect: Rect, shown: &Shown) {
        let palette = self.controls.palette;
        paint_panel(self.ui.painter(), rect, palette);
        let text = |param: Param| self.controls.text(param.info());
        let is_set = |param: Param| self.controls.value(param.info()) != param.info().default;
        let unison = if is_set(Param::Unison) { format!(" × {}", text(Param::Unison)) } else { String::new() };
        let scale = shown.tuning().map_or("equal".to_owned(), |own| tuning::about(own).0);
        // In a kit, what is added says its sign by itself.
        let bend = format!("bend ±{}", text(Param::BendRange)).replace("±±", "±");
        let pitch = if is_set(Param::Tune) { text(Param::Tune) } else { bend };
        let about: [(Part, String); 4] = [
            ("Pitch", pitch),
            ("Voices", format!("{} {}{unison}", text(Param::Voices), text(Param::Mode))),
            ("Tuning", format!("{scale}, {}", text(Param::Tuning))),
            ("Strike", format!("velocity {}", text(Param::Velocity))),
        ];
        let height = rect.height() / about.len() as f32;
        for (row, (part, words)) in about.into_iter().enumerate() {
            let place =
                rect.with_min_y(rect.top() + row as f32 * height).with_max_y(rect.top() + (row + 1) as f32 * height);
            let inside = place.shrink2(vec2(GAP, 0.0));
            let name = inside.with_min_y(place.center().y - 17.0).with_max_y(place.center().y + 1.0);
            self.spot(part, part, place.shrink(1.0), name, false);
            self.words(name.translate(vec2(0.0, 16.0)), Align2::LEFT_CENTER, &words);
        }
    }

    fn movers(&mut self, rect: Rect, bodies: &Bodies) {
        let is_on: Vec<bool> = MOVERS.iter().map(|mover| self.is_on(mover.section)).collect();
        for ((place, is_on), mover) in exciters(rect, &is_on).into_iter().zip(is_on).zip(&MOVERS) {
            let name = place.with_min_x(place.left() + LAMP + 4.0);
            self.spot(mover.section, mover.section, place, name, is_on);
            // Incoming sound has no picture.
            if is_on && mover.param != Param::InputLevel {
                let left = name.left() + width(self.ui.painter(), "Mallet", TEXT) + GAP;
                let picture = place.with_min_x(left).shrink2(vec2(6.0, 0.2 * place.height()));
                self.picture(mover.section, picture, bodies);
            }
        }
    }

    /// Draws the picture of a section. Returns what is said of it.
    fn picture(&self, part: Part, rect: Rect, bodies: &Bodies) -> Option<String> {
        let section = sections::sections(&[part]).next()?;
        sections::picture(self.ui.painter(), rect, section, &bodies.first.figure, self.controls)
    }

    fn bodies(&mut self, rect: Rect, bodies: &Bodies) {
        let Some(second) = &bodies.second else {
            return self.body("Body", "Body", rect, &bodies.first);
        };
        let [one, other] = SHARES.map(|share| (rect.left() + share * rect.width()).round());
        self.body("Body", "Body 1", rect.with_max_x(one), &bodies.first);
        let joint = rect.with_min_x(one + 2.0).with_max_x(other - 2.0);
        let name = Rect::from_min_size(joint.min, vec2(joint.width(), NAME)).translate(vec2(0.0, 1.0));
        let indent = 0.5 * (joint.width() - width(self.ui.painter(), "Joint", TEXT)).max(0.0);
        self.spot("Joint", "Joint", joint, name.with_min_x(joint.left() + indent), false);
        let [kind, heard] = &bodies.joint;
        self.joint(joint, kind);
        for (row, words) in [kind, heard].into_iter().enumerate() {
            let place = Rect::from_min_size(joint.left_center(), vec2(joint.width(), LINE));
            self.words(place.translate(vec2(0.0, 14.0 + row as f32 * LINE)), Align2::CENTER_CENTER, words);
        }
        self.body("Body 2", "Body 2", rect.with_min_x(other), second);
    }

    fn body(&mut self, part: Part, title: &'static str, rect: Rect, body: &Drawn) {
        let mut inside = self.tile(part, title, rect);
        if part == "Body" {
            let (rest, foot) = inside.split_top_bottom_at_y(inside.bottom() - NAME + 4.0);
            let wide = LAMP + width(self.ui.painter(), "Rattle", TEXT) + 2.0 * GAP;
            let place = foot.with_max_x((foot.left() + wide).min(foot.right())).translate(vec2(-4.0, 0.0));
            self.spot("Rattle", "Rattle", place, place.with_min_x(place.left() + LAMP + 2.0), false);
            inside = rest;
        }
        let picture = self.foot(inside, &body.about).shrink2(vec2(4.0, 4.0));
        face::paint_still(self.ui.painter(), picture, &body.figure, self.controls.palette);
    }

    /// Draws how two bodies are joined.
    fn joint(&self, rect: Rect, kind: &str) {
        let (painter, palette) = (self.ui.painter(), self.controls.palette);
        let [left, right] = [rect.left_center() + vec2(2.0, 0.0), rect.right_center() - vec2(2.0, 0.0)];
        let stroke = Stroke::new(1.5, palette.text);
        match kind {
            "spring" => {
                let coil = |step: usize| {
                    let along = step as f32 / 64.0;
                    let aside =
                        if (6..=58).contains(&step) { 8.0 * egui::Vec2::angled(along * 8.0 * TAU).y } else { 0.0 };
                    left + along * (right - left) + vec2(0.0, aside)
                };
                painter.add(Shape::line((0..=64).map(coil).collect(), stroke));
            }
            "rigid" => {
                painter.line_segment([left, right], Stroke::new(4.0, palette.text));
            }
            "series" => {
                painter.line_segment([left, right], stroke);
                let wing = |y: f32| [right, right + vec2(-6.0, y)];
                painter.line_segment(wing(-4.0), stroke);
                painter.line_segment(wing(4.0), stroke);
            }
            _ => painter.extend(Shape::dashed_line(&[left, right], Stroke::new(1.0, palette.muted), 3.0, 5.0)),
        }
    }

    fn effects(&mut self, rect: Rect) {
        let height = (rect.height() - 2.0 * GAP) / EFFECTS.len() as f32;
        for (row, part) in EFFECTS.into_iter().enumerate() {
            let top = rect.top() + GAP + row as f32 * height;
            let place = rect.with_min_y(top).with_max_y(top + height).shrink2(vec2(0.0, 2.0));
            let at = pos2(rect.left() + LAMP / 2.0, place.center().y);
            // The face of what is chosen hides the wire, which goes on over it. Where a lamp is hollow, the wire ends at it.
            self.spot(part, part, place.with_min_x(at.x + 8.0), place.with_min_x(rect.left() + LAMP), false);
            if !self.is_on(part) {
                let palette = self.controls.palette;
                self.ui.painter().circle(at, 3.5, palette.ground, Stroke::new(1.5, palette.muted));
            }
        }
    }

    fn space(&mut self, rect: Rect, bodies: &Bodies) {
        let inside = self.tile("Space", "Space", rect);
        let is_on = self.controls.value(Param::Space.info()) > 0.0;
        let mix = if is_on { self.controls.text(Param::SpaceMix.info()) } else { String::new() };
        let picture = |at: Rect| self.picture("Space", at.shrink2(vec2(10.0, 12.0)), bodies);
        let kinds = [self.controls.text(Param::SpaceMaterial.info()), self.controls.text(Param::Space.info())];
        let words = match self.controls.value(Param::Space.info()) as usize {
            0 => "passes unchanged".to_owned(),
            3 => kinds[1].clone(),
            _ => kinds.join(" "),
        };
        picture(self.foot(inside, &[words, mix]));
    }

    fn output(&mut self, rect: Rect) {
        let inside = self.tile("Output", "Output", rect);
        let limiter = self.controls.text(Param::Limiter.info());
        let words = [self.controls.text(Param::Gain.info()), format!("limiter {limiter}")];
        let area = self.foot(inside, &words).shrink2(vec2(2.0, 10.0));
        let (painter, palette) = (self.ui.painter(), self.controls.palette);
        painter.hline(area.x_range(), painter.round_to_pixel_center(area.center().y), Stroke::new(1.0, palette.line));
        let frames = self.controls.params.link().telemetry.scope().read();
        scope::trace(painter, area, &frames, palette);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::pages::path::PATH;

    #[test]
    fn every_part_of_the_rows_is_in_the_picture() {
        let movers = MOVERS.iter().map(|mover| mover.section);
        let others = ["Pitch", "Voices", "Tuning", "Strike", "Body", "Rattle", "Space", "Output"];
        let mut found: Vec<Part> = movers.chain(EFFECTS).chain(others).collect();
        let mut all: Vec<Part> = PATH.into_iter().flatten().copied().flatten().copied().collect();
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all);
    }

    #[test]
    fn what_moves_the_body_has_room_however_much_of_it_is_on() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(100.0, 166.0));
        for on in 0..64_u32 {
            let is_on: Vec<bool> = (0..6).map(|place| on >> place & 1 == 1).collect();
            let places = exciters(rect, &is_on);
            assert!(places.windows(2).all(|pair| pair[0].bottom() <= pair[1].top() + 0.01), "{is_on:?}: {places:?}");
            assert!(places.iter().all(|place| rect.expand(0.01).contains_rect(*place) && place.height() >= 20.0));
        }
    }
}
