//! Passes live events to the audio thread through lock-free queues of fixed size, merged in order of time.

use super::{BlockClock, Stamp};
use crate::engine::banks::Banks;
use crate::engine::midi::controller::{ALL_NOTES_OFF, ALL_SOUND_OFF, SOSTENUTO, SUSTAIN};
use crate::engine::pressed::Pressed;
use crate::engine::{Event, EventKind};
use rtrb::{Consumer, Producer, RingBuffer};
use std::time::Instant;

/// Number of events that a queue can hold.
const CAPACITY: usize = 1024;

/// A live event.
#[derive(Clone, Copy, Debug)]
pub struct LiveEvent {
    /// When the event arrived.
    pub stamp: Stamp,
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// The event.
    pub kind: EventKind,
}

/// The sending end of a queue. [`LiveSender::send`] is real-time safe.
pub struct LiveSender {
    queue: Producer<LiveEvent>,
    /// The keys and pedals that this sender holds.
    held: Pressed,
    /// The banks by which program changes select sounds, if they do.
    banks: Option<Banks>,
}

impl LiveSender {
    /// The same sender, but its program changes select from a list of melodic sounds and drum kits, by bank.
    #[must_use]
    pub fn with_banks(self) -> Self {
        Self { banks: Some(Banks::default()), ..self }
    }

    /// Sends an event. Returns false if the queue is full: the event is then lost.
    pub fn send(&mut self, mut event: LiveEvent) -> bool {
        if let Some(banks) = &mut self.banks {
            event.kind = banks.resolve(event.channel, event.kind);
        }
        // A note-off that was lost leaves its key held: `release_held` sends it again.
        if self.queue.push(event).is_err() {
            return false;
        }
        self.held.follow(event.channel, &event.kind);
        true
    }

    /// Sends an event with the present time as its time stamp.
    pub fn send_now(&mut self, channel: u8, kind: EventKind) -> bool {
        self.send(LiveEvent { stamp: Stamp::System(Instant::now()), channel, kind })
    }

    /// Releases the keys and pedals that this sender holds. Returns false if the queue is full: some are then still held.
    pub(crate) fn release_held(&mut self) -> bool {
        for channel in 0..16 {
            for key in self.held.keys(channel) {
                self.send_now(channel, EventKind::NoteOff { key, velocity: 0.5, id: None });
            }
            for controller in self.held.pedals(channel) {
                self.send_now(channel, EventKind::Control { controller, value: 0.0 });
            }
        }
        self.held.is_none()
    }

    /// Releases every note and pedal on every channel.
    pub fn release_all(&mut self) {
        for channel in 0..16 {
            for controller in [SUSTAIN, SOSTENUTO, ALL_NOTES_OFF] {
                self.send_now(channel, EventKind::Control { controller, value: 0.0 });
            }
        }
    }

    /// Fades out everything within milliseconds.
    pub fn silence_all(&mut self) {
        for channel in 0..16 {
            self.send_now(channel, EventKind::Control { controller: ALL_SOUND_OFF, value: 0.0 });
        }
    }
}

/// The receiving ends of all queues.
pub struct LiveInputs(Vec<Consumer<LiveEvent>>);

impl LiveInputs {
    /// Makes `N` queues.
    pub fn new<const N: usize>() -> ([LiveSender; N], Self) {
        let mut inputs = Vec::with_capacity(N);
        let senders = std::array::from_fn(|_| {
            let (producer, consumer) = RingBuffer::new(CAPACITY);
            inputs.push(consumer);
            LiveSender { queue: producer, held: Pressed::default(), banks: None }
        });
        (senders, Self(inputs))
    }

    /// Maximum number of events that [`LiveInputs::merge`] adds in one call.
    pub fn capacity(&self) -> usize {
        self.0.len() * CAPACITY
    }

