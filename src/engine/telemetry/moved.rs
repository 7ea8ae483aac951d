//! The controller that was moved last, for a display that lets the user assign it.

use crate::engine::EventKind;
use crate::engine::midi::controller::{BREATH, BRIGHTNESS, EXPRESSION, WHEEL};
use crate::patch::routes::Source;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

/// A control that players move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moved {
    /// A controller, by its number.
    Controller(u8),
    /// The pitch wheel.
    Bend,
    /// Pressure on keys.
    Pressure,
}

/// Numbers of the controls that are not MIDI controllers, beyond 127.
const BEND: u8 = 128;
const PRESSURE: u8 = 129;
/// The middle of controller 74, as MIDI defines it.
const BRIGHTNESS_AT_REST: f32 = 64.0 / 127.0;
/// Number of bits below the count. They hold the controller's number.
const NUMBER: u32 = 8;

impl std::fmt::Display for Moved {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Controller(number) => write!(f, "controller {number}"),
            Self::Bend => f.write_str("the pitch wheel"),
            Self::Pressure => f.write_str("pressure"),
        }
    }
}

impl Moved {
    /// The source of routes that follows it.
    pub fn source(self) -> Option<Source> {
        match self {
            Self::Bend => Some(Source::Bend),
            Self::Pressure => Some(Source::Pressure),
            Self::Controller(WHEEL) => Some(Source::Wheel),
            Self::Controller(BREATH) => Some(Source::Breath),
            Self::Controller(EXPRESSION) => Some(Source::Expression),
            Self::Controller(BRIGHTNESS) => Some(Source::Timbre),
            Self::Controller(_) => None,
        }
    }

    /// The control that an event moves. None for the pitch wheel, pressure or brightness at rest, which MPE keyboards send
    /// with each note.
    fn by(kind: &EventKind) -> Option<Self> {
        match *kind {
            EventKind::Control { controller: BRIGHTNESS, value } if value == BRIGHTNESS_AT_REST => None,
            // Numbers from 120 on are mode messages.
            EventKind::Control { controller: controller @ 0..120, .. } => Some(Self::Controller(controller)),
            EventKind::PitchBend(value) if value != 0.0 => Some(Self::Bend),
            EventKind::ChannelPressure(pressure) | EventKind::PolyPressure { pressure, .. } if pressure > 0.0 => {
                Some(Self::Pressure)
            }
            _ => None,
        }
    }
}

/// The last movement, and the number of movements so far. Only one thread may write.
#[derive(Default)]
pub(super) struct LastMoved(AtomicU64);

impl LastMoved {
    /// Real-time safe.
    pub(super) fn note(&self, kind: &EventKind) {
        let Some(moved) = Moved::by(kind) else { return };
        let number = match moved {
            Moved::Controller(number) => number,
            Moved::Bend => BEND,
            Moved::Pressure => PRESSURE,
        };
        let count = (self.0.load(Relaxed) >> NUMBER) + 1;
        self.0.store(count << NUMBER | u64::from(number), Relaxed);
    }

    pub(super) fn read(&self) -> (u64, Option<Moved>) {
        let packed = self.0.load(Relaxed);
        let count = packed >> NUMBER;
        let moved = match packed as u8 {
            BEND => Moved::Bend,
            PRESSURE => Moved::Pressure,
            number => Moved::Controller(number),
        };
        (count, (count > 0).then_some(moved))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_movement_is_told_and_counted() {
        let last = LastMoved::default();
        assert_eq!(last.read(), (0, None));
        for (count, (kind, moved, source)) in [
            (EventKind::Control { controller: 0, value: 0.0 }, Moved::Controller(0), None),
            (EventKind::Control { controller: 11, value: 0.0 }, Moved::Controller(11), Some(Source::Expression)),
            (EventKind::PitchBend(-0.5), Moved::Bend, Some(Source::Bend)),
            (EventKind::ChannelPressure(0.5), Moved::Pressure, Some(Source::Pressure)),
        ]
        .into_iter()
        .enumerate()
        {
            last.note(&kind);
            last.note(&EventKind::PitchBend(0.0));
            last.note(&EventKind::ChannelPressure(0.0));
            last.note(&EventKind::Control { controller: 123, value: 0.0 });
            last.note(&EventKind::Control { controller: 74, value: 64.0 / 127.0 });
            assert_eq!((last.read(), moved.source()), ((count as u64 + 1, Some(moved)), source));
        }
    }
}
