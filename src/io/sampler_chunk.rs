//! The chunk `smpl` of a WAV file: the key and the loop with which samplers play it.

/// A loop of a sound, in frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Loop {
    /// The first frame.
    pub(crate) start: u64,
    /// The frame after the last one.
    pub(crate) end: u64,
}

impl Loop {
    /// A whole sound of this many frames.
    pub(crate) fn whole(frames: u64) -> Self {
        Self { start: 0, end: frames }
    }
}

/// The key that a chunk names if the sound has none of its own: as most programs write it.
pub(crate) const MIDDLE_C: u8 = 60;

/// The chunk of a loop of a sound that has its own pitch on a key. The loop is played forwards for ever (Multimedia Data Standards Update, 1994). Empty if it has no frames, or if
/// its place does not fit into 32 bits.
pub(super) fn sampler_chunk(sample_rate: u32, looped: &Loop, key: u8) -> Vec<u8> {
    let last = looped.end.checked_sub(1).filter(|last| *last >= looped.start);
    let [Some(start), Some(last)] = [Some(looped.start), last].map(|frame| u32::try_from(frame?).ok()) else {
        return Vec::new();
    };
    let period = 1_000_000_000 / sample_rate.max(1);
    // Manufacturer, product, nanoseconds per frame, key, cents above it, SMPTE format and offset, number of loops, further data.
    let header = [0, 0, period, key.into(), 0, 0, 0, 1, 0];
    // Name, type (forwards), first and last frame, cents within a frame, number of rounds (for ever).
    let data: Vec<u8> = header.into_iter().chain([0, 0, start, last, 0, 0]).flat_map(u32::to_le_bytes).collect();
    [b"smpl", &(data.len() as u32).to_le_bytes()[..], &data].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chunk_names_the_last_frame_of_the_loop() {
        let chunk = sampler_chunk(48_000, &Loop { start: 100, end: 300 }, 57);
        let number = |at: usize| u32::from_le_bytes([chunk[at], chunk[at + 1], chunk[at + 2], chunk[at + 3]]);
        assert_eq!((&chunk[..4], number(4), chunk.len()), (&b"smpl"[..], 60, 68));
        assert_eq!([number(16), number(20), number(36), number(52), number(56)], [20_833, 57, 1, 100, 299]);
        for nothing in [Loop::whole(0), Loop { start: 5, end: 5 }, Loop::whole(1 << 33)] {
            assert!(sampler_chunk(48_000, &nothing, 57).is_empty());
        }
    }
}
