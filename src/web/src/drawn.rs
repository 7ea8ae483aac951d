//! The body of a preset as numbers that the page draws on a canvas.

use ecolor::Color32;
use emath::{Pos2, Rect, pos2, vec2};
use sprung::params::{Param, Values};
use sprung::preset::Preset;
use sprung::sound::bodies::Point;
use sprung_picture::play::MODELS;
use sprung_picture::{BodyShape, Figure, Floor, Origin, Picture, Pose, REACH, Swing};

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

    /// Draws the body some seconds later (at its greatest bend if they are negative), in a picture of this size, with a colour (0xRRGGBB)
    /// for what moves. The numbers are: how many polygons, and for each four corners and its colour; how many lines, and for each its ink
    /// (0 for a string, or else 1 more than that of [`sprung_picture::Ink`]), how many points, and these; and the places of the strike and
    /// of the ear, if they are known and can be moved. Returns how many numbers they are.
    pub(crate) fn draw(&mut self, size: [f32; 2], seconds: f32, glow: u32) -> usize {
        let rect = rect(size);
        let moved = self.swing.advance((seconds >= 0.0).then_some(seconds), &self.shape, &self.energies, rect);
        let strike = self.shape.origin.body().map(|body| body.strike);
        let pose = Pose { displacements: &moved, nodal: self.shape.lines_of(&self.energies), strike };
        let picture = Picture::of(rect, &self.shape.figure, &pose, colour(glow));
        let heard = self.places().map(|[_, ear]| self.shape.figure.form.on(self.shape.place(rect), ear, 0.0));
        self.write(&picture);
        self.numbers.extend(heard.iter().flat_map(|at| [at.x, at.y]));
        self.numbers.len()
    }

    /// Draws the floor of a stage of this size, of which the middle reaches from one of its sides to another, for the level that sounds, a
    /// share of the 60 dB below full scale. The numbers are: the space; how strongly its waves glow, and how much of that is by the level;
    /// the height of its far edge, and its ends; and how many lines, and for each how many points, and these. Where there is no space, the
    /// line goes round a shadow. Returns how many numbers they are.
    pub(crate) fn floor(&mut self, values: &Values, size: [f32; 2], middle: [f32; 2], level: f32) -> usize {
        let (stage, [left, right]) = (rect(size), middle);
        let space = values.get(Param::Space) as usize;
        let size = (space > 0).then(|| Param::SpaceSize.info().normalise(values.get(Param::SpaceSize)) as f32);
        let floor = Floor::of(stage, stage.with_min_x(left).with_max_x(right), size);
        let lines = if space > 0 { floor.lines(space) } else { vec![floor.shadow()] };
        let [strength, glow] = Floor::glow(values.get(Param::SpaceMix) / 100.0, level);
        let [from, to] = floor.ends;
        self.numbers.clear();
        self.numbers.extend([space as f32, strength, glow, floor.far, from, to, lines.len() as f32]);
        for line in lines {
            self.numbers.push(line.len() as f32);
            self.numbers.extend(line.iter().flat_map(|at| [at.x, at.y]));
        }
        self.numbers.len()
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

    /// Writes the coordinates of the point of the body that is nearest to a place in the picture, and to which its ear can be moved, or
    /// where it can be struck. Returns 0 beside the body, 1 on it, and 2 where it can be struck or heard elsewhere; an ear is never beside it.
    pub(crate) fn touch(&mut self, is_ear: bool, size: [f32; 2], at: [f32; 2]) -> u32 {
        let (point, distance) = self.shape.nearest(rect(size), pos2(at[0], at[1]));
        let Point { x, y } = self.shape.confined(point, |body| if is_ear { body.pickup } else { body.strike });
        self.numbers.clear();
        self.numbers.extend([x as f32, y as f32]);
        let is_on = is_ear || distance <= REACH;
        if is_on { 1 + u32::from(self.places().is_some()) } else { 0 }
    }

    /// Writes where the body is struck, or heard. Returns whether that can be moved.
    pub(crate) fn place(&mut self, is_ear: bool) -> bool {
        let place = self.places().map(|places| places[usize::from(is_ear)]);
        self.numbers.clear();
        self.numbers.extend(place.iter().flat_map(|place| [place.x as f32, place.y as f32]));
        place.is_some()
    }

    /// Where strike and ear are, if they can be moved.
    fn places(&self) -> Option<[Point; 2]> {
        let Origin::FromBody(body) = &self.shape.origin else { return None };
        Some([body.strike, body.pickup])
    }
}

fn colour(rgb: u32) -> Color32 {
    let [_, red, green, blue] = rgb.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

fn rect([width, height]: [f32; 2]) -> Rect {
    Rect::from_min_size(Pos2::ZERO, vec2(width, height))
}
