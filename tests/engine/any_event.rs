//! The engine through its public interface: any event, any time, any sample rate.

use crate::events::event;
use sprung::engine::{Ensemble, Event, EventKind, Expression, NoteId, Notes, Synth};
use sprung::params::{PARAMS, Param};
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

fn render(patch: &Patch, events: &[Event], frames: usize) -> (Vec<f32>, Vec<f32>) {
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_patch(patch);
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth.process(events, &mut left, &mut right);
    (left, right)
}

#[test]
fn samples_below_200_dbfs_are_silence() {
    for (volume, limiter) in [(1e-4, 1.0), (1e-5, 0.0), (1e-10, 1.0), (1e-18, 1.0)] {
        let patch = Patch::default().with(Param::Limiter, limiter).with(Param::Decay, 5.0);
        let quiet =
            event(0, EventKind::Express { notes: Notes::default(), expression: Expression::Volume, value: volume });
        let events = [Event::note_on(0, 69, 1.0), quiet];
        let alone = render(&patch, &events, 9600);
        let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
        Ensemble::new(48_000.0, 1, &patch, &[]).process(&events, &mut left, &mut right);
        for samples in [alone.0, alone.1, left, right] {
            let lowest = samples.iter().filter(|sample| **sample != 0.0).map(|sample| sample.abs()).fold(1.0, f32::min);
            assert!(lowest >= 1e-10, "volume {volume}: {lowest}");
            assert!(volume < 1e-9 || samples.iter().any(|sample| *sample != 0.0), "volume {volume}");
        }
    }
}

/// Control ticks come every 32 frames. A note that begins at one sweeps through its first tick like any other.
#[test]
fn a_sweep_is_the_same_wherever_a_note_begins() {
    const FRAMES: usize = 4800;
    for (name, most_db) in [("High Q", -20.0), ("Zap", -60.0), ("Electronic Kick", -75.0)] {
        let patch = &Preset::find(name).unwrap().patch;
        let played = |at: usize| render(patch, &[Event::note_on(at as u32, 60, 0.8)], at + FRAMES).0.split_off(at);
        let energy =
            |samples: &[f32]| samples.iter().map(|sample| f64::from(*sample) * f64::from(*sample)).sum::<f64>();
        let between = played(31);
        for at in [0, 8, 32] {
            let difference: Vec<f32> = played(at).iter().zip(&between).map(|(one, other)| one - other).collect();
            let db = 10.0 * libm::log10(energy(&difference) / energy(&between));
            assert!(db < most_db, "{name} at frame {at}: {db} dB");
        }
    }
}

#[test]
fn garbage_in_events_never_comes_out() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e30, 1e30];
    let mut events = vec![];
    for (n, value) in bad.into_iter().enumerate() {
        let frame = n as u32 * 500;
        events.push(event(frame, EventKind::NoteOn { key: 255, detune: value, velocity: value, id: None }));
        events.push(Event::note_on(frame, 60, 1.0));
        for kind in [
            EventKind::PitchBend(value),
            EventKind::ChannelPressure(value),
            EventKind::PolyPressure { key: 60, pressure: value },
            EventKind::Control { controller: 7, value },
            EventKind::Control { controller: 1, value },
            EventKind::Choke { group: 255 },
            EventKind::Tempo(value),
            EventKind::Tune { key: 255, pitch: value, sounding: true },
            EventKind::Tune { key: 60, pitch: value, sounding: false },
            EventKind::Release { notes: Notes::on(255, 255), velocity: value },
            EventKind::Silence { notes: Notes::on(255, 255) },
            EventKind::Modulate { id: None, param: Param::Gain, offset: value },
            EventKind::Modulate { id: NoteId::new(-1), param: Param::Tune, offset: value },
            EventKind::ModulateNotes { notes: Notes::on(255, 255), param: Param::Tune, offset: value },
            EventKind::ModulateNotes { notes: Notes::default(), param: Param::Gain, offset: value },
        ] {
            events.push(Event { frame, channel: 255, kind });
            events.push(event(frame, kind));
        }
        events.extend(Expression::ALL.map(|expression| {
            let notes = Notes::default();
            event(frame, EventKind::Express { notes, expression, value })
        }));
        events.extend(PARAMS.iter().map(|info| event(frame, EventKind::Param { param: info.param, value })));
    }
    let (left, right) = render(&Patch::default(), &events, 9600);
    assert!(left.iter().chain(&right).all(|sample| sample.is_finite()));
    assert!(left.iter().chain(&right).any(|sample| *sample != 0.0), "it sounds all the same");
}

