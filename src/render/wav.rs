//! Renders a job into a WAV file: sets channels, level and length, and reports figures of the result.

use super::job::{Job, Rendered};
use super::labels::{Labels, NoteLabel};
use super::meter::{Levels, Meter};
use crate::error::{Error, Result};
use crate::io::{Inputs, Loop, MIDDLE_C, Output, SampleFormat, Target, WavFormat, WavWriter};
use crate::units::{db_from_gain, gain_from_db, mono_from_stereo};
use std::path::Path;
use std::time::Instant;

/// The level of a WAV file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// As rendered, plus a gain in dB.
    Gain(f64),
    /// Scaled so that the largest sample has this level in dBFS.
    Peak(f64),
    /// Scaled to this integrated loudness in LUFS.
    Loudness(f64),
}

/// The format in which a rendering is delivered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delivery {
    /// The sample format.
    pub samples: SampleFormat,
    /// Whether to add TPDF dither before rounding to integers. The dither uses the job's seed.
    pub dither: bool,
    /// Whether to mix both channels to mono, (L + R) / 2.
    pub mono: bool,
    /// The level.
    pub level: Level,
}

impl Default for Delivery {
    /// As the command writes: 24 bits, stereo, as loud as rendered.
    fn default() -> Self {
        Self { samples: SampleFormat::Int24, dither: false, mono: false, level: Level::Gain(0.0) }
    }
}

/// Progress of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Frames rendered or passed over so far, in all passes.
    pub frames: u64,
    /// Minimum number of frames in total, with those before [`Job::from`](super::Job::from). A tail whose length depends on the sound is not included.
    pub expected: u64,
}

/// Figures of the finished file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Format of the file.
    pub format: WavFormat,
    /// Length in frames.
    pub frames: u64,
    /// Length in seconds.
    pub seconds: f64,
    /// Length of the part after the end of the song, in seconds.
    pub tail_seconds: f64,
    /// Largest finite sample in dBFS, before rounding to integers; `None` for silence.
    pub peak_dbfs: Option<f64>,
    /// RMS over all channels, in dB relative to a full-scale square wave; `None` for silence.
    pub rms_dbfs: Option<f64>,
    /// Integrated loudness in LUFS; `None` for silence, for less than 400 ms, and if a sample is not finite.
    pub lufs: Option<f64>,
    /// Number of samples that are infinite or NaN. There should be none; an integer format contains silence or full
    /// scale in their place.
    pub non_finite: u64,
    /// Gain in dB that was applied to reach the [`Level`].
    pub gain_db: f64,
    /// Number of samples beyond full scale, which an integer format clips.
    pub clipped: u64,
    /// The maximum number of simultaneous voices of each channel, added up over all channels: an upper bound of the
    /// number of voices that sounded at the same time.
    pub voices_used: usize,
    /// Largest gain reduction of the limiter, in dB; 0 if it did nothing.
    pub limiter_reduction_db: f64,
    /// Time for which the limiter lowered the sound by more than 0.1 dB, in seconds.
    pub limiter_seconds: f64,
    /// Seconds of sound per second of computing time.
    pub realtime_factor: f64,
}

impl Job<'_> {
    /// Renders into a WAV file of 24 bits, which appears when it is complete, and replaces what was there.
    ///
    /// # Errors
    /// [`Error::Value`] if an option is out of range, [`Error::Io`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<Report> {
        let mut output = Output::create(&Target::Path(path.as_ref().to_owned()), true, &Inputs::default())?;
        let report = to_wav(self, &Delivery::default(), &mut output, |_| Ok(()))?;
        output.commit()?;
        Ok(report)
    }
}

/// Renders a job into `output`. A first pass that only measures is needed if the level depends on the sound, or if the
/// length does and `output` cannot seek. The engine gives the same samples in the second pass. `progress` is called
/// after each block and can end the work by returning an error.
///
/// # Errors
/// [`Error::Value`] if an option is out of range, or if the sound has no level that could be changed; [`Error::Io`],
/// before any work if there is no room for the song alone; and the errors of `progress`.
pub fn to_wav(
    job: &Job,
    delivery: &Delivery,
    output: &mut Output,
    progress: impl FnMut(Progress) -> Result<()> + Send,
) -> Result<Report> {
    write(job, delivery, output, None, Instant::now(), progress)
}

