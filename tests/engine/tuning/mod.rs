//! Scala files: known scales sound at their published pitches, and malformed files are refused with their line.

mod playing;
mod refused;

use crate::damped_sine::fit_unknown;
use libm::{exp2, log2, pow};
use sprung::engine::EventKind;
use sprung::io::{Song, SongEvent};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::render::{Job, Options, Tail};
use sprung::sound::{Kit, Tuning};
use std::fs;
use std::path::Path;

const SAMPLE_RATE: u32 = 48_000;

/// The text of a file in `tests/engine/tuning/files`.
fn file(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/engine/tuning/files").join(name)).unwrap()
}

/// The tuning from the scale and keyboard mapping with these names (`just`, or `just c-256`) in that folder.
fn tuning(names: &str) -> Tuning {
    let (scale, keymap) = names.split_once(' ').map_or((names, None), |(scale, keymap)| (scale, Some(keymap)));
    let keymap = keymap.map(|keymap| file(&format!("{keymap}.kbm")));
    Tuning::from_scala(&file(&format!("{scale}.scl")), keymap.as_deref()).unwrap()
}

/// Notes struck together and held until the end: returns the left channel.
fn render(tuning: &Tuning, patch: &Patch, keys: &[u8], seconds: f64) -> Vec<f32> {
    let on = |key: &u8| EventKind::NoteOn { key: *key, detune: 0.0, velocity: 1.0, id: None };
    let events = keys.iter().map(|key| SongEvent { seconds: 0.0, channel: 0, kind: on(key) }).collect();
    let song = Song { events, seconds };
    let options = Options { sample_rate: SAMPLE_RATE, tail: Tail::None, ..Options::default() };
    let kit = Kit::of_patch(patch);
    let [left, _] = Job { tuning, ..Job::new(&song, &kit, options) }.samples().unwrap();
    left
}

/// The frequency in Hz at which a key sounds.
#[track_caller]
fn heard(tuning: &Tuning, patch: &Patch, key: u8) -> f64 {
    fit_unknown(&render(tuning, patch, &[key], 0.4), SAMPLE_RATE.into()).expect("a damped sinusoid").frequency
}

fn cents(frequency: f64, expected: f64) -> f64 {
    1200.0 * log2(frequency / expected)
}

/// Renders every fifth key of five octaves and compares its frequency with `expected` in Hz, within 0.01 cents; `None`
/// means silence. Files are named as for [`tuning`].
#[track_caller]
fn check(names: &str, expected: impl Fn(i32) -> Option<f64>) {
    let (tuning, patch) = (tuning(names), Patch::default());
    for key in (36..=96).step_by(5) {
        match expected(key.into()) {
            Some(frequency) => {
                let cents = cents(heard(&tuning, &patch, key), frequency);
                assert!(cents.abs() <= 0.01, "{names}: key {key} is {cents:+.4} cents off {frequency} Hz");
            }
            None => {
                let silent = render(&tuning, &patch, &[key], 0.1).iter().all(|sample| *sample == 0.0);
                assert!(silent, "{names}: key {key} sounds");
            }
        }
    }
}

/// The ratio of a degree to degree 0, in a scale of these ratios starting at 1, which repeats at `period`.
fn ratio(ratios: &[f64], period: f64, degree: i32) -> f64 {
    let notes = ratios.len() as i32;
    pow(period, degree.div_euclid(notes).into()) * ratios[degree.rem_euclid(notes) as usize]
}

/// Degrees from C of a scale without a keyboard mapping: A4, nine keys above C4, has 440 Hz.
fn from_a4(ratios: &[f64], period: f64) -> impl Fn(i32) -> Option<f64> {
    move |key| Some(440.0 * ratio(ratios, period, key - 60) / ratio(ratios, period, 9))
}

/// Twelve degrees, given as numbers of fifths from C and moved into one octave.
fn fifths(fifth: f64, counts: [i32; 12]) -> [f64; 12] {
    counts.map(|count| {
        let octaves = log2(fifth) * f64::from(count);
        exp2(octaves - libm::floor(octaves))
    })
}

#[test]
fn equal_temperaments() {
    let equal = |steps: i32| move |key: i32| Some(440.0 * exp2(f64::from(key - 69) / f64::from(steps)));
    check("12-equal", equal(12));
    check("12-equal a-440", equal(12));
    check("19-equal", equal(19));
    check("24-equal", equal(24));
    check("31-equal", equal(31));
}

const JUST: [f64; 12] = [
    1.0,
    16.0 / 15.0,
    9.0 / 8.0,
    6.0 / 5.0,
    5.0 / 4.0,
    4.0 / 3.0,
    45.0 / 32.0,
    3.0 / 2.0,
    8.0 / 5.0,
    5.0 / 3.0,
    9.0 / 5.0,
    15.0 / 8.0,
];

#[test]
fn just_intonation_and_its_reference() {
    check("just", from_a4(&JUST, 2.0));
    check("just a-440", from_a4(&JUST, 2.0));
    check("just c-256", |key| Some(256.0 * ratio(&JUST, 2.0, key - 60)));
}

