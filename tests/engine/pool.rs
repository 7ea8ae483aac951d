//! The voice pool: sixteen channels that need more voices than there are, and bodies with many cells.

use crate::in_blocks::in_blocks;
use crate::workers::{Backwards, TwoThreads};
use sprung::engine::{Ensemble, Event, EventKind, Synth, Workers};
use sprung::params::Param;
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};
use sprung::preset::Preset;
use sprung::sound::Kit;

const RATE: f64 = 48_000.0;
const FRAMES: usize = 14_400;

/// A body with this many modes that rings for long.
fn patch(modes: usize) -> Patch {
    let share = 1.0 / modes as f32;
    let mode = |m: usize| Mode {
        ratio: 1.0 + 0.07 * m as f32,
        level: share,
        decay: 0.5 + (m % 7) as f32 * 0.3,
        pan: (m % 5) as f32 * 0.4 - 0.8,
        ..Mode::UNIT
    };
    let mut patch = Patch::default().with(Param::Decay, 4.0).with(Param::Voices, 64.0).with(Param::Limiter, 0.0);
    patch.modes = ModeTable::new(&(0..modes).map(mode).collect::<Vec<_>>());
    patch
}

fn on(frame: u32, channel: u8, key: u8, velocity: f32) -> Event {
    Event { channel, ..Event::note_on(frame, key, velocity) }
}

/// More and more notes on all channels, with programs of other sizes, choke groups and some releases.
fn storm() -> Vec<Event> {
    let mut events = vec![];
    for n in 0..700_u32 {
        let (frame, channel) = (n * 19, (n * 7 % 16) as u8);
        let key = (30 + n * 11 % 61) as u8;
        let event = |kind| Event { frame, channel, kind };
        if n % 9 == 0 {
            events.push(event(EventKind::Program((n / 9 % 3) as u8)));
        }
        events.push(on(frame, channel, key, 0.2 + (n % 8) as f32 * 0.1));
        if n % 5 == 0 {
            events.push(on(frame, (channel + 1) % 16, key, 0.5));
            events.push(event(EventKind::NoteOff { key: key - 3, velocity: 0.5, id: None }));
        }
        if n % 31 == 0 {
            events.push(event(EventKind::Param { param: Param::Mode, value: (n % 3) as f32 }));
        }
    }
    events
}

fn render(ensemble: &mut Ensemble, events: &[Event], block: usize, workers: &impl Workers) -> Vec<u32> {
    in_blocks(events, FRAMES, block, |events, left, right| ensemble.process_by(workers, events, &[], left, right))
}

fn ensemble() -> Ensemble {
    Ensemble::new(RATE, 5, &patch(100), &[patch(1), patch(200), patch(MAX_MODES)])
}

#[test]
fn an_exhausted_pool_gives_the_same_bits_however_frames_are_divided() {
    let events = storm();
    let whole = render(&mut ensemble(), &events, FRAMES, &Backwards);
    assert!(whole.iter().all(|bits| f32::from_bits(*bits).is_finite()));
    assert!(whole.iter().any(|bits| f32::from_bits(*bits).abs() > 0.1));
    let compare = |block, parts: Vec<u32>| {
        let differs = whole.iter().zip(&parts).position(|(one, other)| one != other);
        assert_eq!(differs.map(|at| at % FRAMES), None, "blocks of {block}");
    };
    for block in [1, 64] {
        compare(block, render(&mut ensemble(), &events, block, &Backwards));
    }
    compare(480, render(&mut ensemble(), &events, 480, &TwoThreads));
}

/// Fewer notes sound than were struck, and those that sound are not the quietest.
#[test]
fn the_quietest_of_all_channels_give_way() {
    let mut ensemble = Ensemble::new(RATE, 0, &patch(MAX_MODES), &[]);
    let strike = |n: u8| on(u32::from(n) * 64, n % 16, 30 + n, if n < 20 { 0.05 } else { 0.9 });
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    ensemble.process(&(0..48).map(strike).collect::<Vec<_>>(), &mut left, &mut right);
    assert_eq!(ensemble.snapshot().voices, 48, "a pool of 384 cells for notes that do not fade");
    let more: Vec<_> = (48..68).map(|n| on(0, n % 16, 30 + n, 0.9)).collect();
    ensemble.process(&more, &mut left, &mut right);
    // The stolen notes have faded out.
    assert_eq!(ensemble.snapshot().voices, 48);
    let energy = ensemble.snapshot().masses[0].energy;
    let mut loud = Ensemble::new(RATE, 0, &patch(MAX_MODES), &[]);
    let strike = |n: u8| on(u32::from(n) * 64, n % 16, 30 + n, 0.9);
    loud.process(&(20..48).map(strike).collect::<Vec<_>>(), &mut left, &mut right);
    loud.process(&more, &mut left, &mut right);
    assert!((energy / loud.snapshot().masses[0].energy - 1.0).abs() < 0.01, "the 48 loud notes are left");
}

