//! `sprung render`: renders a MIDI file or some notes to a WAV file.

mod figure;
mod report;

use super::progress::Bar;
use super::song::SongArgs;
use super::sound::SoundArgs;
use super::terminal::warn;
use super::{completion, interrupt, quantity, recording};
use clap::ArgGroup;
use sprung::io::{Inputs, Output, SampleFormat, Target};
use sprung::render::{BLOCKS, Level, THREADS, Tail, on_threads, to_wav};
use sprung::request::Request;
use sprung::{Error, Result};
use std::io::IsTerminal;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung render song.mid -o song.wav
  sprung render song.mid --preset mine.toml --normalize lufs=-14 --bits 16 --dither -o song.wav
  sprung render --note C4 --preset Kick --tail none --length 0.5 -o kick.wav
  sprung render --note C4,E4,67.5,440Hz --set decay=\"3 s\" --set mallet_pulse=contact -o chord.wav
  sprung render song.mid --preset Marimba --channel 10=drums.toml --programs none -o song.wav
  sprung render --note C4 --preset Marimba --figure marimba.png -o marimba.wav
  sprung render --note C3 --preset Gong --set input_level=0 --input voice.wav -o spoken.wav
  sprung render song.mid --scale mine.scl --keymap mine.kbm -o song.wav
  sprung render song.mid -o - | flac - -o song.flac";

#[derive(clap::Args)]
#[command(group(ArgGroup::new("source").required(true).args(["song", "note"])))]
pub(super) struct Args {
    /// Standard MIDI file of type 0 or 1; - is stdin
    song: Option<PathBuf>,
    /// Notes to strike together, instead of a song: names (C#4), keys 0-127 (60, 60.5) or frequencies (440Hz)
    #[arg(long, value_delimiter = ',', value_parser = quantity::note, allow_hyphen_values = true)]
    note: Vec<String>,
    /// Sound file that drives the notes of sounds with an input_level, from the first frame on, at the rate of the output
    #[arg(long, value_name = "IN.wav")]
    input: Option<PathBuf>,
    /// Velocity of the notes, 1-127
    #[arg(long, default_value_t = 100, allow_hyphen_values = true, conflicts_with = "song", value_parser = quantity::whole::<u8>(1..=127))]
    velocity: u8,
    /// How long the notes are held, 0-86400 s
    #[arg(long, default_value = "2.0", value_name = "SECONDS", conflicts_with = "song",
        value_parser = quantity::seconds, allow_hyphen_values = true)]
    length: f64,
    #[command(flatten)]
    reading: SongArgs,
    #[command(flatten)]
    sound: SoundArgs,
    /// Sample rate, 1000-768000 Hz (44100, 44.1k)
    #[arg(long, default_value_t = 48_000, value_name = "HZ", allow_hyphen_values = true, value_parser = quantity::rate)]
    rate: u32,
    /// Sample format: 16 or 24 bits, or 32f for floats
    #[arg(long, default_value = "24", value_name = "16|24|32f", value_parser = quantity::bits,
        add = completion::among(&["16", "24", "32f"]))]
    bits: SampleFormat,
    /// Add TPDF dither before rounding to 16 or 24 bits
    #[arg(long)]
    dither: bool,
    /// Write one channel, (L + R) / 2
    #[arg(long)]
    mono: bool,
    /// What follows the song or the notes: auto goes on until the sound has died, none stops at once, or 0-86400 s
    #[arg(long, default_value = "auto", value_name = "auto|none|SECONDS", value_parser = quantity::tail,
        allow_hyphen_values = true, add = completion::among(&["auto", "none"]))]
    tail: Tail,
    /// Bring the peak (-120-0 dBFS) or the integrated loudness (-70-0 LUFS) to a level
    #[arg(long, value_name = "peak=DBFS|lufs=LUFS", value_parser = quantity::level, allow_hyphen_values = true,
        conflicts_with = "gain_db", add = completion::among(&["peak=", "lufs="]))]
    normalize: Option<Level>,
    /// Gain, -120-120 dB
    #[arg(long, default_value_t = 0.0, value_name = "DB", value_parser = quantity::gain_db, allow_hyphen_values = true)]
    gain_db: f64,
    /// Frames processed at once, 1-65536; the samples do not depend on it
    #[arg(long, default_value_t = 4096, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u32>(*BLOCKS.start() as u64..=*BLOCKS.end() as u64))]
    block: u32,
    /// Threads to work on, 1-256; the samples do not depend on it [default: one a core]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u16>((*THREADS.start()).into()..=(*THREADS.end()).into()))]
    threads: Option<u16>,
    /// Draw waveform, spectrogram and, of single notes, modes, as PNG or SVG
    #[arg(long, value_name = "FILE.png|FILE.svg")]
    figure: Option<PathBuf>,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
    /// Print a report as JSON to stdout, or to stderr if stdout gets the WAV
    #[arg(long)]
    json: bool,
    /// WAV file, device or named pipe to write; - is stdout
    #[arg(short, long, value_name = "OUT.wav|-")]
    output: PathBuf,
}

impl Args {
    fn request(&self) -> Request {
        Request {
            song: self.song.clone(),
            note: self.note.clone(),
            input: self.input.clone(),
            velocity: self.velocity,
            length: self.length,
            reading: self.reading.request(),
            sound: self.sound.request(),
            seed: self.sound.seed,
            rate: self.rate,
            bits: self.bits,
            dither: self.dither,
            mono: self.mono,
            tail: self.tail,
            normalize: self.normalize,
            gain_db: self.gain_db,
            block: self.block as usize,
        }
    }
}

pub(super) fn run(args: &Args) -> Result<()> {
    let request = args.request();
    request.check()?;
    let target = Target::new(&args.output);
    if target == Target::Stdout && std::io::stdout().is_terminal() {
        return Err(Error::value("--output", "stdout is a terminal: expected a file, or stdout sent to one"));
    }
    target.check_wav()?;
    let mut inputs = Inputs::default();
    let prepared = request.prepare(&mut inputs, &mut warn)?;
    let job = prepared.job();
    if args.json {
        inputs.check_stdout()?;
    }
    let mut output = Output::create(&target, args.force, &inputs)?;
    let figure = recording::open_figure(args.figure.as_deref(), args.force, &inputs)?;
    interrupt::catch(output.is_seekable())?;
    let mut bar = Bar::new();
    let progress = |progress| {
        bar.show(progress);
        interrupt::check()
    };
    let report = on_threads(args.threads, || to_wav(&job, &prepared.delivery, &mut output, progress))??;
    drop(bar);
    if let Some(figure) = figure {
        let title = target.name();
        figure.write(|format| figure::draw(&args.note, &title, &job, format))?;
    }
    output.commit()?;
    report::tell(&report, &target, args.sound.mix_gain_db, args.json)
}
