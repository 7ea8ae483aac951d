//! `sprung-standalone`: the plugin's window as a program, with a sound device of its own.

// Windows would open a console beside the window.
#![windows_subsystem = "windows"]

fn main() -> std::process::ExitCode {
    sprung_plugin::standalone::run()
}
