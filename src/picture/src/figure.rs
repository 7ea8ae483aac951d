//! How a body looks at rest: its form, its thickness and the colour of its material.

use crate::form::Form;
use ecolor::Color32;
use sprung::preset::Family;
use sprung::sound::bodies::{Body, Model, Point};

/// What is painted of a body.
pub struct Figure {
    /// Its form.
    pub form: Form,
    /// How many points there are along `x` and along `y`.
    pub grid: [usize; 2],
    /// The points, those along `x` one after the other.
    pub points: Vec<Point>,
    /// The colour of its material in white light.
    pub tint: Color32,
    /// Thickness of a line as a share of the picture's shorter side; 0 for a string.
    pub thickness: f32,
    /// Whether a line is a tube, and not a bar.
    pub is_round: bool,
    /// What is below a head in a small picture.
    pub drum: Option<Drum>,
}

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

impl Figure {
    /// The figure of a body in a large picture.
    pub fn of(body: &Body) -> Self {
        let form = Form::of(&body.model);
        Self::with_grid(body, form, form.grid())
    }

    /// The figure of a body in a picture of the size of a letter or two.
    pub fn small(body: &Body) -> Self {
        let form = Form::of(&body.model);
        let grid = match form {
            Form::Line => [33, 1],
            Form::Plate { .. } => [3, 3],
            Form::Round => [3, 25],
            Form::Bell | Form::Bowl => [9, 25],
        };
        let figure = Self::with_grid(body, form, grid);
        // At this size a bar would look like a line.
        Self { thickness: 2.0 * figure.thickness, ..figure }
    }

    /// The figure of a drum of this family, if it is one; another stays as it is.
    pub(crate) fn drummed(self, family: Option<Family>) -> Self {
        Self { drum: Drum::of(family).filter(|_| self.form == Form::Round), ..self }
    }

    fn with_grid(body: &Body, form: Form, grid: [usize; 2]) -> Self {
        let (thickness, is_round) = match body.model {
            Model::String => (0.0, true),
            Model::OpenTube | Model::StoppedTube | Model::Cone { .. } | Model::TubularBell => (0.11, true),
            _ => (0.07, false),
        };
        Self { form, grid, points: Form::points(grid), tint: tint(body.material.id), thickness, is_round, drum: None }
    }
}

/// The colour of a material in white light.
pub fn tint(material: &str) -> Color32 {
    let [red, green, blue] = match material {
        "steel" | "wire" | "snare_wire" => [168, 174, 184],
        "aluminium" => [196, 199, 205],
        "brass" => [206, 168, 84],
        "bronze" => [176, 122, 62],
        "glass" => [168, 206, 214],
        "porcelain" => [226, 222, 212],
        "rosewood" => [134, 70, 46],
        "maple" => [206, 164, 112],
        "spruce" => [222, 190, 142],
        "rubber" => [74, 72, 78],
        "skin" => [222, 204, 172],
        "mylar" => [212, 216, 220],
        "nylon" => [224, 220, 204],
        "plastic" => [188, 176, 196],
        _ => [190, 186, 180],
    };
    Color32::from_rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::sound::bodies::MATERIALS;

    #[test]
    fn every_material_but_air_has_a_colour_of_its_own() {
        let other = tint("");
        for material in MATERIALS.iter().filter(|material| material.id != "air") {
            assert_ne!(tint(material.id), other, "{}", material.id);
        }
    }
}
