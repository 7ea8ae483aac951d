//! The entry points that hosts look for in the library.

#![allow(unsafe_code, missing_docs, reason = "the wrapper's macros define exported symbols")]

use crate::plugin::Sprung;
use nice_plug::prelude::*;

nice_export_clap!(Sprung);
nice_export_vst3!(Sprung);
