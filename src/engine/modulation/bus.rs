//! The routes of a sound in the order in which they count, and how far they move what they lead to.

use crate::dsp::power_of_two;
use crate::params::{Change, Curve, Param};
use crate::patch::routes::{MAX_ROUTES, Response, Routes, Source, place_of_amount};

/// How many sources there are.
pub(crate) const SOURCES: usize = Source::ALL.len();

/// Values of all sources, by `Source as usize`.
pub(crate) type Sources = [f32; SOURCES];

/// How far each destination is moved, in knob travel.
pub(crate) type Sums = [f32; MAX_ROUTES];

/// What the routes lead to, and the routes to each: those that move macros and amounts of others come first, and otherwise
/// the order of their places counts. Plain data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bus {
    links: [Link; MAX_ROUTES],
    links_len: usize,
    destinations: [Destination; MAX_ROUTES],
    destinations_len: usize,
    /// A bit for each source that is read.
    read: u32,
    /// Sources that move by themselves move what decides when a note is over, or may do so by other routes.
    moves_the_end: bool,
}

/// What decides when a note is over.
const DECIDING: [Param; 6] = [Param::Decay, Param::DecayTilt, Param::Release, Param::Damper, Param::Gain, Param::Pan];

/// The bit of a source.
pub(crate) const fn bit(source: Source) -> u32 {
    1 << source as u32
}

/// The sources that move while nothing happens.
const MOVING: u32 =
    bit(Source::Lfo1) | bit(Source::Lfo2) | bit(Source::Lfo3) | bit(Source::Envelope1) | bit(Source::Envelope2);

/// A route that leads to the destination at `to`.
#[derive(Clone, Copy, Debug)]
struct Link {
    place: u8,
    source: Source,
    scale: Option<Source>,
    response: Response,
    to: u8,
    /// A bit for each source that it reads.
    reads: u32,
    /// What of the bus itself is moved.
    moves: Option<Moved>,
}

impl Link {
    /// How far it moves its destination, in knob travel.
    fn way(&self, sources: &Sources, amounts: &[f32; MAX_ROUTES]) -> f32 {
        let scale = self.scale.map_or(1.0, |scale| sources[scale as usize]);
        amounts[usize::from(self.place)] * self.response.apply(sources[self.source as usize]) * scale
    }
}

/// What routes move of the bus itself, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Moved {
    Amount(u8),
    Macro(u8),
}

impl Moved {
    fn of(param: Param) -> Option<Self> {
        let index = (param as usize).checked_sub(Param::Macro1 as usize).filter(|index| *index < 8);
        let amount = place_of_amount(param).map(|place| Self::Amount(place as u8));
        amount.or(index.map(|index| Self::Macro(index as u8)))
    }
}

/// A parameter that routes lead to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Destination {
    pub(crate) param: Param,
    pub(crate) target: Target,
    min: f32,
    max: f32,
    /// The parameter's range, or how often its ends are doubled.
    span: f32,
    is_logarithmic: bool,
}

/// Which part of the engine uses a destination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// The next strike.
    Strike,
    /// What sounding voices follow.
    Control,
    /// The rate of an oscillator.
    Lfo(u8),
}

impl Destination {
    const NONE: Self =
        Self { param: Param::Gain, target: Target::Strike, min: 0.0, max: 0.0, span: 0.0, is_logarithmic: false };

    fn new(param: Param) -> Self {
        let info = param.info();
        let is_logarithmic = info.curve == Curve::Logarithmic;
        let (min, max) = (info.min, info.max);
        let octaves = || libm::log2(f64::from(max) / f64::from(min)) as f32;
        let target = match (param, info.change) {
            (Param::Lfo1Rate, _) => Target::Lfo(0),
            (Param::Lfo2Rate, _) => Target::Lfo(1),
            (Param::Lfo3Rate, _) => Target::Lfo(2),
            (_, Change::Smoothed(_)) if Moved::of(param).is_none() => Target::Control,
            _ => Target::Strike,
        };
        Self { param, target, min, max, span: if is_logarithmic { octaves() } else { max - min }, is_logarithmic }
    }

