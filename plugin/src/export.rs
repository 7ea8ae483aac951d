//! The entry points that hosts look for in the library.

#![allow(unsafe_code, missing_docs, reason = "the wrapper's macros define exported symbols")]

use crate::multi::SprungMulti;
use crate::plugin::Sprung;
use crate::resonator::Resonator;
use nice_plug::prelude::*;

nice_export_clap!(Sprung, SprungMulti, Resonator);
nice_export_vst3!(Sprung, SprungMulti, Resonator);