#[test]
fn events_beyond_the_block_are_taken_at_its_last_frame() {
    let late = render(&Patch::default(), &[Event::note_on(479, 60, 1.0)], 480);
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_patch(&Patch::default());
    let (mut left, mut right) = (vec![0.0; 480], vec![0.0; 480]);
    synth.process(&[Event::note_on(9999, 60, 1.0)], &mut left, &mut right);
    assert_eq!((left, right), late);
}

#[test]
fn a_note_starts_at_its_frame() {
    for frame in [0, 1, 31, 32, 33, 400] {
        let (left, _) = render(&Patch::default(), &[Event::note_on(frame, 60, 1.0)], 480);
        assert_eq!(left.iter().position(|sample| *sample != 0.0), Some(frame as usize));
    }
}

#[test]
fn reset_and_prepare_bring_back_the_beginning() {
    let patch =
        Patch::default().with(Param::MalletLevel, -60.0).with(Param::NoiseReach, 100.0).with(Param::Vibrato, 50.0);
    let events = [
        Event::note_on(10, 60, 1.0),
        Event::note_on(700, 64, 0.4),
        Event::note_off(900, 60),
        event(950, EventKind::PitchBend(0.5)),
    ];
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_patch(&patch);
    let mut first = [vec![0.0; 4800], vec![0.0; 4800]];
    let mut again = first.clone();
    let run = |synth: &mut Synth, out: &mut [Vec<f32>; 2]| {
        let [left, right] = out;
        synth.process(&events, left, right);
    };
    synth.reset();
    run(&mut synth, &mut first);
    synth.reset();
    run(&mut synth, &mut again);
    assert_eq!(first, again);
    synth.prepare(48_000.0);
    run(&mut synth, &mut again);
    assert_eq!(first, again);
    assert_eq!(synth.values(), &patch.values);
}

#[test]
fn a_synth_falls_silent_by_itself_and_stays_silent() {
    let patch = Patch::default().with(Param::Decay, 0.1);
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_patch(&patch);
    let (mut left, mut right) = (vec![0.0; 48_000], vec![0.0; 48_000]);
    synth.process(&[Event::note_on(0, 60, 1.0)], &mut left, &mut right);
    assert!(synth.is_silent());
    let end = left.iter().rposition(|sample| *sample != 0.0).unwrap();
    // The gain lowers the peak by 6 dB; from there, −120 dBFS is 1.9 T60s of 4,800 frames away.
    assert!((9_000..=9_300).contains(&end), "{end}");
    assert!(left[end].abs() < 1e-6);
}

#[test]
fn every_rate_and_block_size_plays_in_tune() {
    for rate in [8_000.0, 11_025.0, 44_100.0, 96_000.0, 384_000.0, 768_000.0] {
        let mut synth = Synth::new(rate, 1);
        let frames = rate as usize;
        let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
        synth.process(&[], &mut [], &mut []);
        synth.handle(&Event::note_on(0, 69, 1.0));
        synth.process(&[], &mut [], &mut []);
        for (left, right) in left.chunks_mut(65_536).zip(right.chunks_mut(65_536)) {
            synth.process(&[], left, right);
        }
        let crossings = left.windows(2).filter(|pair| pair[0] < 0.0 && pair[1] >= 0.0).count();
        assert!((439..=441).contains(&crossings), "{crossings} periods at {rate} Hz");
    }
}