    /// A value moved by an offset in knob travel, within the parameter's range. Real-time safe.
    pub(crate) fn moved(&self, value: f32, offset: f32) -> f32 {
        let way = offset * self.span;
        let moved = if self.is_logarithmic { value * power_of_two(way) } else { value + way };
        moved.clamp(self.min, self.max)
    }
}

impl Bus {
    /// No routes.
    pub(crate) const EMPTY: Self = {
        let (source, response) = (Source::Velocity, Response::Linear);
        let link = Link { place: 0, source, scale: None, response, to: 0, reads: 0, moves: None };
        Self {
            links: [link; MAX_ROUTES],
            links_len: 0,
            destinations: [Destination::NONE; MAX_ROUTES],
            destinations_len: 0,
            read: 0,
            moves_the_end: false,
        }
    };

    /// That of some routes. Real-time safe.
    pub(crate) fn new(routes: &Routes) -> Self {
        let mut bus = Self::EMPTY;
        for moves_bus in [true, false] {
            let is_now = |param: Param| Moved::of(param).is_some() == moves_bus;
            for (place, route) in routes.iter().filter(|(_, route)| is_now(route.destination)) {
                let param = route.destination;
                let known = bus.destinations().iter().position(|destination| destination.param == param);
                let to = known.unwrap_or_else(|| {
                    bus.destinations[bus.destinations_len] = Destination::new(param);
                    bus.destinations_len += 1;
                    bus.destinations_len - 1
                });
                let (source, scale, response) = (route.source, route.scale, route.response);
                let moves = Moved::of(param);
                let reads = bit(source) | scale.map_or(0, bit);
                bus.links[bus.links_len] =
                    Link { place: place as u8, source, scale, response, to: to as u8, reads, moves };
                bus.links_len += 1;
                bus.read |= reads;
                bus.moves_the_end |= reads & MOVING != 0 && (DECIDING.contains(&param) || moves.is_some());
            }
        }
        bus
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.links_len == 0
    }

    /// Whether oscillators or envelopes move what decides when a note is over.
    pub(crate) fn moves_the_end(&self) -> bool {
        self.moves_the_end
    }

    /// Whether any route reads the source that is so many after `first`.
    pub(crate) fn reads_nth(&self, first: Source, nth: usize) -> bool {
        self.read & 1 << (first as usize + nth) != 0
    }

    /// A bit for each source that is read.
    pub(crate) fn read(&self) -> u32 {
        self.read
    }

    /// Whether a source that is read moves while nothing happens.
    pub(crate) fn reads_moving(&self) -> bool {
        self.read & MOVING != 0
    }

    /// What the routes lead to; offsets are in this order.
    pub(crate) fn destinations(&self) -> &[Destination] {
        &self.destinations[..self.destinations_len]
    }

    /// A bit for each destination whose offset depends on any of some sources, given as bits.
    pub(crate) fn moved_by(&self, sources: u32) -> u32 {
        let links = &self.links[..self.links_len];
        let all = (1 << self.destinations_len) - 1;
        let mut moved = 0;
        for link in links.iter().filter(|link| link.reads & sources != 0) {
            // What moves a macro or an amount may move all that follows.
            moved |= if link.moves.is_some() { all } else { 1 << link.to };
        }
        moved
    }

    /// How far a destination is moved where no route moves macros or amounts: as [`Bus::offsets`].
    fn offset(&self, to: usize, sources: &Sources, amounts: &[f32; MAX_ROUTES]) -> f32 {
        let links = self.links[..self.links_len].iter().filter(|link| usize::from(link.to) == to);
        links.fold(0.0, |offset, link| offset + link.way(sources, amounts))
    }

