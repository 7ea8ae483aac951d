//! The keys and pedals that a stream of events has pressed and not let go of.

use super::event::EventKind;
use super::midi::controller::{ALL_NOTES_OFF, ALL_SOUND_OFF, RESET, SOFT, SOSTENUTO, SUSTAIN};
use super::note::{Notes, nearest_channel, nearest_key};

/// The pedals, by their controllers.
const PEDALS: [u8; 3] = [SUSTAIN, SOSTENUTO, SOFT];

/// The keys and pedals of sixteen channels that are down. Real-time safe.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pressed {
    /// One bit for each key of a channel.
    keys: [u128; 16],
    /// For each of the [`PEDALS`], one bit for each channel.
    pedals: [u16; 3],
}

impl Pressed {
    /// Follows an event of the stream.
    pub(crate) fn follow(&mut self, channel: u8, kind: &EventKind) {
        let channel = nearest_channel(channel);
        let keys = &mut self.keys[usize::from(channel)];
        match *kind {
            EventKind::NoteOn { key, .. } | EventKind::Strike { key, .. } => *keys |= 1 << nearest_key(key),
            // With an identifier, it may leave other notes of the key down.
            EventKind::NoteOff { key, id: None, .. } => *keys &= !(1 << nearest_key(key)),
            EventKind::Release { notes: Notes { id: None, channel: on, key }, .. }
            | EventKind::Silence { notes: Notes { id: None, channel: on, key } }
                if on.is_none_or(|on| nearest_channel(on) == channel) =>
            {
                *keys &= !key.map_or(u128::MAX, |key| 1 << nearest_key(key));
            }
            EventKind::Control { controller: ALL_SOUND_OFF | ALL_NOTES_OFF..=127, .. } => *keys = 0,
            EventKind::Control { controller: RESET, .. } => {
                self.pedals.iter_mut().for_each(|all| *all &= !(1 << channel))
            }
            EventKind::Control { controller, value } => {
                let pedal = PEDALS.iter().zip(&mut self.pedals).find(|(number, _)| **number == controller);
                if let Some((_, all)) = pedal {
                    *all = *all & !(1 << channel) | u16::from(value >= 0.5) << channel;
                }
            }
            _ => {}
        }
    }

    /// Whether nothing is down.
    pub(crate) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The keys of a channel that are down.
    pub(crate) fn keys(&self, channel: u8) -> impl Iterator<Item = u8> + use<> {
        let keys = self.keys[usize::from(nearest_channel(channel))];
        (0..128).filter(move |key| keys & (1 << key) != 0)
    }

    /// The pedals of a channel that are down, by their controllers.
    pub(crate) fn pedals(&self, channel: u8) -> impl Iterator<Item = u8> + use<> {
        let (pedals, bit) = (self.pedals, 1 << nearest_channel(channel));
        PEDALS.into_iter().zip(pedals).filter(move |(_, all)| all & bit != 0).map(|(number, _)| number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::NoteId;

    const fn on(key: u8) -> EventKind {
        EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None }
    }

    const fn control(controller: u8, value: f32) -> EventKind {
        EventKind::Control { controller, value }
    }

    #[test]
    fn what_is_pressed_is_down_until_it_is_let_go() {
        let off = |id| EventKind::NoteOff { key: 60, velocity: 0.5, id };
        let of = |channel| Notes { id: None, channel, key: Some(60) };
        for (events, keys, pedals) in [
            (&[on(60), on(61), off(None)][..], &[61][..], &[][..]),
            (&[on(60), off(NoteId::new(1))], &[60], &[]),
            (&[on(60), on(127), control(123, 0.0)], &[], &[]),
            (&[on(60), control(127, 0.0)], &[], &[]),
            (&[on(60), control(120, 0.0)], &[], &[]),
            (&[on(60), on(61), EventKind::Release { notes: of(None), velocity: 0.5 }], &[61], &[]),
            (&[on(60), EventKind::Silence { notes: of(Some(4)) }], &[60], &[]),
            (&[control(64, 1.0), control(66, 0.5), control(67, 1.0), control(64, 0.49)], &[], &[66, 67]),
            (&[on(60), control(64, 1.0), control(67, 1.0), control(121, 0.0)], &[60], &[]),
            (&[control(65, 1.0), EventKind::Program(3)], &[], &[]),
        ] {
            let mut pressed = Pressed::default();
            events.iter().for_each(|event| pressed.follow(3, event));
            assert_eq!(pressed.keys(3).collect::<Vec<_>>(), keys, "{events:?}");
            assert_eq!(pressed.pedals(3).collect::<Vec<_>>(), pedals, "{events:?}");
            assert_eq!(pressed.is_none(), keys.is_empty() && pedals.is_empty(), "{events:?}");
            assert_eq!(pressed.keys(2).count() + pressed.pedals(2).count(), 0, "{events:?}");
        }
    }
}
