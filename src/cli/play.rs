//! `sprung play`: plays the instrument live on a sound device.

use super::song::SongArgs;
use super::sound::SoundArgs;
use super::terminal::{complain, complain_lines, print, warn};
use super::{completion, interrupt, quantity, view};
use clap_complete::ArgValueCompleter;
use sprung::internals::files::{Inputs, Output, Target};
use sprung::internals::learned::Controllers;
use sprung::internals::library::Library;
use sprung::internals::realtime::Recording;
use sprung::internals::realtime::{device, midi_ports};
use sprung::internals::request::Sounds;
use sprung::internals::text::printable;
use sprung::params::Param;
use sprung::preset::Playable;
use sprung::realtime::{Choice, Found, KitSender, LiveInputs, LiveSender, MidiIn, Player, Session, Setup, Status};
use sprung::render::BLOCKS;
use sprung::{Error, Result};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung play
  sprung play song.mid --preset Kick --record take.wav
  sprung play --midi-in none --buffer 64 --set decay=\"3 s\"
  sprung play --host jack --midi-in Keystation --headless
  sprung play --learn decay=21 --learn space_mix=22
  sprung play --list";

/// Time between two checks of devices, ports and the recording.
const POLL: Duration = Duration::from_millis(20);

#[derive(clap::Args)]
pub(super) struct Args {
    /// Standard MIDI file of type 0 or 1 to play; - is stdin
    song: Option<PathBuf>,
    #[command(flatten)]
    reading: SongArgs,
    #[command(flatten)]
    sound: SoundArgs,
    /// MIDI ports to listen to: all, none, or those with this in their name
    #[arg(long, default_value = "all", value_name = "NAME|all|none", add = completion::among(&["all", "none"]))]
    midi_in: String,
    /// Sound device, by its name or a part of it. See --list
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Sound system, such as alsa, jack, wasapi or coreaudio: --list shows those that are here
    #[arg(long, value_name = "NAME")]
    host: Option<String>,
    /// Sample rate, 1000-768000 Hz (44100, 44.1k) [default: 48000 if the device has it]
    #[arg(long, value_name = "HZ", allow_hyphen_values = true, value_parser = quantity::rate)]
    rate: Option<u32>,
    /// Frames per block, 1-65536: fewer make keys answer sooner, more are safer [default: 256 or the nearest there is]
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true,
        value_parser = quantity::whole::<u32>(*BLOCKS.start() as u64..=*BLOCKS.end() as u64))]
    buffer: Option<u32>,
    /// Have a MIDI controller (1-119) move a parameter, from now on and in the plugin's window as well; may be repeated. See
    /// `sprung params`
    #[arg(long, value_name = "ID=CONTROLLER", value_parser = quantity::learning,
        add = ArgValueCompleter::new(completion::parameters))]
    learn: Vec<(Param, u8)>,
    /// Forget the controller of a parameter; may be repeated
    #[arg(long, value_name = "ID", value_parser = quantity::parameter, add = ArgValueCompleter::new(completion::parameters))]
    forget: Vec<Param>,
    /// List sound systems, their devices, MIDI ports, and the controllers that move parameters
    #[arg(long)]
    list: bool,
    /// Record what is played to a WAV file of 32-bit floats
    #[arg(long, value_name = "OUT.wav")]
    record: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, requires = "record")]
    force: bool,
    /// No terminal view: plain lines on stderr; ends with the song
    #[arg(long)]
    headless: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    device::silence_library();
    let controllers = args.controllers()?;
    if args.list {
        return list(&controllers);
    }
    let headless = args.headless || !std::io::stdout().is_terminal() || !std::io::stdin().is_terminal();
    let record = args.record.as_ref().map(Target::new);
    record.as_ref().map_or(Ok(()), Target::check_wav)?;
    let mut inputs = Inputs::default();
    let (reading, settings) = (args.reading.request(), args.sound.request());
    let mut song = args.song.as_deref().map(|path| reading.read(path, &mut inputs, &mut warn)).transpose()?;
    if let Some(song) = &mut song {
        settings.tuning.overrule(song, &mut warn);
    }
    let choice = Choice { host: args.host.clone(), device: args.device.clone(), rate: args.rate, buffer: args.buffer };
    let found = Found::find(&choice)?;
    // Keyboards may select any program at any time.
    let sounds = settings.load(song.as_mut(), true, &mut inputs)?;
    if let Some(song) = &song {
        settings.warn(song, &sounds, &mut warn);
    }
    let (tap, recording) = match &record {
        Some(target) => {
            let output = Output::create(target, args.force, &inputs)?;
            let (tap, recording) = Recording::start(output, found.sample_rate())?;
            (Some(tap), Some(recording))
        }
        None => (None, None),
    };
    interrupt::catch(true)?;

    let status = Arc::new(Status::default());
    let ([keys, midi, closing], inputs) = LiveInputs::new();
    let has_song = song.is_some();
    let Sounds { kit, channels, programs, mix, tuning, .. } = &sounds;
    let midi = if programs.is_empty() { midi } else { midi.with_banks() };
    let (sample_rate, seed) = (found.sample_rate(), args.sound.seed);
    let setup = Setup { sample_rate, seed, kit, channels, programs, mix: mix.as_ref(), tuning, song };
    let (player, kits) = Player::new(setup, inputs, tap, status.clone());
    let player = player.with_controllers(&controllers);
    let session = match Session::start(&found, choice, player, status.clone()) {
        Ok(session) => session,
        Err(error) => {
            if let Some(recording) = recording {
                recording.abandon();
            }
            return Err(error);
        }
    };
    let stage = Stage {
        session,
        midi: MidiIn::new(&args.midi_in, found.is_jack(), midi),
        recording: recording.map(|recording| Take { recording, told: false }),
        status,
        has_song,
    };
    let make = Box::new(move |playable: &Playable| settings.kit(playable.clone()));
    if headless { stage.headless(closing) } else { stage.on_terminal(keys, kits, closing, sounds, make) }
}

