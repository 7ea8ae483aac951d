//! A digest of a render: a few lines of text that show whether two renders have the same bits, and what changed if not.

use super::{
    level,
    spectrum::{BAND_CENTRES, band_levels},
};
use crate::error::{Error, Result};
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;
use toml::{Table, Value};

/// Frames that share one short hash.
pub(crate) const CHUNK: usize = 4096;

/// The digest of a stereo render.
#[derive(Clone, Debug, PartialEq)]
pub struct Digest {
    /// Length.
    pub frames: usize,
    /// Hz.
    pub(crate) sample_rate: f64,
    /// SHA-256, in hexadecimal, over the little-endian bits of the interleaved `f32` samples.
    pub sha256: String,
    /// Largest magnitude of each channel in dBFS.
    pub(crate) peak_db: [f64; 2],
    /// RMS of each channel in dBFS.
    pub(crate) rms_db: [f64; 2],
    /// Mean of each channel.
    pub(crate) dc: [f64; 2],
    /// Levels of the octaves from 62.5 Hz to 8 kHz in dBFS, mean power of both channels.
    pub(crate) bands_db: [f64; 8],
    /// The first eight digits of the SHA-256 of each 4,096 frames.
    pub chunks: Vec<String>,
}

/// The changes from one digest to another, the most important first.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// First frame of the first chunk that differs; none if only the sample rate differs.
    pub first_frame: Option<usize>,
    /// One phrase per change.
    pub changes: Vec<String>,
}

impl std::fmt::Display for Drift {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.changes.join("; "))
    }
}

impl Digest {
    /// The digest of two channels of equal length.
    pub fn of(left: &[f32], right: &[f32], sample_rate: f64) -> Self {
        let mut whole = Sha256::new();
        let mut chunks = Vec::new();
        for (left, right) in left.chunks(CHUNK).zip(right.chunks(CHUNK)) {
            let bytes: Vec<u8> =
                left.iter().zip(right).flat_map(|(l, r)| [l.to_le_bytes(), r.to_le_bytes()]).flatten().collect();
            whole.update(&bytes);
            chunks.push(hexadecimal(&Sha256::digest(&bytes)[..4]));
        }
        let bands = [left, right].map(|channel| band_levels(channel, sample_rate));
        let power = |db: f64| libm::pow(10.0, db / 10.0);
        let mean = |band: usize| 10.0 * libm::log10((power(bands[0][band]) + power(bands[1][band])) / 2.0);
        Self {
            frames: left.len(),
            sample_rate,
            sha256: hexadecimal(&whole.finalize()),
            peak_db: [left, right].map(|channel| level::dbfs(level::peak(channel))),
            rms_db: [left, right].map(|channel| level::dbfs(level::rms(channel))),
            dc: [left, right].map(level::dc),
            bands_db: std::array::from_fn(mean),
            chunks,
        }
    }

    /// The digest as TOML, the same text for the same digest. Levels are rounded to a hundredth of a decibel.
    pub fn to_toml(&self) -> String {
        let decibels = |levels: &[f64]| levels.iter().map(|db| format!("{db:.2}")).collect::<Vec<_>>().join(", ");
        let mut text = String::new();
        let mut line = |key: &str, value: String| writeln!(text, "{key} = {value}").expect("a String takes all");
        line("frames", self.frames.to_string());
        line("sample_rate", format!("{:?}", self.sample_rate));
        line("sha256", format!("\"{}\"", self.sha256));
        line("peak_db", format!("[{}]", decibels(&self.peak_db)));
        line("rms_db", format!("[{}]", decibels(&self.rms_db)));
        line("dc", format!("[{:.3e}, {:.3e}]", self.dc[0], self.dc[1]));
        line("bands_db", format!("[{}]", decibels(&self.bands_db)));
        let rows = self.chunks.chunks(8).map(|row| row.iter().map(|hash| format!("\"{hash}\"")).collect::<Vec<_>>());
        let rows: String = rows.map(|row| format!("    {},\n", row.join(", "))).collect();
        line("chunks", format!("[\n{rows}]"));
        text
    }

    /// Reads what [`Digest::to_toml`] wrote; `origin` names the file in errors.
    pub fn parse(text: &str, origin: &str) -> Result<Self> {
        let table: Table = text.parse().map_err(|error| Error::format(origin, format!("{error}")))?;
        let wrong = |key: &str, expected: &str| Error::format(origin, format!("‘{key}’ must be {expected}"));
        let text = |value: &Value| value.as_str().map(str::to_owned);
        let number = |value: &Value| value.as_float().or_else(|| Some(value.as_integer()? as f64));
        let list = |key: &str| table.get(key).and_then(Value::as_array);
        let numbers = |key: &str| -> Option<Vec<f64>> { list(key)?.iter().map(number).collect() };
        let pair = |key: &str| numbers(key)?.try_into().ok();
        let stereo = |key: &str| pair(key).ok_or_else(|| wrong(key, "two numbers"));
        let frames = table.get("frames").and_then(Value::as_integer).and_then(|frames| usize::try_from(frames).ok());
        Ok(Self {
            frames: frames.ok_or_else(|| wrong("frames", "a count"))?,
            sample_rate: table.get("sample_rate").and_then(number).ok_or_else(|| wrong("sample_rate", "a number"))?,
            sha256: table.get("sha256").and_then(text).ok_or_else(|| wrong("sha256", "a text"))?,
            peak_db: stereo("peak_db")?,
            rms_db: stereo("rms_db")?,
            dc: stereo("dc")?,
            bands_db: numbers("bands_db")
                .and_then(|bands| bands.try_into().ok())
                .ok_or_else(|| wrong("bands_db", "eight numbers"))?,
            chunks: list("chunks")
                .and_then(|chunks| chunks.iter().map(text).collect())
                .ok_or_else(|| wrong("chunks", "a list of texts"))?,
        })
    }

