//! The master volume and balance of system exclusive messages, as the volumes and balances of all channels.

use super::limits::MAX_EVENTS;
use crate::engine::EventKind;
use crate::engine::midi::controller::{BALANCE, VOLUME};

/// The channel of an event that sets the volume or balance of all of them.
pub(super) const ALL_CHANNELS: u8 = 16;

/// The balance of a channel or the master in the centre.
pub(super) const CENTRE: f32 = 64.0 / 127.0;

/// A controller that a master has as well: what channels and master have of it, and how both go together.
struct Shared {
    own: [f32; ALL_CHANNELS as usize],
    master: f32,
    together: fn(f32, f32) -> f32,
}

impl Shared {
    const fn at(value: f32, together: fn(f32, f32) -> f32) -> Self {
        Self { own: [value; ALL_CHANNELS as usize], master: value, together }
    }
}

/// Replaces each volume and balance of the master by those of channels: a channel’s own volume times the master’s, as both have the
/// same curve, and the balances added up. The events are in order of time.
pub(super) fn spread(events: Vec<(u64, u8, EventKind)>) -> Result<Vec<(u64, u8, EventKind)>, String> {
    let mut volume = Shared::at(1.0, |own, master| own * master);
    let mut balance = Shared::at(CENTRE, |own, master| (own + (master - CENTRE)).clamp(0.0, 1.0));
    let mut spread = Vec::with_capacity(events.len());
    for (tick, channel, kind) in events {
        match kind {
            EventKind::Control { controller: controller @ (VOLUME | BALANCE), value } => {
                let shared = if controller == VOLUME { &mut volume } else { &mut balance };
                let Shared { own, master, together } = shared;
                let event = |channel, value| (tick, channel, EventKind::Control { controller, value });
                if let Some(own) = own.get_mut(usize::from(channel)) {
                    *own = value;
                    spread.push(event(channel, together(value, *master)));
                } else if value != *master {
                    *master = value;
                    spread.extend((0..).zip(*own).map(|(channel, own)| event(channel, together(own, value))));
                }
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

    #[test]
    fn balances_add_up() {
        let given = [(0, 2, 20_u8), (1, ALL_CHANNELS, 74), (2, 2, 64), (3, 2, 120), (4, ALL_CHANNELS, 64)];
        let events = given.map(|(tick, channel, place)| {
            (tick, channel, EventKind::Control { controller: BALANCE, value: f32::from(place) / 127.0 })
        });
        let in_steps = |(tick, channel, kind)| match kind {
            EventKind::Control { controller: BALANCE, value } => (tick, channel, libm::roundf(value * 127.0)),
            other => panic!("{other:?}"),
        };
        let spread: Vec<_> = spread(events.to_vec()).unwrap().into_iter().map(in_steps).collect();
        assert_eq!([spread[0], spread[1], spread[3]], [(0, 2, 20.0), (1, 0, 74.0), (1, 2, 30.0)]);
        assert_eq!([spread[17], spread[18], spread[21]], [(2, 2, 74.0), (3, 2, 127.0), (4, 2, 120.0)]);
    }
}
