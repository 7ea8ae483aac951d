//! Any bytes as a FLAC file, with the right checksums and as they are: nothing panics, and what is read is a sound.

#![no_main]

mod sealed;
mod sound;

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|bytes: &[u8]| -> Corpus {
    let is_flac = |bytes: &[u8]| bytes.starts_with(b"fLaC") || bytes.starts_with(b"ID3");
    sealed::check(bytes, is_flac, |bytes| matches!(bytes, [0xff, 0xf8 | 0xf9, ..]), seal)
});

/// Replaces the checksums of a frame’s header and of the frame (RFC 9639, §9.1.8 and §9.3).
fn seal(frame: &mut [u8]) {
    let Some(&[block_and_rate, _, number]) = frame.get(2..5) else { return };
    let number = number.leading_ones().max(1) as usize;
    let block = [(6, 1), (7, 2)].iter().find(|(code, _)| *code == block_and_rate >> 4).map_or(0, |(_, len)| *len);
    let rate = match block_and_rate & 15 {
        12 => 1,
        13 | 14 => 2,
        _ => 0,
    };
    let (header, end) = (4 + number + block + rate, frame.len().saturating_sub(2));
    if header < end {
        frame[header] = sealed::sum(&frame[..header], 8, 0x07) as u8;
        let sum = sealed::sum(&frame[..end], 16, 0x8005) as u16;
        frame[end..].copy_from_slice(&sum.to_be_bytes());
    }
}
