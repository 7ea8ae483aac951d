//! One route as it is worked out: what it reads, and how far it moves its destination.

use crate::params::Param;
use crate::patch::routes::{MAX_ROUTES, Response, Route, Source, place_of_amount};

/// How many sources there are.
pub(crate) const SOURCES: usize = Source::ALL.len();

/// Values of all sources, by `Source as usize`.
pub(crate) type Sources = [f32; SOURCES];

/// How far each destination is moved, in knob travel.
pub(crate) type Offsets = [f32; MAX_ROUTES];

/// Amounts of the routes, by place, from −1 to 1.
pub(crate) type Amounts = [f32; MAX_ROUTES];

/// The bit of a source.
pub(crate) const fn bit(source: Source) -> u32 {
    1 << source as u32
}

/// The sources that move while nothing happens.
pub(super) const MOVING: u32 =
    bit(Source::Lfo1) | bit(Source::Lfo2) | bit(Source::Lfo3) | bit(Source::Envelope1) | bit(Source::Envelope2);

/// A route, without its destination.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    place: u8,
    source: Source,
    scale: Option<Source>,
    response: Response,
}

impl Link {
    pub(super) const NONE: Self = Self { place: 0, source: Source::Velocity, scale: None, response: Response::Linear };

    /// That of the route at a place.
    pub(super) fn new(place: usize, route: &Route) -> Self {
        Self { place: place as u8, source: route.source, scale: route.scale, response: route.response }
    }

    /// A bit for each source that it reads.
    pub(super) fn reads(&self) -> u32 {
        bit(self.source) | self.scale.map_or(0, bit)
    }

    /// How far it moves its destination, in knob travel.
    pub(super) fn travel(&self, sources: &Sources, amounts: &Amounts) -> f32 {
        let scale = self.scale.map_or(1.0, |scale| sources[scale as usize]);
        amounts[usize::from(self.place)] * self.response.apply(sources[self.source as usize]) * scale
    }
}

/// What a route can move of the routes themselves, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mover {
    Amount(u8),
    Macro(u8),
}

impl Mover {
    /// What a route to this parameter moves of them, if anything.
    pub(super) fn of(param: Param) -> Option<Self> {
        let index = (param as usize).checked_sub(Param::Macro1 as usize).filter(|index| *index < 8);
        let amount = place_of_amount(param).map(|place| Self::Amount(place as u8));
        amount.or(index.map(|index| Self::Macro(index as u8)))
    }

    /// Moves it, by some knob travel.
    pub(super) fn apply(self, travel: f32, sources: &mut Sources, amounts: &mut Amounts) {
        match self {
            Self::Amount(index) => {
                // Knob travel of an amount is half of its range, which is from −1 to 1.
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
