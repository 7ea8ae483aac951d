//! What a model of a body gives: resonances with their mode shapes.

/// A place on a body, where it is struck, heard or joined to another.
///
/// What `x` and `y` mean stands in the description of each [`super::Model`]: along a string, bar or tube `x` runs from one
/// end to the other; on a round body `x` runs from the centre (0) to the rim (1) and `y` round it, in turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// 0 to 1.
    pub x: f64,
    /// 0 to 1.
    pub y: f64,
}

/// How a resonance comes in two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pair {
    /// It is one.
    Single,
    /// Two directions of movement of one shape.
    Directions,
    /// A round body's modes with this many nodal diameters (at least 1): one is the other turned by half a lobe.
    Diameters(u32),
}

/// A mode shape: its value at a place. Round bodies leave out the factor `cos(m (θ − θ₀))` of [`Pair::Diameters`].
///
/// The mean of its square over the body, weighted by mass and with that factor, is 1. So all modes have the mass of the
/// whole body, and `shape(struck) · shape(heard)` is the velocity that an impulse gives each, up to one factor for all.
pub(super) type Shape = Box<dyn Fn(Point) -> f64>;

/// One resonance of a model.
pub(super) struct Partial {
    /// Frequency as a multiple of the body's.
    pub(super) ratio: f64,
    pub(super) pair: Pair,
    /// The material's loss rate is multiplied by this.
    pub(super) loss_factor: f64,
    /// Loss rate besides the material's, in 1/s: sound radiated.
    pub(super) radiation: f64,
    /// Level besides that of its shape.
    pub(super) gain: f64,
    pub(super) shape: Shape,
}

impl Partial {
    pub(super) fn new(ratio: f64, pair: Pair, shape: impl Fn(Point) -> f64 + 'static) -> Self {
        Self { ratio, pair, loss_factor: 1.0, radiation: 0.0, gain: 1.0, shape: Box::new(shape) }
    }
}

/// The lowest `count` of `items` by `frequency`; equal ones stay in their order.
pub(super) fn lowest<T>(mut items: Vec<T>, count: usize, frequency: impl Fn(&T) -> f64) -> Vec<T> {
    items.sort_by(|a, b| frequency(a).total_cmp(&frequency(b)));
    items.truncate(count);
    items
}

/// Calls `below` with ever higher limits until it gives at least `count` items, and keeps the lowest of them.
///
/// `below(limit)` lists all modes up to a limit: in two dimensions it is not known beforehand which those are.
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
