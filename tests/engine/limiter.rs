//! The limiter: what passes unchanged, the highest level between samples, and how the gain moves.
//!
//! True peaks are measured by `ebur128`.

use ebur128::{EbuR128, Mode};
use proptest::prelude::*;
use sprung::engine::{Ensemble, Event, EventKind, Synth};
use sprung::internals::random::uniform;
use sprung::internals::space::Limiter;
use sprung::io::Song;
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::preset::Preset;
use sprung::render::{Job, Options, Tail};
use sprung::sound::Kit;
use sprung::units::{db_from_gain, gain_from_db};
use std::f64::consts::TAU;

/// True peak in dBFS up to which signals pass bit for bit.
const TRANSPARENT: f64 = -1.0;

/// Highest true peak in dBFS that the limiter guarantees.
const HIGHEST: f64 = -0.3;

/// Highest true peak in dBFS of noise, which can peak between two samples that are both just below the threshold.
const HIGHEST_OF_NOISE: f64 = 0.5;

/// The same for white noise up to half the sample rate.
const HIGHEST_OF_WHITE_NOISE: f64 = 0.6;

const RATES: [u32; 6] = [22_050, 44_100, 48_000, 88_200, 96_000, 192_000];

type Stereo = [Vec<f32>; 2];

/// True peak in dBFS. Silence is appended, so that the last points between samples count.
fn true_peak(rate: u32, [left, right]: &Stereo) -> f64 {
    let mut meter = EbuR128::new(2, rate, Mode::TRUE_PEAK).unwrap();
    meter.add_frames_planar_f32(&[left, right]).unwrap();
    meter.add_frames_planar_f32(&[&[0.0; 32], &[0.0; 32]]).unwrap();
    let peak = (0..2).map(|channel| meter.true_peak(channel).unwrap()).fold(0.0, f64::max);
    db_from_gain(peak)
}

fn limited(rate: u32, stereo: &Stereo) -> Stereo {
    let [mut left, mut right] = stereo.clone();
    Limiter::new(rate.into()).process(true, &mut left, &mut right);
    [left, right]
}

/// A stereo signal whose right channel has half the level of the left.
fn stereo(samples: impl Iterator<Item = f64>) -> Stereo {
    let left: Vec<f32> = samples.map(|sample| sample as f32).collect();
    let right = left.iter().map(|sample| 0.5 * sample).collect();
    [left, right]
}

fn scaled([left, right]: &Stereo, gain: f64) -> Stereo {
    [left, right].map(|side| side.iter().map(|sample| (f64::from(*sample) * gain) as f32).collect())
}

/// Random numbers from −1 to 1.
fn noise(seed: u64) -> impl Iterator<Item = f64> {
    (0..).map(move |n| uniform(seed, n).into())
}

const FRAMES: usize = 4800;

/// Full-scale signals that are most difficult for a limiter. Frequencies are relative to the sample rate.
fn adversaries() -> Vec<(String, Stereo)> {
    let mut signals = Vec::new();
    for period in [1, 2, 3, 4, 5, 7, 11, 50, 240] {
        let square = (0..FRAMES).map(|n| if (n / period) % 2 == 0 { 1.0 } else { -1.0 });
        signals.push((format!("square, half a period of {period}"), stereo(square)));
    }
    for frequency in [0.0005, 0.01, 0.1, 0.2, 0.25, 1.0 / 3.0, 0.4, 0.45, 0.47, 0.49, 0.499] {
        for phase in [0.0, 0.125, 0.25, 0.4] {
            let sine = (0..FRAMES).map(|n| libm::sin(TAU * (frequency * n as f64 + phase)));
            signals.push((format!("sine at {frequency} from {phase}"), stereo(sine)));
        }
    }
    for length in [1, 2, 3, 8, 100] {
        let pulse = (0..FRAMES).map(|n| if (100..100 + length).contains(&n) { 1.0 } else { 0.0 });
        signals.push((format!("pulse of {length}"), stereo(pulse)));
    }
    signals
}

/// White noise that decays.
fn burst(seed: u64) -> Stereo {
    stereo(noise(seed).enumerate().map(|(n, sample)| sample * libm::exp(-(n as f64) / 1000.0)).take(FRAMES))
}

