//! A job rendered into a WAV: channels, level and length settled, and the numbers of what came out.

use super::job::Job;
use super::meter::{Levels, Meter};
use crate::error::{Error, Result};
use crate::io::{Output, SampleFormat, WavFormat, WavWriter};
use crate::units::{db_from_gain, gain_from_db, mono_from_stereo};
use std::time::Instant;

/// How loud a WAV is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// As rendered, times a gain in dB.
    Gain(f64),
    /// With the largest sample at this level in dBFS.
    Peak(f64),
    /// With this integrated loudness in LUFS.
    Loudness(f64),
}

/// The form that a rendering is delivered in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delivery {
    /// How samples are stored.
    pub samples: SampleFormat,
    /// Whether to add TPDF dither before rounding to integers; seeded by the job's seed.
    pub dither: bool,
    /// Whether to mix both channels into one, (L + R) / 2.
    pub mono: bool,
    /// How loud.
    pub level: Level,
}

/// How far the work is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Frames rendered so far, in all passes.
    pub frames: u64,
    /// Frames that there will be at least; a tail whose length depends on the sound is not in it.
    pub expected: u64,
}

/// What came out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Format of the file.
    pub format: WavFormat,
    /// Length in frames.
    pub frames: u64,
    /// Length in seconds.
    pub seconds: f64,
    /// How much of it follows the end of the song, in seconds.
    pub tail_seconds: f64,
    /// Largest finite sample in dBFS, before rounding to integers; none for silence.
    pub peak_dbfs: Option<f64>,
    /// RMS over all channels, in dB against a full-scale square wave; none for silence.
    pub rms_dbfs: Option<f64>,
    /// Integrated loudness; none for silence, for less than 400 ms, and if a sample is not finite.
    pub lufs: Option<f64>,
    /// Samples that are infinite or not a number, of which there should be none: an integer format holds silence or
    /// full scale in their place.
    pub non_finite: u64,
    /// Gain that [`Level`] came to, in dB.
    pub gain_db: f64,
    /// Samples beyond full scale that an integer format could not hold.
    pub clipped: u64,
    /// Most voices that sounded at once on each channel, added up over channels: at least as many as ever sounded at
    /// once on all of them together.
    pub voices_used: usize,
    /// Most that the limiter lowered the gain by, in dB; 0 if it had nothing to do.
    pub limiter_reduction_db: f64,
    /// How long it lowered the sound by more than 0.1 dB, in seconds.
    pub limiter_seconds: f64,
    /// Seconds of sound per second of work.
    pub realtime_factor: f64,
}

/// Renders a job into `output`. A level that depends on the sound, and a length that does while the output cannot be
/// gone back to, take a first pass that only measures; the engine gives the same samples in the second.
/// `progress` is called after each block and can end the work with an error.
///
/// # Errors
/// [`Error::Value`] if an option is out of range, or there is nothing to bring to a level; [`Error::Io`], before any
/// work if there is no room for the song alone; those of `progress`.
pub fn to_wav(
    job: &Job,
    delivery: &Delivery,
    output: &mut Output,
    mut progress: impl FnMut(Progress) -> Result<()> + Send,
) -> Result<Report> {
    let started = Instant::now();
    let channels = if delivery.mono { 1 } else { 2 };
    let format = WavFormat { sample_rate: job.options.sample_rate, channels, samples: delivery.samples };
    let least_frames = job.known_frames().unwrap_or(job.song_frames());
    output.check_room(format.file_len(least_frames)?)?;

    let length_needed = !output.is_seekable() && job.known_frames().is_none();
    let two_passes = length_needed || !matches!(delivery.level, Level::Gain(_));
    let expected = least_frames * (1 + u64::from(two_passes));
    let mut rendered_frames = 0;
    let mut advance = |frames: usize| {
        rendered_frames += frames as u64;
        progress(Progress { frames: rendered_frames, expected: expected.max(rendered_frames) })
    };

    let mut length = job.known_frames();
    let mut measured = None;
    if two_passes {
        let mut meter = Meter::new(format.sample_rate, channels)?;
        let mut mix = Mix::new(delivery.mono, 1.0);
        let rendered = job.render(|left, right| {
            let (left, right) = mix.apply(left, right);
            meter.add(left, right)?;
            advance(left.len())
        })?;
        length = Some(rendered.frames);
        measured = Some(meter.levels().with_non_finite(rendered.limiter.non_finite));
    }
    let gain_db = gain_db(delivery.level, measured)?;

    let mut meter = Meter::new(format.sample_rate, channels)?;
    let mut mix = Mix::new(delivery.mono, gain_from_db(gain_db));
    let dither = delivery.dither.then_some(job.options.seed);
    let name = output.name().to_owned();
    let announced = length.filter(|_| !output.is_seekable());
    let mut writer = WavWriter::new(output.stream(), &name, format, dither, announced)?;
    let rendered = job.render(|left, right| {
        let (left, right) = mix.apply(left, right);
        meter.add(left, right)?;
        writer.write(left, right)?;
        advance(left.len())
    })?;
    let clipped = writer.clipped();
    writer.finish()?;

    let levels = meter.levels().with_non_finite(rendered.limiter.non_finite);
    let decibels = |amplitude: f64| (amplitude > 0.0).then(|| db_from_gain(amplitude));
    let seconds = rendered.frames as f64 / f64::from(format.sample_rate);
    Ok(Report {
        format,
        frames: rendered.frames,
        seconds,
        tail_seconds: rendered.tail_frames as f64 / f64::from(format.sample_rate),
        peak_dbfs: decibels(levels.peak),
        rms_dbfs: decibels(levels.rms),
        lufs: levels.lufs,
        non_finite: levels.non_finite,
        gain_db,
        clipped,
        voices_used: rendered.voices_used,
        limiter_reduction_db: 0.0 - db_from_gain(rendered.limiter.least_gain.max(LEAST_GAIN)),
        limiter_seconds: rendered.limiter.frames as f64 / f64::from(format.sample_rate),
        realtime_factor: seconds / started.elapsed().as_secs_f64().max(1e-9),
    })
}

