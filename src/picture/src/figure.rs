//! How a body looks at rest: its form, how it is built, and what it is of.

use crate::form::Form;
use crate::light::{Finish, Gloss, tint};
use crate::view::lying;
use emath::Rect;
use sprung::preset::Family;
use sprung::sound::bodies::{BedKind, Body, Model, Point};
use sprung::sound::pairs::{Link, Pair};
use std::hash::{Hash, Hasher};

/// What is painted of a body.
pub struct Figure {
    /// Its form.
    pub form: Form,
    /// How many points there are along `x` and along `y`.
    pub grid: [usize; 2],
    /// The points, those along `x` one after the other.
    pub points: Vec<Point>,
    /// What its surface is of.
    pub(crate) finish: Finish,
    pub(crate) build: Build,
    /// What is below a head in a small picture.
    pub drum: Option<Drum>,
    /// The body that is joined to it.
    pub(crate) second: Option<Box<Second>>,
}

/// A joined body.
pub(crate) struct Second {
    pub figure: Figure,
    /// Whether the two move together where they are joined.
    pub is_rigid: bool,
}

/// By what it looks like: figures with one hash are painted alike. Points follow from form and grid.
impl Hash for Figure {
    fn hash<H: Hasher>(&self, state: &mut H) {
        format!("{:?}", (self.form, self.grid, self.finish, self.build, self.drum)).hash(state);
        self.second.as_ref().map(|second| (&second.figure, second.is_rigid)).hash(state);
    }
}

/// How a body is built around its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Build {
    /// Without thickness.
    Thin,
    /// A bar.
    Bar(Bar),
    /// A tube.
    Tube(Tube),
    /// A plate or a box of this thickness.
    Slab(f32),
    /// A cymbal over another one, on a rod.
    Hat,
}

/// A bar; its lengths are in halves of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bar {
    /// Half its width.
    pub width: f32,
    /// Its thickness at the ends, and in the middle.
    pub thickness: [f32; 2],
    /// Whether it has holes for a cord.
    pub has_holes: bool,
    /// Whether a block holds its left end.
    pub is_clamped: bool,
}

/// A tube; its lengths are in halves of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tube {
    /// Its radius at the left end, and at the right end.
    pub radius: [f32; 2],
    /// Whether its left end is closed by a cap.
    pub has_cap: bool,
}

impl Tube {
    /// The radius of its open end: that of a cone ends in a bell.
    pub(crate) fn mouth(&self) -> f32 {
        let [left, right] = self.radius;
        if left < right { 1.5 * right } else { right }
    }
}

/// How much wider than a tube its cap is.
pub(crate) const CAP: f32 = 1.22;
/// Half the width of the block that holds a tine, how deep it is, and how high.
pub(crate) const BLOCK: (f32, f32, f32) = (0.2, 0.16, 0.05);

/// What is below the head of a drum. It only tells drums apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drum {
    /// Height of the shell, in radii of the head.
    pub depth: f32,
    /// How much of the picture the drum takes.
    pub size: f32,
    /// The material of the shell.
    pub shell: &'static str,
    /// Whether snare wires are drawn.
    pub has_wires: bool,
}

impl Drum {
    /// The drum of a family, if it is one that has a shell of its own.
    fn of(family: Option<Family>) -> Option<Self> {
        match family? {
            Family::Kick => Some(Self { depth: 1.3, size: 1.0, shell: "rosewood", has_wires: false }),
            Family::Snare => Some(Self { depth: 0.3, size: 1.0, shell: "steel", has_wires: true }),
            Family::Tom => Some(Self { depth: 0.7, size: 0.86, shell: "maple", has_wires: false }),
            _ => None,
        }
    }
}

