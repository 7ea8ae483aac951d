//! Writes WAV files: 16- and 24-bit integers with or without dither, and 32-bit floats.

use super::quantise::quantise;
use super::riff;
use super::sampler_chunk::{Loop, sampler_chunk};
use super::wav_format::{SampleFormat, WavFormat};
use crate::dsp::random;
use crate::error::{Error, Result};
use std::io::{BufWriter, Seek, SeekFrom, Write};

/// Writes blocks of frames to a WAV file: RIFF up to 4 GiB, RF64 (EBU Tech 3306) for longer files.
pub struct WavWriter<W: Write + Seek> {
    out: BufWriter<W>,
    name: String,
    format: WavFormat,
    /// One stream of random numbers per channel.
    dither: Option<[u64; 2]>,
    frames: u64,
    expected: Option<u64>,
    clipped: u64,
    /// The chunks after the samples.
    further: Vec<u8>,
}

impl<W: Write + Seek> WavWriter<W> {
    /// Starts a file on `out`, which must be empty and seekable. It need not be seekable if `frames`, the exact length,
    /// is given: the file is then written from start to end. `name` is used in errors. `dither` is the seed of
    /// triangular noise of ±1 step that is added before rounding to integers (TPDF; Lipshitz, Wannamaker and Vanderkooy
    /// 1992). Floats are not rounded and get no noise.
    ///
    /// # Errors
    /// [`Error::Io`] if the header cannot be written, [`Error::Value`] as `WavFormat::file_len`.
    pub fn new(out: W, name: &str, format: WavFormat, dither: Option<u64>, frames: Option<u64>) -> Result<Self> {
        Self::open(out, name, format, dither, frames, Vec::new())
    }

    /// As [`WavWriter::new`], with a loop for samplers, which play the sound as it is on `key`. The length must be known.
    ///
    /// # Errors
    /// As [`WavWriter::new`].
    pub(crate) fn looped(
        out: W,
        name: &str,
        format: WavFormat,
        dither: Option<u64>,
        frames: u64,
        looped: &Loop,
        key: u8,
    ) -> Result<Self> {
        Self::open(out, name, format, dither, Some(frames), sampler_chunk(format.sample_rate, looped, key))
    }

    fn open(
        out: W,
        name: &str,
        format: WavFormat,
        dither: Option<u64>,
        frames: Option<u64>,
        further: Vec<u8>,
    ) -> Result<Self> {
        format.file_len(frames.unwrap_or(0))?;
        let mut out = BufWriter::with_capacity(1 << 16, out);
        let header = riff::header_with(&format, frames.unwrap_or(0), further.len() as u64);
        out.write_all(&header).map_err(|source| Error::io(name, source))?;
        let dither = dither.map(|seed| [random::key(seed, 0), random::key(seed, 1)]);
        Ok(Self { out, name: name.to_owned(), format, dither, frames: 0, expected: frames, clipped: 0, further })
    }

    /// Appends a block: one slice per channel (the second is ignored for a file with one channel); 1.0 is full scale.
    /// Integers are rounded to the nearest step and clipped.
    ///
    /// # Errors
    /// [`Error::Io`] if writing fails.
    pub fn write(&mut self, left: &[f32], right: &[f32]) -> Result<()> {
        let bits = self.format.samples.bits();
        let channels = &[left, right][..self.format.channels.into()];
        let frames = channels.iter().map(|samples| samples.len()).min().unwrap_or(0);
        for index in 0..frames {
            let n = self.frames + index as u64;
            for (channel, samples) in channels.iter().enumerate() {
                let sample = samples[index];
                match self.format.samples {
                    SampleFormat::Float32 => hound::Sample::write(sample, &mut self.out, bits),
                    _ => hound::Sample::write(self.quantise(sample, channel, n), &mut self.out, bits),
                }
                .map_err(|error| wav_error(&self.name, error))?;
            }
        }
        self.frames += frames as u64;
        Ok(())
    }

    /// Number of samples so far that were clipped. Only integers are.
    pub(crate) fn clipped(&self) -> u64 {
        self.clipped
    }

    /// Completes the file and flushes it.
    ///
    /// # Errors
    /// [`Error::Io`] if writing fails, [`Error::Value`] if the length differs from the one given to [`WavWriter::new`].
    pub fn finish(mut self) -> Result<()> {
        if let Some(expected) = self.expected.filter(|expected| *expected != self.frames) {
            let message = format!("{} frames were written where {expected} were announced", self.frames);
            return Err(Error::value("length", message));
        }
        self.complete().map_err(|source| Error::io(self.name, source))
    }

    fn complete(&mut self) -> std::io::Result<()> {
        if riff::padding(self.frames * self.format.frame_len()) == 1 {
            self.out.write_all(&[0])?;
        }
        self.out.write_all(&self.further)?;
        if self.expected.is_none() {
            self.out.seek(SeekFrom::Start(0))?;
            self.out.write_all(&riff::header(&self.format, self.frames))?;
        }
        self.out.flush()
    }

    fn quantise(&mut self, sample: f32, channel: usize, n: u64) -> i32 {
        let noise = self.dither.map_or(0.0, |keys| {
            let uniform = |n| f64::from(random::uniform(keys[channel], n));
            0.5 * (uniform(2 * n) + uniform(2 * n + 1))
        });
        // A sample of 1.0 is one step above the largest integer. Clipping by that one step is not counted.
        if sample.abs() > 1.0 {
            self.clipped += 1;
        }
        quantise(sample, self.format.samples.bits(), noise)
    }
}

fn wav_error(name: &str, error: hound::Error) -> Error {
    let source = match error {
        hound::Error::IoError(source) => source,
        other => std::io::Error::other(other),
    };
    Error::io(name, source)
}

#[cfg(test)]
mod tests;
