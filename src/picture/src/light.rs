//! How materials look in a light from the left above.

use crate::view::VIEW;
use ecolor::{Color32, Rgba};

/// Where the light comes from: left, in front, above; a unit vector.
const LIGHT: [f32; 3] = [-0.5, 0.45, 0.74];
/// How far away the eye is: near enough that a flat face does not shine all over at once.
const EYE: f32 = 2.6;

/// What a surface is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Gloss {
    /// It mirrors its surroundings in its own colour.
    Metal,
    /// It mirrors them at a slant, and is dark otherwise.
    Glass,
    /// It has a dull highlight, and grain along it.
    Wood,
    /// It has a dull highlight.
    Matt,
}

/// The colour and the gloss of a material.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    /// The colour in white light.
    pub tint: Color32,
    pub gloss: Gloss,
}

/// A piece of surface: where it is, which way it faces, and the direction of the grooves of a lathe if it has some.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    pub at: [f32; 3],
    pub normal: [f32; 3],
    pub groove: Option<[f32; 3]>,
}

impl Finish {
    /// That of a material.
    pub(crate) fn of(material: &str) -> Self {
        let gloss = match material {
            "steel" | "wire" | "snare_wire" | "aluminium" | "brass" | "bronze" => Gloss::Metal,
            "glass" => Gloss::Glass,
            "rosewood" | "maple" | "spruce" => Gloss::Wood,
            _ => Gloss::Matt,
        };
        Self { tint: tint(material), gloss }
    }

    /// The colour of a facet that glows by a share, 0 for one that does not move.
    pub(crate) fn seen(&self, facet: &Facet, (glow, share): (Color32, f32)) -> Color32 {
        let Facet { at, normal, groove } = *facet;
        let eye = unit([VIEW[0] * EYE - at[0], VIEW[1] * EYE - at[1], VIEW[2] * EYE - at[2]]);
        let facing = dot(normal, eye);
        let mirrored: [f32; 3] = std::array::from_fn(|axis| 2.0 * facing * normal[axis] - eye[axis]);
        let lit = dot(normal, LIGHT).max(0.0);
        let sky = 0.5 + 0.5 * normal[2];
        let glance = dot(mirrored, LIGHT).max(0.0);
        let half = unit(std::array::from_fn(|axis| LIGHT[axis] + eye[axis]));
        // The grooves of a lathe spread a highlight across them.
        let streak = groove.map_or(0.0, |groove| {
            let slant = dot(groove, half);
            squared(1.0 - slant * slant, 4) * lit
        });
        let slant = (1.0 - facing.abs()).clamp(0.0, 1.0);
        let (light, white) = match self.gloss {
            Gloss::Metal => {
                let above = smooth((mirrored[2] + 0.15) / 1.0);
                let window = (mirrored[0] + 0.55 * mirrored[2] - 0.1) / 0.2;
                let window = squared(1.0 - 0.25 * window * window, 2);
                let light = 0.08 + 0.07 * sky + 0.46 * lit + 0.31 * above + 0.1 * window + 0.42 * squared(glance, 2);
                (light + 0.5 * streak - 0.1 * slant, 0.4 * squared(glance, 5) + 0.08 * streak * streak)
            }
            Gloss::Glass => {
                (0.1 + 0.14 * lit + 0.75 * slant * slant, 0.75 * squared(glance, 5) + 0.1 * slant * slant * slant)
            }
            Gloss::Wood => (0.1 + 0.14 * sky + 0.72 * lit, 0.08 * squared(glance, 3)),
            Gloss::Matt => (0.12 + 0.18 * sky + 0.72 * lit, 0.06 * squared(glance, 3)),
        };
        let colour = Rgba::from(self.tint.lerp_to_gamma(glow, share));
        // A metal's highlights are of its colour.
        let own = if self.gloss == Gloss::Metal { 0.45 } else { 0.0 };
        let white = Rgba::from(Color32::WHITE.lerp_to_gamma(self.tint, own)) * white.max(0.0);
        let seen = colour * light.max(0.75 * share) + white;
        Color32::from(Rgba::from_rgb(seen.r().clamp(0.0, 1.0), seen.g().clamp(0.0, 1.0), seen.b().clamp(0.0, 1.0)))
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

/// A positive number squared so often.
fn squared(number: f32, times: usize) -> f32 {
    (0..times).fold(number.max(0.0), |power, _| power * power)
}

fn smooth(share: f32) -> f32 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

pub(crate) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector at right angles to both.
pub(crate) fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|n| {
        let (u, v) = ((n + 1) % 3, (n + 2) % 3);
        a[u] * b[v] - a[v] * b[u]
    })
}

/// The same direction, with length 1.
pub(crate) fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length = dot(vector, vector).sqrt().max(1e-9);
    vector.map(|axis| axis / length)
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