/// The rates of the commit's suite.
const USUAL: [u32; 2] = [44_100, 48_000];

#[test]
fn a_true_peak_below_the_threshold_passes_bit_for_bit() {
    passes_below(&USUAL);
}

#[test]
#[ignore = "takes seconds"]
fn true_peaks_are_limited_at_every_rate() {
    passes_below(&RATES);
    brings_down_above(&RATES);
}

fn passes_below(rates: &[u32]) {
    for &rate in rates {
        let bursts = (0..4).map(|seed| (format!("burst {seed}"), burst(seed)));
        for (name, signal) in adversaries().into_iter().chain(bursts) {
            let signal = scaled(&signal, gain_from_db(TRANSPARENT - 0.001 - true_peak(rate, &signal)));
            // From 96 kHz on, the meter evaluates fewer points between samples than the limiter does.
            let signal = scaled(&signal, gain_from_db(f64::min(0.0, TRANSPARENT - true_peak(48_000, &signal))));
            assert!(limited(rate, &signal) == signal, "{name} at {rate} Hz");
        }
    }
}

#[test]
fn a_true_peak_above_it_is_brought_down() {
    brings_down_above(&USUAL);
}

fn brings_down_above(rates: &[u32]) {
    let mut high = Vec::new();
    for &rate in rates {
        for (name, signal) in adversaries() {
            // A full-scale sine at a quarter of the sample rate can have all of its samples below the threshold.
            for (gain_db, highest) in [(0.0, -0.2), (3.0, HIGHEST), (20.0, HIGHEST)] {
                let peak = true_peak(rate, &limited(rate, &scaled(&signal, gain_from_db(gain_db))));
                if peak > highest {
                    high.push(format!("{name}, {gain_db:+} dB, at {rate} Hz: {peak:.2} dBFS"));
                }
            }
        }
    }
    assert!(high.is_empty(), "\n{}", high.join("\n"));
}

/// Noise up to half the sample rate may have a peak between two samples that are both below the threshold: no limiter without
/// latency can foresee it. After a sample has exceeded the threshold, noise is limited like everything else.
#[test]
fn white_noise_may_exceed_full_scale_once() {
    for seed in 0..40 {
        let noise = burst(seed);
        for (gain_db, highest) in [(0.0, HIGHEST_OF_WHITE_NOISE), (20.0, HIGHEST)] {
            let peak = true_peak(48_000, &limited(48_000, &scaled(&noise, gain_from_db(gain_db))));
            assert!(peak <= highest, "{seed}, {gain_db:+} dB: {peak:.2} dBFS");
        }
    }
}

/// The gain of each frame that is loud enough to measure it; `None` for the others.
fn gains(before: &[f32], after: &[f32]) -> Vec<Option<f64>> {
    let gain = |(before, after): (&f32, &f32)| (before.abs() > 1e-3).then(|| f64::from(*after) / f64::from(*before));
    before.iter().zip(after).map(gain).collect()
}

#[test]
fn steady_tones_are_not_distorted() {
    for frequency in [20.0, 50.0, 333.3, 1000.0, 4410.0, 9000.0, 15_000.0, 20_000.0] {
        for level in [gain_from_db(-0.7), 1.0, 2.0, 10.0] {
            let tone = stereo((0..48_000).map(|n| level * libm::sin(TAU * frequency * f64::from(n) / 48_000.0)));
            let [left, right] = limited(48_000, &tone);
            let settled: Vec<f64> = gains(&tone[0], &left).split_off(24_000).into_iter().flatten().collect();
            let (least, most) =
                settled.iter().fold((1.0, 0.0), |(a, b), gain| (f64::min(a, *gain), f64::max(b, *gain)));
            // The measured points of the peaks differ from period to period: 0.01 dB.
            assert!(most < 1.0 && most / least < 1.001_2, "{frequency} Hz, {level:.2}: {least} to {most}");
            assert!(left.iter().zip(&right).all(|(left, right)| 0.5 * left == *right), "the sides are linked");
        }
    }
}

