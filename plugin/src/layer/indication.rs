//! CLAP's parameter indication: marks at knobs, in the host's colours.
//!
//! The host says which controller a parameter is mapped to and whether it is automated, and the window marks the knob.
//! Parameters that the window does not show, as the effect's own three, have no marks.

use super::c::text;
use super::instance::Instance;
use crate::marks::{Automation, Mapping};
use clap_sys::color::clap_color;
use clap_sys::ext::param_indication::*;
use clap_sys::plugin::clap_plugin;
use sprung::params::PARAMS;
use std::ffi::c_char;

pub(super) static INDICATION: clap_plugin_param_indication =
    clap_plugin_param_indication { set_mapping: Some(set_mapping), set_automation: Some(set_automation) };

/// The number by which hosts know the parameter with an id, as the wrapper makes it. Real-time safe.
pub(super) fn number(id: &str) -> u32 {
    id.bytes().fold(0_u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(byte.into())) & !(1 << 31)
}

/// Place in the table of the parameter that hosts know by this number.
fn index(known: u32) -> Option<usize> {
    PARAMS.iter().position(|info| number(info.id) == known)
}

/// Red, green and blue. A colour that is transparent would not be seen, and counts as none.
///
/// # Safety
/// It is null or a colour.
unsafe fn colour(colour: *const clap_color) -> Option<[u8; 3]> {
    // SAFETY: as the caller promises.
    let colour = unsafe { colour.as_ref() }.filter(|colour| colour.alpha > 0)?;
    Some([colour.red, colour.green, colour.blue])
}

unsafe extern "C" fn set_mapping(
    plugin: *const clap_plugin,
    param: u32,
    has_mapping: bool,
    of: *const clap_color,
    label: *const c_char,
    description: *const c_char,
) {
    // SAFETY: hosts pass the plugin that they got, and colours and strings or null, on the main thread.
    unsafe {
        let (Some(own), Some(index)) = (Instance::of(plugin), index(param)) else { return };
        let owned = |string| text(string).unwrap_or_default().to_owned();
        let mapping =
            has_mapping.then(|| Mapping { colour: colour(of), label: owned(label), description: owned(description) });
        own.params.mark(index, |mark| mark.mapping = mapping);
    }
}

unsafe extern "C" fn set_automation(plugin: *const clap_plugin, param: u32, state: u32, of: *const clap_color) {
    // SAFETY: as above.
    unsafe {
        let (Some(own), Some(index)) = (Instance::of(plugin), index(param)) else { return };
        let automation = match state {
            CLAP_PARAM_INDICATION_AUTOMATION_PRESENT => Some(Automation::Present),
            CLAP_PARAM_INDICATION_AUTOMATION_PLAYING => Some(Automation::Playing),
            CLAP_PARAM_INDICATION_AUTOMATION_RECORDING => Some(Automation::Recording),
            CLAP_PARAM_INDICATION_AUTOMATION_OVERRIDING => Some(Automation::Overriding),
            _ => None,
        };
        let colour = colour(of);
        own.params.mark(index, |mark| mark.automation = automation.map(|automation| (automation, colour)));
    }
}
