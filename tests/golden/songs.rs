//! Every song in `assets/midi`, played with the factory's sounds for General MIDI.

use crate::score::Score;
use sprung::io::Song;
use sprung::patch::Patch;
use sprung::preset::Programs;
use sprung::sound::Kit;
use std::path::Path;
use std::sync::Arc;

/// Seconds rendered after a song's last event.
const TAIL: f64 = 1.0;

/// A case for each song.
pub(crate) fn all() -> Vec<Score> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/midi");
    let files = std::fs::read_dir(&folder).expect("assets/midi is a folder");
    let mut paths: Vec<_> = files.map(|file| file.expect("assets/midi can be listed").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "mid"));
    paths.sort();
    assert!(!paths.is_empty(), "there are songs in {}", folder.display());
    let kits = Programs::factory_kits();
    paths.iter().map(|path| song(path, &kits)).collect()
}

/// Whether a case is a song that takes a good part of a minute.
pub(crate) fn is_long(case: &Score) -> bool {
    ["song-kits", "song-suite"].contains(&case.name.as_str())
}

fn song(path: &Path, kits: &[Arc<Kit>]) -> Score {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).expect("songs have plain names");
    let bytes = std::fs::read(path).expect("a song can be read");
    let mut song = Song::parse(&bytes, stem).unwrap_or_else(|error| panic!("{error}"));
    song.select_by_bank();
    let score = Score::new(format!("song-{stem}"), Patch::default(), song.seconds + TAIL);
    // Only one block size: a plate is slow, and `tests/engine/blocks.rs` plays blocks of all sizes.
    let score = score.in_blocks(&[480]).with_kits(kits.to_vec()).with_mix(Programs::general_midi().mix.clone());
    song.events.iter().fold(score, |score, event| score.then(event.seconds, event.channel, event.kind))
}
