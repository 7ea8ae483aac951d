//! What gives way when a pool runs short: the notes that will be missed least, over all managers that share it.

use super::VoiceManager;
use super::footprint::Footprint;
use super::voice::Voice;

/// Whether a note that takes `need` can start in a pool of size `capacity`, of which `free` is free, without any other
/// giving way for it.
pub fn has_room(capacity: Footprint, free: Footprint, need: Footprint) -> bool {
    (capacity - free + need).fits(capacity.for_sounding())
}

/// Makes room in a pool of size `capacity` for a note that takes `need`. Notes that sound fade until they leave a quarter
/// of the pool to those that fade; and while that is not enough, fading ones are cut off. The quietest go first.
///
/// It is decided by the state at this frame alone.
pub fn make_room<P, V: Voice>(
    players: &mut [P],
    manager: impl Fn(&mut P) -> &mut VoiceManager<V>,
    capacity: Footprint,
    need: Footprint,
) {
    let (mut sounding, mut used) = (Footprint::NONE, Footprint::NONE);
    for manager in players.iter_mut().map(&manager) {
        sounding += manager.footprint(true);
        used += sounding_and_fading(manager);
    }
    while !(sounding + need).fits(capacity.for_sounding()) {
        let Some(victim) = quietest(players, &manager, true) else { break };
        let manager = manager(&mut players[victim.player]);
        sounding -= manager.slot_footprint(victim.slot);
        manager.fade_slot(victim.slot);
    }
    while !(used + need).fits(capacity) {
        let Some(victim) = quietest(players, &manager, false).or_else(|| quietest(players, &manager, true)) else {
            break;
        };
        let manager = manager(&mut players[victim.player]);
        used -= manager.slot_footprint(victim.slot);
        manager.cut_slot(victim.slot);
    }
}

fn sounding_and_fading<V: Voice>(manager: &VoiceManager<V>) -> Footprint {
    manager.footprint(true) + manager.footprint(false)
}

/// Whose note, and where it has it.
struct Victim {
    player: usize,
    slot: usize,
}

/// The quietest note of those that sound or of those that fade. Of equals, the first player's and its oldest.
fn quietest<P, V: Voice>(
    players: &mut [P],
    manager: impl Fn(&mut P) -> &mut VoiceManager<V>,
    sounding: bool,
) -> Option<Victim> {
    let quietest = players.iter_mut().enumerate().filter_map(|(player, of)| {
        let (slot, energy) = manager(of).quietest(sounding)?;
        Some((Victim { player, slot }, energy))
    });
    quietest.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(victim, _)| victim)
}