#[test]
fn the_gain_falls_at_once_holds_and_rises_without_haste() {
    let quiet = 0.1;
    let burst = 4_800..5_280;
    let signal = stereo((0..96_000).map(|n| {
        let level = if burst.contains(&n) { 2.0 } else { quiet };
        level * libm::sin(TAU * 1000.0 * n as f64 / 48_000.0)
    }));
    let [left, _] = limited(48_000, &signal);
    assert!(left[..burst.start] == signal[0][..burst.start], "unchanged before");
    let gains: Vec<f64> = gains(&signal[0], &left).split_off(burst.end).into_iter().flatten().collect();
    // 46 of the 48 frames of a period are loud enough to measure.
    let at = |milliseconds: usize| gains[milliseconds * 46];
    assert!((at(0) - 0.4025).abs() < 0.005, "{}", at(0));
    assert!((at(25) / at(0) - 1.0).abs() < 1e-5, "held: {}", at(25));
    let decibels: Vec<f64> = gains.iter().map(|gain| db_from_gain(*gain)).collect();
    for pair in decibels.windows(2) {
        let rise = pair[1] - pair[0];
        // Between two measured frames are at most three frames.
        assert!((-1e-4..0.15 / 48.0 * 3.0).contains(&rise), "{rise} dB in a frame or three");
    }
    assert!(decibels[46 * 100] < -2.5 && decibels[46 * 350] > -0.5, "{} {}", decibels[4600], decibels[46 * 350]);
    assert_eq!(gains.last(), Some(&1.0), "and it is 1 again in the end");
}

fn chord(velocity: f32) -> Vec<Event> {
    [60, 64, 67, 72].map(|key| Event::note_on(0, key, velocity)).to_vec()
}

fn play(rate: u32, patch: &Patch, events: &[Event], seconds: f64) -> Stereo {
    let mut synth = Synth::new(rate.into(), 0);
    synth.set_patch(patch);
    let frames = (seconds * f64::from(rate)) as usize;
    let [mut left, mut right] = [vec![0.0; frames], vec![0.0; frames]];
    synth.process(events, &mut left, &mut right);
    [left, right]
}

#[test]
fn a_chord_of_some_presets_stays_below_full_scale() {
    chords(8, |index| &RATES[index % RATES.len()..][..1]);
}

#[test]
#[ignore = "takes minutes"]
fn a_chord_of_any_preset_stays_below_full_scale() {
    chords(1, |_| &RATES);
}

/// Chords of every so many presets, each at these rates.
fn chords(step: usize, rates: impl Fn(usize) -> &'static [u32]) {
    let mut loud = 0;
    for (index, preset) in Preset::factory().iter().step_by(step).enumerate() {
        for &rate in rates(index) {
            let peak = true_peak(rate, &play(rate, &preset.patch, &chord(1.0), 0.6));
            assert!(peak <= HIGHEST_OF_NOISE, "{} at {rate} Hz: {peak:.2} dBFS", preset.name);
        }
        let off = preset.patch.clone().with(Param::Limiter, 0.0);
        loud += usize::from(true_peak(48_000, &play(48_000, &off, &chord(1.0), 0.6)) > 0.0);
    }
    assert!(loud * step > 20, "of every {step}th preset, {loud} exceed full scale without the limiter");
}

#[test]
fn a_rendered_chord_of_some_presets_stays_below_full_scale_and_tells_how_much_was_lowered() {
    rendered_chords(16);
}

#[test]
#[ignore = "takes half a minute"]
fn a_rendered_chord_of_any_preset_stays_below_full_scale_and_tells_how_much_was_lowered() {
    rendered_chords(1);
}

