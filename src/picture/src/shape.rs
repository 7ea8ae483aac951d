//! The body that is drawn for a sound: its form, and each mode's shape on it.

use crate::figure::Figure;
use crate::nodal;
use crate::origin::{Origin, model_name, with_article};
use crate::second::first_place;
use emath::{Pos2, Rect};
use sprung::internals::library::tagged_material;
use sprung::patch::ModeTable;
use sprung::preset::Family;
use sprung::sound::bodies::{Body, MATERIALS, Model, Point};
use sprung::units::semitones_from_ratio;

/// The most modes that are drawn on a line, and on a surface: the grid of points is too coarse for finer shapes.
const DRAWN: [usize; 2] = [64, 32];
/// The largest distance, in semitones, between a mode of the sound and the mode of the body whose shape it is drawn
/// with: for a table made from the body, and for one that was not made from a body.
const NEAR: [f64; 2] = [0.6, 5.0];

/// A body to draw.
pub struct BodyShape {
    /// Where the modes come from.
    pub origin: Origin,
    /// How it looks at rest.
    pub figure: Figure,
    /// For each mode of the sound, its shape at the points; none if the mode belongs to a body that is not drawn.
    shapes: Vec<Option<Vec<f32>>>,
    /// Rotation speed of each mode in slow motion, as a multiple of the lowest mode's.
    pub speeds: Vec<f32>,
    /// Description of the drawn body.
    pub caption: String,
}

/// The body that a table of modes is drawn as: of a model that suits its family, and of the material that its tags name.
pub fn suggested_body(family: Option<Family>, tags: &[String]) -> Body {
    let has = |tag: &str| tags.iter().any(|other| other == tag);
    let id = match family {
        Some(Family::Kick | Family::Snare | Family::Tom | Family::HandDrum) => "membrane",
        Some(Family::Hat | Family::Cymbal) => "free_disc",
        Some(Family::Percussion) if has("clap") => "free_plate",
        Some(Family::Percussion) if has("whistle") => "open_tube",
        Some(Family::Percussion) if has("bell") => "hand_bell",
        Some(Family::Percussion) => "free_bar",
        Some(Family::Mallet) if has("pluck") => "tine",
        Some(Family::Mallet) if has("keys") || has("bell") || has("glass") => "free_bar",
        Some(Family::Mallet) if has("metal") => "vibraphone",
        Some(Family::Mallet) => "marimba",
        Some(Family::Bell) if has("metal") => "hand_bell",
        Some(Family::Bell) => "church_bell",
        Some(Family::Wind) if has("brass") || has("sax") => "cone",
        Some(Family::Wind) => "open_tube",
        Some(Family::Pad | Family::Effect) if has("glass") => "glass",
        Some(Family::Keys) if has("metal") || has("electric") => "tine",
        Some(Family::Effect) => "free_plate",
        _ => "string",
    };
    let mut body = Body::new(Model::find(id).cloned().unwrap_or(Model::String));
    let named = tagged_material(tags);
    // Skins and strings are of their own, whatever holds them.
    if let Some(material) = named.and_then(|id| MATERIALS.iter().find(|material| material.id == id))
        && !["membrane", "string"].contains(&id)
    {
        body.material = *material;
    }
    body
}

/// What a body is and is made of.
fn named(body: &Body) -> String {
    format!("{} of {}", model_name(body.model.id()), body.material.id.replace('_', " "))
}

/// The same origin; for a table of modes, the body that it is drawn as.
pub fn or_suggested(origin: &Origin, family: Option<Family>, tags: &[String]) -> Origin {
    match origin {
        Origin::Table => Origin::FromBody(Box::new(suggested_body(family, tags))),
        other => other.clone(),
    }
}

/// The figure of a sound's body in a picture of the size of a letter or two: of its model's, or of one that suits its family. Allocates.
pub fn small_figure(modes: &ModeTable, family: Option<Family>, tags: &[String]) -> Figure {
    match Origin::of(modes).with_places().body() {
        Some(body) => Figure::small(body),
        None => Figure::small(&suggested_body(family, tags)),
    }
    .told_apart(family, tags)
}

