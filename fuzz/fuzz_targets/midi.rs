//! Any bytes as a MIDI file: strict and lenient reading never panic, times are finite and in order, and what is read strictly is the
//! same when it is read leniently.

#![no_main]

use sprung::io::Song;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let strict = Song::parse(bytes, "song.mid");
    let Ok((song, repairs)) = Song::parse_leniently(bytes, "song.mid") else {
        assert!(strict.is_err(), "lenient reading refuses what strict reading takes");
        return;
    };
    assert!(song.seconds.is_finite() && song.events.iter().all(|event| event.seconds.is_finite()));
    assert!(song.events.is_sorted_by(|a, b| a.seconds <= b.seconds), "events are in order of time");
    if let Ok(strict) = strict {
        assert!(!repairs.is_empty() || strict == song, "nothing was repaired, but the song is another");
    }
});
