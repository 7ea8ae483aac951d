//! Decay and tuning are independent of how the pitch moves.
//!
//! One mass is measured on rendered audio before it bends, glides or vibrates, and after it has returned.

use crate::damped_sine::{DampedSine, LN_60_DB, fit};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::units::{key_from_frequency, ratio_from_semitones};
use std::f64::consts::TAU;

/// Frames of a control tick: pitch bends are sent as often as the engine reads the pitch.
const TICK: usize = 32;
const RATES: [f64; 5] = [22_050.0, 44_100.0, 48_000.0, 96_000.0, 192_000.0];
const T60S: [f64; 3] = [0.3, 1.0, 5.0];
/// The fastest movement, in octaves per second: an octave in 20 ms.
const FASTEST: f64 = 50.0;

/// The movement of a note between two stretches of constant pitch.
struct Motion {
    name: String,
    patch: Patch,
    /// Frames are relative to the start of the motion.
    events: Vec<Event>,
    frames: usize,
    /// Mean pitch ratio over the motion, if it is known.
    mean_ratio: Option<f64>,
}

fn event(frame: usize, kind: EventKind) -> Event {
    Event { frame: frame as u32, channel: 0, kind }
}

fn on(frame: usize, key: f64) -> Event {
    let nearest = libm::round(key).clamp(0.0, 127.0);
    event(frame, EventKind::NoteOn { key: nearest as u8, detune: (key - nearest) as f32, velocity: 1.0, id: None })
}

/// Bends up, down and back, linearly in pitch, by two octaves each way or as far as time allows.
fn bends(sample_rate: f64, t60: f64, octaves_per_second: f64, every: usize) -> Motion {
    let seconds = (0.5 * t60).max(8.0 / FASTEST);
    let depth = (octaves_per_second * seconds / 4.0).min(2.0);
    let cycle = 4.0 * depth / octaves_per_second;
    let cycles = libm::floor(seconds / cycle + 1e-9).max(1.0);
    let frames = (cycles * cycle * sample_rate) as usize;
    let octaves = |frame: usize| {
        if frame >= frames {
            return 0.0;
        }
        let phase = frame as f64 / (cycle * sample_rate) % 1.0;
        depth * (1.0 - (4.0 * ((phase + 0.25) % 1.0) - 2.0).abs())
    };
    let bend = |frame: usize| event(frame, EventKind::PitchBend((octaves(frame) / 2.0) as f32));
    let events = (0..=frames / every + 1).map(|n| bend(n * every)).collect();
    let mean = (0..frames).map(|frame| libm::exp2(octaves(frame))).sum::<f64>() / frames as f64;
    Motion {
        name: format!("bends of ±{depth:.2} octaves at {octaves_per_second} octaves/s, every {every} frames"),
        patch: Patch::default().with(Param::BendRange, 24.0),
        events,
        frames: frames + every,
        // A bend every few ticks is a staircase, which has another mean.
        mean_ratio: (every <= TICK).then(|| (mean * frames as f64 + every as f64) / (frames + every) as f64),
    }
}

/// Vibrato that starts and stops where its sine is zero.
fn vibrato(sample_rate: f64, t60: f64, cents: f64, rate: f64, rest: usize) -> Motion {
    let rate = f64::from(rate as f32);
    // The note has had a constant pitch for `rest` frames.
    let until_zero = |frame: f64| libm::ceil(frame * rate / sample_rate) * sample_rate / rate;
    let start = until_zero(rest as f64) as usize - rest;
    let cycles = libm::ceil((0.5 * t60).max(0.15) * rate);
    let end = start + (cycles * sample_rate / rate) as usize;
    let depth = |frame, cents: f64| event(frame, EventKind::Param { param: Param::Vibrato, value: cents as f32 });
    Motion {
        name: format!("vibrato of ±{cents} cents at {rate} Hz"),
        patch: Patch::default().with(Param::VibratoRate, rate as f32),
        events: vec![depth(start, cents), depth(end, 0.0)],
        // Parameters are smoothed over 20 ms.
        frames: end + (0.02 * sample_rate) as usize + TICK,
        mean_ratio: None,
    }
}

