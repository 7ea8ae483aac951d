//! The routes of a sound in the order in which they are evaluated, and the offsets of their destinations.

use super::destination::{Destination, Target};
use super::link::{Amounts, Link, MOVING, Mover, Offsets, SOURCES, Sources, bit};
use crate::params::Param;
use crate::patch::routes::{MAX_ROUTES, Route, Routes, Source};

/// The routes of a sound and their destinations. Routes that modulate macros and amounts of other routes come first;
/// otherwise routes keep the order of their places. Plain data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bus {
    /// First the routes to macros and amounts; then the others.
    links: [Link; MAX_ROUTES],
    links_len: usize,
    /// For each of the first links: the macro or amount that it modulates.
    movers: [Mover; MAX_ROUTES],
    movers_len: usize,
    destinations: [Destination; MAX_ROUTES],
    destinations_len: usize,
    /// A bit for each destination that sounding notes follow at control ticks.
    followed: u32,
    /// Destinations of each source, one bit each.
    moved: [u16; SOURCES],
    /// Sources that any route reads, one bit each; and, in the next field, those that routes to macros or amounts read.
    read: u32,
    read_by_movers: u32,
    /// Whether oscillators or envelopes modulate a parameter that decides when a note is over, or a macro or amount through
    /// which they may do so.
    moves_the_end: bool,
}

/// The parameters that decide when a note is over.
const DECIDING: [Param; 9] = [
    Param::Decay,
    Param::DecayTilt,
    Param::Release,
    Param::Damper,
    Param::Touch,
    Param::TouchPosition,
    Param::Bloom,
    Param::Gain,
    Param::Pan,
];

/// The indices of the bits that are set, lowest first.
pub(super) fn places(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (place < u32::BITS).then_some(place as usize)
    })
}

impl Bus {
    /// No routes.
    pub(crate) const EMPTY: Self = Self {
        links: [Link::NONE; MAX_ROUTES],
        links_len: 0,
        movers: [Mover::Amount(0); MAX_ROUTES],
        movers_len: 0,
        destinations: [Destination::NONE; MAX_ROUTES],
        destinations_len: 0,
        followed: 0,
        moved: [0; SOURCES],
        read: 0,
        read_by_movers: 0,
        moves_the_end: false,
    };

    /// The bus of these routes. Real-time safe.
    pub(crate) fn new(routes: &Routes) -> Self {
        let mut bus = Self::EMPTY;
        for (place, route) in routes.iter() {
            if let Some(mover) = Mover::of(route.destination) {
                bus.movers[bus.movers_len] = mover;
                bus.movers_len += 1;
                bus.read_by_movers |= bus.add(place, &route);
            }
        }
        for (place, route) in routes.iter().filter(|(_, route)| Mover::of(route.destination).is_none()) {
            bus.add(place, &route);
        }
        bus
    }

    /// Returns the index of a destination. Adds the destination if it is new.
    fn place_of(&mut self, param: Param) -> usize {
        let known = self.destinations().iter().position(|destination| destination.param == param);
        known.unwrap_or_else(|| {
            let (to, destination) = (self.destinations_len, Destination::new(param));
            self.destinations[to] = destination;
            self.followed |= u32::from(destination.target != Target::Strike) << to;
            self.destinations_len += 1;
            to
        })
    }

    /// Adds a route. Returns a bit for each source that it reads.
    fn add(&mut self, place: usize, route: &Route) -> u32 {
        let (to, is_mover) = (self.place_of(route.destination), Mover::of(route.destination).is_some());
        self.links[self.links_len] = Link::new(place, route, to);
        self.links_len += 1;
        let reads = bit(route.source) | route.scale.map_or(0, bit);
        self.read |= reads;
        self.moves_the_end |= reads & MOVING != 0 && (DECIDING.contains(&route.destination) || is_mover);
        places(reads).for_each(|source| self.moved[source] |= 1 << to);
        reads
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.links_len == 0
    }

    /// Whether oscillators or envelopes modulate a parameter that decides when a note is over.
    pub(crate) fn moves_the_end(&self) -> bool {
        self.moves_the_end
    }

    /// Whether any route reads the source.
    #[inline]
    pub(crate) fn reads(&self, source: Source) -> bool {
        self.read & bit(source) != 0
    }

    /// Whether any route reads the `nth` source after `first` (0 is `first` itself).
    pub(crate) fn reads_nth(&self, first: Source, nth: usize) -> bool {
        self.read & bit(first) << nth != 0
    }

    /// Whether any route reads a source that changes with time alone: an oscillator or an envelope.
    pub(crate) fn reads_moving(&self) -> bool {
        self.read & MOVING != 0
    }

    /// A bit for each source that modulates macros or amounts, and so may change every destination.
    pub(crate) fn read_by_movers(&self) -> u32 {
        self.read_by_movers
    }