impl BodyShape {
    /// The body of a sound of this family. This is slow and allocates: it computes the shapes of all modes.
    pub fn of(modes: &ModeTable, family: Option<Family>, tags: &[String]) -> Self {
        let origin = Origin::of(modes);
        let is_mass = origin.body().is_some_and(|body| body.model == Model::Mass);
        let origin = origin.with_places();
        let (body, near, caption) = match &origin {
            Origin::FromBody(body) => ((**body).clone(), NEAR[0], named(body)),
            Origin::FromPair(pair) => {
                let caption = format!("{}, joined to a second body", named(&pair.first));
                (pair.first.clone(), NEAR[0], caption)
            }
            Origin::Table => {
                let body = suggested_body(family, tags);
                let what = if is_mass { "a mass" } else { "its modes, without a body" };
                let caption = format!("{what}, drawn as {}", with_article(&model_name(body.model.id())));
                (body, NEAR[1], caption)
            }
        };
        let figure = Figure { drum: None, ..Figure::of(&body).told_apart(family, tags) };
        let figure = match origin.pair() {
            Some(pair) => figure.joined(pair),
            None => figure,
        };
        let form = figure.form;
        let most = DRAWN[usize::from(!form.is_line())];
        // A bed's modes depend on how many there are.
        let count = if matches!(body.model, Model::Bed(_)) { body.modes } else { body.modes.min(DRAWN[0]) };
        let points = &figure.points;
        let found = Body { modes: count, ..body }.modes_at(points);
        let found: Vec<(f64, Vec<f32>)> = found
            .into_iter()
            .take(most)
            .map(|(mode, shape)| {
                let seen = points.iter().zip(shape).map(|(point, value)| value as f32 * form.weight(*point));
                (semitones_from_ratio(mode.ratio), seen.collect())
            })
            .collect();
        let shape = |(place, ratio): (usize, f32)| {
            let pitch = semitones_from_ratio(f64::from(ratio));
            let far = |place: &usize| (found[*place].0 - pitch).abs();
            let best = (0..found.len()).min_by(|a, b| far(a).total_cmp(&far(b))).filter(|best| far(best) <= near);
            // In a table with other ratios than the model's, the first mode gets the shape of the model's first mode,
            // and so on.
            let by_order = (origin == Origin::Table).then_some(place % found.len().max(1));
            best.or(by_order).and_then(|best| found.get(best)).map(|(_, shape)| shape.clone())
        };
        let modes = &modes.as_slice()[..modes.as_slice().len().min(DRAWN[0])];
        let lowest = modes.iter().map(|mode| mode.ratio).fold(f32::INFINITY, f32::min);
        // High modes at their true speed would be a blur.
        let speeds = modes.iter().map(|mode| (mode.ratio / lowest).sqrt().min(6.0)).collect();
        let shapes = modes.iter().map(|mode| mode.ratio).enumerate().map(shape).collect();
        Self { origin, figure, shapes, speeds, caption }
    }

    /// The place nearest to a point to which one of the body's places can be moved: `place` is where that is now.
    pub fn confined(&self, point: Point, place: impl Fn(&Body) -> Point) -> Point {
        let rounded = |share: f64| (share * 1000.0).round() / 1000.0;
        let point = Point { x: rounded(point.x), y: rounded(point.y) };
        match (self.origin.body(), self.figure.form) {
            // On a string, the place is counted from the nearer end.
            (None, _) => Point { x: point.x.min(1.0 - point.x).clamp(0.01, 0.5), y: 0.0 },
            (Some(body), form) if form.is_line() => Point { y: place(body).y, ..point },
            (Some(body), form) if form.is_bell() => Point { x: place(body).x, ..point },
            (Some(_), _) => point,
        }
    }

    /// Where the body that is struck is drawn in a picture: beside the one that is joined to it.
    pub fn place(&self, rect: Rect) -> Rect {
        first_place(rect, &self.figure)
    }

    /// The point of the body at rest that is nearest to a place in the picture, and how far away it is in pixels.
    pub fn nearest(&self, rect: Rect, place: Pos2) -> (Point, f32) {
        self.figure.form.nearest(self.place(rect), place)
    }

