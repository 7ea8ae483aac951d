//! Any bytes as a WAV file, of integers, floats and compressed samples: nothing panics, and what is read is a sound.

#![no_main]

mod sound;

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|bytes: &[u8]| -> Corpus { sound::check(bytes, |bytes| bytes.get(8..12) == Some(b"WAVE")) });
