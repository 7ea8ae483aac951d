//! A body as it is painted: its parts in a light from the left above, which glow where they move.

use crate::figure::{Build, Figure, Second};
use crate::form::Form;
use crate::mesh::{Mesh, Moved};
use crate::nodal::{self, Between};
use crate::outline::MOULDINGS;
use crate::view::View;
use crate::{bar, drum, lathe, second, tube};
use ecolor::Color32;
use emath::{Pos2, Rect, lerp, pos2, vec2};
use sprung::sound::bodies::Point;

/// Half the length of the mark where a string does not move, in pixels.
const TICK: f32 = 6.0;

/// A body as it is painted, in the order of its parts.
#[derive(Debug, Default)]
pub struct Picture {
    /// Lines that are painted below the triangles, so that their outline is smooth where triangles are painted without smoothing.
    pub outline: Vec<([Pos2; 2], Color32)>,
    /// Points with their colours.
    pub vertices: Vec<(Pos2, Color32)>,
    /// Triangles between these, the farthest first; two after one another are a patch with four corners.
    pub triangles: Vec<[u32; 3]>,
    /// Lines above the triangles.
    pub lines: Vec<(Ink, Vec<Pos2>)>,
    /// A string, from end to end; empty for all other bodies.
    pub string: Vec<Pos2>,
    /// Where it is struck.
    pub strike: Option<Pos2>,
}

/// How a line is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ink {
    /// The edge of a surface.
    Edge,
    /// An ornament.
    Fine,
    /// Where a mode does not move.
    Node,
    /// What joins two bodies.
    Joint,
}

/// How a body is now.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pose<'a> {
    /// The displacements of its points in the form's unit; none at rest.
    pub displacements: &'a [f32],
    /// The values at its points of the mode whose lines without motion are drawn.
    pub nodal: Option<&'a [f32]>,
    /// Where it is struck, if that is shown.
    pub strike: Option<Point>,
}

