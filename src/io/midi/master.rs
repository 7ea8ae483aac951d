//! What system exclusive messages do to all channels at once: the master's volume and balance, and resets.

use super::limits::MAX_EVENTS;
use crate::engine::EventKind;
use crate::engine::banks::BANK_SELECT;
use crate::engine::midi::DEFAULT_REVERB_SEND;
use crate::engine::midi::controller::{
    ALL_NOTES_OFF, BALANCE, BRIGHTNESS, DATA, DATA_FINE, PAN, RESET, REVERB_SEND, RPN, RPN_FINE, VOLUME,
};
use std::mem::take;

/// The channel of an event that sets the volume or balance of all of them, or resets them.
pub(super) const ALL_CHANNELS: u8 = 16;

/// The balance of a channel or the master in the centre.
const CENTRE: f32 = 64.0 / 127.0;

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

/// The controllers of a channel after a system reset, as seven bits each (General MIDI System Level 1, 1991; Level 2, 1999): no
/// notes, bank 0, volume 100, and the registered parameters bend range, fine and coarse tuning.
const INITIAL: [(u8, u8); 22] = [
    (ALL_NOTES_OFF, 0),
    (RESET, 0),
    (BANK_SELECT, 0),
    (VOLUME, INITIAL_VOLUME),
    (PAN, 64),
    (BALANCE, 64),
    (BRIGHTNESS, 64),
    (REVERB_SEND, (127.0 * DEFAULT_REVERB_SEND + 0.5) as u8),
    (RPN, 0),
    (RPN_FINE, 0),
    (DATA, 2),
    (DATA_FINE, 0),
    (RPN, 0),
    (RPN_FINE, 1),
    (DATA, 64),
    (DATA_FINE, 0),
    (RPN, 0),
    (RPN_FINE, 2),
    (DATA, 64),
    (DATA_FINE, 0),
    (RPN, 127),
    (RPN_FINE, 127),
];
const INITIAL_VOLUME: u8 = 100;

/// Whether an event resets all channels.
pub(super) fn is_reset(channel: u8, kind: &EventKind) -> bool {
    channel == ALL_CHANNELS && matches!(kind, EventKind::Control { controller: RESET, .. })
}

fn control((controller, value): (u8, u8)) -> EventKind {
    EventKind::Control { controller, value: f32::from(value) / 127.0 }
}

/// Replaces each volume and balance of the master by those of channels: a channel’s own volume times the master’s, as both have the
/// same curve, and the balances added up. A reset gives every channel [`INITIAL`], and program 0 if it has had another; mono
/// mode and the portamento’s time stay. The events are in order of time.
pub(super) fn spread(events: Vec<(u64, u8, EventKind)>) -> Result<Vec<(u64, u8, EventKind)>, String> {
    let mut volume = Shared::at(1.0, |own, master| own * master);
    let mut balance = Shared::at(CENTRE, |own, master| (own + (master - CENTRE)).clamp(0.0, 1.0));
    let mut has_program = [false; ALL_CHANNELS as usize];
    let mut spread = Vec::with_capacity(events.len());
    for (tick, channel, kind) in events {
        match kind {
            kind if is_reset(channel, &kind) => {
                volume =
                    Shared { own: [f32::from(INITIAL_VOLUME) / 127.0; ALL_CHANNELS as usize], master: 1.0, ..volume };
                balance = Shared::at(CENTRE, balance.together);
                for (channel, has_program) in (0..).zip(&mut has_program) {
                    spread.extend(INITIAL.map(|initial| (tick, channel, control(initial))));
                    spread.extend(take(has_program).then_some((tick, channel, EventKind::Program(0))));
                }
            }
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
            kind => {
                has_program[usize::from(channel)] |= matches!(kind, EventKind::Program(_));
                spread.push((tick, channel, kind));
            }
        }
        if spread.len() > MAX_EVENTS {
            return Err(format!(
                "too many resets and changes of the master volume: expected at most {MAX_EVENTS} events in all"
            ));
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
    fn a_reset_gives_channels_what_general_midi_says() {
        let all = |controller, value| (1, ALL_CHANNELS, EventKind::Control { controller, value });
        let events = vec![
            (0, 3, EventKind::Program(5)),
            (0, 3, control((VOLUME, 20))),
            all(VOLUME, 0.5),
            all(RESET, 0.0),
            (2, 3, control((VOLUME, 90))),
            all(RESET, 0.0),
        ];
        let spread = spread(events).unwrap();
        let at = |from: usize| spread[from..].iter().filter(|(_, channel, _)| *channel == 3).map(|(.., kind)| *kind);
        let wanted: Vec<EventKind> = INITIAL.map(control).into_iter().chain([EventKind::Program(0)]).collect();
        assert_eq!(at(2 + 16).take(INITIAL.len() + 1).collect::<Vec<_>>(), wanted);
        let later: Vec<EventKind> = at(2 + 16).skip(wanted.len()).collect();
        assert_eq!(later[0], control((VOLUME, 90)), "the master has its volume again");
        assert_eq!(later[1..], wanted[..INITIAL.len()], "it has had no program since");
        assert_eq!(spread.len(), 2 + 16 + 1 + 1 + 2 * 16 * INITIAL.len());
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
