//! What a sampler instrument is to be like.

use crate::io::{FileFormat, SampleFormat};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// The settings of a sampler instrument.
#[derive(Clone, Debug)]
pub struct Sampling {
    /// The folder for all files. It is created if it does not exist.
    pub folder: PathBuf,
    /// The keys to play; none for those that the preset is meant for. Kits have keys of their own.
    pub keys: Option<RangeInclusive<u8>>,
    /// Semitones from one sampled key to the next, at least 1.
    pub every: u8,
    /// Number of velocity layers, 1–127. Each is sampled at its highest velocity.
    pub velocities: u8,
    /// Number of strikes that alternate, at least 1. Sounds whose strikes are all alike get one.
    pub strikes: u8,
    /// Whether what sounds after a key is let go is sampled too, for the SFZ file.
    pub releases: bool,
    /// Seconds for which a key is held, and the longest sample.
    pub length: f64,
    /// Frames per second.
    pub rate: u32,
    /// The sample format.
    pub bits: SampleFormat,
    /// The format of the files.
    pub format: FileFormat,
    /// Seed of all randomness.
    pub seed: u64,
    /// Whether to resume an interrupted run.
    pub resume: bool,
    /// Number of samples at once; none for one per core.
    pub at_once: Option<u16>,
}
