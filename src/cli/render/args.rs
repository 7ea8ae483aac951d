//! The options of `sprung render`.

use crate::song::SongArgs;
use crate::sound::SoundArgs;
use crate::{completion, quantity};
use clap::ArgGroup;
use sprung::Result;
use sprung::internals::request::{Request, SongRequest};
use sprung::internals::threads::THREADS;
use sprung::io::{FileFormat, SampleFormat, SongTime, WavFormat};
use sprung::render::{BLOCKS, Job, Level, Tail};
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(group(ArgGroup::new("source").required(true).args(["song", "note"])))]
pub(crate) struct Args {
    /// Standard MIDI file; - is stdin
    pub(super) song: Option<PathBuf>,
    /// Notes to strike together, instead of a song: names (C#4), keys 0-127 (60, 60.5) or frequencies (440Hz)
    #[arg(long, value_delimiter = ',', value_parser = quantity::note, allow_hyphen_values = true)]
    pub(super) note: Vec<String>,
    /// Sound file that drives the notes of sounds with an input_level, from the first frame on, at the rate of the output
    #[arg(long, value_name = "IN.wav")]
    pub(super) input: Option<PathBuf>,
    /// Velocity of the notes, 1-127
    #[arg(long, default_value_t = 100, allow_hyphen_values = true, conflicts_with = "song", value_parser = quantity::whole::<u8>(1..=127))]
    pub(super) velocity: u8,
    /// How long the notes are held, 0-86400 s
    #[arg(long, default_value = "2.0", value_name = "SECONDS", conflicts_with = "song",
        value_parser = quantity::seconds, allow_hyphen_values = true)]
    pub(super) length: f64,
    #[command(flatten)]
    pub(super) reading: SongArgs,
    /// Where to begin: seconds of the song as it is played, or a bar, or a beat in it (bar 9.3). Notes before are not heard, all other
    /// messages are obeyed
    #[arg(long, value_name = "SECONDS|BAR", requires = "song", value_parser = quantity::song_time, allow_hyphen_values = true)]
    pub(super) from: Option<SongTime>,
    /// Where the song ends: seconds or a bar, as --from
    #[arg(long, value_name = "SECONDS|BAR", requires = "song", value_parser = quantity::song_time, allow_hyphen_values = true)]
    pub(super) to: Option<SongTime>,
    #[command(flatten)]
    pub(super) sound: SoundArgs,
    /// Sample rate, 1000-768000 Hz (44100, 44.1k)
    #[arg(long, default_value_t = 48_000, value_name = "HZ", allow_hyphen_values = true, value_parser = quantity::rate)]
    pub(super) rate: u32,
    /// Sample format: 16 or 24 bits, or 32f for floats
    #[arg(long, default_value = "24", value_name = "16|24|32f", value_parser = quantity::bits,
        add = completion::among(&["16", "24", "32f"]))]
    pub(super) bits: SampleFormat,
    /// Add TPDF dither before rounding to 16 or 24 bits
    #[arg(long)]
    pub(super) dither: bool,
    /// Write one channel, (L + R) / 2
    #[arg(long)]
    pub(super) mono: bool,
    /// What follows the song or the notes: auto goes on until the sound has died, none stops at once, or 0-86400 s
    #[arg(long, default_value = "auto", value_name = "auto|none|SECONDS", value_parser = quantity::tail,
        allow_hyphen_values = true, add = completion::among(&["auto", "none"]))]
    pub(super) tail: Tail,
    /// Make a loop without a seam: what sounds after the end goes into the beginning, and a WAV names its loop points
    #[arg(long = "loop", conflicts_with = "stems")]
    pub(super) is_loop: bool,
    /// Write a file for each channel, for each pad or choke group of kits, and for the shared space into this folder. Together they are the
    /// mix before the limiter
    #[arg(long, value_name = "DIR", requires = "song", conflicts_with_all = ["normalize", "figure", "json"])]
    pub(super) stems: Option<PathBuf>,
    /// Bring the peak (-120-0 dBFS) or the integrated loudness (-70-0 LUFS) to a level
    #[arg(long, value_name = "peak=DBFS|lufs=LUFS", value_parser = quantity::level, allow_hyphen_values = true,
        conflicts_with = "gain_db", add = completion::among(&["peak=", "lufs="]))]
    pub(super) normalize: Option<Level>,
    /// Gain, -120-120 dB
    #[arg(long, default_value_t = 0.0, value_name = "DB", value_parser = quantity::gain_db, allow_hyphen_values = true)]
    pub(super) gain_db: f64,
    /// Frames processed at once, 1-65536; the samples do not depend on it
    #[arg(long, default_value_t = 4096, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u32>(*BLOCKS.start() as u64..=*BLOCKS.end() as u64))]
    pub(super) block: u32,
    /// Threads to work on, 1-256; the samples do not depend on it [default: one a core]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u16>((*THREADS.start()).into()..=(*THREADS.end()).into()))]
    pub(super) threads: Option<u16>,
    /// Draw waveform, spectrogram and, of single notes, modes, as PNG or SVG
    #[arg(long, value_name = "FILE.png|FILE.svg")]
    pub(super) figure: Option<PathBuf>,
    /// Overwrite existing files
    #[arg(long)]
    pub(super) force: bool,
    /// Print a report as JSON to stdout, or to stderr if stdout gets the WAV
    #[arg(long)]
    pub(super) json: bool,
    /// Format of the files [default: what the name of the output says, else wav]
    #[arg(long, value_name = "wav|flac", value_parser = quantity::file_format, add = completion::among(&["wav", "flac"]))]
    pub(super) format: Option<FileFormat>,
    /// WAV or FLAC file, device or named pipe to write; - is stdout
    #[arg(short, long, value_name = "OUT.wav|OUT.flac|-", required_unless_present = "stems", conflicts_with = "stems")]
    pub(super) output: Option<PathBuf>,
}

impl Args {
    pub(super) fn request(&self) -> Request {
        Request {
            song: self.song.clone(),
            note: self.note.clone(),
            input: self.input.clone(),
            velocity: self.velocity,
            length: self.length,
            reading: SongRequest { from: self.from, to: self.to, ..self.reading.request() },
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

    /// Checks that a rendering fits into a file format, as far as its length is known.
    pub(super) fn check_length(&self, format: FileFormat, job: &Job) -> Result<()> {
        let channels = if self.mono { 1 } else { 2 };
        let wav = WavFormat { sample_rate: self.rate, channels, samples: self.bits };
        format.check_length(&wav, if self.is_loop { job.song_frames() } else { job.least_frames() })
    }
}
