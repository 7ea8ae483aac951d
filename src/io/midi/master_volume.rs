//! The master volume of system exclusive messages, as the volumes of all channels.

use super::limits::MAX_EVENTS;
use crate::engine::EventKind;
use crate::engine::midi::controller::VOLUME;

/// The channel of an event that sets the volume of all of them.
pub(super) const ALL_CHANNELS: u8 = 16;

/// Replaces each master volume by channel volumes: a channel’s own times the master’s, as both have the same curve. The events are
/// in order of time.
pub(super) fn spread(events: Vec<(u64, u8, EventKind)>) -> Result<Vec<(u64, u8, EventKind)>, String> {
    let volume = |value| EventKind::Control { controller: VOLUME, value };
    let (mut master, mut own, mut spread) = (1.0, [1.0; ALL_CHANNELS as usize], Vec::with_capacity(events.len()));
    for (tick, channel, kind) in events {
        match kind {
            EventKind::Control { controller: VOLUME, value } if channel == ALL_CHANNELS => {
                if value != master {
                    master = value;
                    spread.extend((0..).zip(own).map(|(channel, own)| (tick, channel, volume(own * master))));
                }
            }
            EventKind::Control { controller: VOLUME, value } => {
                own[usize::from(channel)] = value;
                spread.push((tick, channel, volume(value * master)));
            }
            kind => spread.push((tick, channel, kind)),
        }
        if spread.len() > MAX_EVENTS {
            return Err(format!("too many changes of the master volume: expected at most {MAX_EVENTS} events in all"));
        }
    }
    Ok(spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_master_scales_what_channels_have_and_get() {
        let volume = |tick, channel, value| (tick, channel, EventKind::Control { controller: VOLUME, value });
        let program = (0, 3, EventKind::Program(5));
        let events = vec![
            volume(0, 2, 0.5),
            program,
            volume(1, ALL_CHANNELS, 0.5),
            volume(1, ALL_CHANNELS, 0.5),
            volume(2, 2, 1.0),
        ];
        let spread = spread(events).unwrap();
        assert_eq!(spread.len(), 3 + 16);
        assert_eq!([spread[0], spread[1], spread[18]], [volume(0, 2, 0.5), program, volume(2, 2, 0.5)]);
        assert_eq!([spread[2], spread[4]], [volume(1, 0, 0.5), volume(1, 2, 0.25)]);
    }
}
