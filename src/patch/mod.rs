//! A patch, which users edit and save: a value for each parameter, the table of modes, and the routes.

mod modes;
pub mod routes;

use crate::params::{Param, Values};
pub use modes::{MAX_MODES, Mode, ModeTable};
use routes::{Route, Routes, Source, amount_param};

/// A value for each parameter, the modes of the body, and the routes.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// The parameters.
    pub values: Values,
    /// The body.
    pub modes: ModeTable,
    /// The modulation routes.
    pub routes: Routes,
}

impl Default for Patch {
    /// The preset `init`: every parameter at its default, one mode and `Routes::INITIAL`. Allocates.
    fn default() -> Self {
        Self { values: Values::default(), modes: ModeTable::new(&[Mode::UNIT]), routes: Routes::INITIAL }
    }
}

impl Patch {
    /// As [`Values::get`].
    pub fn get(&self, param: Param) -> f32 {
        self.values.get(param)
    }

    /// As [`Values::set`].
    pub fn set(&mut self, param: Param, value: f32) {
        self.values.set(param, value);
    }

    /// The patch with one parameter changed, for building a patch in an expression.
    #[must_use]
    pub fn with(mut self, param: Param, value: f32) -> Self {
        self.set(param, value);
        self
    }

    /// The patch with a route at a place, 0 to 15, as [`Patch::with`]: `source` modulates `destination` linearly, by
    /// `amount` per cent of its knob travel if the source is 1.
    #[must_use]
    pub fn with_route(mut self, place: usize, source: Source, destination: Param, amount: f32) -> Self {
        self.routes.set(place, Some(Route::linear(source, destination)));
        self.with(amount_param(place), amount)
    }
}
