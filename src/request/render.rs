//! A request to render, and the loaded data for it.

use super::recording::recording;
use super::song::SongRequest;
use super::sounds::{SoundRequest, Sounds};
use crate::error::{Error, Result};
use crate::io::{Inputs, SampleFormat, Song};
use crate::params::Param;
use crate::render::{Delivery, Job, Level, Options, Tail};
use crate::sound::Kit;
use crate::units::parse_key;
use std::path::{Path, PathBuf};

/// Frames processed at once, unless [`Request::block`] says otherwise.
const BLOCK: usize = 4096;

/// The options of `sprung render`, except its output. The fields have the names of the options.
#[derive(Clone, Debug)]
pub struct Request {
    /// MIDI file; `-` is stdin. Either a song or notes must be given.
    pub song: Option<PathBuf>,
    /// Notes to strike together: names, keys or frequencies.
    pub note: Vec<String>,
    /// Sound file for the input.
    pub input: Option<PathBuf>,
    /// Velocity of the notes, 1–127.
    pub velocity: u8,
    /// How long the notes are held, in seconds.
    pub length: f64,
    /// How the song is read.
    pub reading: SongRequest,
    /// The sounds.
    pub sound: SoundRequest,
    /// Seed of all randomness.
    pub seed: u64,
    /// Frames per second.
    pub rate: u32,
    /// Sample format.
    pub bits: SampleFormat,
    /// Whether to add dither before rounding.
    pub dither: bool,
    /// Whether to deliver one channel.
    pub mono: bool,
    /// The tail after the song or the notes.
    pub tail: Tail,
    /// Level to normalise to, in place of the gain.
    pub normalize: Option<Level>,
    /// Gain in dB.
    pub gain_db: f64,
    /// Frames processed at once. The samples do not depend on it.
    pub block: usize,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            song: None,
            note: Vec::new(),
            input: None,
            velocity: 100,
            length: 2.0,
            reading: SongRequest::default(),
            sound: SoundRequest::default(),
            seed: 0,
            rate: 48_000,
            bits: SampleFormat::Int24,
            dither: false,
            mono: false,
            tail: Tail::Auto,
            normalize: None,
            gain_db: 0.0,
            block: BLOCK,
        }
    }
}

/// All loaded data that a rendering needs.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The song, or the notes as one.
    pub(crate) song: Song,
    /// The sounds.
    pub(crate) sounds: Sounds,
    input: Vec<f32>,
    /// Where the rendering begins, in seconds.
    from: f64,
    options: Options,
    /// How the rendering is delivered.
    pub delivery: Delivery,
}

impl Request {
    /// Returns an error for options that contradict each other. Reads nothing.
    ///
    /// # Errors
    /// [`Error::Value`] that says what would be right.
    pub fn check(&self) -> Result<()> {
        if self.dither && self.bits == SampleFormat::Float32 {
            return Err(Error::value("--dither", "floats are not rounded and need none: expected --bits 16 or 24"));
        }
        if self.song.is_some() != self.note.is_empty() {
            return Err(Error::value("--note", "expected either a song or notes"));
        }
        if self.normalize.is_some() && self.gain_db != 0.0 {
            return Err(Error::value("--normalize", "expected it without --gain-db"));
        }
        self.sound.tuning.check()?;
        self.sound.tuning.check_notes(&self.note)
    }

    /// The files that it may name: song, input, presets and kits, programs, scale and keymap. Names of presets are
    /// included, since they may be files.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        let tuning = &self.sound.tuning;
        let paths = [&self.song, &self.input, &tuning.scale, &tuning.keymap];
        let presets = self.sound.preset.iter().chain([&self.sound.programs]).map(Path::new);
        let channels = self.sound.channels.iter().map(|(_, name)| Path::new(name));
        paths.into_iter().flatten().map(PathBuf::as_path).chain(presets).chain(channels)
    }

    /// Reads the song, the sounds and the input. `warn` is called for each warning.
    ///
    /// # Errors
    /// As [`Request::check`] and [`SoundRequest::load`]; those of files that cannot be read.
    pub fn prepare(&self, inputs: &mut Inputs, warn: &mut dyn FnMut(&str)) -> Result<Prepared> {
        self.check()?;
        let (mut song, from) = match &self.song {
            Some(path) => self.reading.read_part(path, inputs, warn).map(|(song, from)| (Some(song), from))?,
            None => (None, 0.0),
        };
        if let Some(song) = &mut song {
            self.sound.tuning.overrule(song, warn);
        }
        let sounds = self.sound.load(song.as_mut(), false, inputs)?;
        let song = match song {
            Some(song) => song,
            None => self.chord(&sounds.kit)?,
        };
        self.sound.warn(&song, &sounds, warn);
        let input = match &self.input {
            Some(path) => {
                let (recording, name) = recording(path, inputs, warn)?;
                if !sounds.take_input() {
                    warn("--input: no sound has an input_level, so it drives nothing: --set input_level=0 sets one");
                }
                recording.mono_at(self.rate, &name)?
            }
            None => vec![],
        };
        let options = Options { sample_rate: self.rate, seed: self.seed, block: self.block, tail: self.tail };
        let level = self.normalize.unwrap_or(Level::Gain(self.gain_db));
        let delivery = Delivery { samples: self.bits, dither: self.dither, mono: self.mono, level };
        Ok(Prepared { song, sounds, input, from, options, delivery })
    }

    fn chord(&self, kit: &Kit) -> Result<Song> {
        // Frequencies are converted to keys with the sound's own A4, so that 440 Hz is 440 Hz with every sound.
        let a4_hz = f64::from(kit.values().get(Param::Tuning));
        let keys: std::result::Result<Vec<f64>, String> = self.note.iter().map(|note| parse_key(note, a4_hz)).collect();
        let keys = keys.map_err(|message| Error::value("--note", message))?;
        Ok(Song::chord(&keys, f32::from(self.velocity) / 127.0, self.length))
    }
}

impl Prepared {
    /// The job.
    pub fn job(&self) -> Job<'_> {
        let Self { song, sounds: Sounds { kit, channels, programs, mix, tuning, .. }, input, from, options, .. } = self;
        Job { song, kit, channels, programs, mix: mix.as_ref(), tuning, input, from: *from, options: *options }
    }
}
