//! One route in the form in which it is evaluated: the sources that it reads, and the offset of its destination.

use crate::params::Param;
use crate::patch::routes::{MAX_ROUTES, Response, Route, Source, place_of_amount};

/// Number of sources.
pub(crate) const SOURCES: usize = Source::ALL.len();

/// Values of all sources, by `Source as usize`. The element after them is 1: the scale of routes without a second source.
/// The length is a power of two, so that [`Link::travel`] needs no bounds checks.
pub(crate) type Sources = [f32; (SOURCES + 1).next_power_of_two()];

/// All sources at 0.
pub(crate) const SOURCES_AT_REST: Sources = {
    let mut sources = [0.0; (SOURCES + 1).next_power_of_two()];
    sources[SOURCES] = 1.0;
    sources
};

/// Offsets of the destinations in knob travel (1 is the knob's whole range), in the bus's order.
pub(crate) type Offsets = [f32; MAX_ROUTES];

/// Amounts of the routes, by route number, from −1 to 1.
pub(crate) type Amounts = [f32; MAX_ROUTES];

/// The bit of a source in a set of sources.
pub(crate) const fn bit(source: Source) -> u32 {
    1 << source as u32
}

/// The sources that change with time alone.
pub(super) const MOVING: u32 = {
    let (mut bits, mut place) = (0, 0);
    while place < SOURCES {
        if Source::ALL[place].is_moving() {
            bits |= bit(Source::ALL[place]);
        }
        place += 1;
    }
    bits
};

/// A route as the bus evaluates it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    place: u8,
    /// Index of the destination in the bus.
    to: u8,
    source: u8,
    /// Index of the second source in [`Sources`].
    scale: u8,
    response: Response,
}

impl Link {
    pub(super) const NONE: Self = Self { place: 0, to: 0, source: 0, scale: 0, response: Response::Linear };

    /// The link of the route with number `place`, to the destination with index `to`.
    pub(super) fn new(place: usize, route: &Route, to: usize) -> Self {
        let (source, response) = (route.source as u8, route.response);
        let scale = route.scale.map_or(SOURCES, |scale| scale as usize) as u8;
        Self { place: place as u8, to: to as u8, source, scale, response }
    }

    /// Adds an offset in knob travel to that of the destination.
    #[inline]
    pub(super) fn add(&self, travel: f32, offsets: &mut Offsets) {
        offsets[usize::from(self.to) % offsets.len()] += travel;
    }

    /// The offset that the route gives its destination, in knob travel.
    #[inline]
    pub(super) fn travel(&self, sources: &Sources, amounts: &Amounts) -> f32 {
        let [source, scale] = [self.source, self.scale].map(|index| sources[usize::from(index) % sources.len()]);
        // Most routes are linear, and the branch to one of the four curves would take as long as the rest of the function.
        let value = if self.response == Response::Linear { source } else { self.response.apply(source) };
        amounts[usize::from(self.place) % amounts.len()] * value * scale
    }
}

/// A destination inside the modulation itself: the amount of a route, or a macro, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mover {
    Amount(u8),
    Macro(u8),
}

impl Mover {
    /// The mover for a route to this parameter; none if it is neither an amount nor a macro.
    pub(super) fn of(param: Param) -> Option<Self> {
        let index = (param as usize).checked_sub(Param::Macro1 as usize).filter(|index| *index < 8);
        let amount = place_of_amount(param).map(|place| Self::Amount(place as u8));
        amount.or(index.map(|index| Self::Macro(index as u8)))
    }

    /// Adds an offset in knob travel, within the range of the macro or amount.
    pub(super) fn apply(self, travel: f32, sources: &mut Sources, amounts: &mut Amounts) {
        match self {
            Self::Amount(index) => {
                // A route's amount ranges from −1 to 1, so the whole knob travel is 2.
                let amount = &mut amounts[usize::from(index)];
                *amount = (*amount + 2.0 * travel).clamp(-1.0, 1.0);
            }
            Self::Macro(index) => {
                let position = &mut sources[Source::Macro1 as usize + usize::from(index)];
                *position = (*position + travel).clamp(0.0, 1.0);
            }
        }
    }
}
