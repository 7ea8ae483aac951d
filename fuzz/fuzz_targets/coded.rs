//! Any bytes as an Ogg or MP3 file, with the right checksums and as they are: nothing panics, and what is read is a sound.

#![no_main]

mod sealed;
mod sound;

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|bytes: &[u8]| -> Corpus {
    let is_coded = |bytes: &[u8]| {
        bytes.starts_with(b"OggS") || bytes.starts_with(b"ID3") || matches!(bytes, [0xff, 0xe0..=0xff, ..])
    };
    sealed::check(bytes, is_coded, |bytes| bytes.starts_with(b"OggS"), seal)
});

/// Replaces the checksum of a page, whose header ends with the lengths of its segments (RFC 3533, §6).
fn seal(page: &mut [u8]) {
    let Some(lengths) = page.get(26).and_then(|count| page.get(27..27 + usize::from(*count))) else { return };
    let len = 27 + lengths.len() + lengths.iter().map(|length| usize::from(*length)).sum::<usize>();
    let Some(page) = page.get_mut(..len) else { return };
    page[22..26].fill(0);
    let sum = sealed::sum(page, 32, 0x04c1_1db7);
    page[22..26].copy_from_slice(&sum.to_le_bytes());
}
