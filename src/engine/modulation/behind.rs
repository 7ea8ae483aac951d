//! The routes that move the effects behind the voices: by the newest note's strike, its channel and the macros.

use super::bus::Bus;
use super::destination::Target;
use super::link::{SOURCES_AT_REST, Sources};
use super::modulators::{Positions, Struck, set_macros};
use super::settings::Settings;
use crate::params::Param;

/// The routes of the newest note's sound, if any leads behind the voices. Evaluated after each event and not at control ticks:
/// effects have their own ramps. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Behind {
    bus: Bus,
    /// The sources of the strike; the others are at rest.
    struck: Sources,
}

impl Behind {
    /// No routes.
    pub(crate) const NONE: Self = Self { bus: Bus::EMPTY, struck: SOURCES_AT_REST };

    /// Whether any route leads behind the voices.
    pub(crate) fn is_on(&self) -> bool {
        self.bus.leads_behind()
    }

    /// A note of a sound with these routes was struck.
    pub(crate) fn strike(&mut self, bus: &Bus, struck: &Struck) {
        if bus.leads_behind() {
            (self.bus, self.struck) = (*bus, SOURCES_AT_REST);
            struck.sources().into_iter().for_each(|(source, value)| self.struck[source as usize] = value);
        } else if self.is_on() {
            *self = Self::NONE;
        }
    }

    /// Calls `tell` with each parameter behind the voices that routes move and its value. `value` reads the parameters.
    pub(crate) fn each_value(
        &self,
        positions: &Positions,
        value: impl Fn(Param) -> f32,
        mut tell: impl FnMut(Param, f32),
    ) {
        // Oscillators do not reach effects, so the tempo does not matter.
        let (mut sources, settings) = (self.struck, Settings::new(&self.bus, value, 1.0));
        positions.sources().into_iter().for_each(|(source, value)| sources[source as usize] = value);
        set_macros(&mut sources, &settings);
        let offsets = self.bus.offsets(sources, settings.amounts);
        for (place, destination) in self.bus.destinations().iter().enumerate() {
            if destination.target == Target::Behind {
                tell(destination.param, destination.moved(settings.bases[place], offsets[place]));
            }
        }
    }
}