/// Rendered chords of every so many presets.
fn rendered_chords(step: usize) {
    let song = Song::chord(&[60.0, 64.0, 67.0, 72.0], 1.0, 0.5);
    let render = |patch: &Patch| {
        let options = Options { sample_rate: 48_000, seed: 0, block: 512, tail: Tail::None };
        let mut sound = [vec![], vec![]];
        let rendered = Job::new(&song, &Kit::of_patch(patch), options).render(|left, right| {
            sound[0].extend(left);
            sound[1].extend(right);
            Ok(())
        });
        (sound, rendered.unwrap().limiter)
    };
    for preset in Preset::factory().iter().step_by(step) {
        let (sound, work) = render(&preset.patch);
        let peak = true_peak(48_000, &sound);
        assert!(peak <= HIGHEST_OF_NOISE, "{}: {peak:.2} dBFS", preset.name);
        let (off, none) = render(&preset.patch.clone().with(Param::Limiter, 0.0));
        assert_eq!((none.least_gain, none.frames), (1.0, 0));
        let unlimited = true_peak(48_000, &off);
        assert_eq!(work.least_gain < 1.0, sound != off, "{}", preset.name);
        if unlimited < TRANSPARENT {
            assert!(sound == off, "{}: {unlimited:.2} dBFS passes", preset.name);
        } else if unlimited > 0.0 {
            let lowered = db_from_gain(work.least_gain);
            // A first peak is clipped, and only the later peaks are lowered by the gain.
            assert!(lowered < -0.9, "{}: {unlimited:.2} {lowered:.2}", preset.name);
            assert!(work.frames > 100, "{}: {}", preset.name, work.frames);
        }
    }
}

#[test]
fn sixty_four_voices_at_once_stay_below_full_scale() {
    for name in ["init", "Church Bell", "Snare", "Open Hat", "Triangle", "Sub Bass", "Gong"] {
        let patch = Preset::find(name).unwrap().patch.clone().with(Param::Voices, 64.0).with(Param::Gain, 12.0);
        for (spread, rate) in [(0, 48_000), (37, 22_050), (37, 96_000)] {
            let events: Vec<Event> = (0..64).map(|n| Event::note_on(n * spread, 32 + n as u8, 1.0)).collect();
            let peak = true_peak(rate, &play(rate, &patch, &events, 0.3));
            assert!(peak <= HIGHEST, "{name} at {rate} Hz: {peak:.2} dBFS");
        }
    }
}

fn ensemble(programs: &[Patch], events: &[Event], frames: usize) -> Stereo {
    let mut ensemble = Ensemble::new(48_000.0, 0, &Patch::default(), programs);
    let [mut left, mut right] = [vec![0.0; frames], vec![0.0; frames]];
    ensemble.process(events, &mut left, &mut right);
    [left, right]
}

fn channels(range: std::ops::Range<u8>) -> Vec<Event> {
    range.map(|channel| Event { channel, ..Event::note_on(0, 48 + channel, 1.0) }).collect()
}

#[test]
fn sixteen_channels_have_one_limiter_after_the_mix() {
    let alone = ensemble(&[], &channels(0..1), 4800);
    assert!(true_peak(48_000, &alone) < TRANSPARENT, "one channel has no need of it");
    let all = ensemble(&[], &channels(0..16), 48_000);
    let peak = true_peak(48_000, &all);
    assert!((-3.0..=HIGHEST).contains(&peak), "{peak:.2} dBFS");
}

#[test]
fn the_mix_is_limited_while_a_channel_that_has_played_asks_for_it() {
    let off = [Patch::default().with(Param::Limiter, 0.0)];
    let is_limited = |events: &[Event]| true_peak(48_000, &ensemble(&off, events, 4800)) <= HIGHEST;
    let switch = |channel, kind| Event { frame: 0, channel, kind };
    let off = |range: std::ops::Range<u8>| range.map(|channel| switch(channel, EventKind::Program(0)));
    let notes = channels(0..8);
    assert!(is_limited(&notes));
    assert!(is_limited(&off(0..7).chain(notes.clone()).collect::<Vec<_>>()), "one channel asks");
    assert!(!is_limited(&off(0..8).chain(notes.clone()).collect::<Vec<_>>()), "no channel that plays asks");
    let on = switch(3, EventKind::Param { param: Param::Limiter, value: 1.0 });
    assert!(is_limited(&off(0..8).chain([on]).chain(notes).collect::<Vec<_>>()), "one asks again");
}

