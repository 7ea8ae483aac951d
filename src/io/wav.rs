//! WAV files: 16- and 24-bit integers with or without dither, and 32-bit floats.

use super::riff::RiffSink;
use crate::dsp::random;
use crate::error::{Error, Result};
use std::io::{BufWriter, Seek, Write};

/// How a sample is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFormat {
    /// 16-bit integers.
    Int16,
    /// 24-bit integers.
    Int24,
    /// 32-bit IEEE floats: the engine's own samples, unrounded and never clipped.
    Float32,
}

impl SampleFormat {
    /// Bits of one sample.
    pub fn bits(self) -> u16 {
        match self {
            Self::Int16 => 16,
            Self::Int24 => 24,
            Self::Float32 => 32,
        }
    }
}

/// What a WAV file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WavFormat {
    /// Frames per second.
    pub sample_rate: u32,
    /// Samples per frame: 1 or 2.
    pub channels: u16,
    /// How samples are stored.
    pub samples: SampleFormat,
}

/// Bytes that the size field of a RIFF chunk counts besides the samples: the larger of hound's headers, and the
/// padding of an odd data chunk.
const HEADER_LEN: u64 = 60 + 1;

impl WavFormat {
    /// Bytes of one frame.
    pub fn frame_len(&self) -> u64 {
        u64::from(self.channels) * u64::from(self.samples.bits() / 8)
    }

    /// Most frames that a file can have: RIFF counts its bytes in 32 bits.
    pub fn max_frames(&self) -> u64 {
        (u64::from(u32::MAX) - HEADER_LEN) / self.frame_len()
    }

    /// Refuses a length that a WAV file cannot have.
    ///
    /// # Errors
    /// [`Error::Value`] with the size that it would be and the longest that it can be.
    pub fn check_frames(&self, frames: u64) -> Result<()> {
        if frames <= self.max_frames() {
            return Ok(());
        }
        let bytes = u128::from(frames) * u128::from(self.frame_len());
        let longest = self.max_frames() as f64 / f64::from(self.sample_rate);
        Err(Error::value(
            "length",
            format!(
                "{frames} frames are {bytes} bytes, and a WAV file holds at most {}: at this rate and these bits, {longest:.0} s",
                u64::from(u32::MAX) - HEADER_LEN
            ),
        ))
    }

    fn spec(&self) -> hound::WavSpec {
        hound::WavSpec {
            channels: self.channels,
            sample_rate: self.sample_rate,
            bits_per_sample: self.samples.bits(),
            sample_format: match self.samples {
                SampleFormat::Float32 => hound::SampleFormat::Float,
                _ => hound::SampleFormat::Int,
            },
        }
    }
}

/// Writes blocks of frames as a WAV.
pub struct WavWriter<W: Write + Seek> {
    hound: hound::WavWriter<RiffSink<BufWriter<W>>>,
    name: String,
    format: WavFormat,
    /// One stream of random numbers per channel.
    dither: Option<[u64; 2]>,
    frames: u64,
    expected: Option<u64>,
    clipped: u64,
}

impl<W: Write + Seek> WavWriter<W> {
    /// Starts a file on `out`, which has to be able to seek unless `frames`, the exact length, is given beforehand.
    /// `name` is what errors call it. `dither` is the seed of triangular noise of ±1 step that is added before rounding to integers (TPDF;
    /// Lipshitz, Wannamaker and Vanderkooy 1992); floats are not rounded and get none.
    ///
    /// # Errors
    /// [`Error::Io`] if the header cannot be written, [`Error::Value`] if `frames` are more than a WAV file holds.
    pub fn new(out: W, name: &str, format: WavFormat, dither: Option<u64>, frames: Option<u64>) -> Result<Self> {
        let data_len = match frames {
            Some(frames) => {
                format.check_frames(frames)?;
                Some((frames * format.frame_len()) as u32)
            }
            None => None,
        };
        let sink = RiffSink::new(BufWriter::with_capacity(1 << 16, out), data_len);
        let hound = hound::WavWriter::new(sink, format.spec()).map_err(|error| wav_error(name, error))?;
        let dither = dither.map(|seed| [random::key(seed, 0), random::key(seed, 1)]);
        Ok(Self { hound, name: name.to_owned(), format, dither, frames: 0, expected: frames, clipped: 0 })
    }