#[test]
fn a_sample_rate_out_of_range_is_brought_into_it() {
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        let mut synth = Synth::new(rate, 1);
        let (mut left, mut right) = (vec![0.0; 480], vec![0.0; 480]);
        synth.process(&[Event::note_on(0, 69, 1.0)], &mut left, &mut right);
        assert!(left.iter().all(|sample| sample.is_finite()) && left[100] != 0.0, "{rate}");
    }
}

#[test]
fn a_block_of_no_frames_brings_its_events() {
    let mut ensemble = Ensemble::new(48_000.0, 1, &Patch::default(), &[]);
    let (mut left, mut right) = (vec![0.0; 480], vec![0.0; 480]);
    ensemble.process(&[Event::note_on(0, 60, 1.0)], &mut [], &mut []);
    ensemble.process(&[], &mut left, &mut right);
    assert!(left.iter().any(|sample| sample.abs() > 0.1));
    ensemble.process(&[Event::note_off(0, 60)], &mut [], &mut []);
    (0..100).for_each(|_| ensemble.process(&[], &mut left, &mut right));
    assert!(ensemble.is_silent());
}

fn rms(samples: &[f32]) -> f32 {
    (samples.iter().map(|sample| sample * sample).sum::<f32>() / samples.len() as f32).sqrt()
}

/// Number of periods of the lowest mode in some samples.
fn periods(samples: &[f32]) -> usize {
    samples.windows(2).filter(|pair| pair[0] < 0.0 && pair[1] >= 0.0).count()
}

#[test]
fn a_monophonic_voice_plays_every_note_as_a_new_one_would() {
    let tone = |mode: f32, coefficients: f32, keys: &[u8]| {
        let patch = Patch::default().with(Param::Mode, mode).with(Param::Coefficients, coefficients);
        let events: Vec<Event> = (0..).zip(keys).map(|(n, key)| Event::note_on(n * 4800, *key, 1.0)).collect();
        let (left, _) = render(&patch, &events, 4800 * (keys.len() + 9));
        periods(&left[4800 * (keys.len() - 1) + 64..][..38_400])
    };
    for coefficients in [0.0, 1.0] {
        let direct = tone(1.0, coefficients, &[60]);
        for mode in [1.0, 2.0] {
            for before in [36, 108, 127] {
                let after = tone(mode, coefficients, &[before, 60]);
                assert!(after.abs_diff(direct) <= 1, "{before} before: {after} periods where {direct} are right");
            }
        }
    }
}

#[test]
fn a_changed_patch_is_heard_by_a_note_that_strikes_again() {
    let tuning = event(24_000, EventKind::Param { param: Param::Tuning, value: 480.0 });
    let events = [Event::note_on(0, 69, 1.0), tuning, Event::note_on(24_000, 69, 1.0)];
    let (left, _) = render(&Patch::default(), &events, 72_064);
    assert!(periods(&left[..24_000]).abs_diff(220) <= 1);
    assert!(periods(&left[24_064..]).abs_diff(480) <= 1, "{}", periods(&left[24_064..]));
}

#[test]
fn a_touch_takes_nothing_from_the_stroke_before() {
    let soft = Patch::default().with(Param::MalletPulse, 1.0).with(Param::MalletHardness, 0.0);
    let (alone, _) = render(&soft, &[Event::note_on(0, 48, 1.0)], 9600);
    let (touched, _) = render(&soft, &[Event::note_on(0, 48, 1.0), Event::note_on(240, 48, 0.01)], 9600);
    assert!(rms(&touched) > 0.99 * rms(&alone), "{} {}", rms(&touched), rms(&alone));
}

#[test]
fn pressure_belongs_to_its_key() {
    let legato = Patch::default().with(Param::Mode, 2.0).with(Param::Decay, 10.0).with_route(
        0,
        Source::Pressure,
        Param::Damper,
        100.0,
    );
    let pressed = event(4800, EventKind::PolyPressure { key: 57, pressure: 1.0 });
    let (plain, _) = render(&legato, &[Event::note_on(0, 57, 1.0), Event::note_on(4900, 64, 1.0)], 48_000);
    let (left, _) = render(&legato, &[Event::note_on(0, 57, 1.0), pressed, Event::note_on(4900, 64, 1.0)], 48_000);
    assert!(rms(&left[24_000..]) > 0.7 * rms(&plain[24_000..]));
}

