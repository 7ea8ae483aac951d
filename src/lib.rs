//! Sprung: a synthesizer whose only sound source is a mass on a spring.
//!
//! One mass is a kick drum or a sine; sixty-four are a marimba or a bell. The signal path, and the order in which
//! to read the crate:
//!
//! | module | holds |
//! |---|---|
//! | [`dsp`] | pure numerics: the oscillator, its coefficients, and the bank of modes |
//! | [`params`], [`patch`], [`preset`] | the parameters, a set of their values with modes and routes, and its file |
//! | [`sound`] | kits, bodies, and the tuning of the keys, also by Scala's files |
//! | [`engine`] | events, the synth, the ensemble of sixteen channels |
//! | [`io`] | songs, MIDI files, and files that are written whole or not at all; WAV files out (feature `render`), sound files in (feature `fit`) |
//! | `render` | the offline renderer (feature `render`) |
//! | `batch` | thousands of sounds from a file of jobs, with exact labels (feature `batch`) |
//! | `analysis` | what sound is measured with: the modes of a recorded strike, differences, spectra (feature `fit`), and figures of them (feature `analysis`) |
//! | `lab` | methods that integrate a mass on a spring, compared with the exact motion and with the oscillator (feature `lab`) |
//! | `sampler` | sampler instruments of presets and kits (feature `batch`) |
//! | `realtime` | sound devices and MIDI ports (feature `live`) |
//!
//! # Notes and songs
//!
//! A preset’s chord as samples, and a song through all of General MIDI as a WAV file (feature `render`):
//!
//! ```
//! # #[cfg(feature = "render")]
//! # fn main() -> sprung::Result<()> {
//! use sprung::io::Song;
//! use sprung::preset::{Preset, Programs};
//! use sprung::render::{Job, Options};
//!
//! let marimba = Preset::find("marimba")?.kit();
//! let [left, right] = Job::new(&Song::chord(&[60.0, 64.0, 67.0], 0.8, 1.0), &marimba, Options::default()).samples()?;
//! assert!(left.len() > 48_000 && left.iter().any(|sample| sample.abs() > 0.01));
//!
//! # let folder = tempfile::tempdir().unwrap();
//! # let path = folder.path().join("song.wav");
//! let song = Song::parse(include_bytes!("../assets/midi/groove.mid"), "groove.mid")?;
//! let instruments = Programs::factory_kits();
//! let job = Job { programs: &instruments, ..Job::new(&song, &marimba, Options::default()) };
//! # let song = Song::chord(&[60.0], 0.8, 1.5);
//! # let job = Job { song: &song, ..job };
//! let report = job.write(path)?;
//! assert!(report.seconds > 1.0);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "render"))]
//! # fn main() {}
//! ```
//!
//! # Live
//!
//! What an audio callback does: it hands on the events of a block, and gets its samples. Nothing in [`engine::Synth::process`]
//! allocates, locks or waits. A game strikes with what its physics engine says of a contact: see [`sound::Sound::strike`].
//!
//! ```
//! use sprung::engine::{Event, Synth};
//! use sprung::params::Param;
//! use sprung::preset::Preset;
//!
//! # fn main() -> sprung::Result<()> {
//! let kick = Preset::find("kick")?.patch.clone().with(Param::Gain, -9.0);
//! let mut synth = Synth::new(48_000.0, 0);
//! synth.set_patch(&kick);
//!
//! let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
//! synth.process(&[Event::note_on(100, 36, 0.8)], &mut left, &mut right);
//! assert!(left[..100].iter().all(|sample| *sample == 0.0), "events fall on their frame");
//! assert!(left[100..].iter().any(|sample| sample.abs() > 0.01));
//! # Ok(())
//! # }
//! ```

// Some of the crate’s own functions serve certain features only. Where all features are on, dead code is found.
#![cfg_attr(not(all(feature = "batch", feature = "lab", feature = "live")), allow(dead_code, unused_imports))]

#[cfg(feature = "fit")]
pub mod analysis;
#[cfg(feature = "batch")]
pub mod batch;
pub mod dsp;
pub mod engine;
mod error;
#[cfg(feature = "analysis")]
pub mod figure;
#[doc(hidden)]
pub mod internals;
pub mod io;
#[cfg(feature = "lab")]
pub mod lab;
mod manual;
pub mod params;
pub mod patch;
pub mod preset;
#[cfg(feature = "live")]
pub mod realtime;
#[cfg(feature = "render")]
pub mod render;
#[cfg(feature = "batch")]
mod request;
#[cfg(feature = "batch")]
pub mod sampler;
pub mod sound;
mod text;
pub mod units;

pub use error::{Error, Result};
