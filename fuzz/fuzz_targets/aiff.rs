//! Any bytes as an AIFF file: nothing panics, and what is read is a sound.

#![no_main]

mod sound;

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|bytes: &[u8]| -> Corpus { sound::check(bytes, |bytes| bytes.starts_with(b"FORM")) });
