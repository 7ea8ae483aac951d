//! Messages between the window and the audio thread, neither of which ever waits for the other.
//!
//! The audio thread writes its telemetry only during the second after the window has looked. The window sends notes
//! through a queue, which the audio thread empties at the first frame of a block and which drops what does not fit.
//! Only the window and the thread beside it take the locks of `devices`. A knob that the window turns is set first and
//! then told to the host, because the wrapper's VST3 drops changes while nothing is processed.

use crate::devices::DeviceLink;
use crate::lock::lock;
use nice_plug_egui::RepaintNotifier;
use rtrb::{Consumer, Producer, RingBuffer};
use sprung::engine::EventKind;
use sprung::internals::display::Telemetry;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU32};
use std::sync::{Arc, Mutex};

/// How many touches can wait for the audio thread. Half of the space is reserved for releases.
const WAITING: usize = 64;

/// How many messages can wait for the window.
#[cfg(feature = "standalone")]
const MESSAGES: usize = 16;

/// MIDI's number of the modulation wheel.
const WHEEL: u8 = 1;

/// What is played in the window: notes and wheels. It is neither part of the state nor of a host's rendering to a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Touch {
    /// A key goes down, with a velocity from 0 to 1.
    Down { key: u8, velocity: f32 },
    /// A key goes up.
    Up { key: u8 },
    /// A mode of a key's sounding note is pushed, with an amplitude from 0 to 1.
    Nudge { channel: u8, key: u8, mode: u16, amplitude: f32 },
    /// A key goes down without a strike, and one mode of its note is pushed.
    Wake { key: u8, mode: u16, amplitude: f32 },
    /// The pitch wheel stands at a place from −1 to 1.
    Bend(f32),
    /// The modulation wheel stands at a place from 0 to 1.
    Wheel(f32),
}

impl Touch {
    /// The touch as events of the engine, each with its channel. Real-time safe.
    pub(crate) fn events(self) -> impl Iterator<Item = (u8, EventKind)> {
        let on = |key, velocity| (0, EventKind::NoteOn { key, detune: 0.0, velocity, id: None });
        let events = match self {
            Self::Down { key, velocity } => [Some(on(key, velocity)), None],
            Self::Up { key } => [Some((0, EventKind::NoteOff { key, velocity: 0.5, id: None })), None],
            Self::Nudge { channel, key, mode, amplitude } => {
                [Some((channel, EventKind::Nudge { key, mode, amplitude })), None]
            }
            Self::Wake { key, mode, amplitude } => {
                [Some(on(key, 0.0)), Some((0, EventKind::Nudge { key, mode, amplitude }))]
            }
            Self::Bend(place) => [Some((0, EventKind::PitchBend(place))), None],
            Self::Wheel(value) => [Some((0, EventKind::Control { controller: WHEEL, value })), None],
        };
        events.into_iter().flatten()
    }
}

/// The channels between the window, the audio thread and the standalone program.
#[derive(Default)]
pub(crate) struct Link {
    /// From the audio thread: the sounding notes, levels and load.
    pub(crate) telemetry: Arc<Telemetry>,
    /// From the audio thread: a request to repaint while something sounds.
    pub(crate) repaint: RepaintNotifier,
    sample_rate: AtomicU32,
    /// To the audio thread; none before it has connected. The audio thread never locks it.
    touches: Mutex<Option<Producer<Touch>>>,
    /// To the standalone program's window: a request to close.
    closing: AtomicBool,
    /// To the standalone program's window: messages about devices and ports, the oldest first.
    messages: Mutex<Vec<Result<String, String>>>,
    /// Between the standalone program and its window: the devices and ports.
    pub(crate) devices: DeviceLink,
}

impl Link {
    /// Creates the audio thread's end of the link, for a sample rate in Hz. Touches sent to an earlier one are dropped.
    /// Allocates.
    pub(crate) fn connect(&self, sample_rate: f64) -> Consumer<Touch> {
        let (producer, consumer) = RingBuffer::new(WAITING);
        self.sample_rate.store(sample_rate.round() as u32, Relaxed);
        *lock(&self.touches) = Some(producer);
        consumer
    }

    /// No audio thread has come of [`Link::connect`].
    #[cfg(feature = "standalone")]
    pub(crate) fn disconnect(&self) {
        self.sample_rate.store(0, Relaxed);
        *lock(&self.touches) = None;
    }