    /// Appends a block: a slice per channel (the second is not looked at in a file of one channel), 1.0 being full
    /// scale. Integers take the nearest step, and beyond full scale the last one.
    ///
    /// # Errors
    /// [`Error::Io`] if writing fails, [`Error::Value`] when the file becomes longer than a WAV file can be.
    pub fn write(&mut self, left: &[f32], right: &[f32]) -> Result<()> {
        self.format.check_frames(self.frames + left.len() as u64)?;
        for (index, pair) in left.iter().zip(right).enumerate() {
            let n = self.frames + index as u64;
            for (channel, sample) in [*pair.0, *pair.1].into_iter().enumerate().take(self.format.channels.into()) {
                match self.format.samples {
                    SampleFormat::Float32 => self.hound.write_sample(sample),
                    _ => {
                        let step = self.quantise(sample, channel, n);
                        self.hound.write_sample(step)
                    }
                }
                .map_err(|error| wav_error(&self.name, error))?;
            }
        }
        self.frames += left.len() as u64;
        Ok(())
    }

    /// Samples beyond full scale so far, of those that were to become integers.
    pub fn clipped(&self) -> u64 {
        self.clipped
    }

    /// Completes the file and writes out all of it.
    ///
    /// # Errors
    /// [`Error::Io`] if writing fails, [`Error::Value`] if the length is not the one that was announced.
    pub fn finish(self) -> Result<()> {
        if let Some(expected) = self.expected.filter(|expected| *expected != self.frames) {
            let message = format!("{} frames were written where {expected} were announced", self.frames);
            return Err(Error::value("length", message));
        }
        self.hound.finalize().map_err(|error| wav_error(&self.name, error))
    }

