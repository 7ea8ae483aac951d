//! The routes of a sound in the order in which they count, and how far they move what they lead to.

use crate::params::{Curve, Param};
use crate::patch::routes::{MAX_ROUTES, Response, Routes, Source, place_of_amount};

/// Values of all sources, by `Source as usize`.
pub(crate) type Sources = [f32; Source::ALL.len()];

/// What the routes lead to, and the routes to each: those that move amounts of others come first, and otherwise the
/// order of their places counts. Plain data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bus {
    links: [Link; MAX_ROUTES],
    links_len: usize,
    destinations: [Destination; MAX_ROUTES],
    destinations_len: usize,
    /// A bit for each source that is read.
    read: u32,
}

/// A route that leads to the destination at `to`.
#[derive(Clone, Copy, Debug)]
struct Link {
    place: u8,
    source: Source,
    scale: Option<Source>,
    response: Response,
    to: u8,
}

/// A parameter that routes lead to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Destination {
    pub(crate) param: Param,
    /// The parameter's range, or the logarithm of the ratio of its ends.
    span: f64,
}

impl Destination {
    /// A value moved by an offset in knob travel, within the parameter's range. Real-time safe.
    pub(crate) fn moved(&self, value: f32, offset: f32) -> f32 {
        let (info, way) = (self.param.info(), f64::from(offset) * self.span);
        let moved = match info.curve {
            Curve::Linear => f64::from(value) + way,
            Curve::Logarithmic => f64::from(value) * libm::exp(way),
        };
        (moved as f32).clamp(info.min, info.max)
    }
}

impl Bus {
    /// No routes.
    pub(crate) const EMPTY: Self = {
        let link = Link { place: 0, source: Source::Velocity, scale: None, response: Response::Linear, to: 0 };
        Self {
            links: [link; MAX_ROUTES],
            links_len: 0,
            destinations: [Destination { param: Param::Gain, span: 0.0 }; MAX_ROUTES],
            destinations_len: 0,
            read: 0,
        }
    };

    /// That of some routes. Real-time safe.
    pub(crate) fn new(routes: &Routes) -> Self {
        let mut bus = Self::EMPTY;
        let to_amount = |param: Param| place_of_amount(param).is_some();
        for moves_amounts in [true, false] {
            for (place, route) in routes.iter().filter(|(_, route)| to_amount(route.destination) == moves_amounts) {
                let param = route.destination;
                let known = bus.destinations().iter().position(|destination| destination.param == param);
                let to = known.unwrap_or_else(|| {
                    bus.destinations[bus.destinations_len] = Destination { param, span: span(param) };
                    bus.destinations_len += 1;
                    bus.destinations_len - 1
                });
                let (source, scale, response) = (route.source, route.scale, route.response);
                bus.links[bus.links_len] = Link { place: place as u8, source, scale, response, to: to as u8 };
                bus.links_len += 1;
                bus.read |= 1 << source as u32 | scale.map_or(0, |scale| 1 << scale as u32);
            }
        }
        bus
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.links_len == 0
    }

    /// Whether any route reads a source.
    pub(crate) fn reads(&self, source: Source) -> bool {
        self.read & 1 << source as u32 != 0
    }

    /// What the routes lead to; offsets are in this order.
    pub(crate) fn destinations(&self) -> &[Destination] {
        &self.destinations[..self.destinations_len]
    }

    /// How far each destination is moved, in knob travel, by sources with these values through routes with these
    /// amounts. Real-time safe.
    pub(crate) fn offsets(&self, sources: &Sources, mut amounts: [f32; MAX_ROUTES]) -> [f32; MAX_ROUTES] {
        let mut offsets = [0.0; MAX_ROUTES];
        for link in &self.links[..self.links_len] {
            let scale = link.scale.map_or(1.0, |scale| sources[scale as usize]);
            let way = amounts[usize::from(link.place)] * link.response.apply(sources[link.source as usize]) * scale;
            let to = usize::from(link.to);
            offsets[to] += way;
            if let Some(place) = place_of_amount(self.destinations[to].param) {
                // Knob travel of an amount is half of its range, which is from −1 to 1.
                amounts[place] = (amounts[place] + 2.0 * way).clamp(-1.0, 1.0);
            }
        }
        offsets
    }
}

fn span(param: Param) -> f64 {
    let (min, max) = (f64::from(param.info().min), f64::from(param.info().max));
    match param.info().curve {
        Curve::Linear => max - min,
        Curve::Logarithmic => libm::log(max / min),
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
            assert!(bus.reads(source));
            sources[source as usize] = value;
        }
        assert!(!bus.reads(Source::Random));
        let mut amounts = [9.0; MAX_ROUTES];
        (amounts[3], amounts[5], amounts[7]) = (0.5, 1.0, -1.0);
        let params: Vec<_> = bus.destinations().iter().map(|destination| destination.param).collect();
        assert_eq!(params, [Param::Gain, Param::Decay]);
        assert_eq!(bus.offsets(&sources, amounts)[..2], [0.0, 0.25]);
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
            let offsets = bus.offsets(&sources, amounts);
            assert_eq!(bus.destinations()[1].param, Param::Tune);
            assert_eq!(offsets[1], 0.25, "half of a quarter, twice");
        }
    }

    #[test]
    fn values_move_along_the_knob_and_stay_in_range() {
        let destination = |param| Destination { param, span: span(param) };
        assert_eq!(destination(Param::Gain).moved(-24.0, 0.25), -6.0);
        assert_eq!(destination(Param::Gain).moved(-24.0, 9.0), 12.0);
        let decay = destination(Param::Decay);
        let info = Param::Decay.info();
        let expected = info.denormalise(info.normalise(0.5) + 0.1);
        assert!((decay.moved(0.5, 0.1) / expected - 1.0).abs() < 1e-4);
        assert_eq!(decay.moved(0.5, -9.0), info.min);
    }
}
