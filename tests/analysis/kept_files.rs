//! The fuzzer's kept files, each of which reached new code when it was kept: they are sounds and songs, or errors.

use sprung::io::Song;
use sprung::io::sound_file::read;
use std::fs::{self, File};
use std::path::PathBuf;

fn kept(kind: &str) -> Vec<PathBuf> {
    let folder = format!("{}/fuzz/corpus/{kind}", env!("CARGO_MANIFEST_DIR"));
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn sound_files_are_sounds_or_errors() {
    for kind in ["wav", "aiff", "flac", "coded"] {
        let mut sounds = 0;
        for path in kept(kind) {
            if let Ok(sound) = read(File::open(&path).unwrap(), "kept") {
                let frames = sound.frames();
                let is_whole = sound.channels.iter().all(|channel| channel.len() == frames);
                assert!(frames > 0 && is_whole && sound.check_layout("kept").is_ok(), "{}", path.display());
                sounds += 1;
            }
        }
        assert!(sounds >= 3, "{kind}: {sounds}");
    }
}

#[test]
fn midi_files_are_songs_or_errors() {
    let mut songs = 0;
    for path in kept("midi") {
        let (bytes, name) = (fs::read(&path).unwrap(), path.display());
        let strict = Song::parse(&bytes, "kept");
        match Song::parse_leniently(&bytes, "kept") {
            Ok((song, repairs)) => {
                assert!(song.seconds.is_finite() && song.events.is_sorted_by_key(|event| event.seconds), "{name}");
                assert!(strict.is_ok_and(|strict| strict == song) || !repairs.is_empty(), "{name}");
                songs += 1;
            }
            Err(_) => assert!(strict.is_err(), "{name}: read strictly alone"),
        }
    }
    assert!(songs > 20, "{songs}");
}