impl Args {
    /// The controllers that move parameters, after those of the command line are learnt or forgotten.
    fn controllers(&self) -> Result<Controllers> {
        let forgotten = self.forget.iter().map(|param| (*param, None));
        let changes = forgotten.chain(self.learn.iter().map(|(param, controller)| (*param, Some(*controller))));
        let Some(library) = Library::of_user() else {
            let message = "the system names no folder for controllers: expected a home folder";
            let option = if self.learn.is_empty() { "--forget" } else { "--learn" };
            return if changes.count() > 0 { Err(Error::value(option, message)) } else { Ok(Controllers::new()) };
        };
        for (param, controller) in changes {
            library.set_controller(param, controller)?;
        }
        // Playing goes on without them.
        Ok(library.controllers().unwrap_or_else(|error| {
            complain("warning", format_args!("no controller moves a parameter: {error}"));
            Controllers::new()
        }))
    }
}

fn list(controllers: &Controllers) -> Result<()> {
    let learnt: String = match controllers.is_empty() {
        true => "  none\n".to_owned(),
        false => {
            controllers.iter().map(|(number, param)| format!("  --learn {}={number}\n", param.info().id)).collect()
        }
    };
    print(&(device::list() + &midi_ports::list() + "Controllers of parameters\n" + &learnt))
}

/// Prints a line on stderr.
fn say(line: &str) {
    complain_lines(&format!("sprung: {}\n", printable(line)));
}

/// A recording, and whether its early end was reported.
struct Take {
    recording: Recording,
    told: bool,
}

/// Everything that is playing.
struct Stage {
    session: Session,
    midi: MidiIn,
    recording: Option<Take>,
    status: Arc<Status>,
    has_song: bool,
}

impl Stage {
    /// Checks devices, ports and the recording. Returns messages for the user.
    fn poll(&mut self) -> Vec<String> {
        let mut news: Vec<String> = self.session.poll().into_iter().collect();
        news.extend(self.midi.poll().into_iter().map(|message| message.unwrap_or_else(|problem| problem)));
        if let Some(take) = &mut self.recording
            && take.recording.has_ended()
            && !std::mem::replace(&mut take.told, true)
        {
            news.push("recording has stopped: the file cannot be written any further; playing goes on".to_owned());
        }
        news
    }

    fn headless(mut self, closing: LiveSender) -> Result<()> {
        say(&format!("playing on {}; Ctrl-C ends", self.session.description()));
        while interrupt::check().is_ok() && !(self.has_song && self.status.is_song_over()) {
            self.poll().iter().for_each(|line| say(line));
            std::thread::sleep(POLL);
        }
        self.finish(closing)
    }

    fn on_terminal(
        mut self,
        keys: LiveSender,
        kits: KitSender,
        closing: LiveSender,
        sounds: Sounds,
        make: view::MakeKit,
    ) -> Result<()> {
        let (device, status) = (self.session.description().to_owned(), self.status.clone());
        let Sounds { kit, channels, programs, .. } = sounds;
        let desk =
            view::Desk { device, status, keys, kits, kit, channels, programs, make, library: Library::of_user() };
        let news = view::run(desk, || interrupt::check().is_err(), || self.poll());
        let ended = self.finish(closing);
        news.and(ended)
    }

    /// Releases the notes, ends the stream and completes the recording.
    fn finish(self, mut closing: LiveSender) -> Result<()> {
        let Self { session, recording, status, midi, .. } = self;
        let sample_rate = session.sample_rate();
        drop(midi);
        if !session.finish(&mut closing) {
            complain("warning", "the sound device does not answer; left it behind");
        }
        say(&summary(&status, sample_rate));
        let Some(Take { recording, .. }) = recording else { return Ok(()) };
        let recorded = recording.finish()?;
        let seconds = recorded.frames as f64 / f64::from(sample_rate);
        say(&format!("recorded {} frames ({seconds:.3} s)", recorded.frames));
        if recorded.lost > 0 {
            complain(
                "warning",
                format_args!("the disk was too slow: {} frames are missing in the recording", recorded.lost),
            );
        }
        recorded.problem.map_or(Ok(()), Err::<(), Error>)
    }
}

fn summary(status: &Status, sample_rate: u32) -> String {
    let load = status.telemetry().load();
    format!(
        "played {:.3} s in blocks of {:.0} frames, heard {:.1} ms after their keys: {} xruns; a block took {:.1} % of its \
         time on average, {:.1} % at most, {} of {} more than all of it",
        load.frames as f64 / f64::from(sample_rate),
        load.frames as f64 / load.blocks.max(1) as f64,
        1000.0 * status.delay(),
        status.xruns(),
        100.0 * load.mean_share,
        100.0 * load.worst_share,
        load.late_blocks,
        load.blocks,
    )
}