/// A legato note two octaves up or down, then back to the first.
fn glides(sample_rate: f64, t60: f64, key: f64, octaves: f64) -> Motion {
    let seconds = (0.25 * t60).max(2.0 / FASTEST) as f32;
    let way = libm::ceil(f64::from(seconds) * sample_rate) as usize + TICK;
    let to = key + 12.0 * octaves;
    Motion {
        name: format!("glides of {octaves} octaves in {seconds} s and back"),
        patch: Patch::default().with(Param::Glide, seconds).with(Param::Mode, 2.0),
        events: vec![on(0, to), Event::note_off(way as u32, libm::round(to) as u8)],
        frames: 2 * way,
        mean_ratio: None,
    }
}

/// A struck mass: constant pitch, motion, constant pitch.
struct Note {
    sample_rate: f64,
    frequency: f64,
    t60: f64,
}

/// The results of the measurement.
struct Measured {
    after: DampedSine,
    /// T60 over the motion.
    t60: f64,
    /// Mean pitch ratio over the motion.
    mean_ratio: f64,
}

impl Note {
    /// Frames of a stretch of constant pitch: enough cycles, and enough decay.
    fn rest(&self) -> usize {
        let seconds = (0.1 * self.t60).max(4.0 / self.frequency).min(0.3);
        (seconds * self.sample_rate) as usize / TICK * TICK
    }

    fn measure(&self, motion: &Motion) -> Option<Measured> {
        let rest = self.rest();
        let mut synth = Synth::new(self.sample_rate, 0);
        synth.set_patch(&motion.patch.clone().with(Param::Decay, self.t60 as f32));
        let mut events = vec![on(0, key_from_frequency(self.frequency, 440.0))];
        events.extend(motion.events.iter().map(|event| Event { frame: event.frame + rest as u32, ..*event }));
        // A linear pitch ramp ends at the second control tick after its start.
        let back = rest + motion.frames.next_multiple_of(TICK) + 2 * TICK;
        let (mut left, mut right) = (vec![0.0; back + rest], vec![0.0; back + rest]);
        synth.process(&events, &mut left, &mut right);

        let before = fit(&left[..rest], self.sample_rate, self.frequency, self.t60)?;
        let after = fit(&left[back..], self.sample_rate, self.frequency, self.t60)?;
        let seconds = (back - rest) as f64 / self.sample_rate;
        let fall = |seconds: f64, t60: f64| LN_60_DB * seconds / t60;
        let amplitude = before.amplitude * libm::exp(-fall(rest as f64 / self.sample_rate, before.t60));
        let t60 = LN_60_DB * seconds / libm::log(amplitude / after.amplitude);

        // Cycles from the end of the first stretch to the start of the second. Zero crossings give the number of whole cycles.
        let phase = |cycles: f64| cycles - libm::floor(cycles);
        let start = before.frequency * rest as f64 / self.sample_rate + before.phase / TAU;
        let crossings = left[rest - 1..=back].windows(2).skip(1).filter(|pair| pair[0] < 0.0 && pair[1] >= 0.0).count();
        let cycles = crossings as f64 + phase(after.phase / TAU) - phase(start);
        let at_rest = (back - rest - motion.frames) as f64;
        let mean_ratio = (cycles * self.sample_rate / self.frequency - at_rest) / motion.frames as f64;
        Some(Measured { after, t60, mean_ratio })
    }
}

fn cents(measured: f64, expected: f64) -> f64 {
    1200.0 * libm::log2(measured / expected)
}

#[test]
fn t60_and_tuning_are_the_same_however_the_pitch_moves() {
    the_pitch_moves(1.0);
}

#[test]
#[ignore = "takes half a minute"]
fn t60_and_tuning_are_the_same_of_long_notes_at_high_rates() {
    the_pitch_moves(f64::INFINITY);
}

