//! The body of a preset as numbers that the page draws on a canvas.

use ecolor::Color32;
use emath::{Pos2, Rect, pos2, vec2};
use sprung::preset::Preset;
use sprung::sound::bodies::Point;
use sprung_picture::play::MODELS;
use sprung_picture::{BodyShape, Figure, Origin, Picture, Pose, REACH, Swing};

/// Number of modes that are shown.
pub(crate) const SHOWN: usize = 64;

/// A body that swings.
pub(crate) struct Drawn {
    shape: BodyShape,
    swing: Swing,
    /// The energies of the modes, which the page writes.
    pub(crate) energies: [f32; SHOWN],
    pub(crate) numbers: Vec<f32>,
}

impl Drawn {
    /// The body of a preset at rest. Slow: it computes the shapes of all modes.
    pub(crate) fn new(preset: &Preset) -> Self {
        let shape = BodyShape::of(&preset.patch.modes, preset.guide.family, &preset.tags);
        Self { shape, swing: Swing::default(), energies: [0.0; SHOWN], numbers: Vec::new() }
    }

    /// Draws the body some seconds later (at its greatest bend if they are negative), in a picture of this size, with a colour (0xRRGGBB) for what moves. The numbers are: how many
    /// polygons, and for each four corners and its colour; how many lines, and for each its ink (0 for a string, or else 1 more than
    /// that of [`sprung_picture::Ink`]), how many points, and these; and the place of the strike, if it is known. Returns how many numbers they are.
    pub(crate) fn draw(&mut self, size: [f32; 2], seconds: f32, glow: u32) -> usize {
        let rect = rect(size);
        let moved = self.swing.advance((seconds >= 0.0).then_some(seconds), &self.shape, &self.energies, rect);
        let strike = self.shape.origin.body().map(|body| body.strike);
        let pose = Pose { displacements: &moved, nodal: self.shape.lines_of(&self.energies), strike };
        let picture = Picture::of(rect, &self.shape.figure, &pose, colour(glow));
        self.write(&picture)
    }

    /// Draws the tile of a model, as [`Drawn::draw`] does.
    pub(crate) fn tile(&mut self, model: usize, size: [f32; 2], glow: u32) -> usize {
        let id = MODELS.get(model).map_or("string", |(id, _)| *id);
        self.write(&Picture::of(rect(size), &Figure::tile(id), &Pose::default(), colour(glow)))
    }

    fn write(&mut self, picture: &Picture) -> usize {
        let numbers = &mut self.numbers;
        numbers.clear();
        // Two triangles are a patch with four corners.
        numbers.push((picture.triangles.len() / 2) as f32);
        for pair in picture.triangles.chunks_exact(2) {
            let corners =
                [pair[0][0], pair[0][1], pair[0][2], pair[1][2]].map(|corner| picture.vertices[corner as usize]);
            corners.iter().for_each(|(at, _)| numbers.extend([at.x, at.y]));
            let mean = |part: usize| corners.iter().map(|(_, colour)| f32::from(colour[part])).sum::<f32>() / 4.0;
            numbers.extend([mean(0), mean(1), mean(2)]);
        }
        let string = Some((0, &picture.string)).filter(|(_, string)| !string.is_empty());
        let lines = picture.lines.iter().map(|(ink, line)| (1 + *ink as u8, line)).chain(string);
        numbers.push(lines.clone().count() as f32);
        for (ink, line) in lines {
            numbers.extend([f32::from(ink), line.len() as f32]);
            line.iter().for_each(|at| numbers.extend([at.x, at.y]));
        }
        picture.strike.iter().for_each(|at| numbers.extend([at.x, at.y]));
        numbers.len()
    }

    /// Writes the coordinates of the point of the body that is nearest to a place in the picture. Returns whether the body is touched
    /// there, and can be struck elsewhere.
    pub(crate) fn touch(&mut self, size: [f32; 2], at: [f32; 2]) -> bool {
        let (point, distance) = self.shape.nearest(rect(size), pos2(at[0], at[1]));
        let Point { x, y } = self.shape.confined(point, |body| body.strike);
        self.numbers.clear();
        self.numbers.extend([x as f32, y as f32]);
        distance <= REACH && matches!(self.shape.origin, Origin::FromBody(_))
    }
}

fn colour(rgb: u32) -> Color32 {
    let [_, red, green, blue] = rgb.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

fn rect([width, height]: [f32; 2]) -> Rect {
    Rect::from_min_size(Pos2::ZERO, vec2(width, height))
}