    /// Finds anew how far the destinations of some bits are moved. Real-time safe.
    pub(crate) fn update(&self, offsets: &mut Sums, moved: u32, sources: &Sources, amounts: &[f32; MAX_ROUTES]) {
        if self.links.first().is_some_and(|link| link.moves.is_some()) {
            *offsets = self.offsets(sources, amounts);
            return;
        }
        for to in (0..self.destinations_len).filter(|to| moved & 1 << to != 0) {
            offsets[to] = self.offset(to, sources, amounts);
        }
    }

    /// How far each destination is moved, in knob travel, by sources with these values through routes with these
    /// amounts. Real-time safe.
    pub(crate) fn offsets(&self, sources: &Sources, amounts: &[f32; MAX_ROUTES]) -> Sums {
        let (mut sources, mut amounts, mut offsets) = (*sources, *amounts, [0.0; MAX_ROUTES]);
        for link in &self.links[..self.links_len] {
            let way = link.way(&sources, &amounts);
            offsets[usize::from(link.to)] += way;
            match link.moves {
                None => {}
                Some(Moved::Amount(index)) => {
                    // Knob travel of an amount is half of its range, which is from −1 to 1.
                    let amount = &mut amounts[usize::from(index)];
                    *amount = (*amount + 2.0 * way).clamp(-1.0, 1.0);
                }
                Some(Moved::Macro(index)) => {
                    let position = &mut sources[Source::Macro1 as usize + usize::from(index)];
                    *position = (*position + way).clamp(0.0, 1.0);
                }
            }
        }
        offsets
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::routes::Route;

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
        let mut sources = [0.0; Source::ALL.len()];
        for (source, value) in
            [(Source::Velocity, 0.5), (Source::Lfo1, -1.0), (Source::Wheel, 0.25), (Source::Bend, -0.5)]
        {
            assert!(bus.reads_nth(source, 0));
            sources[source as usize] = value;
        }
        assert!(!bus.reads_nth(Source::Random, 0));
        let mut amounts = [9.0; MAX_ROUTES];
        (amounts[3], amounts[5], amounts[7]) = (0.5, 1.0, -1.0);
        let params: Vec<_> = bus.destinations().iter().map(|destination| destination.param).collect();
        assert_eq!(params, [Param::Gain, Param::Decay]);
        assert_eq!(bus.offsets(&sources, &amounts)[..2], [0.0, 0.25]);
    }

    #[test]
    fn a_route_can_move_the_amount_of_another_wherever_it_stands() {
        for (mover, moved) in [(0, 1), (9, 2)] {
            let mut routes = Routes::NONE;
            routes.set(moved, Some(route(Source::Lfo1, Param::Tune)));
            routes.set(mover, Some(route(Source::Wheel, crate::patch::routes::amount_param(moved))));
            let bus = Bus::new(&routes);
            let mut sources = [0.0; Source::ALL.len()];
            (sources[Source::Lfo1 as usize], sources[Source::Wheel as usize]) = (1.0, 0.5);
            let mut amounts = [0.0; MAX_ROUTES];
            amounts[mover] = 0.25;
            let offsets = bus.offsets(&sources, &amounts);
            assert_eq!(bus.destinations()[1].param, Param::Tune);
            assert_eq!(offsets[1], 0.25, "half of a quarter, twice");
        }
    }

    #[test]
    fn values_move_along_the_knob_and_stay_in_range() {
        let destination = Destination::new;
        assert_eq!(destination(Param::Gain).moved(-24.0, 0.25), -6.0);
        assert_eq!(destination(Param::Gain).moved(-24.0, 9.0), 12.0);
        let decay = destination(Param::Decay);
        let info = Param::Decay.info();
        let expected = info.denormalise(info.normalise(0.5) + 0.1);
        assert!((decay.moved(0.5, 0.1) / expected - 1.0).abs() < 1e-4);
        assert_eq!(decay.moved(0.5, -9.0), info.min);
    }
}
