//! Where a preset or kit is, as hosts say it: in the plugin under its name, or in a file.

use super::c::text;
use clap_sys::factory::preset_discovery::{
    CLAP_PRESET_DISCOVERY_LOCATION_FILE, CLAP_PRESET_DISCOVERY_LOCATION_PLUGIN, clap_preset_discovery_location_kind,
};
use std::ffi::c_char;

/// A place of presets.
#[derive(Debug, PartialEq)]
pub(super) enum Place<'a> {
    /// The plugin itself.
    Factory,
    /// The file at a path.
    File(&'a str),
}

impl<'a> Place<'a> {
    /// The place that a host names.
    ///
    /// # Errors
    /// What is wrong with it, and what would be right.
    ///
    /// # Safety
    /// `location` is null or a string that ends with a null and lives as long as the result.
    pub(super) unsafe fn of(
        kind: clap_preset_discovery_location_kind,
        location: *const c_char,
    ) -> Result<Self, String> {
        // SAFETY: as the caller promises.
        let location = (!location.is_null()).then(|| unsafe { text(location) }.ok_or("the location is not UTF-8"));
        match (kind, location.transpose()?.unwrap_or_default()) {
            (CLAP_PRESET_DISCOVERY_LOCATION_PLUGIN, "") => Ok(Self::Factory),
            (CLAP_PRESET_DISCOVERY_LOCATION_PLUGIN, other) => {
                Err(format!("‘{other}’: expected no location with the kind ‘plugin’"))
            }
            (CLAP_PRESET_DISCOVERY_LOCATION_FILE, "") => Err("expected the path of a preset or kit file".to_owned()),
            (CLAP_PRESET_DISCOVERY_LOCATION_FILE, path) => Ok(Self::File(path)),
            (other, _) => Err(format!("location kind {other} is unknown: expected 0, a file, or 1, the plugin")),
        }
    }
}
