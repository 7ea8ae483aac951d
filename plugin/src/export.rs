//! The entry points that hosts look for in the library.

#![allow(
    unsafe_code,
    missing_docs,
    unreachable_pub,
    non_upper_case_globals,
    reason = "exported symbols have the formats' names"
)]

use crate::layer::entry::ENTRY;
use crate::multi::SprungMulti;
use crate::plugin::Sprung;
use crate::resonator::Resonator;
use clap_sys::entry::clap_plugin_entry;
use nice_plug::prelude::*;

#[unsafe(no_mangle)]
#[used]
pub static clap_entry: clap_plugin_entry = ENTRY;

nice_export_vst3!(Sprung, SprungMulti, Resonator);
