//! `sprung play`: plays the instrument live on a sound device.

use super::song::SongArgs;
use super::sound::SoundArgs;
use super::terminal::{complain, complain_lines, print, warn};
use super::{completion, interrupt, quantity, view};
use sprung::engine::telemetry::Load;
use sprung::io::{Inputs, Output, Target};
use sprung::preset::Playable;
use sprung::preset::library::Library;
use sprung::realtime::{
    Choice, Found, KitSender, LiveInputs, LiveSender, MidiIn, Player, Recording, Session, Setup, Status, device,
    midi_ports,
};
use sprung::render::BLOCKS;
use sprung::request::Sounds;
use sprung::text::printable;
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
    /// List sound systems, their devices, and MIDI ports
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
    if args.list {
        return list();
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
    // Keyboards may select any program at any time.
    let sounds = settings.load(song.as_mut(), true, &mut inputs)?;
    if let Some(song) = &song {
        settings.warn(song, &sounds, &mut warn);
    }
    let choice = Choice { host: args.host.clone(), device: args.device.clone(), rate: args.rate, buffer: args.buffer };
    let found = Found::find(&choice)?;
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

fn list() -> Result<()> {
    print(&(device::list() + &midi_ports::list()))
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
        news.extend(self.midi.poll());
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
        say(&summary(&status.telemetry().load(), status.xruns(), sample_rate));
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

fn summary(load: &Load, xruns: u64, sample_rate: u32) -> String {
    format!(
        "played {:.3} s in blocks of {:.0} frames: {} xruns; a block took {:.1} % of its time on average, {:.1} % at most, \
         {} of {} more than all of it",
        load.frames as f64 / f64::from(sample_rate),
        load.frames as f64 / load.blocks.max(1) as f64,
        xruns,
        100.0 * load.mean_share,
        100.0 * load.worst_share,
        load.late_blocks,
        load.blocks,
    )
}
