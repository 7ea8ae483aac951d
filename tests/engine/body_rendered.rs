//! Renders notes of bodies at C3 and C6 and compares their partials with SciPy’s numbers: pitch, T60 and relative level.

use crate::bodies::{Line, body, groups, lines};
use sprung::analysis::modes::{Mode, Settings, modes};
use sprung::engine::{Event, Synth};
use sprung::params::{MalletPulse, Param};
use sprung::patch::Patch;
use sprung::patch::routes::Routes;
use sprung::sound::bodies::Body;
use sprung::units::frequency_from_key;
use std::f64::consts::TAU;

const RATE: f64 = 48_000.0;
const FRAMES: usize = 72_000;
const KEYS: [u8; 2] = [48, 84];

/// Modes whose ratios differ by a smaller share than this count as one mode.
const SAME: f64 = 1e-6;
/// Modes whose ratios differ by a smaller share than this beat too slowly to be separated within a note.
const APART: f64 = 0.01;
/// Modes below this share of the strongest mode's level are not compared.
const AUDIBLE: f64 = 0.02;
/// Shortest T60 in seconds and highest frequency in Hz of the partials that are compared.
const SHORTEST: f64 = 0.03;
const HIGHEST: f64 = 0.45 * RATE;

/// Drum heads: their modes are so many and so short that [`modes`] cannot separate them.
const DENSE: [&str; 2] = ["membrane", "timpani"];

/// Energy in dB of the difference between a note and the sum of SciPy's modes. A cent would be −20 dB after 0.3 s at C3, 1 %
/// of T60 −40 dB, and 0.1 dB of level −39 dB.
const DIFFERENCE_DB: f64 = -60.0;

/// A mode that is audible by SciPy's numbers: its ratio to the key, its T60, and its level relative to the strongest mode.
struct Expected {
    ratio: f64,
    t60: f64,
    level: f64,
}

fn expected(group: &[Line]) -> Vec<Expected> {
    let mut heard: Vec<Expected> = Vec::new();
    for Line { ratio, t60, product, .. } in group {
        match heard.iter_mut().find(|mode| (mode.ratio - ratio).abs() < SAME * ratio) {
            Some(mode) => mode.level += product,
            None => heard.push(Expected { ratio: *ratio, t60: *t60, level: *product }),
        }
    }
    let strongest = heard.iter().fold(0.0_f64, |most, mode| most.max(mode.level.abs()));
    heard.iter_mut().for_each(|mode| mode.level = mode.level.abs() / strongest);
    let is_alone =
        |mode: &Expected| heard.iter().filter(|other| (other.ratio / mode.ratio - 1.0).abs() < APART).count() == 1;
    let places: Vec<bool> = heard.iter().map(|mode| mode.level > AUDIBLE && is_alone(mode)).collect();
    heard.into_iter().zip(places).filter_map(|(mode, is_clear)| is_clear.then_some(mode)).collect()
}

/// A note struck by an impulse, of a body without modes above those for which SciPy has numbers.
fn render(group: &[Line], key: u8) -> Vec<f32> {
    let body = Body { modes: most(group), ..body(&group[0].model, &group[0].set) };
    let mut patch = Patch { modes: body.table(), routes: Routes::NONE, ..Patch::default() };
    for (param, value) in [
        (Param::Decay, body.t60() as f32),
        (Param::MalletPulse, MalletPulse::Impulse as u8 as f32),
        (Param::Gain, 0.0),
        (Param::Limiter, 0.0),
    ] {
        patch.set(param, value);
    }
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(&patch);
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    synth.process(&[Event::note_on(0, key, 1.0)], &mut left, &mut right);
    left
}

/// Number of modes up to the highest that SciPy has numbers for.
fn most(group: &[Line]) -> usize {
    group.iter().map(|line| line.place + 1).max().unwrap_or(0)
}

fn highest(group: &[Line]) -> f64 {
    group.iter().fold(0.0, |most, line| most.max(line.ratio))
}

/// Warburton's free plate is a formula with coefficients of four digits.
fn is_exact(group: &[Line]) -> bool {
    group.iter().all(|line| line.tolerance < 1e-4)
}

fn pitch(key: u8) -> f64 {
    frequency_from_key(key.into(), 440.0)
}