#[test]
fn a_used_ensemble_plays_as_a_new_one() {
    let mut used = ensemble();
    render(&mut used, &storm(), 480, &Backwards);
    let silence: Vec<Event> = (0..16)
        .map(|channel| Event { frame: 0, channel, kind: EventKind::Control { controller: 120, value: 0.0 } })
        .collect();
    render(&mut used, &silence, 480, &Backwards);
    assert!(used.is_silent());
    let mut fresh = Ensemble::new(RATE, 5, &patch(100), &[]);
    // The clocks of both ensembles are at a control tick, and the sound has no random part.
    (0..16).for_each(|channel| used.set_kit(channel, &Kit::of_patch(&patch(300))));
    (0..16).for_each(|channel| fresh.set_kit(channel, &Kit::of_patch(&patch(300))));
    let notes: Vec<_> = (0..30).map(|n| on(u32::from(n) * 333, n % 16, 40 + n, 0.7)).collect();
    assert!(render(&mut used, &notes, 480, &Backwards) == render(&mut fresh, &notes, 480, &Backwards));
}

/// One voice of 512 modes, compared with eight synths with one cell each.
#[test]
fn a_voice_of_512_modes_is_the_sum_of_eight_of_64() {
    let whole = patch(MAX_MODES);
    let play = |patch: &Patch| {
        let mut synth = Synth::new(RATE, 0);
        synth.set_patch(patch);
        let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
        let bend = Event { frame: 3_000, channel: 0, kind: EventKind::PitchBend(0.5) };
        synth.process(&[Event::note_on(100, 45, 0.8), bend, Event::note_off(9_000, 45)], &mut left, &mut right);
        left
    };
    let together = play(&whole);
    let mut sum = vec![0.0_f64; FRAMES];
    for modes in whole.modes.as_slice().chunks(64) {
        let mut part = whole.clone();
        part.modes = ModeTable::new(modes);
        sum.iter_mut().zip(play(&part)).for_each(|(sum, sample)| *sum += f64::from(sample));
    }
    let worst = together.iter().zip(&sum).map(|(one, sum)| (f64::from(*one) - sum).abs()).fold(0.0, f64::max);
    let peak = together.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    assert!(peak > 0.1 && worst < 1e-5, "{peak} {worst}");
}

#[test]
fn a_synth_steals_when_its_own_pool_is_exhausted() {
    let mut synth = Synth::new(RATE, 0);
    synth.set_patch(&patch(MAX_MODES));
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    let events: Vec<_> = (0..60).map(|n| on(u32::from(n), 0, 30 + n, 0.5)).collect();
    synth.process(&events, &mut left, &mut right);
    // 24 voices of 512 modes take 192 cells.
    assert_eq!(synth.voices_used(), 24);
    let mut reported: Vec<u64> = synth.ended().iter().map(|note| note.serial).collect();
    reported.sort_unstable();
    reported.dedup();
    assert_eq!(reported.len(), 36, "each note that gave way has ended once");
}

/// A note that is played swings in after it has begun. It is not the quietest for that.
#[test]
fn a_chord_that_is_bowed_takes_the_place_of_older_notes_not_of_itself() {
    let violin = Preset::find("Violin").unwrap().patch.clone().with(Param::Voices, 2.0);
    let violin = violin.with(Param::MalletLevel, -60.0).with(Param::NoiseLevel, -60.0);
    let mut ensemble = Ensemble::new(48_000.0, 1, &violin, &[]);
    let on = |frame, key| Event::note_on(frame, key, 0.8);
    let events = [on(0, 55), on(0, 62), on(48_000, 67), on(48_000, 71)];
    let (mut left, mut right) = (vec![0.0; 60_000], vec![0.0; 60_000]);
    ensemble.process(&events, &mut left, &mut right);
    let mut keys: Vec<u8> = ensemble.snapshot().notes.iter().flatten().map(|note| note.key).collect();
    keys.sort_unstable();
    assert_eq!(keys, [67, 71]);
}
