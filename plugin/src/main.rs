//! `sprung-standalone`: the plugin's window as a program, with a sound device of its own.

fn main() -> std::process::ExitCode {
    sprung_plugin::standalone::run()
}
