//! Outlines that are turned round an axis: heights and radii of bells, bowls, cymbals and what belongs to them.

/// A bell from its crown to its rim.
pub(crate) const BELL: [[f32; 2]; 10] = [
    [1.0, 0.0],
    [0.995, 0.17],
    [0.955, 0.31],
    [0.85, 0.365],
    [0.66, 0.395],
    [0.47, 0.435],
    [0.3, 0.5],
    [0.15, 0.595],
    [0.045, 0.69],
    [0.0, 0.72],
];
/// The ornaments of a bell, as shares of the way from its crown to its rim.
pub(crate) const MOULDINGS: [f32; 4] = [0.29, 0.34, 0.86, 0.895];
/// The grip of a hand bell, from its end down.
pub(crate) const GRIP: [[f32; 2]; 8] =
    [[1.62, 0.0], [1.61, 0.06], [1.57, 0.095], [1.5, 0.1], [1.32, 0.07], [1.12, 0.085], [1.04, 0.105], [0.99, 0.11]];
/// What a church bell hangs from.
pub(crate) const CROWN: [[f32; 2]; 4] = [[1.1, 0.0], [1.095, 0.06], [1.05, 0.075], [0.985, 0.085]];
/// A bowl from its bottom to its rim.
pub(crate) const BOWL: [[f32; 2]; 8] =
    [[0.0, 0.0], [0.02, 0.3], [0.1, 0.56], [0.24, 0.74], [0.42, 0.86], [0.62, 0.92], [0.82, 0.95], [1.0, 0.96]];
/// The bowl of a glass, from its bottom to its rim.
pub(crate) const GLASS: [[f32; 2]; 8] =
    [[0.72, 0.0], [0.73, 0.17], [0.8, 0.33], [0.93, 0.45], [1.1, 0.515], [1.28, 0.525], [1.46, 0.5], [1.62, 0.46]];
/// The stem and the foot of a glass, from the bowl down.
pub(crate) const STEM: [[f32; 2]; 9] = [
    [0.74, 0.1],
    [0.68, 0.06],
    [0.58, 0.042],
    [0.4, 0.036],
    [0.22, 0.04],
    [0.12, 0.065],
    [0.07, 0.14],
    [0.035, 0.3],
    [0.0, 0.42],
];
/// A cymbal from its middle to its rim: a small bell, and the bow.
pub(crate) const CYMBAL: [[f32; 2]; 12] = [
    [0.25, 0.0],
    [0.244, 0.0909],
    [0.208, 0.1818],
    [0.14, 0.2727],
    [0.116, 0.3636],
    [0.108, 0.4545],
    [0.096, 0.5455],
    [0.081, 0.6364],
    [0.064, 0.7273],
    [0.045, 0.8182],
    [0.024, 0.9091],
    [0.0, 1.0],
];
/// The rod through a pair of hats, from its end down.
pub(crate) const ROD: [[f32; 2]; 4] = [[0.6, 0.0], [0.6, 0.022], [0.3, 0.022], [0.24, 0.05]];
/// A gong from its middle to the bend of its rim: a boss, and a nearly flat face.
pub(crate) const GONG: [[f32; 2]; 12] = [
    [0.2, 0.0],
    [0.197, 0.0909],
    [0.175, 0.1818],
    [0.105, 0.2727],
    [0.068, 0.3636],
    [0.062, 0.4545],
    [0.06, 0.5455],
    [0.057, 0.6364],
    [0.053, 0.7273],
    [0.046, 0.8182],
    [0.032, 0.9091],
    [0.0, 1.0],
];

/// The point of the outline at a share of its length, on a smooth curve through all of its points (Catmull and Rom).
pub(crate) fn along(outline: &[[f32; 2]], share: f32) -> [f32; 2] {
    let place = share.clamp(0.0, 1.0) * (outline.len() - 1) as f32;
    let before = (place as usize).min(outline.len() - 2);
    let t = place - before as f32;
    std::array::from_fn(|axis| {
        let at = |place: usize| outline[place.min(outline.len() - 1)][axis];
        let [a, b, c, d] = [at(before.saturating_sub(1)), at(before), at(before + 1), at(before + 2)];
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    })
}