impl Build {
    fn of(model: &Model) -> Self {
        let bar = |width, thickness| Bar { width, thickness, has_holes: true, is_clamped: false };
        match model {
            Model::FreeBar => Self::Bar(bar(0.16, [0.1, 0.1])),
            Model::Marimba => Self::Bar(bar(0.22, [0.17, 0.07])),
            Model::Xylophone => Self::Bar(bar(0.19, [0.19, 0.11])),
            Model::Vibraphone => Self::Bar(bar(0.2, [0.12, 0.06])),
            Model::Tine => Self::Bar(Bar { has_holes: false, is_clamped: true, ..bar(0.07, [0.035, 0.035]) }),
            Model::TubularBell => Self::Tube(Tube { radius: [0.065, 0.065], has_cap: true }),
            Model::OpenTube => Self::Tube(Tube { radius: [0.12, 0.12], has_cap: false }),
            Model::StoppedTube => Self::Tube(Tube { radius: [0.12, 0.12], has_cap: true }),
            Model::Cone { truncation } => {
                let narrow = (*truncation / (1.0 + truncation)) as f32;
                Self::Tube(Tube { radius: [0.15 * narrow.max(0.12), 0.15], has_cap: false })
            }
            Model::Bed(bed) if matches!(bed.kind, BedKind::Box | BedKind::Shell) => Self::Slab(0.42),
            Model::Plate { .. } | Model::Bed(_) => Self::Slab(0.045),
            Model::Disc { .. } => Self::Slab(0.035),
            _ => Self::Thin,
        }
    }
}

impl Figure {
    /// The figure of a body in a large picture.
    pub fn of(body: &Body) -> Self {
        let form = Form::of(&body.model);
        Self::with_grid(body, form, form.grid())
    }

    /// The figure of a body in a picture of the size of a letter or two.
    pub fn small(body: &Body) -> Self {
        let form = Form::of(&body.model);
        let figure = Self::with_grid(body, form, form.small_grid());
        // At this size a bar would look like a line.
        let build = match figure.build {
            Build::Bar(bar) => {
                Build::Bar(Bar { width: 1.25 * bar.width, thickness: bar.thickness.map(|end| 1.3 * end), ..bar })
            }
            Build::Tube(tube) => Build::Tube(Tube { radius: tube.radius.map(|end| 1.35 * end), ..tube }),
            other => other,
        };
        Self { build, ..figure }
    }

    /// The figure of a model's tile, by its name. That of a round plate is a gong.
    pub fn tile(model: &str) -> Self {
        let body = Body::new(Model::find(model).cloned().unwrap_or(Model::String));
        Self::small(&body).told_apart(Some(Family::Cymbal), &["gong".to_owned()])
    }

    /// The figure of the first of two joined bodies in a large picture.
    pub(crate) fn joined(self, pair: &Pair) -> Self {
        let second = Second { figure: Self::small(&pair.second), is_rigid: pair.link == Link::Rigid };
        Self { second: Some(Box::new(second)), ..self }
    }

    /// The figure of a body in a sound of this family: a drum has its shell, a gong its boss, a cymbal its small bell, and a wind instrument
    /// is of what its kind is made of.
    pub(crate) fn told_apart(self, family: Option<Family>, tags: &[String]) -> Self {
        let has = |tag: &str| tags.iter().any(|other| other == tag);
        let is_plate = self.form == Form::Round && self.build != Build::Thin;
        match family {
            Some(Family::Cymbal) if is_plate && has("gong") => self.domed(Form::Gong),
            Some(Family::Hat) if is_plate => Self { build: Build::Hat, ..self.domed(Form::Cymbal) },
            Some(Family::Cymbal | Family::Bell) if is_plate => self.domed(Form::Cymbal),
            Some(Family::Wind) if has("flute") => Self { finish: Finish::of("steel"), ..self },
            Some(Family::Wind) if has("reed") && !has("sax") => Self { finish: Finish::of("rosewood"), ..self },
            _ if self.form == Form::Round && !is_plate => Self { drum: Drum::of(family), ..self },
            _ => self,
        }
    }

    /// A round plate with another form.
    fn domed(self, form: Form) -> Self {
        let is_small = self.grid == self.form.small_grid();
        let grid = if is_small { form.small_grid() } else { form.grid() };
        Self { form, grid, points: Form::points(grid), ..self }
    }

