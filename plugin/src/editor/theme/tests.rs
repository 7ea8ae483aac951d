//! Whether colours can be read, seen and told apart.

use super::*;

const fn rgb(red: u8, green: u8, blue: u8) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// All combinations of text colour and ground in use.
fn pairs(palette: &Palette) -> Vec<(Color32, Color32)> {
    let grounds = [palette.ground, palette.panel, palette.raised];
    let texts = [palette.text, palette.muted, palette.accent_text];
    let mut pairs: Vec<_> = texts.iter().flat_map(|text| grounds.map(|ground| (*text, ground))).collect();
    pairs.extend([
        (palette.on_accent, palette.accent),
        (palette.warning, palette.ground),
        (palette.key_text, palette.white_key),
        (palette.modulation, palette.panel),
    ]);
    pairs
}

/// The light of a channel of sRGB, 0–1.
fn linear(channel: u8) -> f64 {
    let share = f64::from(channel) / 255.0;
    if share <= 0.040_45 { share / 12.92 } else { power((share + 0.055) / 1.055, 2.4) }
}

/// Relative luminance (WCAG 2.2).
fn luminance(colour: Color32) -> f64 {
    0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
}

#[allow(clippy::disallowed_methods, reason = "a measurement")]
fn power(base: f64, exponent: f64) -> f64 {
    base.powf(exponent)
}

fn contrast(text: Color32, ground: Color32) -> f64 {
    let (one, other) = (luminance(text), luminance(ground));
    (one.max(other) + 0.05) / (one.min(other) + 0.05)
}

/// WCAG 2.2 requires 4.5 for text at level AA, and 7 at level AAA, which is checked for the high-contrast theme.
#[test]
fn every_text_can_be_read_on_its_ground() {
    assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
    for theme in Theme::ALL {
        let least = if theme == Theme::HighContrast { 7.0 } else { 4.5 };
        for (text, ground) in pairs(theme.palette()) {
            let found = contrast(text, ground);
            assert!(found >= least, "{}: {text:?} on {ground:?} has {found:.2}", theme.name());
        }
    }
}

/// WCAG 2.2 requires 3 for graphical parts that are needed to use the window.
#[test]
fn every_mark_can_be_seen_on_its_ground() {
    for theme in Theme::ALL {
        let Palette { panel, accent, modulation, level, ground, .. } = theme.palette();
        for (mark, ground) in [(accent, panel), (modulation, panel), (level, ground)] {
            let found = contrast(*mark, *ground);
            assert!(found >= 3.0, "{}: {mark:?} on {ground:?} has {found:.2}", theme.name());
        }
    }
}

/// Less than of a mark, since nothing is there.
#[test]
fn what_is_empty_can_be_seen() {
    for theme in Theme::ALL {
        let found = contrast(theme.palette().empty_edge(), theme.palette().ground);
        assert!((1.8..4.5).contains(&found), "{}: {found:.2}", theme.name());
    }
}

/// Colours in linear light as somebody without one kind of cones sees them: without those for red and for green (Viénot, Brettel
/// and Mollon 1999).
const WITHOUT: [[[f64; 3]; 3]; 2] = [
    [[0.112_38, 0.887_62, 0.0], [0.112_38, 0.887_62, 0.0], [0.004_01, -0.004_01, 1.0]],
    [[0.292_75, 0.707_25, 0.0], [0.292_75, 0.707_25, 0.0], [-0.022_34, 0.022_34, 1.0]],
];

/// Distance of two colours in CIELAB, as somebody sees them whose eyes turn linear light by a matrix.
fn distance(colours: [Color32; 2], eyes: &[[f64; 3]; 3]) -> f64 {
    let row = |row: &[f64; 3], of: [f64; 3]| row.iter().zip(of).map(|(weight, part)| weight * part).sum::<f64>();
    let lab = |colour: Color32| {
        let light = [colour.r(), colour.g(), colour.b()].map(linear);
        let seen = eyes.map(|weights| row(&weights, light).clamp(0.0, 1.0));
        // sRGB's primaries and white.
        let xyz = [
            row(&[0.4124, 0.3576, 0.1805], seen) / 0.9505,
            row(&[0.2126, 0.7152, 0.0722], seen),
            row(&[0.0193, 0.1192, 0.9505], seen) / 1.089,
        ];
        let [x, y, z] =
            xyz.map(|part| if part > 0.008_856 { power(part, 1.0 / 3.0) } else { 7.787 * part + 16.0 / 116.0 });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    };
    let [one, other] = colours.map(lab);
    one.into_iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// What is set and what modulation adds lie on each other on knobs. 25 is about ten times the least difference that is seen (2.3;
/// Mahy, Van Eycken and Oosterlinck 1994).
#[test]
fn colours_that_mean_something_differ_for_colour_blind_eyes() {
    for theme in Theme::ALL {
        let Palette { accent, modulation, .. } = theme.palette();
        for eyes in &WITHOUT {
            let found = distance([*accent, *modulation], eyes);
            assert!(found > 25.0, "{}: {found:.1}", theme.name());
            assert!(
                distance([rgb(200, 60, 0), rgb(90, 120, 0)], eyes) < 25.0,
                "this red and green, chosen for it, do not"
            );
        }
    }
}