#[test]
fn switching_is_heard_at_once_but_not_as_a_click() {
    let patch = Patch::default().with(Param::Gain, 6.0).with(Param::Decay, 20.0);
    let switch = |frame, value| Event { frame, channel: 0, kind: EventKind::Param { param: Param::Limiter, value } };
    let events = [&chord(1.0)[..], &[switch(24_000, 0.0)]].concat();
    let [with, without] = [events, chord(1.0)].map(|events| play(48_000, &patch, &events, 2.5));
    let off = play(48_000, &patch.with(Param::Limiter, 0.0), &chord(1.0), 2.5);
    assert!(with[0][..24_000] == without[0][..24_000] && with[0][24_000..] != without[0][24_000..]);
    // After it is switched off, the gain rises as it does after the last peak.
    let gains: Vec<f64> = gains(&off[0], &with[0]).split_off(24_000).into_iter().flatten().collect();
    assert!(gains.windows(2).all(|pair| (-1e-4..1e-3).contains(&(pair[1] - pair[0]))));
    assert_eq!(gains.last(), Some(&1.0));
}

#[test]
fn after_silence_it_begins_anew() {
    let patch = Patch::default().with(Param::Gain, 12.0).with(Param::Decay, 0.05);
    let mut synth = Synth::new(48_000.0, 0);
    synth.set_patch(&patch);
    let [mut left, mut right] = [[0.0; 480]; 2];
    let mut strikes = Vec::new();
    for _ in 0..2 {
        let mut sound = Vec::new();
        for block in 0..200 {
            let events = if block == 0 { chord(1.0) } else { Vec::new() };
            synth.process(&events, &mut left, &mut right);
            sound.extend(left);
        }
        assert!(synth.is_silent() && synth.tail_frames() == 0);
        strikes.push(sound);
    }
    assert!(synth.limiter_work().least_gain < 0.5);
    assert!(strikes[0].iter().any(|sample| *sample != 0.0));
    assert!(strikes[0] == strikes[1]);
}

#[test]
fn what_is_not_finite_does_not_come_out() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -f32::MAX] {
        let mut limiter = Limiter::new(48_000.0);
        for at in [0, 5, 63, 64, 100] {
            let [mut left, mut right] = [vec![0.1; 48_000], vec![-0.1; 48_000]];
            left[at] = bad;
            right[at + 1] = bad;
            limiter.process(true, &mut left, &mut right);
            let finite = |samples: &[f32]| samples.iter().all(|sample| sample.abs() <= 1.0);
            assert!(finite(&left) && finite(&right), "{bad} at {at}");
            assert!((left[47_999] - 0.1).abs() < 1e-3, "{bad}: it goes on");
        }
        // Samples set to 0 are counted, because the limiter must not hide a defect.
        assert_eq!(limiter.work().non_finite, if bad.is_finite() { 0 } else { 10 }, "{bad}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn blocks_and_rests_make_no_difference(
        seed in any::<u64>(),
        levels in prop::collection::vec(prop_oneof![Just(0.0), 0.3..0.6f64, 0.8..1.1f64, 1.0..20.0f64], 1..30),
        lengths in prop::collection::vec(prop_oneof![1..20_usize, 1..700_usize], 1..30),
        blocks in prop::collection::vec(prop_oneof![0..4_usize, 0..200_usize], 1..30),
    ) {
        prop_assume!(blocks.iter().any(|block| *block > 0));
        let parts = levels.iter().zip(lengths.iter().cycle());
        let levels = parts.flat_map(|(level, length)| std::iter::repeat_n(*level, *length));
        let signal = stereo(levels.zip(noise(seed)).map(|(level, sample)| level * sample));
        let whole = limited(8_000, &signal);
        let [mut left, mut right] = signal.clone();
        let (mut limiter, mut start, mut blocks) = (Limiter::new(8_000.0), 0, blocks.iter().cycle());
        while start < left.len() {
            let end = left.len().min(start + blocks.next().unwrap());
            let (left, right) = (&mut left[start..end], &mut right[start..end]);
            // Silent blocks are skipped while the limiter is idle, as in the engine.
            if !limiter.is_idle() || left.iter().chain(&*right).any(|sample| *sample != 0.0) {
                limiter.process(true, left, right);
            }
            start = end;
        }
        prop_assert!(whole == [left, right]);
    }
}
