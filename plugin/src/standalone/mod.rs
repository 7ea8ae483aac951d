//! The standalone program: the plugin's window with a sound device of its own, whose state is kept between runs.
//!
//! | module | holds |
//! |---|---|
//! | `player` | the audio thread |
//! | `chosen` | the choice of the device: from the command line or from the last run |
//! | `host` | the window's host in this program |
//! | `supervisor` | follows devices and ports, and saves the state |
//! | `store` | the files of the state and of the choice of devices |
//! | `signals` | Ctrl-C |
//! | `messages` | messages for the user |
//! | `console` | where they go on Windows |

mod chosen;
#[cfg(windows)]
mod console;
mod host;
mod messages;
mod player;
mod signals;
mod store;
mod supervisor;

use crate::devices::Chosen;
use crate::editor::SprungEditor;
use crate::params::SprungParams;
use crate::state::State;
use chosen::{open_first, systems};
use clap::Parser;
use host::Alone;
use messages::{print, report};
use sprung::internals::realtime::{device, midi_ports};
use sprung::preset::Playable;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use store::Store;
use supervisor::{Opened, Supervisor};

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
    /// MIDI ports to listen to: all, none, or those with this in their name [default: those of the last time, or all]
    #[arg(long, value_name = "NAME|all|none")]
    midi_in: Option<String>,
    /// Sound device, by its name or a part of it. See --list [default: that of the last time, or the system's]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Sound system, such as alsa, jack, wasapi or coreaudio: --list shows those that are here
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
    #[cfg(windows)]
    console::attach();
    match start(Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            print(&format!("error: {error}"));
            #[cfg(windows)]
            console::show(&error);
            ExitCode::FAILURE
        }
    }
}

fn start(args: Args) -> Result<(), String> {
    device::silence_library();
    if args.list {
        use std::io::Write as _;
        let text = device::list() + &midi_ports::list();
        return std::io::stdout().write_all(text.as_bytes()).map_err(|error| format!("stdout: {error}"));
    }
    let params = Arc::new(SprungParams::of_instrument());
    let mut store = Store::of_user();
    report(&params, store.restore(&params));
    if let Some(name) = &args.sound {
        let playable = Playable::find(name).map_err(|error| error.to_string())?;
        params.load(State::new(playable, 0, params.view()).into());
    }
    let (last, message) = store.saved_devices();
    report(&params, message);
    let given =
        Chosen { host: args.host, device: args.device, rate: args.rate, buffer: args.buffer, midi_in: args.midi_in };
    let open = |chosen: &Chosen| Opened::of(chosen, &params);
    let (chosen, opened) = match open_first(given, last, open, systems, |message| report(&params, Some(message))) {
        Ok((chosen, opened)) => (chosen, Some(opened)),
        Err((error, None)) => return Err(error),
        Err((error, Some(chosen))) => {
            report(&params, Some(format!("silent until a device is chosen or plugged in: {error}")));
            params.link().devices.want();
            (chosen, None)
        }
    };
    if let Some(opened) = &opened {
        print(&format!("sprung: playing on {}", opened.session.description()));
    }
    signals::catch({
        let params = params.clone();
        move || params.link().close()
    })?;
    let is_closed = Arc::new(AtomicBool::new(false));
    let supervisor = Supervisor { params: params.clone(), store, is_closed: is_closed.clone(), chosen };
    let supervisor = std::thread::spawn(move || supervisor.run(opened));
    let closed = SprungEditor::new(params).run(Alone::context());
    is_closed.store(true, Relaxed);
    let ended = supervisor.join().map_err(|_| "the thread that looks after the device has failed".to_owned())?;
    let has_display = !cfg!(target_os = "linux") || std::env::var_os("DISPLAY").is_some();
    closed.map_err(|error| match has_display {
        true => format!("the window cannot be shown: {error}"),
        false => "the window cannot be shown: there is no X11 display, since DISPLAY is not set".to_owned(),
    })?;
    ended
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_sound() {
        Args::command().debug_assert();
        let args = Args::parse_from(["x", "Kick", "--rate", "44100", "--host", "jack"]);
        assert_eq!((args.sound.as_deref(), args.rate, args.midi_in), (Some("Kick"), Some(44_100), None));
        assert!(Args::try_parse_from(["x", "--rate", "10"]).is_err());
    }
}
