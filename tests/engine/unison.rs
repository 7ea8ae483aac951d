//! Unison voices and glides, compared with single notes that have the same tuning.

use crate::events::on;
use sprung::engine::{Event, EventKind, Snapshot, Synth};
use sprung::params::Param;
use sprung::patch::Patch;

const RATE: f64 = 48_000.0;
const FRAMES: usize = 48_000;

fn synth(patch: &Patch) -> Synth {
    let mut synth = Synth::new(RATE, 3);
    synth.set_patch(patch);
    synth
}

fn render(patch: &Patch, events: &[Event]) -> [Vec<f32>; 2] {
    let mut sides = [vec![0.0; FRAMES], vec![0.0; FRAMES]];
    let [left, right] = &mut sides;
    synth(patch).process(events, left, right);
    sides
}

fn patch() -> Patch {
    Patch::default().with(Param::Decay, 10.0).with(Param::Limiter, 0.0).with(Param::Gain, 0.0)
}

fn worst(one: &[f32], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (f64::from(*one) - other).abs()).fold(0.0, f64::max)
}

/// 0.01 cent at 440 Hz is 0.016 radians after a second.
#[test]
fn unison_voices_lie_evenly_about_the_note() {
    for count in [2, 3, 8] {
        let unison = patch()
            .with(Param::Unison, count as f32)
            .with(Param::UnisonDetune, 14.0)
            .with(Param::UnisonSpread, 0.0)
            .with(Param::UnisonPhase, 0.0);
        let mut sum = vec![0.0; FRAMES];
        for index in 0..count {
            let cents = -14.0 + 28.0 * f64::from(index) / f64::from(count - 1);
            let [single, _] = render(&patch().with(Param::Fine, cents as f32), &[on(0, 69)]);
            let level = 1.0 / f64::from(count).sqrt();
            sum.iter_mut().zip(single).for_each(|(sum, sample)| *sum += level * f64::from(sample));
        }
        let off = worst(&render(&unison, &[on(0, 69)])[0], &sum);
        assert!(off < 5e-3, "{count}: {off}");
    }
}

#[test]
fn the_lowest_unison_voice_is_on_the_left() {
    let unison = patch().with(Param::Unison, 2.0).with(Param::UnisonSpread, 100.0).with(Param::UnisonPhase, 0.0);
    let sides = render(&unison, &[on(0, 60)]);
    for (side, cents) in sides.iter().zip([-10.0, 10.0]) {
        let [single, _] = render(&patch().with(Param::Fine, cents), &[on(0, 60)]);
        let single: Vec<f64> = single.into_iter().map(f64::from).collect();
        assert!(worst(side, &single) < 5e-3, "half the energy, all of it on one side");
    }
}

#[test]
fn unison_has_the_energy_of_one_voice_whatever_its_phases() {
    let energy = |patch: &Patch| {
        let mut synth = synth(patch);
        let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
        synth.process(&[on(0, 60)], &mut left, &mut right);
        let mut snapshot = Snapshot::default();
        synth.show(&mut snapshot);
        snapshot.masses[0].energy
    };
    for coefficients in [0.0, 1.0] {
        for [mallet, pluck] in [[0.0, -60.0], [-60.0, 0.0]] {
            let levelled = patch().with(Param::MalletLevel, mallet).with(Param::PluckLevel, pluck);
            let patch = levelled.with(Param::Coefficients, coefficients);
            let one = energy(&patch);
            for count in 2..=8 {
                let share = energy(&patch.clone().with(Param::Unison, count as f32)) / one;
                assert!((share - 1.0).abs() < 0.03, "{count} by mallet {mallet}, law {coefficients}: {share}");
            }
        }
    }
    let alike = patch().with(Param::Unison, 3.0);
    let [first, _] = render(&alike, &[on(0, 60)]);
    assert!(first == render(&alike, &[on(0, 60)])[0], "the same seed, note and index, the same phase");
    assert!(first != render(&alike.with(Param::UnisonPhase, 0.0), &[on(0, 60)])[0]);
}

#[test]
fn a_unison_note_ends_once_and_counts_as_one() {
    let mut synth = synth(&patch().with(Param::Unison, 5.0).with(Param::Voices, 3.0));
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    let notes = [on(0, 60), on(10, 64), on(20, 67), on(30, 72)];
    synth.process(&notes, &mut left, &mut right);
    assert_eq!((synth.voices_used(), synth.ended().len()), (3, 1));
    let silence = Event { frame: 0, channel: 0, kind: EventKind::Control { controller: 120, value: 0.0 } };
    synth.process(&[silence], &mut left, &mut right);
    assert_eq!(synth.ended().len(), 3);
    assert!(synth.is_silent());
}

/// Length in frames of the period after a frame: the distance between the next two upward zero crossings.
fn period(samples: &[f32], at: usize) -> f64 {
    let crosses = |i: &usize| samples[*i] < 0.0 && samples[i + 1] >= 0.0;
    let exact = |i: usize| i as f64 + f64::from(samples[i] / (samples[i] - samples[i + 1]));
    let mut crossings = (at..).filter(crosses).map(exact);
    let (first, second) = (crossings.next().unwrap(), crossings.next().unwrap());
    second - first
}

#[test]
fn slides_last_as_long_as_they_are_told() {
    let legato = [on(0, 69), on(9_600, 93)];
    let apart = [on(0, 69), Event::note_off(4_000, 69), on(9_600, 93)];
    let patch = patch().with(Param::Mode, 1.0).with(Param::Glide, 0.25).with(Param::Release, 5.0);
    let choice = |param: Param, name: &str| param.info().parse(name).unwrap();
    let only = patch.clone().with(Param::GlideWhen, choice(Param::GlideWhen, "legato"));
    let rate = patch.clone().with(Param::GlideBy, choice(Param::GlideBy, "rate"));
    // A glide of two octaves: it takes a quarter of a second, or half a second at a constant rate.
    for (name, patch, events, octaves) in [
        ("time", &patch, &legato[..], [1.0, 2.0]),
        ("time, apart", &patch, &apart, [1.0, 2.0]),
        ("rate", &rate, &legato, [0.5, 1.0]),
        ("legato", &only, &legato, [1.0, 2.0]),
        ("legato, apart", &only, &apart, [2.0, 2.0]),
    ] {
        let [samples, _] = render(patch, events);
        for (at, octaves) in [9_600 + 6_000, 9_600 + 12_000].into_iter().zip(octaves) {
            let found = libm::log2(RATE / 440.0 / period(&samples, at));
            assert!((found - octaves).abs() < 0.04, "{name} at {at}: {found} octaves");
        }
    }
}