#[test]
fn a_sweep_from_beyond_the_spectrum_arrives() {
    let zap = Patch::default().with(Param::Sweep, 60.0).with(Param::SweepTime, 0.05).with(Param::Decay, 2.0);
    for (key, periods_expected) in [(60, 262), (84, 1047), (108, 4186)] {
        let (left, _) = render(&zap, &[Event::note_on(0, key, 1.0)], 57_600);
        assert!(periods(&left[9600..]).abs_diff(periods_expected) <= 2, "{key}: {}", periods(&left[9600..]));
        assert!(rms(&left[9600..14_400]) > 0.1, "{key}: {}", rms(&left[9600..14_400]));
    }
}

/// After a change of patch, a held key that gets the voice back keeps the patch with which the voice started: its ratios, decay,
/// tracking and tuning, not those of the new patch.
#[test]
fn a_voice_returns_to_a_held_key_in_its_own_patch() {
    let first = Patch::default().with(Param::Decay, 20.0).with(Param::Limiter, 0.0);
    let second = first.clone().with(Param::Decay, 0.05).with(Param::Stretch, 0.5).with(Param::KeyTrack, 0.0);
    let mut other = second.clone().with(Param::Tuning, 400.0);
    other.modes = ModeTable::new(&[Mode { ratio: 0.25, ..Mode::UNIT }]);
    for mode in [1.0, 2.0] {
        let patch = first.clone().with(Param::Mode, mode);
        let [kept, changed] = [None, Some(other.clone().with(Param::Mode, mode))].map(|program| {
            let mut synth = Synth::new(48_000.0, 1);
            synth.set_patch(&patch);
            let (mut left, mut right) = (vec![0.0; 9_600], vec![0.0; 9_600]);
            synth.process(&[Event::note_on(0, 60, 1.0), Event::note_on(4_800, 64, 1.0)], &mut left, &mut right);
            program.iter().for_each(|program| synth.set_patch(program));
            synth.process(&[Event::note_off(0, 64)], &mut left, &mut right);
            left
        });
        assert_eq!(periods(&kept), 52, "mode {mode}: 261.6 Hz for a fifth of a second");
        assert!(kept == changed, "mode {mode}: {} periods", periods(&changed));
    }
}

/// Values that are all set at once during silence sound as if they had always been set, and modulation is kept.
#[test]
fn values_set_at_once_have_no_slopes() {
    let mut values = Preset::find("Marimba").unwrap().patch.values;
    values.set(Param::Gain, -9.0);
    let expected = {
        let patch = Patch { values, ..Patch::default() };
        let mut synth = Synth::new(48_000.0, 1);
        synth.set_patch(&patch);
        synth.handle(&event(0, EventKind::Modulate { id: None, param: Param::Tune, offset: 0.1 }));
        played(&mut synth, &[Event::note_on(9600, 60, 0.8)])
    };
    let mut synth = Synth::new(48_000.0, 1);
    synth.handle(&event(0, EventKind::Modulate { id: None, param: Param::Tune, offset: 0.1 }));
    synth.process(&[], &mut [0.0; 9600], &mut [0.0; 9600]);
    synth.set_values(&values);
    assert_eq!(synth.values(), &values);
    let found = played(&mut synth, &[Event::note_on(0, 60, 0.8)]);
    assert!(expected[9600..14_400].iter().any(|sample| *sample != 0.0));
    assert_eq!(found[..4800], expected[9600..14_400]);
}

/// The left channel of what a synth plays.
fn played(synth: &mut Synth, events: &[Event]) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; 14_400], vec![0.0; 14_400]);
    synth.process(events, &mut left, &mut right);
    left
}
