//! The work of a block in other orders and on two threads, and what notes played apart sound like.

use crate::in_blocks::in_blocks;
use sprung::engine::{Ensemble, Event, EventKind, Workers};
use sprung::params::Param;
use sprung::preset::{Preset, Programs};
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;

/// One thread that begins at the end.
pub(crate) struct Backwards;

impl Workers for Backwards {
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        items.iter_mut().rev().for_each(work);
    }

    fn shares_notes(&self) -> bool {
        true
    }
}

/// Two threads, each with its half.
pub(crate) struct TwoThreads;

impl Workers for TwoThreads {
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        let (first, second) = items.split_at_mut(items.len() / 2);
        std::thread::scope(|scope| {
            scope.spawn(|| first.iter_mut().for_each(&work));
            second.iter_mut().for_each(&work);
        });
    }

    fn shares_notes(&self) -> bool {
        true
    }
}

/// One thread, in order; it hands out notes if that is wanted, and counts how many.
struct Counting {
    shares_notes: bool,
    notes: AtomicUsize,
}

impl Workers for Counting {
    fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        if items.len() < CHANNELS {
            self.notes.fetch_add(items.len(), Relaxed);
        }
        items.iter_mut().for_each(work);
    }

    fn shares_notes(&self) -> bool {
        self.shares_notes
    }
}

const CHANNELS: usize = 16;
const FRAMES: usize = 30_000;

/// Chords of six notes that are held, let go and choked, with wheels, pedal and knobs that move.
fn chords() -> Vec<Event> {
    let event = |frame, kind| Event { frame, channel: 0, kind };
    let control = |frame, controller, value| event(frame, EventKind::Control { controller, value });
    let mut events = vec![event(5, EventKind::Param { param: Param::InputLevel, value: -10.0 }), control(10, 64, 1.0)];
    for chord in 0..5_u32 {
        let start = chord * 5500 + 17;
        let keys = (0..6).map(|note| 36 + (chord * 5 + note * 7) as u8 % 45);
        events.extend(keys.clone().map(|key| Event::note_on(start, key, 0.3 + 0.1 * chord as f32)));
        events.push(event(start + 900, EventKind::PitchBend(0.2 * chord as f32 - 0.4)));
        events.push(control(start + 1000, 1, 0.25 * chord as f32));
        events.push(control(start + 1100, 11, 1.0 - 0.1 * chord as f32));
        events.push(event(start + 1200, EventKind::Param { param: Param::Decay, value: 0.05 + 0.5 * chord as f32 }));
        events.extend(keys.map(|key| Event::note_off(start + 3800, key)));
        events.push(control(start + 3900, 64, (chord % 2) as f32));
    }
    events
}

#[test]
fn notes_of_some_sounds_played_apart_sound_as_if_one_thread_had_played_them() {
    notes_apart(5);
}

#[test]
#[ignore = "takes half a minute"]
fn notes_played_apart_sound_as_if_one_thread_had_played_them() {
    notes_apart(1);
}

/// Plays every so many of some thirty sounds.
fn notes_apart(step: usize) {
    let (events, programs) = (chords(), Programs::factory_kits());
    let mix = &Programs::general_midi().mix;
    let sounds = Preset::factory().iter().step_by(7).map(Preset::kit);
    let (mut heard, mut shared) = (0, 0);
    for (index, kit) in sounds.chain(programs.iter().step_by(31).cloned()).step_by(step).enumerate() {
        let input: Vec<f32> = (0..FRAMES).map(|n| if n % 400 == 0 { 0.5 } else { 0.0 }).collect();
        let new = || Ensemble::of_kits(48_000.0, 9, &kit, Vec::new()).with_mix(mix).with_chunk(4096);
        let render = |workers: &Counting| {
            let (mut ensemble, mut done) = (new(), 0);
            in_blocks(&events, FRAMES, 4096, |events, left, right| {
                ensemble.process_by(workers, events, &input[done..done + left.len()], left, right);
                done += left.len();
            })
        };
        let [alone, apart] = [false, true].map(|shares_notes| Counting { shares_notes, notes: AtomicUsize::new(0) });
        let (expected, in_order) = (render(&alone), render(&apart));
        assert_eq!(alone.notes.into_inner(), 0);
        shared += usize::from(apart.notes.into_inner() > 10);
        heard += usize::from(expected.iter().any(|bits| f32::from_bits(*bits).abs() > 0.001));
        let (mut ensemble, mut done) = (new(), 0);
        let two = in_blocks(&events, FRAMES, 1024, |events, left, right| {
            ensemble.process_by(&TwoThreads, events, &input[done..done + left.len()], left, right);
            done += left.len();
        });
        for (order, bits) in [("in order", in_order), ("two threads", two)] {
            let differs = expected.iter().zip(&bits).position(|(one, other)| one != other);
            assert_eq!(differs.map(|at| at % FRAMES), None, "sound {index}, {order}");
        }
    }
    assert!(heard * step > 30 && shared * step > 30, "{heard} {shared}");
}
