//! The voices that the parts of an ensemble share: lent to those that have notes to start, and taken back.
//!
//! Parts play a chunk by themselves, on any threads. So before it each is lent what its notes can need at most. If the
//! pool cannot serve them all, the chunk ends at the first note that it cannot serve; the notes that give way are chosen
//! by the state of all channels at that frame. So the bits depend on events alone.

use super::chunk::Chunk;
use super::part::Part;
use crate::dsp::cells::MAX_CELLS;
use crate::engine::EventKind;
use crate::engine::note::nearest_channel;
use crate::engine::synth::{Synth, voices};
use crate::engine::voice::SynthVoice;
use crate::engine::voice_manager::{Footprint, MAX_UNISON, VoicePool, has_room, make_room};
use crate::params::Param;

/// What an ensemble can sound: 384 notes of 64 modes or 48 of 512 on all channels together, and as many more as a third
/// of them that fade.
const POOL: Footprint = Footprint { voices: 512, cells: 512 };

/// The pool of an ensemble. Real-time safe once made.
pub(super) struct Lender {
    pool: VoicePool<SynthVoice>,
}

/// The most that a note of a part can take from the pool in a chunk, as far as its events have been looked at.
struct MostNeeded {
    /// By the kits that the part has had; none before it is asked for.
    by_kits: Option<Footprint>,
    /// The number of unison voices changes in the chunk.
    any_unison: bool,
}

impl MostNeeded {
    const UNKNOWN: Self = Self { by_kits: None, any_unison: false };

    /// By the kits that the part has had in the chunk.
    fn by_kits(&mut self, synth: &Synth) -> Footprint {
        *self.by_kits.get_or_insert_with(|| synth.footprint())
    }

    fn by_next_note(&mut self, synth: &Synth) -> Footprint {
        let most = self.by_kits(synth);
        if !self.any_unison {
            return most;
        }
        Footprint { voices: MAX_UNISON, cells: (most.cells * MAX_UNISON).min(MAX_CELLS * MAX_UNISON) }
    }
}

impl Lender {
    /// A full pool. Allocates.
    pub(super) fn new(sample_rate: f64) -> Self {
        Self { pool: voices(sample_rate, POOL) }
    }

    /// An empty pool for one part, with places for all. Allocates.
    pub(super) fn for_part() -> VoicePool<SynthVoice> {
        VoicePool::empty(POOL)
    }

    /// Lends each part what its notes in a chunk can need. Gives the index and the frame of the first note-on that
    /// cannot be served yet: there the chunk has to end.
    pub(super) fn lend(&mut self, parts: &mut [Part], chunk: &Chunk) -> Option<(usize, usize)> {
        let mut most_needed = [const { MostNeeded::UNKNOWN }; 16];
        for (index, event) in chunk.events.iter().enumerate() {
            let owner = usize::from(chunk.owner(event));
            let (most, synth) = (&mut most_needed[owner], &parts[owner].synth);
            match event.kind {
                EventKind::NoteOn { key, .. } => {
                    // Events before it in the chunk may change what a note needs.
                    let is_first = index == 0 && chunk.frame(event) == 0;
                    let need = match is_first {
                        true => synth.need(nearest_channel(event.channel), key),
                        false => most.by_next_note(synth),
                    };
                    if !has_room(POOL, self.pool.free(), need) {
                        if !is_first {
                            return Some((index, chunk.frame(event)));
                        }
                        make_room(parts, |part| part.synth.manager(), POOL, need);
                        self.take_back(parts);
                    }
                    self.pool.lend(parts[owner].synth.manager().pool(), need);
                }
                EventKind::Program(number) => {
                    if let Some(kit) = chunk.program(event, number) {
                        most.by_kits = Some(most.by_kits(synth).max(synth.footprint_of(kit)));
                    }
                }
                EventKind::Param { param: Param::Unison, .. } | EventKind::Modulate { param: Param::Unison, .. } => {
                    most.any_unison = true;
                }
                _ => {}
            }
        }
        None
    }

    /// Takes back what no note of the parts has.
    pub(super) fn take_back(&mut self, parts: &mut [Part]) {
        for part in parts {
            let pool = part.synth.manager().pool();
            pool.lend(&mut self.pool, pool.free());
        }
    }
}
