//! `sprung-standalone`: the plugin with its own sound device, for trying it without a host.

use nice_plug::prelude::nice_export_standalone;

fn main() -> std::process::ExitCode {
    if nice_export_standalone::<sprung_plugin::Sprung>() {
        std::process::ExitCode::SUCCESS
    } else {
        std::process::ExitCode::FAILURE
    }
}