    /// What it covers in a picture at rest, without a body that is joined to it.
    pub fn frame(&self, rect: Rect) -> Rect {
        let view = self.form.view(rect);
        let points = self.points.iter().map(|point| self.form.in_space(*point, 0.0));
        Rect::from_points(&points.chain(self.beyond()).map(|at| view.at(at)).collect::<Vec<_>>())
    }

    /// The farthest places of what belongs to it beyond its points.
    fn beyond(&self) -> Vec<[f32; 3]> {
        let ends = [-1.0, 1.0];
        let below = |down: f32| self.points.iter().map(move |point| self.form.in_space(*point, -down));
        match (self.form, self.build) {
            (_, Build::Bar(bar)) => {
                let (width, depth, up) = if bar.is_clamped { BLOCK } else { (bar.width, bar.thickness[0], 0.0) };
                let corners = ends.map(|side| [lying([-1.0, side * width], up), lying([-1.0, side * width], -depth)]);
                let right = ends.map(|side| lying([1.0, side * bar.width], -bar.thickness[0]));
                corners.into_iter().flatten().chain(right).collect()
            }
            (_, Build::Tube(tube)) => {
                let radii = [tube.radius[0] * if tube.has_cap { CAP } else { 1.0 }, tube.mouth()];
                let end = |(along, radius): (f32, f32)| {
                    [
                        lying([along, radius], 0.0),
                        lying([along, -radius], 0.0),
                        // Highest and lowest as it is seen.
                        lying([along, -0.48 * radius], 0.88 * radius),
                        lying([along, 0.48 * radius], -0.88 * radius),
                    ]
                };
                ends.into_iter().zip(radii).flat_map(end).collect()
            }
            (Form::Gong, _) => below(0.17).collect(),
            (_, Build::Slab(thickness)) => below(thickness).collect(),
            (Form::Round, _) => below(0.26).collect(),
            (Form::Cymbal, _) => below(0.11).chain([[0.0, 0.0, 0.6]]).collect(),
            (Form::HandBell, _) => vec![[0.0, 0.0, 1.62]],
            (Form::Bell, _) => vec![[0.0, 0.0, 1.1]],
            (Form::Glass, _) => vec![[0.0, 0.42, 0.0]],
            _ => Vec::new(),
        }
    }

    /// Whether it is for a large picture.
    pub(crate) fn is_large(&self) -> bool {
        self.grid != self.form.small_grid()
    }

    fn with_grid(body: &Body, form: Form, grid: [usize; 2]) -> Self {
        // The walls around the air of a tube are not known.
        let finish = match body.material.id {
            "air" => Finish { tint: tint("brass"), gloss: Gloss::Metal },
            other => Finish::of(other),
        };
        let build = Build::of(&body.model);
        Self { form, grid, points: Form::points(grid), finish, build, drum: None, second: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Picture, Pose};
    use ecolor::Color32;
    use emath::{Pos2, vec2};
    use sprung::sound::bodies::MATERIALS;
    use std::collections::HashMap;
    use std::hash::{BuildHasher, BuildHasherDefault, DefaultHasher};

    #[test]
    fn figures_with_one_hash_are_painted_alike() {
        let hash = |figure: &Figure| BuildHasherDefault::<DefaultHasher>::default().hash_one(figure);
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(60.0, 40.0));
        let mut pictures = HashMap::new();
        let families = [None, Some(Family::Kick), Some(Family::Snare), Some(Family::Hat), Some(Family::Bell)];
        for (_, model) in Model::ALL {
            for (material, family) in MATERIALS.iter().flat_map(|material| families.map(|family| (*material, family))) {
                let figure = Figure::small(&Body { material, ..Body::new(model.clone()) }).told_apart(family, &[]);
                let picture = format!("{:?}", Picture::of(rect, &figure, &Pose::default(), Color32::WHITE));
                assert_eq!(pictures.entry(hash(&figure)).or_insert_with(|| picture.clone()), &picture, "{model:?}");
            }
        }
        assert!(pictures.len() > 100);
    }
}