impl Picture {
    /// The picture of a figure in a rectangle. What moves takes on the colour `glow`. Allocates.
    pub fn of(rect: Rect, figure: &Figure, pose: &Pose, glow: Color32) -> Self {
        let form = figure.form;
        let whole = rect;
        let rect = figure.drum.map_or_else(|| second::first_place(rect, figure), |drum| drum::head(rect, drum));
        let moved = Moved { displacements: pose.displacements, reach: form.reach(rect), glow };
        let view = form.view(rect);
        let mut mesh = Mesh::new(view);
        let on = |number: usize| form.on(rect, figure.points[number], moved.by(number));
        let mut picture = Self::default();
        match (form, figure.build) {
            (Form::Line, _) => picture.string = (0..figure.points.len()).map(on).collect(),
            (_, Build::Bar(bar)) => bar::add_bar(&mut mesh, figure, &bar, &moved),
            (_, Build::Tube(tube)) => tube::add_tube(&mut mesh, figure, &tube, &moved),
            (Form::Plate { .. }, Build::Slab(thickness)) => bar::add_slab(&mut mesh, figure, thickness, &moved),
            _ => {
                lathe::add(&mut mesh, figure, &moved);
                picture.ring(figure, &on);
            }
        }
        if form == Form::Round && figure.build == Build::Thin {
            let drum = figure.drum.unwrap_or(drum::FRAME);
            drum::add(&mut mesh, drum, &moved);
            if drum.has_wires {
                picture.lines.extend(drum::wires(&view).map(|wire| (Ink::Fine, wire)));
            }
        }
        picture.triangles = mesh.triangles();
        (picture.vertices, picture.outline) = (mesh.vertices, mesh.outline);
        if let Some(values) = pose.nodal {
            picture.nodes(figure, values, &view, &moved);
        }
        if let Some(second) = &figure.second {
            let from = view.at(form.joint(moved.by(figure.points.len() - 1)));
            picture.join(second, whole, from, glow);
        }
        picture.strike = pose.strike.map(|strike| {
            let at = |point| form.on(rect, point, 0.0);
            let far = |number: &usize| (at(figure.points[*number]) - at(strike)).length();
            let nearest = (0..figure.points.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
            form.on(rect, strike, nearest.map_or(0.0, |nearest| moved.by(nearest)))
        });
        picture
    }

    /// Adds the lines where a mode with these values does not move.
    fn nodes(&mut self, figure: &Figure, values: &[f32], view: &View, moved: &Moved) {
        let space = |number: usize| figure.form.in_space(figure.points[number], moved.by(number));
        let between = |([from, to], share): &Between| view.at(space(*from)).lerp(view.at(space(*to)), *share);
        let lines: Vec<Vec<Pos2>> = if figure.form.is_line() {
            let line = |place: &Between| {
                let ([from, to], share) = *place;
                let along = lerp(figure.points[from].x as f32..=figure.points[to].x as f32, share);
                let up = lerp(moved.by(from)..=moved.by(to), share);
                match figure.build {
                    Build::Bar(bar) => bar::across(&bar, 2.0 * along - 1.0, up).map(|at| view.at(at)).to_vec(),
                    Build::Tube(tube) => tube::around(&tube, along, up).map(|at| view.at(at)).to_vec(),
                    _ => [-TICK, TICK].map(|off| between(place) + vec2(0.0, off)).to_vec(),
                }
            };
            nodal::on_line(values).iter().map(line).collect()
        } else {
            let lines = nodal::on_surface(figure.form, &figure.points, values, figure.grid);
            lines.iter().map(|line| line.iter().map(between).collect()).collect()
        };
        self.lines.extend(lines.iter().flat_map(|line| nodal::dashed(line)).map(|dash| (Ink::Node, dash)));
    }

    /// Adds a joined body, which stands on the same floor.
    fn join(&mut self, second: &Second, rect: Rect, from: Pos2, glow: Color32) {
        let floor = self.vertices.iter().map(|(at, _)| at.y).fold(from.y, f32::max);
        let place = second::second_place(rect);
        let other = Self::of(place, &second.figure, &Pose::default(), glow).standing(floor.min(rect.bottom()));
        let ends = other.vertices.iter().map(|(at, _)| *at).chain(other.string.iter().copied());
        let left = ends.clone().map(|at| at.x).fold(f32::INFINITY, f32::min);
        let at_left: Vec<f32> = ends.filter(|at| at.x < left + 1.0).map(|at| at.y).collect();
        let to = pos2(left, at_left.iter().sum::<f32>() / at_left.len().max(1) as f32);
        self.lines.push((Ink::Joint, second::joint(from, to, 0.055 * place.width(), second.is_rigid)));
        let first = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        self.outline.extend(other.outline);
        self.lines.extend(other.lines);
        if !other.string.is_empty() {
            self.lines.push((Ink::Edge, other.string));
        }
    }

    /// Adds the edge of a turned form, and a bell's ornaments.
    fn ring(&mut self, figure: &Figure, on: &impl Fn(usize) -> Pos2) {
        let (form, [columns, rows]) = (figure.form, figure.grid);
        let mut add = |ink: Ink, column: usize| {
            let numbers: Vec<usize> = (0..rows).map(|row| row * columns + column).collect();
            let is_hidden = |number: &usize| form.is_behind(figure.points[*number]);
            // The far side of a bell is behind it; a bowl is open.
            for run in numbers.chunk_by(|a, b| !form.is_bell() || is_hidden(a) == is_hidden(b)) {
                if !form.is_bell() || !is_hidden(&run[0]) {
                    self.lines.push((ink, run.iter().copied().map(on).collect()));
                }
            }
        };
        if form.is_open() {
            add(Ink::Edge, columns - 1);
        }
        if form.is_bell() && figure.is_large() {
            MOULDINGS.iter().for_each(|share| add(Ink::Fine, (share * (columns - 1) as f32).round() as usize));
        }
    }

    /// The same body, with its lowest point at this height.
    pub fn standing(mut self, floor: f32) -> Self {
        let points = || self.vertices.iter().map(|(at, _)| at).chain(&self.string);
        let down = vec2(0.0, floor - points().fold(f32::NEG_INFINITY, |lowest, at| lowest.max(at.y)));
        let vertices = self.vertices.iter_mut().map(|(at, _)| at);
        let lines = self.lines.iter_mut().flat_map(|(_, line)| line).chain(&mut self.string).chain(&mut self.strike);
        let outline = self.outline.iter_mut().flat_map(|(ends, _)| ends);
        vertices.chain(lines).chain(outline).for_each(|at| *at += down);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BodyShape;
    use sprung::preset::Preset;
    use sprung::sound::bodies::{Body, Model};

    #[test]
    fn a_joined_body_stands_at_the_right_and_the_loudest_mode_has_its_lines() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        let Preset { patch, guide, tags, .. } = Preset::find("Resonator Marimba").unwrap();
        let shape = BodyShape::of(&patch.modes, guide.family, tags);
        let picture = |energies: &[f32]| {
            let pose = Pose { nodal: shape.lines_of(energies), ..Pose::default() };
            Picture::of(rect, &shape.figure, &pose, Color32::WHITE)
        };
        let places = |ink: Ink| {
            let lines = picture(&[]).lines.into_iter().filter(|(other, _)| *other == ink).collect::<Vec<_>>();
            lines.into_iter().flat_map(|(_, line)| line).collect::<Vec<Pos2>>()
        };
        let joint = places(Ink::Joint);
        let first = shape.place(rect);
        let end = shape.figure.form.on(first, Point { x: 1.0, y: 0.0 }, 0.0);
        assert!((joint[0] - end).length() < 12.0 && joint[joint.len() - 1].x > end.x, "{end:?}");
        assert!(rect.contains_rect(Rect::from_points(&joint)) && joint.len() > 50, "a coil");
        let (nearest, _) = shape.nearest(rect, end);
        assert!(nearest.x > 0.99, "{nearest:?}");
        // The lowest mode of a bar rests at 22.4 % from each end.
        let still = [0.224, 0.776].map(|x| shape.figure.form.on(first, Point { x, y: 0.0 }, 0.0));
        for at in still {
            assert!(places(Ink::Node).iter().any(|place| (*place - at).length() < 8.0), "{at:?}");
        }
        let alone = |mode: usize| (0..64).map(|other| if other == mode { 1.0 } else { 0.0 }).collect::<Vec<f32>>();
        assert!((1..16).any(|mode| shape.lines_of(&alone(mode)) != shape.lines_of(&[])), "the loudest mode's");
    }

    #[test]
    fn a_frame_is_about_as_large_as_its_body() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        for (id, model) in Model::ALL.iter().filter(|(id, _)| !["mass", "string"].contains(id)) {
            let figure = Figure::of(&Body::new(model.clone()));
            let picture = Picture::of(rect, &figure, &Pose::default(), Color32::WHITE);
            let places: Vec<Pos2> = picture.vertices.iter().map(|(at, _)| *at).collect();
            let (body, frame) = (Rect::from_points(&places), figure.frame(rect));
            assert!(
                frame.expand(6.0).contains_rect(body) && body.expand(10.0).contains_rect(frame),
                "{id}: {frame:?} {body:?}"
            );
        }
    }

    #[test]
    fn an_outline_reaches_as_far_as_its_body() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        for name in [
            "Marimba",
            "Tubular Bells",
            "Flute",
            "Gong",
            "Crash",
            "Church Bell",
            "Hand Bell",
            "Metal Plate",
            "Singing Bowl",
            "Wine Glass",
            "Kick",
            "Timpani",
        ] {
            let Preset { patch, guide, tags, .. } = Preset::find(name).unwrap();
            let figure = crate::small_figure(&patch.modes, guide.family, tags);
            let moved: Vec<f32> = (0..figure.points.len()).map(|number| (number % 7) as f32).collect();
            for displacements in [&[], &moved[..]] {
                let picture = Picture::of(rect, &figure, &Pose { displacements, ..Pose::default() }, Color32::WHITE);
                let places: Vec<Pos2> = picture.vertices.iter().map(|(at, _)| *at).collect();
                let ends: Vec<Pos2> = picture.outline.iter().flat_map(|(ends, _)| *ends).collect();
                assert_eq!(Rect::from_points(&ends), Rect::from_points(&places), "{name}");
            }
        }
    }
}
