//! The order of a key's release and its next strike when both fall on one tick.

use crate::engine::EventKind;

/// Puts the release of a held key first at its tick if the key's next strike stands before it there. Sequencers write notes that
/// touch in either order; read literally, the release would end the note that has just begun.
pub(super) fn release_before_strike(events: &mut [(u64, u8, EventKind)]) {
    let mut held = [[false; 128]; 16];
    // The tick at which a held key was struck again and its release has not come yet.
    let mut struck = [[None; 128]; 16];
    for simultaneous in events.chunk_by_mut(|a, b| a.0 == b.0) {
        let mut early = Vec::new();
        for (index, (tick, channel, kind)) in simultaneous.iter().enumerate() {
            let (EventKind::NoteOn { key, .. } | EventKind::NoteOff { key, .. }) = *kind else { continue };
            let (channel, key) = (usize::from(*channel), usize::from(key));
            let (held, struck) = (&mut held[channel][key], &mut struck[channel][key]);
            if matches!(kind, EventKind::NoteOn { .. }) {
                if *held {
                    *struck = Some(*tick);
                }
                *held = true;
            } else if *struck == Some(*tick) {
                *struck = None;
                early.push(index);
            } else {
                *held = false;
            }
        }
        for (place, index) in early.into_iter().enumerate() {
            simultaneous[place..=index].rotate_right(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(tick: u64, key: u8) -> (u64, u8, EventKind) {
        (tick, 3, EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None })
    }

    fn off(tick: u64, key: u8) -> (u64, u8, EventKind) {
        (tick, 3, EventKind::NoteOff { key, velocity: 0.5, id: None })
    }

    #[test]
    fn a_release_ends_the_note_that_was_there_before_the_tick() {
        let mut touching = [on(0, 60), on(0, 62), on(5, 60), on(5, 61), off(5, 61), off(5, 60), off(9, 60), off(9, 62)];
        let expected = [on(0, 60), on(0, 62), off(5, 60), on(5, 60), on(5, 61), off(5, 61), off(9, 60), off(9, 62)];
        release_before_strike(&mut touching);
        assert_eq!(touching, expected);
        // A note of no length, two in a row, and a second release.
        for mut events in
            [vec![on(0, 60), off(0, 60), on(0, 60), off(0, 60)], vec![on(0, 60), off(5, 60), on(5, 60), off(5, 60)]]
        {
            let before = events.clone();
            release_before_strike(&mut events);
            assert_eq!(events, before);
        }
    }
}