    /// The shape of the loudest of the modes; at rest, of the lowest one that has lines where it does not move. None if it has none.
    pub fn lines_of(&self, energies: &[f32]) -> Option<&[f32]> {
        let mut shapes = self.shapes.iter().zip(energies.iter().copied().chain(std::iter::repeat(0.0)));
        let loudest = shapes.clone().max_by(|(_, a), (_, b)| a.total_cmp(b)).filter(|(_, energy)| *energy > 0.0);
        match loudest {
            Some((shape, _)) => shape.as_deref().filter(|shape| nodal::has_any(shape)),
            None => shapes.find_map(|(shape, _)| shape.as_deref().filter(|shape| nodal::has_any(shape))),
        }
    }

    /// The displacement of each point, for the amplitudes of the modes.
    pub(crate) fn displacements(&self, amplitudes: &[f32]) -> Vec<f32> {
        let mut sum = vec![0.0; self.figure.points.len()];
        for (shape, amplitude) in self.shapes.iter().zip(amplitudes) {
            if let Some(shape) = shape.as_ref().filter(|_| *amplitude != 0.0) {
                sum.iter_mut().zip(shape).for_each(|(sum, value)| *sum += amplitude * value);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form::Form;
    use sprung::internals::editor::modes_of_body;
    use sprung::preset::Preset;

    #[test]
    fn a_string_moves_as_its_modes_do_and_its_ends_stay() {
        let body = Body::new(Model::String);
        let shape = BodyShape::of(&modes_of_body(&body), None, &[]);
        let count = shape.figure.points.len();
        for mode in 0..6 {
            let amplitudes: Vec<f32> = (0..6).map(|other| if other == mode { 1.0 } else { 0.0 }).collect();
            let moved = shape.displacements(&amplitudes);
            assert!(moved[0].abs() < 1e-6 && moved[count - 1].abs() < 1e-5, "{mode}: the ends stay");
            let nodes = moved.windows(2).filter(|pair| pair[0] * pair[1] < -1e-9).count();
            let exact = moved[1..count - 1].iter().filter(|value| value.abs() < 1e-5).count();
            assert_eq!(nodes + exact, mode, "mode {} has that many nodes", mode + 1);
        }
    }

    #[test]
    fn drums_are_told_apart_by_their_shells() {
        let drum = |name: &str| {
            let preset = Preset::find(name).unwrap();
            small_figure(&preset.patch.modes, preset.guide.family, &preset.tags).drum
        };
        let [kick, snare, tom] = ["Kick", "Snare", "Low Tom"].map(|name| drum(name).unwrap());
        assert!(kick.depth > tom.depth && tom.depth > snare.depth && snare.has_wires && kick.size > tom.size);
        assert_eq!((drum("Ride"), drum("Conga")), (None, None));
    }

    #[test]
    fn what_is_only_guessed_is_of_the_material_that_its_tags_name() {
        let material = |family, tags: &[&str]| {
            let tags: Vec<String> = tags.iter().map(|tag| (*tag).to_owned()).collect();
            suggested_body(Some(family), &tags).material.id
        };
        assert_eq!(material(Family::Mallet, &["mallet"]), "rosewood");
        assert_eq!(material(Family::Mallet, &["mallet", "metal"]), "steel");
        assert_eq!(material(Family::Mallet, &["glass"]), "glass");
        assert_eq!(material(Family::Snare, &["metal"]), suggested_body(Some(Family::Snare), &[]).material.id);
    }

    #[test]
    fn every_factory_sound_has_a_body_that_moves() {
        for preset in Preset::factory() {
            let shape = BodyShape::of(&preset.patch.modes, preset.guide.family, &preset.tags);
            let loudest =
                preset.patch.modes.as_slice().iter().take(64).map(|mode| mode.level.abs()).collect::<Vec<_>>();
            let moved = shape.displacements(&loudest);
            assert!(moved.iter().all(|value| value.is_finite()), "{}", preset.name);
            assert!(moved.iter().any(|value| value.abs() > 1e-4), "{}: {}", preset.name, shape.caption);
        }
        let bell = Preset::find("Church Bell").unwrap();
        let shape = BodyShape::of(&bell.patch.modes, None, &[]);
        assert_eq!(
            (shape.figure.form, shape.caption.as_str()),
            (Form::Bell, "church bell of bronze, joined to a second body")
        );
    }
}
