//! Checks that presets have the pitches, partials and decays that their names promise.

use super::played::{RATE, decay, energy, event, note, note_of, partial_near, spectrum_from};
use super::whole_bank;
use sprung::engine::Synth;
use sprung::internals::measures::octaves::octaves;
use sprung::preset::{Family, KitPreset, Preset};
use sprung::units::frequency_from_key;

/// Largest deviation of a partial in cents.
const CENTS: f64 = 18.0;

fn preset(name: &str) -> &'static Preset {
    Preset::find(name).unwrap_or_else(|error| panic!("{error}"))
}

fn decibels(energy: f64) -> f64 {
    10.0 * libm::log10(energy)
}

fn cents(frequency: f64, from: f64) -> f64 {
    1200.0 * libm::log2(frequency / from)
}

/// Partials as multiples of the first.
#[test]
fn bars_bells_and_strings_have_the_partials_of_their_kind() {
    for (name, ratios) in [
        ("Marimba", &[1.0, 4.0][..]),
        ("Resonator Marimba", &[1.0, 4.0]),
        ("Vibraphone", &[1.0, 4.0]),
        ("Xylophone", &[1.0, 3.0]),
        ("Glockenspiel", &[1.0, 2.756]),
        ("Kalimba", &[1.0]),
        ("Church Bell", &[0.5, 1.0, 1.183, 1.506, 2.0]),
        ("Timpani", &[1.0]),
        ("Nylon Guitar", &[1.0, 2.0, 3.0]),
        ("Harp", &[1.0, 2.0]),
        ("Grand Piano", &[1.0, 2.0, 3.0]),
        ("Violin", &[1.0, 2.0, 3.0]),
        ("Clarinet", &[1.0, 3.0]),
        ("Flute", &[1.0, 2.0]),
        ("Drawbar Organ", &[1.0, 2.0, 3.0]),
    ] {
        let preset = preset(name);
        let sound = note(preset, preset.guide.home, 100.0, 2.0, 2.0);
        let spectrum = spectrum_from(&sound, 0.25);
        let expected = frequency_from_key(preset.guide.home.into(), 440.0);
        // The name says nothing about the octave, so all three are tried.
        let first =
            [1.0, 0.5, 2.0].iter().find_map(|octave| partial_near(&spectrum, expected * octave * ratios[0], 1.03));
        let first = first.unwrap_or_else(|| panic!("{name}: nothing near {expected:.1} Hz")) / ratios[0];
        for ratio in ratios {
            let found = partial_near(&spectrum, first * ratio, 1.03);
            let found = found.unwrap_or_else(|| panic!("{name}: no partial at {ratio} times {first:.1} Hz"));
            let off = cents(found, first * ratio);
            assert!(off.abs() < CENTS, "{name}: partial {ratio} is off by {off:.1} cents");
        }
    }
}

#[test]
fn kicks_end_low_and_soon() {
    for preset in whole_bank().into_iter().filter(|preset| preset.guide.family == Some(Family::Kick)) {
        let sound = note(preset, preset.guide.home, 100.0, 0.1, 4.0);
        let found = partial_near(&spectrum_from(&sound, 0.12), 53.0, 1.5);
        let found = found.unwrap_or_else(|| panic!("{}: nothing between 35 and 80 Hz", preset.name));
        let is_long = preset.tags.iter().any(|tag| tag == "long");
        assert!((40.0..=70.0).contains(&found), "{}: {found:.1} Hz at its end", preset.name);
        let (falls, _) = decay(&sound, 20.0);
        assert!(is_long || falls < 0.6, "{}: -20 dB after {falls:.2} s", preset.name);
    }
}

#[test]
fn wires_of_snares_sing_and_hats_are_closed_or_open() {
    let highs = |name: &str| {
        let preset = preset(name);
        octaves(&note(preset, preset.guide.home, 100.0, 0.1, 4.0))[7].t60.expect("it decays")
    };
    let snare = highs("Snare");
    assert!((0.35..=0.85).contains(&snare), "the wires of the snare: {snare:.2} s");
    let (closed, open) = (highs("Closed Hat"), highs("Open Hat"));
    assert!((0.1..=0.5).contains(&closed), "closed hat: {closed:.2} s");
    assert!(open > 1.5 * closed, "open hat: {open:.2} s, closed {closed:.2} s");
}

#[test]
fn gongs_bloom_and_their_highs_last() {
    for name in ["Gong", "Tam-Tam"] {
        let preset = preset(name);
        let sound = note(preset, preset.guide.home, 115.0, 0.5, 3.0);
        let high: Vec<f32> = sound.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (strike, after) = (energy(&high, 0.0, 0.05) / 0.05, energy(&high, 0.25, 0.65) / 0.4);
        assert!(after > strike * 0.1, "{name}: its highs fall by {:.1} dB", decibels(after / strike));
    }
}

#[test]
fn what_is_held_lasts_as_long_as_its_key() {
    use Family::{Bowed, Wind};
    for preset in whole_bank().into_iter().filter(|preset| matches!(preset.guide.family, Some(Bowed | Wind))) {
        if preset.tags.iter().any(|tag| tag == "struck" || tag == "pluck" || tag == "pizzicato" || tag == "swell") {
            continue;
        }
        let sound = note(preset, preset.guide.home, 100.0, 5.0, 8.0);
        let (early, late) = (energy(&sound, 1.0, 2.0), energy(&sound, 3.5, 4.5));
        let change = decibels(late / early);
        assert!(change > -8.0, "{}: {change:.1} dB while its key is held", preset.name);
        let after = decibels(energy(&sound, 7.0, 8.0) / early);
        assert!(after < -25.0, "{}: {after:.1} dB after its key came up", preset.name);
    }
}

#[test]
fn soft_notes_are_softer() {
    for preset in whole_bank() {
        let kit = preset.kit();
        let level = |velocity| energy(&note_of(&kit, preset.guide.home, velocity, 0.3, 0.3), 0.0, 0.3);
        let db = decibels(level(100.0) / level(40.0));
        // Organs, bagpipes and harpsichords do not respond to velocity.
        let least = if matches!(preset.guide.family, Some(Family::Keys | Family::Wind | Family::StruckString)) {
            -1.0
        } else {
            2.0
        };
        assert!((least..30.0).contains(&db), "{}: {db:.1} dB from velocity 40 to 100", preset.name);
    }
}

#[test]
fn a_closed_hat_chokes_an_open_one() {
    for kit in KitPreset::factory() {
        let pad = |name: &str| kit.pads.iter().find(|(_, pad)| pad.name == name).map(|(key, _)| *key);
        let Some((open, closed)) = pad("Open Hat").zip(pad("Closed Hat")) else { continue };
        let mut synth = Synth::new(RATE, 1);
        synth.set_kit(&kit.kit());
        synth.reset();
        let [mut left, mut right] = [0, 1].map(|_| vec![0.0; (2.0 * RATE) as usize]);
        let events = [event(0.0, open, Some(100.0)), event(0.5, closed, Some(1.0))];
        synth.process(&events, &mut left, &mut right);
        let (ringing, choked) = (energy(&left, 0.4, 0.5), energy(&left, 0.6, 0.7));
        assert!(choked < 0.1 * ringing, "{}: {:.1} dB are left", kit.name, decibels(choked / ringing));
    }
}
