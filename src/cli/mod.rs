//! The command line: one file a subcommand.

mod completion;
mod interrupt;
mod lab;
mod manual;
mod parameters;
#[cfg(feature = "realtime")]
mod play;
mod presets;
mod progress;
mod quantity;
mod render;
mod song;
mod tuning;
mod usage;

use clap::{CommandFactory, Parser, Subcommand};
use sprung::text::{printable, printable_lines};
use sprung::{Error, Result};
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// What the shell reports for a program that Ctrl-C has ended.
const INTERRUPTED: u8 = 130;

#[derive(Parser)]
#[command(
    name = "sprung",
    version,
    about = "A synthesizer whose only sound source is a mass on a spring",
    after_help = EXAMPLES,
    arg_required_else_help = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  sprung render song.mid -o song.wav
  sprung render --note C2 --preset Kick -o kick.wav
  sprung presets list
  sprung params
  sprung lab compare -o report.html

Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted.";

#[derive(Subcommand)]
enum Command {
    /// Render a MIDI file or some notes to a WAV file
    #[command(after_help = render::EXAMPLES)]
    Render(Box<render::Args>),
    /// Play live: a MIDI file, a keyboard, or the terminal
    #[cfg(feature = "realtime")]
    #[command(after_help = play::EXAMPLES)]
    Play(Box<play::Args>),
    /// Play live (not in this build)
    #[cfg(not(feature = "realtime"))]
    #[command(hide = true, disable_help_flag = true)]
    Play {
        /// Whatever `play` would take
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        rest: Vec<std::ffi::OsString>,
    },
    /// List, show or check presets
    #[command(after_help = presets::EXAMPLES)]
    Presets(presets::Args),
    /// Print the table of parameters
    #[command(after_help = parameters::EXAMPLES)]
    Params(parameters::Args),
    /// Compare ways to integrate a mass on a spring
    #[command(after_help = lab::EXAMPLES)]
    Lab(lab::Args),
    /// Print a completion script for a shell
    #[command(after_help = completion::EXAMPLES)]
    Completions(completion::Args),
    /// Print the manual page, or write one page per subcommand
    #[command(after_help = manual::EXAMPLES)]
    Man(manual::Args),
}

pub(crate) fn run() -> ExitCode {
    match completion::answer() {
        Ok(true) => return finish(checked(std::io::stdout().flush())),
        Ok(false) => {}
        Err(error) => return usage::refuse(error, &Cli::command()),
    }
    match Cli::try_parse() {
        Ok(cli) => finish(execute(&cli.command)),
        // `--help` and `--version` are no errors, and go to stdout.
        Err(error) if !error.use_stderr() => finish(checked(error.print().and_then(|()| std::io::stdout().flush()))),
        Err(error) => usage::refuse(error, &Cli::command()),
    }
}

fn execute(command: &Command) -> Result<()> {
    match command {
        Command::Render(args) => render::run(args),
        #[cfg(feature = "realtime")]
        Command::Play(args) => play::run(args),
        #[cfg(not(feature = "realtime"))]
        Command::Play { .. } => Err(Error::value(
            "play",
            "this sprung was built without sound devices: expected one built with ‘cargo build --features realtime’; \
             ‘sprung render’ writes a file",
        )),
        Command::Presets(args) => presets::run(args),
        Command::Params(args) => parameters::run(args),
        Command::Lab(args) => lab::run(args),
        Command::Completions(args) => completion::run(args),
        Command::Man(args) => manual::run(args),
    }
}

fn finish(result: Result<()>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain("error", &error);
            if matches!(error, Error::Interrupted) { ExitCode::from(INTERRUPTED) } else { ExitCode::FAILURE }
        }
    }
}

/// Says one line on stderr, with nothing in it that steers the terminal.
fn complain(severity: &str, message: impl Display) {
    complain_lines(&format!("sprung: {severity}: {}\n", printable(&message.to_string())));
}

/// Writes lines to stderr, with nothing in them that steers the terminal. If it is closed, there is nobody left to tell.
fn complain_lines(text: &str) {
    let _ = write!(std::io::stderr(), "{}", printable_lines(text));
}

/// Writes lines to stdout, with nothing in them that steers the terminal.
fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    checked(stdout.write_all(printable_lines(text).as_bytes()).and_then(|()| stdout.flush()))
}

/// What came of writing to stdout. A reader that has gone away, as `head` does, has what it wanted: that is no error.
fn checked(written: std::io::Result<()>) -> Result<()> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::io("stdout", error)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    /// The arguments of a shell's simple command: split at spaces outside quotes, up to a pipe or redirection.
    fn words(line: &str) -> Vec<String> {
        let mut words = Vec::new();
        for (index, part) in line.split(['"', '\'']).enumerate() {
            let quoted = index % 2 == 1;
            match words.last_mut() {
                Some(last) if quoted => *last += part,
                _ => words.extend(part.split_whitespace().map(str::to_owned)),
            }
        }
        words.into_iter().take_while(|word| word != "|" && word != ">").collect()
    }

    #[test]
    fn every_example_is_a_valid_command_line() {
        let examples = [
            EXAMPLES,
            render::EXAMPLES,
            presets::EXAMPLES,
            parameters::EXAMPLES,
            #[cfg(feature = "realtime")]
            play::EXAMPLES,
            lab::EXAMPLES,
            manual::EXAMPLES,
            completion::EXAMPLES,
        ];
        for text in examples {
            let mut lines = text.lines().filter(|line| line.starts_with("  sprung")).peekable();
            assert!(lines.peek().is_some(), "no example in: {text}");
            for example in lines {
                if let Err(error) = Cli::try_parse_from(words(example)) {
                    panic!("{example}: {error}");
                }
            }
        }
    }
}
