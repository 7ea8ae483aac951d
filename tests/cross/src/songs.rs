//! Every song in `assets/midi`, compiled into the program because WebAssembly has no files.

use crate::score::Score;
use sprung::io::Song;
use sprung::patch::Patch;
use sprung::preset::Programs;

/// The songs by name. `cargo xtask cross` reports a song that is missing here.
const SONGS: [(&str, &[u8]); 3] = [
    ("groove", include_bytes!("../../../assets/midi/groove.mid")),
    ("kits", include_bytes!("../../../assets/midi/kits.mid")),
    ("suite", include_bytes!("../../../assets/midi/suite.mid")),
];

/// Seconds rendered after a song's last event.
const TAIL: f64 = 1.0;

/// A case for each song, as `tests/golden/songs.rs` makes it.
pub(crate) fn all() -> Vec<Score> {
    SONGS.iter().map(|(name, bytes)| song(name, bytes)).collect()
}

fn song(name: &str, bytes: &[u8]) -> Score {
    let mut song = Song::parse(bytes, name).unwrap_or_else(|error| panic!("{error}"));
    song.select_by_bank();
    let score = Score::new(format!("song-{name}"), Patch::default(), song.seconds + TAIL);
    let score = score.with_kits(Programs::factory_kits()).with_mix(Programs::general_midi().mix.clone());
    song.events.iter().fold(score, |score, event| score.then(event.seconds, event.channel, event.kind))
}
