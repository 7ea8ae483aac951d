//! The voices that the parts of an ensemble share: lent to those that have notes to start, and taken back.
//!
//! Parts play a stretch of frames by themselves, on any threads. So before it each is lent what its notes can need at
//! most. If the pool cannot serve them all, the stretch ends at the first note that it cannot serve; at that frame, from
//! what sounds then on all channels, it is decided which notes give way. So the bits depend on events alone.

use super::event::{Event, EventKind};
use super::note::nearest_channel;
use super::synth::{Synth, voices};
use super::voice::SynthVoice;
use super::voice_manager::{Footprint, MAX_UNISON, VoicePool, has_room, make_room};
use super::zones::Owners;
use crate::dsp::cells::MAX_CELLS;
use crate::params::Param;
use crate::sound::Kit;
use std::sync::Arc;

/// What an ensemble can sound: 384 notes of 64 modes or 48 of 512 on all channels together, and as many more as a third
/// of them that fade.
const POOL: Footprint = Footprint { voices: 512, cells: 512 };

/// The events of a stretch of frames, and what they mean.
#[derive(Clone, Copy)]
pub(super) struct Stretch<'a> {
    pub(super) events: &'a [Event],
    /// The frames of the events count from so many before the stretch, and its last one that an event can be at.
    pub(super) start: usize,
    pub(super) last: usize,
    pub(super) owners: Owners,
    pub(super) programs: &'a [Arc<Kit>],
}

impl Stretch<'_> {
    /// The frame of an event, from the start of the stretch.
    fn frame(&self, event: &Event) -> usize {
        (event.frame as usize).saturating_sub(self.start).min(self.last)
    }
}

/// The pool of an ensemble. Real-time safe once made.
pub(super) struct Lender {
    pool: VoicePool<SynthVoice>,
}

/// What the next notes of a part can take.
struct Notes {
    /// By the programs that have come up, if any.
    most: Option<Footprint>,
    /// The number of unison voices changes in the stretch.
    any_unison: bool,
}

impl Notes {
    fn most(&mut self, part: &Synth) -> Footprint {
        let most = *self.most.get_or_insert_with(|| part.footprint());
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

    /// Lends each part what its notes in a stretch can need. Gives the index and the frame of the first note-on that
    /// cannot be served yet: there the stretch has to end.
    pub(super) fn lend<P>(
        &mut self,
        players: &mut [P],
        synth: impl Fn(&mut P) -> &mut Synth,
        stretch: &Stretch,
    ) -> Option<(usize, usize)> {
        let mut notes = [const { Notes { most: None, any_unison: false } }; 16];
        for (index, event) in stretch.events.iter().enumerate() {
            let sender = nearest_channel(event.channel);
            let owner = usize::from(stretch.owners.of(sender));
            let notes = &mut notes[owner];
            match event.kind {
                EventKind::NoteOn { key, .. } => {
                    // What has happened before in the stretch may change what this note needs.
                    let is_next = index == 0 && stretch.frame(event) == 0;
                    let part = synth(&mut players[owner]);
                    let need = if is_next { part.need(sender, key) } else { notes.most(part) };
                    if !has_room(POOL, self.pool.free(), need) {
                        if !is_next {
                            return Some((index, stretch.frame(event)));
                        }
                        make_room(players, |player| synth(player).manager(), POOL, need);
                        self.take_back(players, &synth);
                    }
                    self.pool.lend(synth(&mut players[owner]).manager().pool(), need);
                }
                EventKind::Program(number) if owner == usize::from(sender) => {
                    if let Some(kit) = stretch.programs.get(usize::from(number)) {
                        let part = synth(&mut players[owner]);
                        notes.most = Some(notes.most(part).max(part.footprint_of(kit)));
                    }
                }
                EventKind::Param { param: Param::Unison, .. } | EventKind::Modulate { param: Param::Unison, .. } => {
                    notes.any_unison = true;
                }
                _ => {}
            }
        }
        None
    }

    /// Takes back what no note of the parts has.
    pub(super) fn take_back<P>(&mut self, players: &mut [P], synth: impl Fn(&mut P) -> &mut Synth) {
        for player in players {
            let pool = synth(player).manager().pool();
            pool.lend(&mut self.pool, pool.free());
        }
    }
}