    fn quantise(&mut self, sample: f32, channel: usize, n: u64) -> i32 {
        let full_scale = f64::from(1u32 << (self.format.samples.bits() - 1));
        let noise = self.dither.map_or(0.0, |keys| {
            let uniform = |n| f64::from(random::uniform(keys[channel], n));
            0.5 * (uniform(2 * n) + uniform(2 * n + 1))
        });
        // Full scale itself is one step beyond the largest integer; that step is not worth a warning.
        if sample.abs() > 1.0 {
            self.clipped += 1;
        }
        (f64::from(sample) * full_scale + noise).round_ties_even().clamp(-full_scale, full_scale - 1.0) as i32
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
mod tests {
    use super::*;
    use std::io::{Cursor, SeekFrom};

    const FORMATS: [SampleFormat; 3] = [SampleFormat::Int16, SampleFormat::Int24, SampleFormat::Float32];

    /// A pipe: what is written stays written.
    #[derive(Default)]
    struct Pipe<'a>(Option<&'a mut Vec<u8>>);

    impl Write for Pipe<'_> {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.as_mut().unwrap().extend(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Pipe<'_> {
        fn seek(&mut self, _: SeekFrom) -> std::io::Result<u64> {
            Err(std::io::ErrorKind::NotSeekable.into())
        }
    }

    fn format(samples: SampleFormat, channels: u16) -> WavFormat {
        WavFormat { sample_rate: 48_000, channels, samples }
    }

    fn write(
        out: impl Write + Seek,
        format: WavFormat,
        dither: Option<u64>,
        frames: Option<u64>,
        samples: &[f32],
    ) -> u64 {
        let mut writer = WavWriter::new(out, "x", format, dither, frames).unwrap();
        let negated: Vec<f32> = samples.iter().map(|sample| -sample).collect();
        for (left, right) in samples.chunks(3).zip(negated.chunks(3)) {
            writer.write(left, right).unwrap();
        }
        let clipped = writer.clipped();
        writer.finish().unwrap();
        clipped
    }

    fn file(format: WavFormat, dither: Option<u64>, samples: &[f32]) -> Vec<u8> {
        let mut out = Cursor::new(Vec::new());
        write(&mut out, format, dither, None, samples);
        out.into_inner()
    }

    fn integers(wav: &[u8]) -> Vec<i32> {
        hound::WavReader::new(wav).unwrap().into_samples().map(|sample| sample.unwrap()).collect()
    }

    #[test]
    fn a_pipe_gets_the_bytes_of_a_file() {
        for samples in FORMATS {
            for channels in [1, 2] {
                for frames in [0, 1, 6, 7] {
                    let signal: Vec<f32> = (0..frames).map(|n| n as f32 * 0.1 - 0.3).collect();
                    let format = format(samples, channels);
                    let mut piped = Vec::new();
                    write(Pipe(Some(&mut piped)), format, Some(1), Some(frames), &signal);
                    let file = file(format, Some(1), &signal);
                    assert_eq!(piped, file, "{format:?} {frames}");

                    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
                    assert_eq!(word(4) + 8, file.len(), "the RIFF chunk is the file");
                    assert_eq!(file.len() % 2, 0, "chunks are padded to even lengths");
                    let reader = hound::WavReader::new(&file[..]).unwrap();
                    assert_eq!((u64::from(reader.duration()), reader.spec()), (frames, format.spec()));
                }
            }
        }
    }

    #[test]
    fn samples_become_the_nearest_step() {
        let signal = [0.0, 0.5, -1.0, 1.0, 1.5, f32::from_bits(1), 1.5 / 32768.0, 2.5 / 32768.0];
        let mut out = Cursor::new(Vec::new());
        let clipped = write(&mut out, format(SampleFormat::Int16, 1), None, None, &signal);
        assert_eq!(integers(out.get_ref()), [0, 16384, -32768, 32767, 32767, 0, 2, 2]);
        assert_eq!(clipped, 1);
        assert_eq!(integers(&file(format(SampleFormat::Int24, 2), None, &[0.25])), [1 << 21, -(1 << 21)]);
    }

    #[test]
    fn floats_are_kept_exactly_and_never_clipped() {
        let signal = [0.1, -3.7, 1e-30, f32::MAX];
        let mut out = Cursor::new(Vec::new());
        assert_eq!(write(&mut out, format(SampleFormat::Float32, 1), Some(1), None, &signal), 0);
        let read: Vec<f32> = hound::WavReader::new(&out.get_ref()[..]).unwrap().samples().map(|s| s.unwrap()).collect();
        assert_eq!(read, signal);
    }

    #[test]
    fn dither_is_triangular_seeded_and_its_own_in_each_channel() {
        let signal = vec![0.25 / 32768.0; 40_000];
        let wav = file(format(SampleFormat::Int16, 2), Some(7), &signal);
        assert_eq!(wav, file(format(SampleFormat::Int16, 2), Some(7), &signal));
        assert_ne!(wav, file(format(SampleFormat::Int16, 2), Some(8), &signal));
        let steps = integers(&wav);
        let left: Vec<f64> = steps.iter().step_by(2).map(|step| f64::from(*step)).collect();
        let right: Vec<f64> = steps.iter().skip(1).step_by(2).map(|step| f64::from(*step)).collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let product = |a: &[f64], b: &[f64]| mean(&a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>());
        assert!((mean(&left) - 0.25).abs() < 0.02, "the signal survives below a step");
        // TPDF's point: the error's power is 1/4 step² (rounding 1/12, noise 1/6) whatever the signal.
        assert!((product(&left, &left) - 0.0625 - 0.25).abs() < 0.02, "{}", product(&left, &left));
        assert!((product(&left, &right) + 0.0625).abs() < 0.02, "{}", product(&left, &right));
    }

    #[test]
    fn more_than_a_wav_holds_is_refused_with_the_number() {
        let format = format(SampleFormat::Float32, 2);
        assert!(format.check_frames(format.max_frames()).is_ok());
        let error = format.check_frames(600_000_000).unwrap_err().to_string();
        assert!(error.contains("4800000000 bytes") && error.contains("at most 4294967234"), "{error}");
        assert!(WavWriter::new(Cursor::new(Vec::new()), "x", format, None, Some(600_000_000)).is_err());
        assert!(format.check_frames(u64::MAX).is_err());
    }

    #[test]
    fn a_length_other_than_announced_is_an_error() {
        let mut out = Vec::new();
        let mut writer =
            WavWriter::new(Pipe(Some(&mut out)), "x", format(SampleFormat::Int16, 1), None, Some(2)).unwrap();
        writer.write(&[0.0], &[0.0]).unwrap();
        assert!(writer.finish().is_err());
    }
}
