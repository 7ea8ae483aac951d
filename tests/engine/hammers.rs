//! What touches a body in whole notes: how hammers follow velocity and what they meet, and what rattles.

use crate::events::{event, off, played};
use crate::exciters::{brightness, rms};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

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
    played(patch, (RATE, 1), events, frames)
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

/// Two strikes of a key at one frame are heard: its hammer strikes modes that have their pitch.
#[test]
fn two_strokes_at_one_frame_sound() {
    let strokes = [Event::note_on(100, 60, 0.8), Event::note_on(100, 60, 0.8)];
    let [single, both] = [&strokes[..1], &strokes].map(|strokes| rms(&render(&string(40), strokes, 9600)));
    assert!(single > 1e-3 && both > 0.9 * single, "{single} {both}");
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

/// A plucked string of `count` partials, and what it hits.
fn rattling(kind: f32, gap: f32) -> Patch {
    let mode = |n: u16| Mode { ratio: n.into(), level: 0.05, ..Mode::UNIT };
    Patch { modes: ModeTable::new(&(1..=40).map(mode).collect::<Vec<_>>()), ..Patch::default() }
        .with(Param::MalletLevel, -60.0)
        .with(Param::PluckLevel, 0.0)
        .with(Param::PluckPosition, 20.0)
        .with(Param::PluckHardness, 25.0)
        .with(Param::Decay, 3.0)
        .with(Param::Limiter, 0.0)
        .with(Param::Rattle, kind)
        .with(Param::RattleGap, gap)
        .with(Param::RattlePosition, 3.0)
        .with(Param::RattleHardness, 95.0)
}

/// A string that beats on an edge loses little, but has more of it in its high partials; a soft stroke does not reach the edge.
#[test]
fn an_edge_buzzes_when_the_string_reaches_it() {
    let play = |patch: &Patch, velocity| render(patch, &[Event::note_on(0, 48, velocity)], 48_000);
    let (free, edge) = (play(&rattling(0.0, 6.0), 1.0), play(&rattling(1.0, 6.0), 1.0));
    let late = 12_000..24_000;
    let [plain, buzz] = [&free, &edge].map(|sound| brightness(&sound[late.clone()]));
    assert!(buzz > 3.0 * plain, "{buzz} {plain}");
    assert!((rms(&edge) / rms(&free) - 1.0).abs() < 0.1, "{} {}", rms(&edge), rms(&free));
    let [soft, soft_edge] = [0.0, 1.0].map(|kind| play(&rattling(kind, 6.0), 0.15));
    let apart: Vec<_> = soft.iter().zip(&soft_edge).map(|(free, edge)| free - edge).collect();
    assert!(rms(&soft) > 1e-4 && rms(&apart) < 1e-4 * rms(&soft), "{} {}", rms(&apart), rms(&soft));
}

/// A loose mass clatters, and the note ends all the same.
#[test]
fn a_loose_mass_clatters_and_comes_to_rest() {
    let loose = rattling(2.0, 0.0).with(Param::RattlePosition, 12.0);
    let sound = render(&loose, &[Event::note_on(0, 48, 1.0), off(48_000, 48)], 480_000);
    let free = render(&rattling(0.0, 20.0), &[Event::note_on(0, 48, 1.0)], 48_000);
    assert!(brightness(&sound[4000..24_000]) > 3.0 * brightness(&free[4000..24_000]));
    assert!(sound.iter().all(|sample| sample.abs() < 4.0));
    assert!(sound[470_000..].iter().all(|sample| *sample == 0.0), "the voice is over");
}

/// Blocks of any length give the same bits, with a hammer before the rattle.
#[test]
fn a_rattle_sounds_the_same_in_blocks() {
    let patch = rattling(2.0, 20.0).with(Param::MalletLevel, 0.0).with(Param::MalletPulse, FELT);
    let events = [Event::note_on(100, 48, 0.9), Event::note_on(5000, 48, 0.6)];
    let whole = render(&patch, &events, 20_000);
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(&patch);
    let mut parts = vec![];
    for start in (0..20_000_u32).step_by(77) {
        let frames = 77.min(20_000 - start);
        let here = events.iter().filter(|event| (start..start + frames).contains(&event.frame));
        let here: Vec<_> = here.map(|event| Event { frame: event.frame - start, ..*event }).collect();
        let (mut left, mut right) = (vec![0.0; frames as usize], vec![0.0; frames as usize]);
        synth.process(&here, &mut left, &mut right);
        parts.extend(left);
    }
    assert!(parts == whole && rms(&whole) > 1e-3);
}

/// Each strike finds the modes that swing under other levels than those by which they were moved.
#[test]
fn a_rattle_does_not_grow_where_strikes_are_dark_and_bright_in_turn() {
    let sitar = Preset::find("Sitar").unwrap().patch.clone().with(Param::Limiter, 0.0);
    let most = |tilts: [f32; 2], strikes: u32, velocity: f32| {
        let strike = |n: u32| {
            let tilt = event(4800 * n, EventKind::Param { param: Param::Tilt, value: tilts[n as usize % 2] });
            [tilt, Event::note_on(4800 * n, 48, velocity)]
        };
        let events: Vec<Event> = (0..strikes).flat_map(strike).collect();
        render(&sitar, &events, 4800 * strikes as usize).iter().fold(0.0, |most: f32, sample| most.max(sample.abs()))
    };
    let full = most([-12.0, 12.0], 2, 1.0);
    let turned = most([-12.0, 12.0], 100, 0.2);
    assert!(full > 0.01 && turned < 4.0 * full, "{full} {turned}");
}

#[test]
fn a_hammer_strikes_also_where_a_bow_has_just_stopped() {
    let bowed = string(60).with(Param::BowLevel, -20.0);
    let lift = event(24_000, EventKind::Param { param: Param::BowLevel, value: -60.0 });
    let strike = |velocity| Event::note_on(24_000, 48, velocity);
    let [soft, hard] = [0.0, 1.0].map(|velocity| {
        let sound = render(&bowed, &[Event::note_on(0, 48, 0.3), lift, strike(velocity)], 36_000);
        rms(&sound[24_000..])
    });
    assert!(hard > 1.5 * soft, "{soft} {hard}");
}
