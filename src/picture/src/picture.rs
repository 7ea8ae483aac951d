//! A body as it is painted: its parts in a light from the left above, which glow where they move.

use crate::figure::{Build, Figure};
use crate::form::Form;
use crate::mesh::{Mesh, Moved};
use crate::outline::MOULDINGS;
use crate::{bar, drum, lathe, tube};
use ecolor::Color32;
use emath::{Pos2, Rect, vec2};
use sprung::sound::bodies::Point;

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
}

impl Picture {
    /// The picture of a figure in a rectangle. Displacements of its points are in the form's unit, none for a body at rest. What moves
    /// takes on the colour `glow`. Allocates.
    pub fn of(rect: Rect, figure: &Figure, displacements: &[f32], strike: Option<Point>, glow: Color32) -> Self {
        let form = figure.form;
        let rect = figure.drum.map_or(rect, |drum| drum::head(rect, drum));
        let moved = Moved { displacements, reach: form.reach(rect), glow };
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
        picture.strike = strike.map(|strike| {
            let at = |point| form.on(rect, point, 0.0);
            let far = |number: &usize| (at(figure.points[*number]) - at(strike)).length();
            let nearest = (0..figure.points.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
            form.on(rect, strike, nearest.map_or(0.0, |nearest| moved.by(nearest)))
        });
        picture
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
    use sprung::preset::Preset;

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
                let picture = Picture::of(rect, &figure, displacements, None, Color32::WHITE);
                let places: Vec<Pos2> = picture.vertices.iter().map(|(at, _)| *at).collect();
                let ends: Vec<Pos2> = picture.outline.iter().flat_map(|(ends, _)| *ends).collect();
                assert_eq!(Rect::from_points(&ends), Rect::from_points(&places), "{name}");
            }
        }
    }
}
