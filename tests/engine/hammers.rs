//! Hammers in whole notes: how they follow velocity and what they meet.

use crate::events::off;
use sprung::engine::{Event, Synth};
use sprung::params::Param;
use sprung::patch::{Mode, ModeTable, Patch};

const RATE: f64 = 48_000.0;
const FELT: f32 = 2.0;

/// A string of `count` partials under a hammer.
fn string(count: u16) -> Patch {
    let mode = |n: u16| Mode { ratio: n.into(), level: 0.1, ..Mode::UNIT };
    Patch { modes: ModeTable::new(&(1..=count).map(mode).collect::<Vec<_>>()), ..Patch::default() }
        .with(Param::MalletPulse, FELT)
        .with(Param::MalletHardness, 55.0)
        .with(Param::Velocity, 100.0)
        .with(Param::Decay, 4.0)
        .with(Param::Limiter, 0.0)
}

fn render(patch: &Patch, events: &[Event], frames: usize) -> Vec<f32> {
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(patch);
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth.process(events, &mut left, &mut right);
    left
}

fn rms(sound: &[f32]) -> f64 {
    (sound.iter().map(|sample| f64::from(*sample).powi(2)).sum::<f64>() / sound.len() as f64).sqrt()
}

/// RMS of the differences between successive samples, relative to that of the samples.
fn brightness(sound: &[f32]) -> f64 {
    rms(&sound.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>()) / rms(sound)
}

/// A felt is the harder, the deeper it is pressed; a pulse of fixed length only grows.
#[test]
fn a_hard_stroke_is_brighter() {
    let struck = |patch: &Patch, velocity| brightness(&render(patch, &[Event::note_on(0, 60, velocity)], 9600)[960..]);
    let felt = [0.25, 0.5, 1.0].map(|velocity| struck(&string(40), velocity));
    assert!(felt[1] > 1.2 * felt[0] && felt[2] > 1.2 * felt[1], "{felt:?}");
    let pulse = string(40).with(Param::MalletPulse, 1.0);
    assert!((struck(&pulse, 0.25) / struck(&pulse, 1.0) - 1.0).abs() < 0.01);
}

/// A heavier hammer touches for longer, and is not louder.
#[test]
fn a_heavy_hammer_is_duller_but_not_louder() {
    let struck = |mass| render(&string(40).with(Param::MalletMass, mass), &[Event::note_on(0, 60, 1.0)], 9600);
    let (light, heavy) = (struck(0.3), struck(2.0));
    assert!(brightness(&heavy[960..]) < 0.7 * brightness(&light[960..]));
    assert!(rms(&heavy) < rms(&light));
}

/// With more modes than a bank has, the hammer feels all of them: the lower ones sound alike whether or not silent ones follow.
#[test]
fn a_hammer_feels_all_banks_of_a_body() {
    // The modes from the 60th on lie above all that is rendered: they only give way.
    let high = |note| render(&string(140), &[Event::note_on(0, note, 0.8)], 4800);
    let (whole, first) = (high(108), render(&string(60), &[Event::note_on(0, 108, 0.8)], 4800));
    let apart: Vec<_> = whole.iter().zip(&first).map(|(whole, first)| whole - first).collect();
    assert!(rms(&first) > 1e-4 && rms(&apart) < 0.02 * rms(&first), "{} {}", rms(&first), rms(&apart));
    // And those that are rendered sound: above the 64th partial of C2.
    let low = render(&string(140).with(Param::MalletHardness, 90.0), &[Event::note_on(0, 36, 1.0)], 9600);
    let few = render(&string(64).with(Param::MalletHardness, 90.0), &[Event::note_on(0, 36, 1.0)], 9600);
    assert!(brightness(&low[960..]) > 1.05 * brightness(&few[960..]));
}

/// A key that is struck again while its string rings is never louder than its strokes together, and comes to rest.
#[test]
fn strokes_on_a_ringing_string_add_up_at_most() {
    let strokes: Vec<_> = (0..12).map(|n| Event::note_on(n * 1777, 48, 1.0)).collect();
    let sound = render(&string(60), &strokes, 48_000);
    let single = render(&string(60), &strokes[..1], 48_000);
    let peak = |sound: &[f32]| sound.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    assert!(peak(&sound) > peak(&single) && peak(&sound) < 12.0 * peak(&single));
    let ended = render(&string(60), &[Event::note_on(0, 48, 1.0), off(4800, 48)], 240_000);
    assert!(peak(&ended[200_000..]) < 1e-6);
}

/// What needs the contacts of the modes for itself, or has none, is pushed as by a plain contact.
#[test]
fn where_no_hammer_can_strike_a_contact_does() {
    for (param, value) in [(Param::BowLevel, -20.0), (Param::BreathLevel, -20.0), (Param::Coefficients, 1.0)] {
        let felt = string(20).with(param, value);
        let contact = felt.clone().with(Param::MalletPulse, 1.0);
        let [felt, contact] = [felt, contact].map(|patch| render(&patch, &[Event::note_on(0, 60, 1.0)], 4800));
        assert!(felt == contact && rms(&felt) > 1e-3, "{param:?}");
    }
}
