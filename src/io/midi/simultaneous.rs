//! The order of a key's release and its next strike when both fall on one tick.

use crate::engine::EventKind;

/// Puts the release of a held key before the key's next strike if it stands after it at the same tick. Sequencers write notes that
/// touch in either order; read literally, the release would end the note that has just begun.
pub(super) fn release_before_strike(events: &mut [(u64, u8, EventKind)]) {
    let mut held = [[false; 128]; 16];
    // The tick and place at which a held key was struck again and its release has not come yet.
    let mut struck = [[None; 128]; 16];
    for simultaneous in events.chunk_by_mut(|a, b| a.0 == b.0) {
        // Places of strikes, and of the releases that belong before them.
        let mut touching = Vec::new();
        for (place, (tick, channel, kind)) in simultaneous.iter().enumerate() {
            let (EventKind::NoteOn { key, .. } | EventKind::NoteOff { key, .. }) = *kind else { continue };
            let (channel, key) = (usize::from(*channel), usize::from(key));
            let (held, struck) = (&mut held[channel][key], &mut struck[channel][key]);
            if matches!(kind, EventKind::NoteOn { .. }) {
                if *held && struck.is_none_or(|(last, _)| last != *tick) {
                    *struck = Some((*tick, place));
                }
                *held = true;
            } else if let Some((_, strike)) = struck.take_if(|(last, _)| last == tick) {
                touching.push((strike, place));
            } else {
                *held = false;
            }
        }
        if !touching.is_empty() {
            reorder(simultaneous, touching);
        }
    }
}

/// Moves each release to the place before its strike.
fn reorder(simultaneous: &mut [(u64, u8, EventKind)], mut touching: Vec<(usize, usize)>) {
    let before = simultaneous.to_vec();
    let mut releases: Vec<usize> = touching.iter().map(|(_, release)| *release).collect();
    releases.sort_unstable();
    touching.sort_unstable();
    let (mut releases, mut touching) = (releases.into_iter().peekable(), touching.into_iter().peekable());
    let mut order = Vec::with_capacity(before.len());
    for place in 0..before.len() {
        if releases.next_if_eq(&place).is_some() {
            continue;
        }
        order.extend(touching.next_if(|(strike, _)| *strike == place).map(|(_, release)| release));
        order.push(place);
    }
    for (event, place) in simultaneous.iter_mut().zip(order) {
        *event = before[place];
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
        let pedal = (5, 3, EventKind::Control { controller: 64, value: 1.0 });
        let first = [on(0, 60), on(0, 62), pedal];
        let mut touching =
            [&first[..], &[on(5, 60), on(5, 61), off(5, 61), off(5, 60), off(9, 60), off(9, 62)]].concat();
        let expected = [&first[..], &[off(5, 60), on(5, 60), on(5, 61), off(5, 61), off(9, 60), off(9, 62)]].concat();
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

    #[test]
    fn a_million_events_at_one_tick_take_no_time() {
        let mut events = vec![on(0, 60)];
        (0..500_000).for_each(|n| events.extend([on(1, 60 + (n % 2) as u8), off(1, 60 + (n % 2) as u8)]));
        let count = events.len();
        release_before_strike(&mut events);
        assert_eq!((events.len(), events[1]), (count, off(1, 60)));
    }
}
