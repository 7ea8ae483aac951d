//! The result of every model: resonances with their mode shapes.

/// A place on a body, where it is struck, heard or joined to another body.
///
/// [`super::Model`] explains `x` and `y` for each model. Along a string, bar or tube, `x` runs from one end to the
/// other. On a round body, `x` runs from the centre (0) to the rim (1) and `y` round it, in turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// 0 to 1.
    pub x: f64,
    /// 0 to 1.
    pub y: f64,
}

/// Whether a resonance is one mode or a pair of modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pair {
    /// One mode.
    Single,
    /// A pair: two directions of movement with the same shape.
    Directions,
    /// A pair in a round body, with this many nodal diameters (at least 1): the second mode is the first turned by half
    /// a lobe.
    Diameters(u32),
}

/// A mode shape: its value at a place. The shapes of round bodies do not include the factor `cos(m (θ − θ₀))` of
/// [`Pair::Diameters`].
///
/// The mean of its square over the body, weighted by mass and including that factor, is 1. So every mode has the mass
/// of the whole body, and `shape(struck) · shape(heard)` is the velocity after an impulse, up to a factor that all
/// modes share.
pub(super) type Shape = Box<dyn Fn(Point) -> f64>;

/// One resonance of a model.
pub(super) struct Partial {
    /// Frequency as a multiple of the body's frequency.
    pub(super) ratio: f64,
    pub(super) pair: Pair,
    /// Factor of the material's loss rate.
    pub(super) loss_factor: f64,
    /// Loss rate in addition to the material's, in 1/s: radiated sound.
    pub(super) radiation: f64,
    /// Factor of the level, in addition to the shape.
    pub(super) gain: f64,
    pub(super) shape: Shape,
}

impl Partial {
    pub(super) fn new(ratio: f64, pair: Pair, shape: impl Fn(Point) -> f64 + 'static) -> Self {
        Self { ratio, pair, loss_factor: 1.0, radiation: 0.0, gain: 1.0, shape: Box::new(shape) }
    }
}

/// The `count` items with the lowest `frequency`. Items with equal frequencies keep their order.
pub(super) fn lowest<T>(mut items: Vec<T>, count: usize, frequency: impl Fn(&T) -> f64) -> Vec<T> {
    items.sort_by(|a, b| frequency(a).total_cmp(&frequency(b)));
    items.truncate(count);
    items
}

/// Calls `below` with higher and higher limits until it returns at least `count` items, and keeps the lowest of them.
///
/// `below(limit)` returns all modes up to a limit. In two dimensions, it is not known beforehand which modes are the
/// lowest.
pub(super) fn lowest_below<T>(
    count: usize,
    start: f64,
    frequency: impl Fn(&T) -> f64,
    below: impl Fn(f64) -> Vec<T>,
) -> Vec<T> {
    let mut limit = start;
    loop {
        let found = below(limit);
        if found.len() >= count {
            return lowest(found, count, frequency);
        }
        limit *= 1.25;
    }
}