    /// Whether `actual` is the same sound, bit for bit: hash, length and rate decide. The other values only describe
    /// the change, since they are rounded and their last digit depends on the machine that measured them.
    pub fn compare(&self, actual: &Digest) -> std::result::Result<(), Drift> {
        let same_rate = self.sample_rate == actual.sample_rate;
        if self.sha256 == actual.sha256 && self.frames == actual.frames && same_rate {
            return Ok(());
        }
        let mut changes = Vec::new();
        if !same_rate {
            changes.push(format!("sample rate {} Hz → {} Hz", self.sample_rate, actual.sample_rate));
        }
        if self.frames != actual.frames {
            changes.push(format!("length {} → {} frames", self.frames, actual.frames));
        }
        let count = self.chunks.len().max(actual.chunks.len());
        let differing: Vec<usize> =
            (0..count).filter(|index| self.chunks.get(*index) != actual.chunks.get(*index)).collect();
        let first_frame = differing.first().map(|chunk| chunk * CHUNK);
        if let Some(first) = first_frame {
            let last = first + CHUNK - 1;
            let number = differing.len();
            changes.push(format!("first differing frame is in {first}–{last}; {number} of {count} chunks differ"));
        }
        changes.extend(self.level_changes(actual));
        Err(Drift { first_frame, changes })
    }

    /// Phrases for the levels that differ after rounding, the largest change first.
    fn level_changes(&self, actual: &Digest) -> Vec<String> {
        let mut changes = Vec::new();
        let mut decibels = |name: String, was: f64, is: f64| {
            if format!("{was:.2}") != format!("{is:.2}") {
                changes.push(((is - was).abs(), format!("{name} {was:.2} → {is:.2} dB")));
            }
        };
        for (channel, name) in ["left", "right"].into_iter().enumerate() {
            decibels(format!("{name} peak"), self.peak_db[channel], actual.peak_db[channel]);
            decibels(format!("{name} RMS"), self.rms_db[channel], actual.rms_db[channel]);
        }
        for (band, centre) in BAND_CENTRES.iter().enumerate() {
            decibels(format!("band {centre} Hz"), self.bands_db[band], actual.bands_db[band]);
        }
        for (channel, name) in ["left", "right"].into_iter().enumerate() {
            let (was, is) = (self.dc[channel], actual.dc[channel]);
            if format!("{was:.3e}") != format!("{is:.3e}") {
                changes.push((0.0, format!("{name} DC {was:.3e} → {is:.3e}")));
            }
        }
        changes.sort_by(|a, b| b.0.total_cmp(&a.0));
        changes.into_iter().map(|(_, phrase)| phrase).collect()
    }
}

/// Bytes in hexadecimal digits.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::uniform;

    fn noise(len: usize) -> Vec<f32> {
        (0..len as u64).map(|n| 0.5 * uniform(1, n)).collect()
    }

    #[test]
    fn the_hash_is_sha_256_of_the_interleaved_bits() {
        // sha256sum of the eight bytes of 1.0 and −2.0.
        let digest = Digest::of(&[1.0], &[-2.0], 48_000.0);
        assert_eq!(digest.sha256, hexadecimal(&Sha256::digest([0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0])));
        assert_eq!(digest.chunks, [&digest.sha256[..8]]);
        let empty = Digest::of(&[], &[], 48_000.0);
        assert!(empty.sha256.starts_with("e3b0c44298fc1c14") && empty.chunks.is_empty());
    }

    #[test]
    fn text_goes_both_ways() {
        for len in [0, 1, 5000, 50_000] {
            let digest = Digest::of(&noise(len), &noise(len), 44_100.0);
            let text = digest.to_toml();
            let read = Digest::parse(&text, "test").unwrap();
            assert_eq!(read.to_toml(), text);
            assert_eq!(digest.compare(&read), Ok(()));
        }
    }

    #[test]
    fn a_drift_names_chunk_and_changes() {
        let samples = noise(20_000);
        let mut other = samples.clone();
        other[9000] += 1e-6;
        let (expected, actual) = (Digest::of(&samples, &samples, 48_000.0), Digest::of(&samples, &other, 48_000.0));
        let drift = expected.compare(&actual).unwrap_err();
        assert_eq!(drift.first_frame, Some(8192));
        assert!(drift.to_string().contains("in 8192–12287; 1 of 5 chunks differ"), "{drift}");

        let quiet: Vec<f32> = samples.iter().map(|sample| sample * 0.5).collect();
        let drift = expected.compare(&Digest::of(&samples, &quiet, 48_000.0)).unwrap_err();
        assert!(drift.changes.iter().any(|change| change.starts_with("right RMS")), "{drift}");
        let drift = expected.compare(&Digest::of(&samples[..100], &samples[..100], 48_000.0)).unwrap_err();
        assert_eq!(drift.changes[0], "length 20000 → 100 frames");
    }

    #[test]
    fn bad_text_is_refused_with_its_name_and_key() {
        let text = Digest::of(&[1.0], &[1.0], 48_000.0).to_toml();
        for (from, to, expected) in [
            ("frames = 1", "frames = -1", "x.toml: ‘frames’ must be a count"),
            ("peak_db = [", "peak_db = [1.0, ", "x.toml: ‘peak_db’ must be two numbers"),
            ("sha256", "sha", "x.toml: ‘sha256’ must be a text"),
        ] {
            let error = Digest::parse(&text.replace(from, to), "x.toml").unwrap_err();
            assert_eq!(error.to_string(), expected);
        }
        assert!(Digest::parse("= 1", "x.toml").unwrap_err().to_string().starts_with("x.toml: "));
    }
}
