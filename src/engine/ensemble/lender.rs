//! The pool of voices that the parts of an ensemble share: lends voices before each chunk, takes unused ones back.
//!
//! Parts render a chunk independently, on any threads. So before the chunk, each part receives the maximum that its
//! notes can need. If the pool is too small for that, the chunk ends at the first note for which there are no voices,
//! and the notes to steal are chosen by the state of all channels at that frame. So the output depends on the events
//! alone, and is bit for bit the same for all numbers of threads and block sizes.

use super::chunk::Chunk;
use super::part::Part;
use crate::dsp::cells::MAX_CELLS;
use crate::engine::EventKind;
use crate::engine::note::nearest_channel;
use crate::engine::synth::{Synth, voices};
use crate::engine::voice::SynthVoice;
use crate::engine::voice_manager::{Footprint, MAX_UNISON, VoicePool, has_room, make_room};
use crate::params::Param;

/// Size of an ensemble's pool: on all channels together 384 notes of 64 modes, or 48 of 512. The remaining quarter of
/// the pool is for notes that fade out.
const POOL: Footprint = Footprint { voices: 512, cells: 512 };

/// The pool of an ensemble. Real-time safe once made.
pub(super) struct Lender {
    pool: VoicePool<SynthVoice>,
}

/// The maximum that one note of a part can take from the pool, according to the events of the chunk that were examined
/// so far.
struct MostNeeded {
    /// The maximum over all kits that the part has had in the chunk; none until it is first needed.
    by_kits: Option<Footprint>,
    /// Whether an event of the chunk changes the number of unison voices.
    any_unison: bool,
}

impl MostNeeded {
    const UNKNOWN: Self = Self { by_kits: None, any_unison: false };

    /// The maximum over all kits that the part has had in the chunk.
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

    /// The voices that no part has.
    pub(super) fn voices_mut(&mut self) -> impl Iterator<Item = &mut SynthVoice> {
        self.pool.voices_mut()
    }

    /// An empty pool for one part, with capacity for all voices and cells. Allocates.
    pub(super) fn for_part() -> VoicePool<SynthVoice> {
        VoicePool::empty(POOL)
    }

    /// Lends each part the voices that its notes in a chunk can need. Returns the index and the frame of the first note
    /// on that the pool has no room for; the chunk must end there.
    pub(super) fn lend(&mut self, parts: &mut [Part], chunk: &Chunk) -> Option<(usize, usize)> {
        let mut most_needed = [const { MostNeeded::UNKNOWN }; 16];
        for (index, event) in chunk.events.iter().enumerate() {
            let owner = usize::from(chunk.owner(event));
            let (most, synth) = (&mut most_needed[owner], &parts[owner].synth);
            match event.kind {
                EventKind::NoteOn { key, .. } | EventKind::Strike { key, .. } => {
                    // Events before this one in the chunk may change the need of the note.
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

    /// Takes back all voices and cells that no note uses.
    pub(super) fn take_back(&mut self, parts: &mut [Part]) {
        for part in parts {
            let pool = part.synth.manager().pool();
            pool.lend(&mut self.pool, pool.free());
        }
    }
}
