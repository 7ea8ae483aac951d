//! What every reader of sound files is held to, and the checksums without which a changed file is refused at once.

use libfuzzer_sys::Corpus;
use sprung::io::sound_file::{DECODER, read};
use std::io::{Seek, Write};
use std::sync::Once;

/// Lets decoders of others panic, whose panics are errors of the file: the fuzzer would end at each.
static LET_DECODERS_PANIC: Once = Once::new();

/// Reads these bytes as a file, if they begin as one of the readers looks for: nothing panics, and what is read is a sound.
pub fn check(bytes: &[u8], is_of_format: impl Fn(&[u8]) -> bool) -> Corpus {
    if !is_of_format(bytes) {
        return Corpus::Reject;
    }
    LET_DECODERS_PANIC.call_once(|| {
        let end = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            let is_own = panic.location().is_some_and(|place| place.file().contains("sound_file"));
            if is_own || std::thread::current().name() != Some(DECODER) {
                end(panic);
            }
        }));
    });
    let mut file = tempfile::tempfile().expect("a temporary file");
    file.write_all(bytes).and_then(|()| file.rewind()).expect("a written file");
    if let Ok(sound) = read(file, "sound") {
        assert!(sound.frames() > 0, "no frame");
        assert!(sound.check_layout("sound").is_ok(), "a layout that nothing can work on");
        assert!(sound.channels.iter().all(|channel| channel.len() == sound.frames()), "channels of different lengths");
    }
    Corpus::Keep
}

/// A checksum without reflection, from 0, of the low `bits` bits.
#[allow(dead_code, reason = "WAV and AIFF have no checksums")]
pub fn sum(bytes: &[u8], bits: u32, polynomial: u32) -> u32 {
    let (top, mask) = (1 << (bits - 1), u32::MAX >> (32 - bits));
    bytes.iter().fold(0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte) << (bits - 8), |sum, _| {
            (if sum & top == 0 { sum << 1 } else { sum << 1 ^ polynomial }) & mask
        })
    })
}

/// The parts of a file, each from a place where `is_start` finds a start to the next.
#[allow(dead_code, reason = "WAV and AIFF have no checksums")]
pub fn parts(bytes: &[u8], is_start: impl Fn(&[u8]) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut starts: Vec<usize> = (0..bytes.len()).filter(|at| is_start(&bytes[*at..])).collect();
    starts.push(bytes.len());
    starts.windows(2).map(|pair| pair[0]..pair[1]).collect()
}