#[test]
fn pythagorean_and_meantone_are_chains_of_fifths() {
    check("pythagorean", from_a4(&fifths(1.5, [0, 7, 2, -3, 4, -1, 6, 1, -4, 3, -2, 5]), 2.0));
    // In quarter-comma meantone, four fifths make a pure third two octaves higher.
    check("meantone", from_a4(&fifths(pow(5.0, 0.25), [0, 7, 2, -3, 4, -1, 6, 1, 8, 3, -2, 5]), 2.0));
}

#[test]
fn scales_that_do_not_repeat_at_the_octave() {
    // Bohlen (1978): thirteen steps to the tritave.
    let bohlen_pierce = [
        1.0,
        27.0 / 25.0,
        25.0 / 21.0,
        9.0 / 7.0,
        7.0 / 5.0,
        75.0 / 49.0,
        5.0 / 3.0,
        9.0 / 5.0,
        49.0 / 25.0,
        15.0 / 7.0,
        7.0 / 3.0,
        63.0 / 25.0,
        25.0 / 9.0,
    ];
    check("bohlen-pierce", from_a4(&bohlen_pierce, 3.0));
    // Carlos (1987), "Tuning: At the Crossroads": alpha and gamma divide the pure fifth into about 9 and 20.
    check("carlos-alpha", |key| Some(440.0 * exp2(77.965 / 1200.0 * f64::from(key - 69))));
    check("carlos-gamma", |key| Some(440.0 * exp2(35.099 / 1200.0 * f64::from(key - 69))));
}

#[test]
fn measured_scales_of_java() {
    let of_cents = |cents: &[f64]| cents.iter().map(|cents| exp2(cents / 1200.0)).collect::<Vec<_>>();
    check("slendro", from_a4(&of_cents(&[0.0, 228.0, 484.0, 728.0, 960.0]), 2.0));
    check("pelog c-256", |key| {
        Some(256.0 * ratio(&of_cents(&[0.0, 137.0, 446.0, 575.0, 687.0, 820.0, 1098.0]), 2.0, key - 60))
    });
}

#[test]
fn partch_and_the_harmonic_series() {
    // The scale is symmetric: its upper half is the octave divided by the lower ratios.
    let lower: [(f64, f64); 22] = [
        (1.0, 1.0),
        (81.0, 80.0),
        (33.0, 32.0),
        (21.0, 20.0),
        (16.0, 15.0),
        (12.0, 11.0),
        (11.0, 10.0),
        (10.0, 9.0),
        (9.0, 8.0),
        (8.0, 7.0),
        (7.0, 6.0),
        (32.0, 27.0),
        (6.0, 5.0),
        (11.0, 9.0),
        (5.0, 4.0),
        (14.0, 11.0),
        (9.0, 7.0),
        (21.0, 16.0),
        (4.0, 3.0),
        (27.0, 20.0),
        (11.0, 8.0),
        (7.0, 5.0),
    ];
    let rising = lower.iter().map(|(n, d)| n / d);
    let partch: Vec<f64> = rising.chain(lower[1..].iter().rev().map(|(n, d)| 2.0 * d / n)).collect();
    assert_eq!(partch.len(), 43);
    check("partch partch", |key| Some(392.0 * ratio(&partch, 2.0, key - 67)));
    let harmonics: Vec<f64> = (8..16).map(|n| f64::from(n) / 8.0).collect();
    check("harmonics", from_a4(&harmonics, 2.0));
}

#[test]
fn a_keyboard_map_with_gaps() {
    let white = [Some(0), None, Some(1), None, Some(2), Some(3), None, Some(4), None, Some(5), None, Some(6)];
    let diatonic = [1.0, 9.0 / 8.0, 5.0 / 4.0, 4.0 / 3.0, 3.0 / 2.0, 5.0 / 3.0, 15.0 / 8.0];
    check("diatonic white-keys", |key| {
        let degree = white[(key - 60).rem_euclid(12) as usize]?;
        // A4 is the sixth degree of the octave that starts at C4.
        Some(264.0 * ratio(&diatonic, 2.0, degree + 7 * (key - 60).div_euclid(12)))
    });
    let tuning = tuning("diatonic white-keys");
    let mapped: Vec<u8> = (0..128).filter(|key| tuning.pitch(*key).is_some()).collect();
    let is_white = |key: &u8| white[usize::from(key % 12)].is_some();
    assert_eq!(mapped, (21..=108).filter(is_white).collect::<Vec<_>>());
}

#[test]
fn a_keyboard_map_that_repeats_after_thirteen_semitones() {
    let major = [0, 2, 4, 5, 7, 9, 11];
    check("12-equal stretched", |key| {
        let semitones = major[(key - 60).rem_euclid(7) as usize] + 13 * (key - 60).div_euclid(7);
        // Key 62, four semitones above the middle key, has 300 Hz.
        Some(300.0 * exp2(f64::from(semitones - 4) / 12.0)).filter(|frequency| *frequency < 20_000.0)
    });
}

#[test]
fn without_a_keyboard_mapping_the_patch_says_where_a4_is() {
    let baroque = Patch::default().with(Param::Tuning, 415.0);
    let (own, mapped) = (tuning("just"), tuning("just c-256"));
    assert!(cents(heard(&own, &baroque, 69), 415.0).abs() <= 0.01);
    assert!(cents(heard(&own, &baroque, 60), 415.0 * 3.0 / 5.0).abs() <= 0.01);
    assert!(cents(heard(&mapped, &baroque, 60), 256.0).abs() <= 0.01, "a keyboard mapping says it itself");
}
