//! The demo songs with General MIDI's sounds, which the benches of whole songs play.

use sprung::io::Song;
use sprung::preset::{Preset, Programs};
use sprung::render::{Job, Options, Tail};
use sprung::sound::Kit;
use std::sync::Arc;

/// The sample rate in Hz.
pub(crate) const RATE: u32 = 48_000;

/// A song of `assets/midi`.
pub(crate) fn song(name: &str) -> Song {
    let file = format!("{}/assets/midi/{name}.mid", env!("CARGO_MANIFEST_DIR"));
    let mut song = Song::read(std::fs::File::open(&file).unwrap(), &file).unwrap();
    song.select_by_bank();
    song
}

/// What songs are played with.
pub(crate) struct Sounds {
    kit: Arc<Kit>,
    programs: Vec<Arc<Kit>>,
}

impl Sounds {
    pub(crate) fn new() -> Self {
        Self { kit: Preset::find("init").unwrap().kit(), programs: Programs::factory_kits() }
    }

    /// A song without a tail, in blocks of so many frames.
    pub(crate) fn job<'a>(&'a self, song: &'a Song, block: usize) -> Job<'a> {
        let options = Options { sample_rate: RATE, seed: 0, block, tail: Tail::None };
        let mix = Some(&Programs::general_midi().mix);
        Job { programs: &self.programs, mix, ..Job::new(song, &self.kit, options) }
    }
}
