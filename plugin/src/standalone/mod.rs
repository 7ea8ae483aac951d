//! The window as a program: it plays on a sound device of its own, and keeps its state between runs.
//!
//! | module | holds |
//! |---|---|
//! | `player` | the audio thread |
//! | `host` | what the window takes for its host |
//! | `kept` | the file of the state |
//! | `signals` | Ctrl-C |

mod host;
mod kept;
mod player;
mod signals;

use crate::editor::SprungEditor;
use crate::params::SprungParams;
use crate::state::State;
use clap::Parser;
use host::Alone;
use kept::Kept;
use player::WindowPlayer;
use sprung::preset::Playable;
use sprung::realtime::{Choice, Found, LiveInputs, LiveSender, MidiIn, Session, Status, device, midi_ports};
use sprung::text::printable;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Time between two looks at devices and ports.
const POLL: Duration = Duration::from_millis(50);

/// Time between two looks at whether there is something to keep.
const KEEP: Duration = Duration::from_secs(5);

/// How long a window that was asked to close may take. One that nobody can see may never do it.
const PATIENCE: Duration = Duration::from_secs(2);

const EXAMPLES: &str = "\
Examples:
  sprung-standalone
  sprung-standalone \"Church Bell\" --midi-in Keystation --buffer 128
  sprung-standalone --host jack --midi-in none
  sprung-standalone --list";

/// Sprung in a window: the plugin as a program.
#[derive(Parser)]
#[command(name = "sprung-standalone", version, after_help = EXAMPLES)]
struct Args {
    /// Factory preset or kit to begin with, by its name [default: the sound of the last time]
    sound: Option<String>,
    /// MIDI ports to listen to: all, none, or those with this in their name
    #[arg(long, default_value = "all", value_name = "NAME|all|none")]
    midi_in: String,
    /// Sound device, by its name or a part of it. See --list
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Sound system: alsa, jack or another that --list shows
    #[arg(long, value_name = "NAME")]
    host: Option<String>,
    /// Sample rate in Hz [default: 48000 if the device has it]
    #[arg(long, value_name = "HZ", value_parser = clap::value_parser!(u32).range(1_000..=768_000))]
    rate: Option<u32>,
    /// Frames per block: fewer make keys answer sooner, more are safer [default: 256 or the nearest there is]
    #[arg(long, value_name = "FRAMES", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    buffer: Option<u32>,
    /// List sound systems, their devices, and MIDI ports
    #[arg(long)]
    list: bool,
}

/// Runs the program with the arguments of its command line, until its window is closed.
#[must_use]
pub fn run() -> ExitCode {
    match start(Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&format!("error: {error}"));
            ExitCode::FAILURE
        }
    }
}

/// Prints a line on stderr, whether or not anybody reads it.
fn complain(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

fn start(args: Args) -> Result<(), String> {
    device::silence_library();
    if args.list {
        use std::io::Write as _;
        let text = device::list() + &midi_ports::list();
        return std::io::stdout().write_all(text.as_bytes()).map_err(|error| format!("stdout: {error}"));
    }
    let params = Arc::new(SprungParams::default());
    let mut kept = Kept::of_user();
    tell(&params, kept.restore(&params));
    if let Some(name) = &args.sound {
        let playable = Playable::find(name).map_err(|error| error.to_string())?;
        params.load(State::new(playable, 0, params.view()).into());
    }
    let choice = Choice { host: args.host, device: args.device, rate: args.rate, buffer: args.buffer };
    let found = Found::find(&choice).map_err(|error| error.to_string())?;
    let status = Arc::new(Status::of(params.link().telemetry.clone()));
    let ([midi, closing], inputs) = LiveInputs::new();
    let player = WindowPlayer::new(found.sample_rate(), params.clone(), inputs, status.clone());
    let is_jack = found.is_jack();
    let session = Session::start(&found, choice, player, status).map_err(|error| error.to_string())?;
    complain(&format!("sprung: playing on {}", session.description()));
    signals::catch({
        let params = params.clone();
        move || params.link().close()
    })?;
    let is_closed = Arc::new(AtomicBool::new(false));
    let keeper = Keeper { params: params.clone(), kept, session, closing, is_closed: is_closed.clone() };
    let wanted = args.midi_in;
    let keeper = std::thread::spawn(move || keeper.run(|| MidiIn::new(&wanted, is_jack, midi)));
    let closed = SprungEditor::new(params).run(Alone::context());
    is_closed.store(true, Relaxed);
    let ended = keeper.join().map_err(|_| "the thread that looks after the device has failed".to_owned())?;
    closed.map_err(|error| format!("the window cannot be shown: {error}"))?;
    ended
}

/// Looks after the device, the ports and the file of the state while the window is open.
struct Keeper {
    params: Arc<SprungParams>,
    kept: Kept,
    session: Session<WindowPlayer>,
    closing: LiveSender,
    /// Whether the window is closed.
    is_closed: Arc<AtomicBool>,
}

impl Keeper {
    fn run(mut self, midi: impl FnOnce() -> MidiIn) -> Result<(), String> {
        let mut midi = midi();
        let mut asked: Option<Instant> = None;
        let mut keep_at = Instant::now() + KEEP;
        // A problem with the file is told once.
        let mut told = false;
        while !self.is_closed.load(Relaxed) {
            tell(&self.params, self.session.poll());
            tell(&self.params, midi.poll());
            if Instant::now() > keep_at {
                keep_at = Instant::now() + KEEP;
                let problem = self.kept.keep_what_changed(&self.params).err();
                let is_new = problem.is_some() && !std::mem::replace(&mut told, problem.is_some());
                tell(&self.params, problem.filter(|_| is_new));
            }
            if self.params.link().is_closing() && asked.get_or_insert_with(Instant::now).elapsed() > PATIENCE {
                break;
            }
            std::thread::sleep(POLL);
        }
        drop(midi);
        if !self.session.finish(&mut self.closing) {
            complain("warning: the sound device does not answer; left it behind");
        }
        let ended = self.kept.keep(&self.params);
        if !self.is_closed.load(Relaxed) {
            // The window's thread still waits for a window that does not close.
            if let Err(error) = &ended {
                complain(&format!("error: {error}"));
            }
            std::process::exit(ended.is_err().into());
        }
        ended
    }
}

/// Tells the user on stderr and in the window.
fn tell(params: &SprungParams, news: impl IntoIterator<Item = String>) {
    for line in news {
        complain(&format!("sprung: {line}"));
        params.link().tell(line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_sound() {
        Args::command().debug_assert();
        let args = Args::parse_from(["x", "Kick", "--rate", "44100", "--host", "jack"]);
        assert_eq!((args.sound.as_deref(), args.rate, args.midi_in.as_str()), (Some("Kick"), Some(44_100), "all"));
        assert!(Args::try_parse_from(["x", "--rate", "10"]).is_err());
    }
}
