//! Routes: which source modulates which parameter, and with which response.
//!
//! The amount of each route is a parameter, `route1` to `route16`, so that hosts can automate it and routes can
//! modulate it.

use crate::params::{PARAMS, Param};

/// Maximum number of routes of a sound.
pub const MAX_ROUTES: usize = 16;

macro_rules! named {
    ($(#[$about:meta])* $name:ident { $($(#[$help:meta])* $variant:ident $id:literal,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$help])* $variant,)*
        }

        impl $name {
            /// All of them, in order.
            pub const ALL: &'static [$name] = &[$($name::$variant,)*];

            /// Stable identifier in files.
            pub fn id(self) -> &'static str {
                match self {
                    $($name::$variant => $id,)*
                }
            }

            /// The one with this identifier.
            pub(crate) fn from_id(id: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|one| one.id() == id)
            }
        }
    };
}

named! {
    /// Modulation sources. Each note has its own values. Sources of a strike keep their value until the next strike.
    Source {
        /// Velocity of the strike, 0–1.
        Velocity "velocity",
        /// Release velocity, 0–1; 0 until the key is released.
        ReleaseVelocity "release_velocity",
        /// Semitones above C4 divided by 60, −1 to 1.
        Key "key",
        /// A random number for each strike, −1 to 1.
        Random "random",
        /// Alternates between 1 and −1 from strike to strike.
        Alternation "alternation",
        /// Pressure on the key or channel, 0–1.
        Pressure "pressure",
        /// Brightness of the note and its channel (controller 74), −1 to 1.
        Timbre "timbre",
        /// The pitch wheel, −1 to 1.
        Bend "bend",
        /// The modulation wheel, or the note's vibrato expression, 0–1.
        Wheel "wheel",
        /// Breath (controller 2), 0–1.
        Breath "breath",
        /// Expression (controller 11), 0–1.
        Expression "expression",
        /// The first low-frequency oscillator, −1 to 1.
        Lfo1 "lfo1",
        /// The second, −1 to 1.
        Lfo2 "lfo2",
        /// The third, −1 to 1.
        Lfo3 "lfo3",
        /// The first envelope, 0–1.
        Envelope1 "envelope1",
        /// The second, 0–1.
        Envelope2 "envelope2",
        /// A knob, 0–1.
        Macro1 "macro1",
        /// A knob, 0–1.
        Macro2 "macro2",
        /// A knob, 0–1.
        Macro3 "macro3",
        /// A knob, 0–1.
        Macro4 "macro4",
        /// A knob, 0–1.
        Macro5 "macro5",
        /// A knob, 0–1.
        Macro6 "macro6",
        /// A knob, 0–1.
        Macro7 "macro7",
        /// A knob, 0–1.
        Macro8 "macro8",
    }
}

impl Source {
    /// The value of [`Source::Key`] at a pitch on the MIDI scale. Real-time safe.
    pub(crate) fn key_at(pitch: f64) -> f32 {
        ((pitch - 60.0) / 60.0).clamp(-1.0, 1.0) as f32
    }

    /// Whether it changes with time alone: an oscillator or an envelope.
    pub(crate) const fn is_moving(self) -> bool {
        use Source::{Envelope1, Envelope2, Lfo1, Lfo2, Lfo3};
        matches!(self, Lfo1 | Lfo2 | Lfo3 | Envelope1 | Envelope2)
    }

    /// Whether its values range from −1 to 1; otherwise they range from 0 to 1.
    pub fn is_bipolar(self) -> bool {
        use Source::{Alternation, Bend, Key, Lfo1, Lfo2, Lfo3, Random, Timbre};
        matches!(self, Key | Random | Alternation | Timbre | Bend | Lfo1 | Lfo2 | Lfo3)
    }
}

named! {
    /// The curve that a route applies to its source. It keeps 0 and ±1, and is symmetrical for negative values.
    Response {
        /// No change.
        Linear "linear",
        /// The square: flat near 0.
        Squared "squared",
        /// The square root: steep near 0.
        Root "root",
        /// `x² (3 − 2x)`: flat near 0 and near 1.
        Smooth "smooth",
    }
}

impl Response {
    /// Applies the curve to a source value from −1 to 1. Real-time safe.
    pub(crate) fn apply(self, value: f32) -> f32 {
        let magnitude = value.abs();
        match self {
            Response::Linear => value,
            Response::Squared => value * magnitude,
            Response::Root => libm::sqrtf(magnitude).copysign(value),
            Response::Smooth => value * magnitude * (3.0 - 2.0 * magnitude),
        }
    }
}

/// A route: a source that modulates a parameter. Its amount is the parameter that belongs to its place in [`Routes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Route {
    /// The source.
    pub source: Source,
    /// The parameter that is modulated: see [`Route::is_possible`].
    pub destination: Param,
    /// The curve that is applied to the source.
    pub response: Response,
    /// A second source, by which the first is multiplied.
    pub scale: Option<Source>,
}

