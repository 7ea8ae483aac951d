//! Prints the digests of the golden cases: run by `cargo xtask cross` for each CPU, and compared with the accepted ones.
//!
//! A line has the case's name, the number of rendered frames, the SHA-256 of all samples, and the first eight digits of the
//! SHA-256 of each 4096 frames: the same numbers as in `tests/golden`. Songs end after the given number of seconds.

#[path = "../../golden/cases.rs"]
#[allow(dead_code, reason = "the golden tests use more of it")]
mod cases;
mod host;
#[path = "../../golden/score.rs"]
#[allow(dead_code, reason = "the golden tests use more of it")]
mod score;
mod songs;

use score::{Score, WHOLE};
use sha2::{Digest as _, Sha256};
use sprung::internals::Level;

/// Frames that share one short hash, as in `analysis::digest`.
const CHUNK: usize = 4096;

fn main() {
    let asked = host::asked();
    host::print(&format!("level {}", Level::current().name()));
    for mut case in cases::all().into_iter().skip(asked.first).step_by(asked.step.max(1)) {
        if case.name.starts_with("song-") {
            // Whole chunks, since a part of a chunk has no accepted hash.
            let limit = asked.song_seconds * case.sample_rate as usize / CHUNK * CHUNK;
            if limit == 0 {
                continue;
            }
            case.frames = case.frames.min(limit);
        }
        host::print(&line(&case));
    }
}

/// The line of a case.
fn line(case: &Score) -> String {
    let [left, right] = case.render(WHOLE);
    let (mut whole, mut chunks) = (Sha256::new(), Vec::new());
    for (left, right) in left.chunks(CHUNK).zip(right.chunks(CHUNK)) {
        let bytes: Vec<u8> =
            left.iter().zip(right).flat_map(|(l, r)| [l.to_le_bytes(), r.to_le_bytes()]).flatten().collect();
        whole.update(&bytes);
        chunks.push(hexadecimal(&Sha256::digest(&bytes)[..4]));
    }
    format!("{} {} {} {}", case.name, left.len(), hexadecimal(&whole.finalize()), chunks.join(","))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