/// Energy in dB, relative to the note's, that is left after SciPy's modes are subtracted from the note.
fn difference_db(group: &[Line], pitch: f64, note: &[f32]) -> f64 {
    let mut sum = vec![0.0; note.len()];
    for line in group {
        let decay = libm::pow(0.001, 1.0 / (RATE * line.t60));
        let (sin, cos) = libm::sincos(TAU * line.ratio * pitch / RATE);
        let (sin, cos, mut re, mut im) = (decay * sin, decay * cos, line.product, 0.0);
        for sum in &mut sum {
            (re, im) = (re * cos - im * sin, re * sin + im * cos);
            *sum += im;
        }
    }
    let note: Vec<f64> = note.iter().map(|sample| f64::from(*sample)).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // A body's levels add up to 1, SciPy's do not.
    let gain = dot(&note, &sum) / dot(&sum, &sum);
    let left: Vec<f64> = note.iter().zip(&sum).map(|(note, sum)| note - gain * sum).collect();
    10.0 * libm::log10(dot(&left, &left) / dot(&note, &note))
}

#[test]
fn rendered_notes_are_sums_of_the_modes_of_scipy() {
    let (lines, mut compared) = (lines(), 0);
    for group in groups(&lines) {
        for key in KEYS.into_iter().filter(|key| highest(group) * pitch(*key) < HIGHEST) {
            if is_exact(group) && group.len() == most(group) {
                let db = difference_db(group, pitch(key), &render(group, key));
                let place = format!("{} {}, key {key}: the difference is {db:.1} dB", group[0].model, group[0].set);
                println!("{place}");
                assert!(db < DIFFERENCE_DB, "{place}");
                compared += 1;
            }
        }
    }
    assert!(compared > 15, "{compared} notes");
}

/// Deviation of a partial from SciPy's mode: in cents, as a share of the T60, and in dB.
type Off = [f64; 3];

/// The compared partials of a note: the description and the deviation of each.
fn partials(group: &[Line], key: u8) -> Vec<(String, Off)> {
    let found = modes(&[render(group, key)], RATE, &Settings::default(), &mut |_| true).expect("modes");
    let nearest = |frequency: f64| {
        let off = |mode: &&Mode| (mode.frequency / frequency - 1.0).abs();
        found.strikes[0].modes.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("a mode")
    };
    let (expected, pitch) = (expected(group), pitch(key));
    let expected: Vec<&Expected> =
        expected.iter().filter(|mode| mode.t60 > SHORTEST && mode.ratio * pitch < HIGHEST).collect();
    let strongest = expected.iter().max_by(|a, b| a.level.total_cmp(&b.level)).expect("a mode");
    let decibels = |level: f64| 20.0 * libm::log10(level);
    let full_db = nearest(strongest.ratio * pitch).level_db - decibels(strongest.level);
    let off = |mode: &&Expected| {
        let heard = nearest(mode.ratio * pitch);
        let cents = 1200.0 * libm::log2(heard.frequency / (mode.ratio * pitch));
        let level = heard.level_db - full_db - decibels(mode.level);
        let place = format!("{} {}, key {key}, ratio {:.3}", group[0].model, group[0].set, mode.ratio);
        (place, [cents, heard.t60 / mode.t60 - 1.0, level])
    };
    expected.iter().map(off).collect()
}

#[test]
fn partials_of_some_rendered_notes_are_those_of_scipy() {
    partials_agree(18);
}

#[test]
#[ignore = "takes minutes"]
fn partials_of_rendered_notes_are_those_of_scipy() {
    partials_agree(1);
}

/// Compares the partials of every so many bodies.
fn partials_agree(step: usize) {
    let (lines, mut compared, mut worst) = (lines(), 0, [0.0_f64; 3]);
    for group in groups(&lines).step_by(step) {
        if DENSE.contains(&group[0].model.as_str()) {
            continue;
        }
        let limits = if is_exact(group) { [1.0, 0.01, 0.1] } else { [2.0, 0.01, 0.1] };
        for (place, off) in KEYS.into_iter().flat_map(|key| partials(group, key)) {
            assert!(off.iter().zip(limits).all(|(off, limit)| off.abs() < limit), "{place}: {off:?}");
            worst.iter_mut().zip(off).for_each(|(worst, off)| *worst = worst.max(off.abs()));
            compared += 1;
        }
    }
    let [cents, t60, level] = worst;
    println!("{compared} partials; at worst {cents:.2e} cents, {:.2e} % of T60 and {level:.2e} dB", 100.0 * t60);
    assert!(compared * step > 300, "{compared}");
}