impl Route {
    /// A route with a linear response and no scale.
    pub const fn linear(source: Source, destination: Param) -> Self {
        Self { source, destination, response: Response::Linear, scale: None }
    }

    /// Whether it can act: [`crate::params::ParamInfo::is_modulatable`] is true for its destination, and what all notes share is
    /// not moved by the oscillators and envelopes of one.
    pub fn is_possible(&self) -> bool {
        let is_of_a_note = |source: Source| source.is_moving() || source == Source::ReleaseVelocity;
        let sources = [Some(self.source), self.scale].into_iter().flatten();
        self.destination.info().is_modulatable()
            && !(self.destination.is_behind_voices() && sources.into_iter().any(is_of_a_note))
    }
}

/// Up to [`MAX_ROUTES`] routes. Plain data of fixed size, so that the audio thread can copy it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Routes([Option<Route>; MAX_ROUTES]);

impl Routes {
    /// No routes.
    pub const NONE: Routes = Routes([None; MAX_ROUTES]);

    /// The routes of a new patch, in the last places: the modulation wheel adds vibrato; brightness tilts the levels
    /// and the decay of the modes. Their amounts are the default values of the parameters.
    pub(crate) const INITIAL: Routes = {
        let mut routes = Routes::NONE;
        routes.0[13] = Some(Route::linear(Source::Wheel, Param::Vibrato));
        routes.0[14] = Some(Route::linear(Source::Timbre, Param::Tilt));
        routes.0[15] = Some(Route::linear(Source::Timbre, Param::DecayTilt));
        routes
    };

    /// The route at a place, 0 to 15.
    pub fn get(&self, place: usize) -> Option<Route> {
        self.0.get(place).copied().flatten()
    }

    /// Sets or removes the route at a place. Does nothing if the place does not exist or the route is not possible.
    pub fn set(&mut self, place: usize, route: Option<Route>) {
        let is_allowed = route.is_none_or(|route| route.is_possible());
        if let Some(slot) = self.0.get_mut(place).filter(|_| is_allowed) {
            *slot = route;
        }
    }

    /// The routes with their places.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Route)> + '_ {
        self.0.iter().enumerate().filter_map(|(place, route)| Some((place, (*route)?)))
    }
}

/// The parameter that is the amount of the route at a place, 0 to 15. A greater place counts as 15.
pub fn amount_param(place: usize) -> Param {
    PARAMS[Param::Route1 as usize + place.min(MAX_ROUTES - 1)].param
}

/// Number of macros.
pub(crate) const MAX_MACROS: usize = 8;

/// The parameter that is the macro of a number, counted from 0; none beyond the eighth. Real-time safe.
pub fn macro_param(number: usize) -> Option<Param> {
    (number < MAX_MACROS).then(|| PARAMS[Param::Macro1 as usize + number].param)
}

/// The place of the route whose amount this parameter is; none if the parameter is not the amount of a route.
pub(crate) fn place_of_amount(param: Param) -> Option<usize> {
    (param as usize).checked_sub(Param::Route1 as usize).filter(|place| *place < MAX_ROUTES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_read_back() {
        assert!(Source::ALL.iter().all(|source| Source::from_id(source.id()) == Some(*source)));
        assert!(Response::ALL.iter().all(|response| Response::from_id(response.id()) == Some(*response)));
        assert_eq!(Source::from_id("lfo4"), None);
    }

    #[test]
    fn responses_keep_the_ends_and_the_middle() {
        for response in Response::ALL {
            assert_eq!([-1.0, 0.0, 1.0].map(|value| response.apply(value)), [-1.0, 0.0, 1.0], "{response:?}");
            assert_eq!(response.apply(-0.3), -response.apply(0.3), "{response:?}");
        }
        assert_eq!(Response::Smooth.apply(0.5), 0.5);
    }

    #[test]
    fn every_place_has_its_amount() {
        for place in 0..MAX_ROUTES {
            assert_eq!(amount_param(place).info().id, format!("route{}", place + 1));
            assert_eq!(place_of_amount(amount_param(place)), Some(place));
        }
        assert_eq!(place_of_amount(Param::Macro8), None);
        assert_eq!([0, 7, 8].map(macro_param), [Some(Param::Macro1), Some(Param::Macro8), None]);
        assert_eq!(place_of_amount(Param::Voices), None);
    }

    #[test]
    fn what_cannot_be_moved_has_no_route() {
        let route = |destination| Route { source: Source::Lfo1, destination, response: Response::Linear, scale: None };
        let mut routes = Routes::NONE;
        for param in [Param::MalletPulse, Param::Voices, Param::Limiter, Param::Glide] {
            routes.set(0, Some(route(param)));
        }
        assert_eq!(routes, Routes::NONE);
        routes.set(15, Some(route(Param::Route1)));
        assert_eq!(routes.iter().collect::<Vec<_>>(), [(15, route(Param::Route1))]);
    }
}