    /// Inserts the events that belong before frame `end` of the clock's block into `events`, which must be in order and
    /// stays so. Frames in `events` count from `start`. At the same frame, existing events come first. Events sent
    /// during the call may be left for the next one. `change` gets each event with its channel, and those before it, and returns
    /// what is inserted.
    ///
    /// Real-time safe if `change` is, and `events` has room for [`LiveInputs::capacity`] more events.
    pub fn merge(
        &mut self,
        clock: &BlockClock,
        start: u32,
        end: u32,
        events: &mut Vec<Event>,
        mut change: impl FnMut(&[Event], u8, EventKind) -> Option<EventKind>,
    ) {
        for input in &mut self.0 {
            let mut earliest = 0;
            // Only the events that wait at the start: a sender that fills the queue as fast as it is emptied would keep
            // this loop busy forever.
            for _ in 0..input.slots() {
                let Ok(&LiveEvent { stamp, channel, kind }) = input.peek() else { break };
                let Some(frame) = clock.frame_of(stamp).filter(|frame| *frame < end) else { break };
                let frame = frame.saturating_sub(start).max(earliest);
                earliest = frame;
                let place = events.partition_point(|event| event.frame <= frame);
                if let Some(kind) = change(&events[..place], channel, kind) {
                    events.insert(place, Event { frame, channel, kind });
                }
                let _ = input.pop();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::realtime::Moment;
    use std::time::Duration;

    #[test]
    fn events_of_all_queues_come_in_the_order_of_their_frames() {
        let ([mut first, mut second], mut inputs) = LiveInputs::new();
        let mut clock = BlockClock::new(48_000.0);
        let now = Instant::now() + Duration::from_secs(1);
        clock.begin(Moment { now, called: Duration::ZERO, heard: Duration::ZERO }, 480);
        let at = |ms: u64| now - Duration::from_millis(10) + Duration::from_millis(ms);
        let program = EventKind::Program;
        for (ms, number) in [(1, 1), (5, 5), (20, 99)] {
            assert!(first.send(LiveEvent { stamp: Stamp::System(at(ms)), channel: 0, kind: program(number) }));
        }
        for (ms, number) in [(3, 3), (5, 6), (2, 7)] {
            assert!(second.send(LiveEvent { stamp: Stamp::System(at(ms)), channel: 0, kind: program(number) }));
        }
        let mut events = vec![Event { frame: 48, channel: 0, kind: program(0) }];
        inputs.merge(&clock, 0, 192, &mut events, |_, _, kind| Some(kind));
        inputs.merge(&clock, 0, 480, &mut events, |_, _, kind| Some(kind));
        let order: Vec<_> = events.iter().map(|event| (event.frame, event.kind)).collect();
        // Events of one queue stay in order, even if their time stamps are not.
        let expected = [(48, 0), (48, 1), (144, 3), (240, 5), (240, 6), (240, 7)];
        assert_eq!(order, expected.map(|(frame, number)| (frame, program(number))));
    }

    #[test]
    fn a_sender_lets_go_of_what_it_holds_and_of_nothing_else() {
        let ([mut sender], mut inputs) = LiveInputs::new();
        let on = |key| EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None };
        let off = |key| EventKind::NoteOff { key, velocity: 0.5, id: None };
        let pedal = |value| EventKind::Control { controller: SUSTAIN, value };
        for (channel, kind) in [(0, on(60)), (3, on(61)), (3, on(127)), (0, off(60)), (15, pedal(1.0))] {
            sender.send_now(channel, kind);
        }
        let mut next = move || inputs.0[0].pop().ok().map(|event| (event.channel, event.kind));
        while next().is_some() {}
        sender.release_held();
        let released: Vec<_> = std::iter::from_fn(next).collect();
        assert_eq!(released, [(3, off(61)), (3, off(127)), (15, pedal(0.0))]);
    }

    #[test]
    fn what_a_full_queue_loses_is_released_later() {
        let ([mut sender], mut inputs) = LiveInputs::new();
        let on = EventKind::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: None };
        let off = EventKind::NoteOff { key: 60, velocity: 0.5, id: None };
        assert!(sender.send_now(0, on));
        let wheel = EventKind::Control { controller: 1, value: 0.0 };
        while sender.send_now(0, wheel) {}
        assert!(!sender.send_now(0, off) && !sender.release_held(), "the queue is full");
        while inputs.0[0].pop().is_ok() {}
        assert!(sender.release_held());
        assert_eq!(inputs.0[0].pop().ok().map(|event| event.kind), Some(off));
        assert!(sender.release_held() && inputs.0[0].pop().is_err(), "once");
    }

    #[test]
    fn a_sender_that_keeps_filling_its_queue_does_not_outgrow_the_capacity() {
        let ([mut sender], mut inputs) = LiveInputs::new();
        let mut clock = BlockClock::new(48_000.0);
        let now = Instant::now() + Duration::from_secs(1);
        clock.begin(Moment { now, called: Duration::ZERO, heard: Duration::ZERO }, 480);
        let done = std::sync::atomic::AtomicBool::new(false);
        let mut most = 0;
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(std::sync::atomic::Ordering::Relaxed) {
                    sender.send_now(0, EventKind::PitchBend(0.0));
                }
            });
            let start = Instant::now();
            while start.elapsed() < Duration::from_millis(300) {
                let mut events = Vec::with_capacity(inputs.capacity());
                inputs.merge(&clock, 0, 480, &mut events, |_, _, kind| Some(kind));
                most = most.max(events.len());
                assert!(events.len() <= inputs.capacity(), "{}", events.len());
            }
            done.store(true, std::sync::atomic::Ordering::Relaxed);
        });
        assert!(most > 0, "nothing was sent");
    }

    #[test]
    fn a_full_queue_refuses() {
        let ([mut sender], inputs) = LiveInputs::new();
        assert!((0..inputs.capacity()).all(|_| sender.send_now(0, EventKind::PitchBend(0.0))));
        assert!(!sender.send_now(0, EventKind::PitchBend(0.0)));
    }
}
