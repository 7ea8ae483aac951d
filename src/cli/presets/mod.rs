//! `sprung presets`: lists, shows and auditions presets and kits, finds those like a recording, and checks preset and kit files.

mod audition;
mod like;
mod list;
mod select;

use crate::completion;
use crate::figure;
use crate::recording::FigureArgs;
use crate::terminal::{complain, print};
use clap::Subcommand;
use clap_complete::ArgValueCompleter;
use sprung::analysis::figure::modes_of;
use sprung::internals::files::Inputs;
use sprung::internals::text::printable;
use sprung::io::Song;
use sprung::params::Param;
use sprung::preset::Playable;
use sprung::render::{Job, Options, Tail};
use sprung::units::{frequency_from_key, note_name};
use sprung::{Error, Result};
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
Examples:
  sprung presets list --family mallet
  sprung presets list --gm
  sprung presets audition --out sounds
  sprung presets like strike.wav --family bell
  sprung presets show Kick > mine.toml
  sprung presets show Marimba --figure marimba.png
  sprung presets check *.toml";

#[derive(clap::Args)]
#[command(arg_required_else_help = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// List the factory presets and kits: name, family, keys, what it is
    List(list::Args),
    /// Render the factory's sounds, with a page that plays them and shows how they measure
    Audition(audition::Args),
    /// Name the presets that sound most like a recording
    Like(like::Args),
    /// Print a preset's file, to start one's own from
    Show {
        /// Name of a factory preset or kit, or a preset or kit file ending in .toml
        #[arg(add = ArgValueCompleter::new(completion::presets))]
        name: OsString,
        #[command(flatten)]
        figure: FigureArgs,
    },
    /// Check preset and kit files and report all that is wrong with each
    Check {
        /// Preset and kit files
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
}

pub(crate) fn run(args: &Args) -> Result<()> {
    match &args.action {
        Action::List(args) => print(&list::list(args)),
        Action::Audition(args) => audition::run(args),
        Action::Like(args) => like::run(args),
        Action::Show { name, figure } => {
            let mut inputs = Inputs::default();
            let playable = load(name, &mut inputs)?;
            inputs.check_stdout()?;
            if let Some(figure) = figure.open(&inputs)? {
                return figure.write(|format| drawn(&playable, format));
            }
            print(&playable.to_toml())
        }
        Action::Check { files } => check(files),
    }
}

/// Loads the preset or kit that the user names.
fn load(name: &OsStr, inputs: &mut Inputs) -> Result<Playable> {
    sprung::internals::request::playable(name, inputs)
}

/// Velocity of the note with which a preset is drawn, and its length in seconds.
const DRAWN_VELOCITY: f32 = 100.0 / 127.0;
const DRAWN_SECONDS: f64 = 2.0;
const DRAWN_RATE: u32 = 48_000;

/// Draws the note of a preset's home key and its modes.
fn drawn(playable: &Playable, format: &str) -> Result<Vec<u8>> {
    let Playable::Preset(preset) = playable else {
        let message = format!(
            "‘{}’ is a kit: expected a preset; ‘sprung render --figure’ draws what a kit plays",
            playable.name()
        );
        return Err(Error::value("--figure", message));
    };
    let home = preset.guide.home;
    let key = f64::from(home);
    let (kit, song) = (preset.kit(), Song::chord(&[key], DRAWN_VELOCITY, DRAWN_SECONDS));
    let options = Options { sample_rate: DRAWN_RATE, seed: 0, block: 4096, tail: Tail::Auto };
    let a4_hz = f64::from(preset.patch.get(Param::Tuning));
    let modes = modes_of(&preset.patch, frequency_from_key(key, a4_hz));
    figure::drawn(&Job::new(&song, &kit, options), &format!("{}: {}", preset.name, note_name(home)), &modes, format)
}

fn check(files: &[PathBuf]) -> Result<()> {
    let (mut wrong, mut inputs) = (0, Inputs::default());
    for path in files {
        let read = Playable::read_lenient(path, &mut |path| inputs.open(path));
        inputs.check_stdout()?;
        let complaints = match read {
            Ok((playable, complaints)) if complaints.is_empty() => {
                let line = format!("{}: ‘{}’ is in order", path.display(), playable.name());
                print(&format!("{}\n", printable(&line)))?;
                continue;
            }
            Ok((_, complaints)) => complaints.into_iter().map(|line| format!("{}: {line}", path.display())).collect(),
            Err(error) => vec![error.to_string()],
        };
        wrong += 1;
        complaints.iter().for_each(|line| complain("error", line));
    }
    if wrong == 0 { Ok(()) } else { Err(Error::value("presets", format!("{wrong} of {} cannot be used", files.len()))) }
}
