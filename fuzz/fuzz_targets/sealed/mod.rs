//! Files with checksums, without which a changed file is refused at once: they are read with the right ones, and as they are.

use crate::sound;
use libfuzzer_sys::Corpus;
use std::ops::Range;

/// As [`sound::check`], of a file whose parts begin where `is_start` says; `seal` replaces the checksums of a part.
pub fn check(
    bytes: &[u8],
    is_of_format: impl Fn(&[u8]) -> bool,
    is_start: impl Fn(&[u8]) -> bool,
    seal: impl Fn(&mut [u8]),
) -> Corpus {
    let mut sealed = bytes.to_vec();
    for part in parts(bytes, is_start) {
        seal(&mut sealed[part]);
    }
    if sealed != bytes {
        sound::check(&sealed, &is_of_format);
    }
    sound::check(bytes, is_of_format)
}

/// A checksum without reflection, from 0, of the low `bits` bits.
pub fn sum(bytes: &[u8], bits: u32, polynomial: u32) -> u32 {
    let (top, mask) = (1 << (bits - 1), u32::MAX >> (32 - bits));
    bytes.iter().fold(0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte) << (bits - 8), |sum, _| {
            (if sum & top == 0 { sum << 1 } else { sum << 1 ^ polynomial }) & mask
        })
    })
}

/// The parts of a file, each from a place where `is_start` finds a start to the next.
fn parts(bytes: &[u8], is_start: impl Fn(&[u8]) -> bool) -> Vec<Range<usize>> {
    let mut starts: Vec<usize> = (0..bytes.len()).filter(|at| is_start(&bytes[*at..])).collect();
    starts.push(bytes.len());
    starts.windows(2).map(|pair| pair[0]..pair[1]).collect()
}