    /// Plays a note, or moves a wheel. Without an audio thread nothing happens. Not for the audio thread.
    pub(crate) fn play(&self, touch: Touch) {
        if let Some(producer) = &mut *lock(&self.touches) {
            // What goes down must be able to go up, and the pitch to come back: only half of the space is used for anything else.
            if matches!(touch, Touch::Up { .. } | Touch::Bend(0.0)) || producer.slots() > WAITING / 2 {
                let _ = producer.push(touch);
            }
        }
    }

    /// Asks the window to close.
    #[cfg(feature = "standalone")]
    pub(crate) fn close(&self) {
        self.closing.store(true, Relaxed);
        self.repaint.request_repaint();
    }

    /// Whether the window should close.
    pub(crate) fn is_closing(&self) -> bool {
        self.closing.load(Relaxed)
    }

    /// Sends the window a message for the user: what was done, or what went wrong. Not for the audio thread.
    #[cfg(feature = "standalone")]
    pub(crate) fn report(&self, message: Result<String, String>) {
        let mut waiting = lock(&self.messages);
        // If nothing reads the messages, the newest ones are kept.
        if waiting.len() == MESSAGES {
            drop(waiting.remove(0));
        }
        waiting.push(message);
        drop(waiting);
        self.repaint.request_repaint();
    }

    /// The messages since the last call, as one.
    pub(crate) fn take_messages(&self) -> Option<Result<String, String>> {
        joined(std::mem::take(&mut *lock(&self.messages)))
    }

    /// The sample rate in Hz; 0 before the first one is known.
    pub(crate) fn sample_rate(&self) -> u32 {
        self.sample_rate.load(Relaxed)
    }
}

/// Messages joined to one line, if they say anything. Something went wrong if any of them says so.
pub(crate) fn joined(messages: Vec<Result<String, String>>) -> Option<Result<String, String>> {
    let is_ok = messages.iter().all(Result::is_ok);
    let texts = messages.into_iter().map(|message| message.unwrap_or_else(|error| error));
    let line = texts.filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; ");
    (!line.is_empty()).then_some(if is_ok { Ok(line) } else { Err(line) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touches_arrive_in_order_and_keys_beyond_the_room_do_not_go_down() {
        let link = Link::default();
        link.play(Touch::Up { key: 1 });
        let mut consumer = link.connect(44_100.0);
        assert_eq!((consumer.pop().ok(), link.sample_rate()), (None, 44_100));
        let keys = 0..100;
        keys.clone().for_each(|key| link.play(Touch::Down { key, velocity: 0.5 }));
        let down = keys.take(WAITING / 2);
        down.clone().for_each(|key| link.play(Touch::Up { key }));
        for key in down.clone() {
            assert_eq!(consumer.pop(), Ok(Touch::Down { key, velocity: 0.5 }));
        }
        for key in down {
            assert_eq!(consumer.pop(), Ok(Touch::Up { key }), "each key that went down goes up");
        }
        assert!(consumer.pop().is_err());
        link.play(Touch::Up { key: 1 });
        let mut consumer = link.connect(48_000.0);
        assert!(consumer.pop().is_err(), "what was sent to an earlier one is dropped");
        (0..WAITING).for_each(|_| link.play(Touch::Bend(1.0)));
        link.play(Touch::Bend(0.0));
        let bends: Vec<Touch> = std::iter::from_fn(|| consumer.pop().ok()).collect();
        assert_eq!((bends.len(), bends.last()), (WAITING / 2 + 1, Some(&Touch::Bend(0.0))), "the pitch comes back");
    }

    #[cfg(feature = "standalone")]
    #[test]
    fn messages_wait_for_the_window_and_none_replaces_another() {
        let link = Link::default();
        link.report(Ok("one".to_owned()));
        link.report(Ok("two".to_owned()));
        assert_eq!((link.take_messages(), link.take_messages()), (Some(Ok("one; two".to_owned())), None));
        link.report(Err("bad".to_owned()));
        link.report(Ok("good".to_owned()));
        assert_eq!(link.take_messages(), Some(Err("bad; good".to_owned())));
        (0..2 * MESSAGES).for_each(|line| link.report(Ok(line.to_string())));
        let messages = link.take_messages().unwrap().unwrap();
        assert!(messages.starts_with("16; 17") && messages.ends_with("; 31"), "the newest: {messages}");
    }
}
