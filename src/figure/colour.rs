//! Colours that readers with any colour vision can tell apart.

use plotters::style::RGBColor;

/// Text and axes.
pub(crate) const INK: RGBColor = RGBColor(40, 40, 46);
/// Grid lines.
pub(crate) const GRID: RGBColor = RGBColor(226, 226, 230);

/// Blue of `SERIES`: left channels, expected signals.
pub(crate) const BLUE: RGBColor = SERIES[0];
/// Vermillion of `SERIES`: right channels, actual signals.
pub(crate) const VERMILLION: RGBColor = SERIES[1];

/// Six colours of Okabe & Ito, "Color Universal Design" (2008), without black (the true motion) and yellow (too pale).
const SERIES: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Colour of the `n`-th series, and whether its line is dashed: twelve different combinations.
pub(crate) fn series(n: usize) -> (RGBColor, bool) {
    (SERIES[n % SERIES.len()], (n / SERIES.len()) % 2 == 1)
}

/// Nine points of the perceptually uniform map "viridis" (S. van der Walt & N. Smith, 2015, public domain).
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// The colour at `position`, from 0 (dark) to 1 (bright). The lightness rises evenly, so that it can also be read in
/// grey.
pub(crate) fn viridis(position: f64) -> RGBColor {
    let position = if position.is_nan() { 0.0 } else { position.clamp(0.0, 1.0) };
    let scaled = position * (VIRIDIS.len() - 1) as f64;
    let index = (scaled as usize).min(VIRIDIS.len() - 2);
    let fraction = scaled - index as f64;
    let channel = |c: usize| (VIRIDIS[index][c] + fraction * (VIRIDIS[index + 1][c] - VIRIDIS[index][c])).round() as u8;
    RGBColor(channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_brightens_from_end_to_end() {
        let lightness = |position: f64| {
            let RGBColor(r, g, b) = viridis(position);
            0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
        };
        assert!((0..100).all(|step| lightness(f64::from(step + 1) / 100.0) > lightness(f64::from(step) / 100.0)));
        assert_eq!((viridis(-1.0), viridis(2.0)), (RGBColor(68, 1, 84), RGBColor(253, 231, 37)));
        assert_eq!(viridis(f64::NAN), RGBColor(68, 1, 84));
    }
}