    /// Whether any route has this parameter as its destination.
    pub(crate) fn leads_to(&self, param: Param) -> bool {
        self.destinations().iter().any(|destination| destination.param == param)
    }

    /// Whether any route moves an effect behind the voices.
    pub(crate) fn leads_behind(&self) -> bool {
        self.destinations().iter().any(|destination| destination.target == Target::Behind)
    }

    /// The destinations of the routes; offsets are in this order.
    pub(crate) fn destinations(&self) -> &[Destination] {
        &self.destinations[..self.destinations_len]
    }

    /// A bit for each destination that sounding notes follow at control ticks.
    pub(crate) fn followed(&self) -> u32 {
        self.followed
    }

    /// A bit for each destination whose offset depends on any of these `sources` (bits). None of them may modulate
    /// macros or amounts.
    pub(crate) fn moved_by(&self, sources: u32) -> u32 {
        places(sources & self.read).fold(0, |moved, source| moved | u32::from(self.moved[source]))
    }

    /// Applies the routes to macros (in `sources`) and to amounts, both of which must have their values from the
    /// settings. Returns the offsets in knob travel, in the order of the destinations. Real-time safe.
    pub(crate) fn move_routes(&self, sources: &mut Sources, amounts: &mut Amounts) -> Offsets {
        let mut offsets = [0.0; MAX_ROUTES];
        for (link, mover) in self.links.iter().zip(&self.movers[..self.movers_len]) {
            let travel = link.travel(sources, amounts);
            link.add(travel, &mut offsets);
            mover.apply(travel, sources, amounts);
        }
        offsets
    }

    /// Adds the offsets in knob travel of all destinations that are neither macros nor amounts. Call
    /// [`Bus::move_routes`] before. Real-time safe.
    pub(crate) fn add_offsets(&self, sources: &Sources, amounts: &Amounts, offsets: &mut Offsets) {
        for link in &self.links[self.movers_len..self.links_len] {
            link.add(link.travel(sources, amounts), offsets);
        }
    }

    /// Offsets of all destinations in knob travel, for these source values and amounts. Macros and amounts must have
    /// their values from the settings. Real-time safe.
    pub(crate) fn offsets(&self, mut sources: Sources, mut amounts: Amounts) -> Offsets {
        let mut offsets = self.move_routes(&mut sources, &mut amounts);
        self.add_offsets(&sources, &amounts, &mut offsets);
        offsets
    }
}

#[cfg(test)]
mod tests {
    use super::super::link::SOURCES_AT_REST;
    use super::*;
    use crate::patch::routes::{Response, Route};

    fn route(source: Source, destination: Param) -> Route {
        Route { source, destination, response: Response::Linear, scale: None }
    }

    #[test]
    fn routes_to_one_destination_add_up_and_scales_scale() {
        let mut routes = Routes::NONE;
        routes.set(3, Some(route(Source::Velocity, Param::Gain)));
        routes.set(5, Some(Route { scale: Some(Source::Wheel), ..route(Source::Lfo1, Param::Gain) }));
        routes.set(7, Some(Route { response: Response::Squared, ..route(Source::Bend, Param::Decay) }));
        let bus = Bus::new(&routes);
        let mut sources = SOURCES_AT_REST;
        for (source, value) in
            [(Source::Velocity, 0.5), (Source::Lfo1, -1.0), (Source::Wheel, 0.25), (Source::Bend, -0.5)]
        {
            assert!(bus.reads(source));
            sources[source as usize] = value;
        }
        assert!(!bus.reads(Source::Random));
        let mut amounts = [9.0; MAX_ROUTES];
        (amounts[3], amounts[5], amounts[7]) = (0.5, 1.0, -1.0);
        let params: Vec<_> = bus.destinations().iter().map(|destination| destination.param).collect();
        assert_eq!(params, [Param::Gain, Param::Decay]);
        assert_eq!(bus.offsets(sources, amounts)[..2], [0.0, 0.25]);
    }

    #[test]
    fn a_route_can_move_the_amount_of_another_wherever_it_stands() {
        for (mover, moved) in [(0, 1), (9, 2)] {
            let mut routes = Routes::NONE;
            routes.set(moved, Some(route(Source::Lfo1, Param::Tune)));
            routes.set(mover, Some(route(Source::Wheel, crate::patch::routes::amount_param(moved))));
            let bus = Bus::new(&routes);
            let mut sources = SOURCES_AT_REST;
            (sources[Source::Lfo1 as usize], sources[Source::Wheel as usize]) = (1.0, 0.5);
            let mut amounts = [0.0; MAX_ROUTES];
            amounts[mover] = 0.25;
            let offsets = bus.offsets(sources, amounts);
            assert_eq!(bus.destinations()[1].param, Param::Tune);
            assert_eq!(offsets[1], 0.25, "half of a quarter, twice");
        }
    }
}
