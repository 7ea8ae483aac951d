//! Voice stealing when a pool runs short: the quietest notes of all managers that share the pool fade out.

use super::VoiceManager;
use super::footprint::Footprint;
use super::slot::Slot;
use super::voice::Voice;

/// Whether a note that needs `need` can start without stealing, in a pool of size `capacity` of which `free` is free.
pub(crate) fn has_room(capacity: Footprint, free: Footprint, need: Footprint) -> bool {
    (capacity - free + need).fits(capacity.for_sounding())
}

/// Makes room for a note that needs `need` in a pool of size `capacity`. First, sounding notes are faded until the other
/// sounding notes and the new one fit into three quarters of the pool. If the pool is still too full, fading notes are cut
/// off. In both cases the quietest notes go first.
///
/// The choice depends only on the state at this frame, so it is the same for all block sizes.
pub(crate) fn make_room<P, V: Voice>(
    players: &mut [P],
    manager: impl Fn(&mut P) -> &mut VoiceManager<V>,
    capacity: Footprint,
    need: Footprint,
) {
    let (mut sounding, mut used) = (Footprint::NONE, Footprint::NONE);
    for manager in players.iter_mut().map(&manager) {
        sounding += manager.slots.footprint(Slot::is_sounding);
        used += manager.slots.footprint(|_| true);
    }
    while !(sounding + need).fits(capacity.for_sounding()) {
        let Some(victim) = quietest(players, &manager, Slot::is_sounding) else { break };
        let slot = &mut manager(&mut players[victim.player]).slots.in_use_mut()[victim.slot];
        sounding -= slot.footprint();
        slot.fade();
    }
    while !(used + need).fits(capacity) {
        let fading = quietest(players, &manager, Slot::is_fading);
        let Some(victim) = fading.or_else(|| quietest(players, &manager, Slot::is_sounding)) else { break };
        let manager = manager(&mut players[victim.player]);
        used -= manager.slots.in_use()[victim.slot].footprint();
        manager.cut_off(victim.slot);
    }
}

/// A note that is stolen: the index of its player, and its slot there.
struct Victim {
    player: usize,
    slot: usize,
}

/// The quietest note of those that `includes` selects. If several are equal: of the first player, the oldest.
fn quietest<P, V: Voice>(
    players: &mut [P],
    manager: impl Fn(&mut P) -> &mut VoiceManager<V>,
    includes: fn(&Slot<V>) -> bool,
) -> Option<Victim> {
    let quietest = players.iter_mut().enumerate().filter_map(|(player, of)| {
        let (slot, energy) = manager(of).slots.quietest(includes)?;
        Some((Victim { player, slot }, energy))
    });
    quietest.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(victim, _)| victim)
}
