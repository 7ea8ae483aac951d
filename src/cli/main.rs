//! The command `sprung`. Each subcommand has a file of its own.

mod analyze;
mod batch;
mod completion;
mod diff;
mod figure;
mod fit;
mod interrupt;
mod lab;
mod man;
mod manual;
mod parameters;
#[cfg(feature = "play")]
mod play;
mod presets;
mod progress;
mod recording;
mod render;
mod sample;
mod song;
mod sound;
mod terminal;
mod tuning;
mod usage;
#[cfg(feature = "play")]
mod view;

use clap::{CommandFactory, Parser, Subcommand};
use interrupt::INTERRUPTED;
use sprung::Result;
use sprung::internals::files::DECODER;
use sprung::internals::request::quantity;
use std::io::Write;
use std::process::ExitCode;
use terminal::{checked, complain};

#[derive(Parser)]
#[command(
    name = "sprung",
    version,
    about = "A synthesizer whose only sound source is a mass on a spring",
    after_help = EXAMPLES,
    arg_required_else_help = true
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  sprung render song.mid -o song.wav
  sprung render --note C4 --preset Kick -o kick.wav
  sprung batch jobs.jsonl --out sounds
  sprung sample Marimba -o marimba
  sprung presets list
  sprung params
  sprung manual
  sprung analyze strike.wav
  sprung fit strike.wav -o strike.toml
  sprung diff before.wav after.wav
  sprung lab compare -o report.html

Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted.";

#[derive(Subcommand)]
enum Command {
    /// Render a MIDI file or some notes to a WAV file
    #[command(after_help = render::EXAMPLES)]
    Render(Box<render::Args>),
    /// Render thousands of sounds from a file of jobs, with exact labels
    #[command(after_help = batch::EXAMPLES)]
    Batch(batch::Args),
    /// Make a sampler instrument of a preset or kit
    #[command(after_help = sample::EXAMPLES)]
    Sample(sample::Args),
    /// Play live: a MIDI file, a keyboard, or the terminal
    #[cfg(feature = "play")]
    #[command(after_help = play::EXAMPLES)]
    Play(Box<play::Args>),
    /// Play live (not in this build)
    #[cfg(not(feature = "play"))]
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
    /// Take the recording of a strike apart into its modes
    #[command(after_help = analyze::EXAMPLES)]
    Analyze(analyze::Args),
    /// Make a preset that plays what was recorded
    #[command(after_help = fit::EXAMPLES)]
    Fit(fit::Args),
    /// Compare two sound files
    #[command(after_help = diff::EXAMPLES)]
    Diff(diff::Args),
    /// Compare ways to integrate a mass on a spring
    #[command(after_help = lab::EXAMPLES)]
    Lab(lab::Args),
    /// Print a completion script for a shell
    #[command(after_help = completion::EXAMPLES)]
    Completions(completion::Args),
    /// Print the manual: what each part of the instrument does, with recipes
    #[command(after_help = manual::EXAMPLES)]
    Manual(manual::Args),
    /// Print the page of the command for `man`, or write one page per subcommand
    #[command(after_help = man::EXAMPLES)]
    Man(man::Args),
}

fn main() -> ExitCode {
    // What makes a decoder panic is told as an error of its file.
    let show = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if std::thread::current().name() != Some(DECODER) {
            show(panic);
        }
    }));
    match completion::answer(Cli::command) {
        Ok(true) => return finish(checked(std::io::stdout().flush())),
        Ok(false) => {}
        Err(error) => return usage::refuse(error, &Cli::command()),
    }
    match Cli::try_parse() {
        // A difference is a result with its own exit code, not an error.
        Ok(Cli { command: Command::Diff(args) }) => diff::run(&args),
        // After an interrupt or an error, finished sounds are kept; the exit code and message are the command's own.
        Ok(Cli { command: Command::Batch(args) }) => batch::run(&args),
        Ok(cli) => finish(execute(&cli.command)),
        // `--help` and `--version` are no errors, and go to stdout.
        Err(error) if !error.use_stderr() => finish(checked(error.print().and_then(|()| std::io::stdout().flush()))),
        Err(error) => usage::refuse(error, &Cli::command()),
    }
}

fn execute(command: &Command) -> Result<()> {
    match command {
        Command::Render(args) => render::run(args),
        #[cfg(feature = "play")]
        Command::Play(args) => play::run(args),
        #[cfg(not(feature = "play"))]
        Command::Play { .. } => Err(sprung::Error::value(
            "play",
            "this sprung was built without sound devices: expected one of \
             ‘cargo install --locked --path src/cli --features play’; ‘sprung render’ writes a file",
        )),
        Command::Presets(args) => presets::run(args),
        Command::Sample(args) => sample::run(args),
        Command::Params(args) => parameters::run(args),
        Command::Analyze(args) => analyze::run(args),
        Command::Fit(args) => fit::run(args),
        Command::Batch(_) | Command::Diff(_) => unreachable!("they have exit codes of their own"),
        Command::Lab(args) => lab::run(args),
        Command::Completions(args) => completion::run(args),
        Command::Manual(args) => manual::run(args),
        Command::Man(args) => man::run(args, Cli::command()),
    }
}

fn finish(result: Result<()>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain("error", &error);
            if error.is_interrupt() { ExitCode::from(INTERRUPTED) } else { ExitCode::FAILURE }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    /// Splits a simple shell command into arguments: at spaces outside quotes, up to a pipe or redirection.
    fn words(line: &str) -> Vec<String> {
        let mut words = Vec::new();
        for (index, part) in line.split(['"', '\'']).enumerate() {
            let quoted = index % 2 == 1;
            match words.last_mut() {
                Some(last) if quoted => *last += part,
                _ => words.extend(part.split_whitespace().map(str::to_owned)),
            }
        }
        words.into_iter().take_while(|word| !["|", ">", ">>"].contains(&word.as_str())).collect()
    }

    #[test]
    fn every_example_is_a_valid_command_line() {
        let examples = [
            EXAMPLES,
            render::EXAMPLES,
            batch::EXAMPLES,
            sample::EXAMPLES,
            presets::EXAMPLES,
            parameters::EXAMPLES,
            #[cfg(feature = "play")]
            play::EXAMPLES,
            analyze::EXAMPLES,
            fit::EXAMPLES,
            diff::EXAMPLES,
            lab::EXAMPLES,
            man::EXAMPLES,
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