/// What is written into a WAV file.
pub(super) trait Source: Sync {
    /// The job that it comes from.
    fn job(&self) -> &Job<'_>;

    /// Its length in frames, unless that depends on the sound.
    fn known_frames(&self) -> Option<u64>;

    /// Whether the file is a loop as a whole.
    fn is_loop(&self) -> bool;

    /// Hands each block to `sink`, and reads labels. Gives the same samples each time.
    fn play(&self, labels: Option<&mut Labels>, sink: &mut Sink) -> Result<Rendered>;
}

/// Takes blocks, left and right.
pub(super) type Sink<'a> = dyn FnMut(&[f32], &[f32]) -> Result<()> + Send + 'a;

impl Source for Job<'_> {
    fn job(&self) -> &Job<'_> {
        self
    }

    fn known_frames(&self) -> Option<u64> {
        Job::known_frames(self)
    }

    fn is_loop(&self) -> bool {
        false
    }

    fn play(&self, labels: Option<&mut Labels>, sink: &mut Sink) -> Result<Rendered> {
        self.render_labelled(labels, sink)
    }
}

/// Like [`to_wav`]; also returns the labels of all notes in order of their onsets. Their levels are those of the file.
///
/// # Errors
/// As [`to_wav`].
pub(crate) fn to_labelled_wav(
    job: &Job,
    delivery: &Delivery,
    output: &mut Output,
    progress: impl FnMut(Progress) -> Result<()> + Send,
) -> Result<(Report, Vec<NoteLabel>)> {
    let mut labels = Labels::new(job);
    let report = write(job, delivery, output, Some(&mut labels), Instant::now(), progress)?;
    let mut labels = labels.finish();
    let modes = labels.iter_mut().flat_map(|label| &mut label.modes);
    modes.for_each(|mode| mode.level_db += report.gain_db);
    Ok((report, labels))
}

pub(super) fn write(
    source: &impl Source,
    delivery: &Delivery,
    output: &mut Output,
    labels: Option<&mut Labels>,
    started: Instant,
    mut progress: impl FnMut(Progress) -> Result<()> + Send,
) -> Result<Report> {
    let job = source.job();
    let channels = if delivery.mono { 1 } else { 2 };
    let format = WavFormat { sample_rate: job.options.sample_rate, channels, samples: delivery.samples };
    let least_frames = source.known_frames().unwrap_or(job.song_frames());
    output.check_room(format.file_len(least_frames)?)?;

    let length_needed = !output.is_seekable() && source.known_frames().is_none();
    let two_passes = length_needed || !matches!(delivery.level, Level::Gain(_));
    let passed = if source.is_loop() { 0 } else { job.first_frame() };
    let expected = least_frames.saturating_add(passed).saturating_mul(1 + u64::from(two_passes));
    let mut rendered_frames = 0;
    let mut advance = |frames: usize| {
        rendered_frames += job.counted(frames);
        progress(Progress { frames: rendered_frames, expected: expected.max(rendered_frames) })
    };

    let mut length = source.known_frames();
    let mut measured = None;
    if two_passes {
        let mut meter = Meter::new(format.sample_rate, channels)?;
        let mut mix = Mix::new(delivery.mono, 1.0);
        let rendered = source.play(None, &mut |left, right| {
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
    let mut writer = match length.filter(|_| source.is_loop()) {
        None => WavWriter::new(output.stream(), &name, format, dither, announced)?,
        Some(frames) => {
            WavWriter::looped(output.stream(), &name, format, dither, frames, &Loop::whole(frames), MIDDLE_C)?
        }
    };
    let rendered = source.play(labels, &mut |left, right| {
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

/// Lower bound of the reported limiter gain, −200 dB, so that it can be written as a number.
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
            // The loudness meter uses the system's mathematics functions. Rounding makes the gain the same on every
            // machine.
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

/// Applies channel mode and gain, in buffers that are reused for each block. In mono there is no right channel.
pub(super) struct Mix {
    mono: bool,
    gain: f64,
    left: Vec<f32>,
    right: Vec<f32>,
}

impl Mix {
    pub(super) fn new(mono: bool, gain: f64) -> Self {
        Self { mono, gain, left: Vec::new(), right: Vec::new() }
    }

    pub(super) fn apply(&mut self, left: &[f32], right: &[f32]) -> (&[f32], &[f32]) {
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
