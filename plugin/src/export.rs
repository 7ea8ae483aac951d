//! The entry points that hosts look for in the library.

#![allow(unsafe_code, missing_docs, reason = "the wrapper's macros define exported symbols")]

use crate::plugin::Sprung;
use crate::resonator::Resonator;
use nice_plug::prelude::*;

nice_export_clap!(Sprung, Resonator);
nice_export_vst3!(Sprung, Resonator);