/// Checks notes whose T60 is below `longest` seconds at rates above 48 kHz, and of any T60 at others.
fn the_pitch_moves(longest: f64) {
    let mut failures = vec![];
    let (mut worst_t60, mut worst_cents, mut worst_mean, mut measured) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    for sample_rate in RATES {
        for frequency in [55.0, 440.0, 0.05 * sample_rate, 0.12 * sample_rate] {
            for t60 in T60S.into_iter().filter(|t60| *t60 < longest || sample_rate <= 48_000.0) {
                let note = Note { sample_rate, frequency, t60 };
                let key = key_from_frequency(frequency, 440.0);
                let rest = note.rest();
                let mut motions: Vec<Motion> =
                    [1.0, 10.0, FASTEST].iter().map(|speed| bends(sample_rate, t60, *speed, TICK)).collect();
                // Not synchronous with control ticks.
                motions.push(bends(sample_rate, t60, 5.0, 100));
                // Not synchronous with control ticks, and most pitch ramps are interrupted.
                motions.push(bends(sample_rate, t60, FASTEST, 23));
                motions.push(vibrato(sample_rate, t60, 50.0, 5.5, rest));
                motions.push(vibrato(sample_rate, t60, 400.0, 20.0, rest));
                motions.push(vibrato(sample_rate, t60, 1200.0, 4.0, rest));
                motions.push(glides(sample_rate, t60, key, 2.0));
                motions.push(glides(sample_rate, t60, key, -2.0));
                // Keys end at 127, and voices end at −120 dBFS.
                motions.retain(|motion| motion.patch.get(Param::Mode) == 0.0 || key < 103.0);
                motions.retain(|motion| (motion.frames as f64) < 1.2 * t60 * sample_rate);
                for motion in motions {
                    let case = format!("{frequency} Hz, T60 {t60} s at {sample_rate} Hz, {}", motion.name);
                    let Some(found) = note.measure(&motion) else {
                        failures.push(format!("{case}: no damped sinusoid"));
                        continue;
                    };
                    measured += 1;
                    let percent = 100.0 * (found.t60 / t60 - 1.0);
                    let after = cents(found.after.frequency, frequency);
                    let mean = motion.mean_ratio.map_or(0.0, |ratio| cents(found.mean_ratio, ratio));
                    worst_t60 = worst_t60.max(percent.abs());
                    (worst_cents, worst_mean) = (worst_cents.max(after.abs()), worst_mean.max(mean.abs()));
                    if !(percent.abs() <= 0.1 && after.abs() <= 0.01 && mean.abs() <= 1.0) {
                        failures.push(format!(
                            "{case}: T60 {percent:+.4} %, {after:+.5} cents afterwards, {mean:+.3} on the way"
                        ));
                    }
                }
            }
        }
    }
    println!(
        "{measured} notes that moved; at worst {worst_t60:.2e} % of T60, {worst_cents:.2e} cents afterwards, \
         {worst_mean:.2e} cents on the way"
    );
    assert!(failures.is_empty(), "{} of {measured} notes are off:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn a_bent_note_is_where_it_was_bent_to() {
    let mut failures = vec![];
    for sample_rate in RATES {
        for semitones in [-24.0, -12.5, -0.3, 7.0, 24.0] {
            for (frequency, t60) in [(55.0, 0.3_f64), (440.0, 5.0), (0.12 * sample_rate, 1.0)] {
                let mut synth = Synth::new(sample_rate, 0);
                let patch = Patch::default().with(Param::BendRange, 24.0).with(Param::Decay, t60 as f32);
                synth.set_patch(&patch);
                let bend = (semitones / 24.0) as f32;
                let events = [on(0, key_from_frequency(frequency, 440.0)), event(100, EventKind::PitchBend(bend))];
                let frames = (t60.min(1.0) * sample_rate) as usize;
                let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
                synth.process(&events, &mut left, &mut right);
                let expected = frequency * ratio_from_semitones(f64::from(bend) * 24.0);
                let case = format!("{frequency} Hz at {sample_rate} Hz, bent by {semitones} semitones");
                match fit(&left[256..], sample_rate, expected, t60) {
                    Some(found) => {
                        let (cents, percent) = (cents(found.frequency, expected), 100.0 * (found.t60 / t60 - 1.0));
                        if !(cents.abs() <= 0.01 && percent.abs() <= 0.1) {
                            failures.push(format!("{case}: {cents:+.5} cents, T60 {percent:+.4} %"));
                        }
                    }
                    None => failures.push(format!("{case}: no damped sinusoid")),
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} notes are off:\n{}", failures.len(), failures.join("\n"));
}