/// What the limiter's work is told down to, −200 dB, so that it can be written as a number.
const LEAST_GAIN: f64 = 1e-10;

fn gain_db(level: Level, measured: Option<Levels>) -> Result<f64> {
    let silent = || Error::value("normalize", "the sound is silent and has no level to change");
    match (level, measured) {
        (Level::Gain(gain_db), _) => Ok(gain_db),
        (_, Some(Levels { non_finite: 1.., .. })) => Err(Error::value(
            "normalize",
            "the sound has samples that are infinite or not a number, so it has no level to change",
        )),
        (Level::Peak(target), Some(levels)) if levels.peak > 0.0 => Ok(target - db_from_gain(levels.peak)),
        (Level::Loudness(target), Some(Levels { lufs: Some(lufs), .. })) => {
            // The loudness meter uses the system's mathematics. Rounded, the gain is the same on every machine.
            Ok(((target - lufs) * 1000.0).round() / 1000.0)
        }
        (Level::Loudness(_), Some(levels)) if levels.peak > 0.0 => Err(Error::value(
            "normalize",
            "the sound is too short or too quiet to have a loudness: expected at least 400 ms above -70 LUFS, \
             or use peak=…",
        )),
        _ => Err(silent()),
    }
}

/// Settles channels and gain, in buffers that are used again for each block. A sound of one channel has no right one.
struct Mix {
    mono: bool,
    gain: f64,
    left: Vec<f32>,
    right: Vec<f32>,
}

impl Mix {
    fn new(mono: bool, gain: f64) -> Self {
        Self { mono, gain, left: Vec::new(), right: Vec::new() }
    }

    fn apply(&mut self, left: &[f32], right: &[f32]) -> (&[f32], &[f32]) {
        let Self { mono, gain, .. } = *self;
        let scaled = |sample: f32| (f64::from(sample) * gain) as f32;
        self.left.clear();
        self.right.clear();
        if mono {
            let pairs = left.iter().zip(right);
            self.left.extend(pairs.map(|(left, right)| scaled(mono_from_stereo(*left, *right))));
        } else {
            self.left.extend(left.iter().map(|sample| scaled(*sample)));
            self.right.extend(right.iter().map(|sample| scaled(*sample)));
        }
        (&self.left, &self.right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_become_gains() {
        let levels = |peak, lufs| Some(Levels { peak, rms: 0.1, lufs, non_finite: 0 });
        let broken = |peak| Some(Levels { peak, rms: 0.1, lufs: None, non_finite: 1 });
        for (level, measured, expected) in [
            (Level::Gain(-3.0), None, -3.0),
            (Level::Peak(-1.0), levels(1.0, None), -1.0),
            (Level::Loudness(-14.0), levels(0.5, Some(-20.12345)), 6.123),
        ] {
            assert_eq!(gain_db(level, measured).unwrap(), expected);
        }
        for (level, measured, expected) in [
            (Level::Peak(-1.0), levels(0.0, None), "silent"),
            (Level::Loudness(-14.0), levels(0.0, None), "silent"),
            (Level::Loudness(-14.0), levels(0.1, None), "too short"),
            (Level::Peak(-1.0), broken(1.0), "infinite or not a number"),
            (Level::Peak(-1.0), broken(0.0), "infinite or not a number"),
            (Level::Loudness(-14.0), broken(1.0), "infinite or not a number"),
        ] {
            assert!(gain_db(level, measured).unwrap_err().to_string().contains(expected));
        }
    }

    #[test]
    fn a_normalised_peak_is_the_peak_asked_for() {
        for peak in [1.0e-30f32, 0.123_456_7, 0.999, 3.0] {
            let gain_db =
                gain_db(Level::Peak(0.0), Some(Levels { peak: peak.into(), rms: 0.0, lufs: None, non_finite: 0 }))
                    .unwrap();
            let mut mix = Mix::new(false, gain_from_db(gain_db));
            let (left, right) = mix.apply(&[peak, -peak], &[0.0, peak]);
            assert_eq!((left, right), (&[1.0, -1.0][..], &[0.0, 1.0][..]));
        }
    }

    #[test]
    fn unit_gain_changes_no_bit_and_mono_is_the_mean() {
        let samples = [0.1, -0.3, f32::from_bits(1), 7.5];
        assert_eq!(Mix::new(false, 1.0).apply(&samples, &samples), (&samples[..], &samples[..]));
        assert_eq!(Mix::new(true, 2.0).apply(&[0.5, 1.0], &[0.25, -1.0]).0, [0.75, 0.0]);
    }
}
