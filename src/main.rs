//! The command `sprung`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
