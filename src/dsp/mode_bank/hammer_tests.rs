//! Tests of a hammer on a bank: its energy, and pianos beside a converged solution of the same equations.

use super::tests::Stream;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::{Drive, Hammer, HammerLaw, Player, Rattle, RattleKind, RattleLaw};
use crate::dsp::mode_bank::{ExcitationGains, ExcitationRows, MAX_MODES, ModeBank, ModeSetup};
use crate::dsp::random::key;
use std::f64::consts::{PI, TAU};

const RATE: f64 = 48_000.0;
const SETTINGS: u64 = 10_000;

/// A mode: its frequency in Hz, T60 in seconds, and weight at the point of the strike.
type Partial = (f64, f64, f64);

/// A bank that a push of 1 makes as loud as `push`, with the hammer's `law` on it.
fn struck(partials: &[Partial], push: f32, law: HammerLaw, rate: f64) -> (ModeBank, Hammer) {
    let mut bank = ModeBank::new(rate);
    let setup = |(frequency, t60, _): &Partial| ModeSetup { frequency: *frequency, t60: *t60, left: 1.0, right: 0.5 };
    bank.load(&partials.iter().map(setup).collect());
    bank.set_excitation_gains(&ExcitationRows::all(ExcitationGains { push, ..ExcitationGains::NONE }));
    bank.jump_to(1.0);
    let (mut compliance, mut stillness) = (0.0, law.stillness);
    for (m, (.., weight)) in partials.iter().enumerate() {
        let [own, still] = bank.set_touched(m, push.into(), *weight);
        (compliance, stillness) = (compliance + own, stillness + still);
    }
    (bank, Hammer::new(HammerLaw { compliance, stillness, ..law }))
}

/// The energy of a body that a push of 1 makes as loud as `push`.
fn of_body(bank: &ModeBank, partials: &[Partial], push: f32) -> f64 {
    let of = |(m, (.., weight)): (usize, &Partial)| f64::from(bank.mass(m).1) * weight;
    0.5 * partials.iter().enumerate().map(of).sum::<f64>() / f64::from(push * push)
}

/// The forces of some frames.
fn strike(bank: &mut ModeBank, hammer: &mut Hammer, frames: usize) -> Vec<f64> {
    let mut forces = vec![];
    for i in 0..frames {
        if i % CONTROL_FRAMES == 0 {
            bank.sweep_to(1.0, CONTROL_FRAMES);
        }
        let force = hammer.force_on(bank.given());
        bank.render_played(None, Some(Player::Forces(&[force; CONTROL_FRAMES])), 1);
        forces.push(f64::from(force));
    }
    forces
}

/// For all hammers, felts, bodies and rates, modes and hammer together never gain energy, also where the force is absurd.
#[test]
fn a_hammer_and_its_body_gain_nothing() {
    let mut touched = 0;
    for seed in 0..SETTINGS {
        let mut stream = Stream(key(81, seed), 0);
        let mut spread = |decades| stream.spread(decades);
        let rate = 80_000.0 * spread(2.0);
        let len = 1 + (MAX_MODES as f64 * spread(2.0) * 0.1) as usize;
        let partials: Vec<Partial> =
            (0..len.min(MAX_MODES)).map(|_| (0.05 * rate * spread(2.2), 10.0 * spread(8.0), spread(6.0))).collect();
        let speed = spread(6.0);
        let law = HammerLaw {
            mass: spread(8.0),
            speed,
            full_speed: speed * spread(2.0),
            contact: 30.0 * spread(6.0),
            longest: 2000,
            ..HammerLaw::NONE
        };
        let push = spread(4.0) as f32;
        let (mut bank, mut hammer) = struck(&partials, push, law, rate);
        let energy = |bank: &ModeBank, hammer: &Hammer| of_body(bank, &partials, push) + hammer.energy();
        let first = energy(&bank, &hammer);
        for i in 0..200 {
            if i % CONTROL_FRAMES == 0 {
                bank.sweep_to(1.0, CONTROL_FRAMES);
            }
            bank.render_played(None, Some(Player::Hammer(&mut hammer)), 1);
            let now = energy(&bank, &hammer);
            assert!(now <= first * (1.0 + 2e-6), "{seed}, frame {i}: {now} of {first}\n{law:?}\n{hammer:?}");
        }
        touched += u32::from(energy(&bank, &hammer) - hammer.energy() > 1e-3 * first);
    }
    assert!(touched > 3000, "hammers moved bodies: {touched}");
}

/// For all edges and loose masses on all bodies, which lose nothing themselves, modes and rattle together never gain energy.
#[test]
fn a_rattle_and_its_body_gain_nothing() {
    let (mut hits, mut kept) = (0, 0.0);
    for seed in 0..SETTINGS {
        let mut stream = Stream(key(82, seed), 0);
        let mut spread = |decades| stream.spread(decades);
        let rate = 80_000.0 * spread(2.0);
        let len = 1 + (MAX_MODES as f64 * spread(2.0) * 0.1) as usize;
        let partials: Vec<Partial> =
            (0..len.min(MAX_MODES)).map(|_| (0.05 * rate * spread(2.2), 1e5, spread(6.0))).collect();
        let push = spread(4.0) as f32;
        let (mut bank, _) = struck(&partials, push, HammerLaw::NONE, rate);
        let (mut compliance, mut stillness) = (0.0, 0.0);
        for (m, (.., weight)) in partials.iter().enumerate() {
            let [own, still] = bank.set_touched(m, push.into(), *weight);
            (compliance, stillness) = (compliance + own + still, stillness + still);
        }
        // The body swings before it meets the rattle.
        let force = spread(4.0);
        let mut drive = Drive::NONE;
        drive.push[0] = force as f32;
        bank.sweep_to(1.0, CONTROL_FRAMES);
        bank.render(Some(&drive), CONTROL_FRAMES);
        let speed = force * partials.iter().map(|(.., weight)| weight).sum::<f64>();
        let kind = if seed % 2 == 0 {
            RattleKind::Edge { gap: speed * spread(6.0) }
        } else {
            RattleKind::Loose { mass: spread(6.0), pull: speed * 0.01 * spread(4.0) }
        };
        let law = RattleLaw { kind, speed: speed * spread(2.0), contact: 30.0 * spread(5.0), compliance };
        let mut rattle = Rattle::new(law);
        let body = |bank: &ModeBank| of_body(bank, &partials, push);
        let mut first = None;
        for i in 0..200 {
            if i % CONTROL_FRAMES == 0 {
                bank.sweep_to(1.0, CONTROL_FRAMES);
            }
            bank.render_played(None, Some(Player::Rattle(&mut rattle)), 1);
            let now = body(&bank) + rattle.energy(stillness);
            // A rattle begins in its first two frames.
            let (most, size) = *first.get_or_insert((now, body(&bank) + rattle.energy(stillness).abs()));
            if i < 2 {
                first = None;
                continue;
            }
            // Single precision rounds each turn, and the displacement of the point.
            assert!(now <= most + 4e-7 * i as f64 * size, "{seed}, frame {i}: {now} of {most}\n{law:?}\n{rattle:?}");
        }
        let lost = first.map_or(0.0, |(most, _)| 1.0 - body(&bank) / most);
        hits += u32::from(lost > 1e-3);
        kept += f64::from(u32::from(lost < 1.0));
    }
    assert!(hits > 1000 && kept > 5000.0, "rattles met bodies: {hits}, {kept}");
}

/// A string of Chaigne and Askenfelt, "Numerical simulations of piano strings" II, JASA 95 (1994), table I: fundamental, mass,
/// stiffness, losses, mass of the hammer, place of the strike.
struct Piano {
    name: &'static str,
    f0: f64,
    mass: f64,
    stiffness: f64,
    loss: f64,
    hammer: f64,
    place: f64,
    /// Contact time at a wall at 5 m/s, in milliseconds.
    contact: f64,
}

impl Piano {
    /// Its modes below `highest` Hz.
    fn partials(&self, highest: f64) -> Vec<Partial> {
        let partial = |n: u32| {
            let n = f64::from(n);
            let frequency = n * self.f0 * libm::sqrt(1.0 + PI * PI * self.stiffness * n * n);
            let damping = 0.5 + self.loss * (TAU * frequency) * (TAU * frequency);
            let shape = libm::sin(n * PI * self.place);
            (frequency, 3.0 * std::f64::consts::LN_10 / damping, 2.0 / self.mass * shape * shape)
        };
        (1..1000).map(partial).take_while(|(frequency, ..)| *frequency < highest).collect()
    }
}

const PIANOS: [Piano; 3] = [
    Piano {
        name: "C2",
        f0: 65.4,
        mass: 35e-3,
        stiffness: 7.5e-6,
        loss: 6.25e-9,
        hammer: 4.9e-3,
        place: 0.12,
        contact: 0.9,
    },
    Piano {
        name: "C4",
        f0: 262.2,
        mass: 3.93e-3,
        stiffness: 3.82e-5,
        loss: 6.25e-9,
        hammer: 2.97e-3,
        place: 0.12,
        contact: 0.55,
    },
    Piano {
        name: "C7",
        f0: 2093.0,
        mass: 0.467e-3,
        stiffness: 8.67e-4,
        loss: 2.6e-10,
        hammer: 2.2e-3,
        place: 0.0625,
        contact: 0.33,
    },
];

/// Amplitudes of the modes, and the forces, from a solution by the classical Runge–Kutta method with `steps` steps a frame of
/// 1/48,000 s. The felt is that of [`Hammer`] without losses.
fn converged(
    partials: &[Partial],
    mass: f64,
    speed: f64,
    stiffness: f64,
    frames: usize,
    steps: usize,
) -> [Vec<f64>; 2] {
    let count = partials.len();
    let step = 1.0 / (RATE * steps as f64);
    let constants: Vec<_> = partials
        .iter()
        .map(|(frequency, t60, weight)| {
            let (damping, angle) = (3.0 * std::f64::consts::LN_10 / t60, TAU * frequency);
            (2.0 * damping, angle * angle + damping * damping, *weight, angle, damping)
        })
        .collect();
    // Each mode's displacement at the point of the strike, per unit of its own weight, and velocity; then those of the hammer.
    let mut state = vec![0.0; 2 * count + 2];
    state[2 * count + 1] = speed;
    let force_at = |state: &[f64]| {
        let point: f64 = constants.iter().zip(state.chunks(2)).map(|((.., weight, _, _), q)| weight * q[0]).sum();
        let dent = (state[2 * count] - point).max(0.0);
        stiffness * dent * dent * libm::sqrt(dent)
    };
    let slope = |state: &[f64], out: &mut Vec<f64>| {
        let force = force_at(state);
        out.clear();
        for ((damping, square, ..), q) in constants.iter().zip(state.chunks(2)) {
            out.extend([q[1], force - damping * q[1] - square * q[0]]);
        }
        out.extend([state[2 * count + 1], -force / mass]);
    };
    let (mut forces, mut k, mut at) = (vec![], [vec![], vec![], vec![], vec![]], vec![]);
    for _ in 0..frames * steps {
        forces.push(force_at(&state));
        for (stage, share) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
            at.clear();
            at.extend_from_slice(&state);
            if stage > 0 {
                at.iter_mut().zip(&k[stage - 1]).for_each(|(at, k)| *at += share * step * k);
            }
            slope(&at, &mut k[stage]);
        }
        for (i, value) in state.iter_mut().enumerate() {
            *value += step / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
        }
    }
    // A push of 1 gives a velocity of 1, and so an amplitude of 1 in units of 1/ω.
    let amplitude = |((.., angle, damping), q): (&(f64, f64, f64, f64, f64), &[f64])| {
        let velocity = (q[1] + damping * q[0]) / angle;
        angle * libm::sqrt(q[0] * q[0] + velocity * velocity)
    };
    [constants.iter().zip(state.chunks(2)).map(amplitude).collect(), forces]
}

/// Milliseconds in which a force is above a thousandth of its peak, and the peak.
fn contact(forces: &[f64], per_second: f64) -> [f64; 2] {
    let peak = forces.iter().copied().fold(0.0, f64::max);
    let touching = |force: &&f64| **force > 1e-3 * peak;
    let (first, last) = (forces.iter().position(|f| touching(&f)), forces.iter().rposition(|f| touching(&f)));
    [1e3 * (last.unwrap_or(0) - first.unwrap_or(0) + 1) as f64 / per_second, peak]
}

#[test]
fn pianos_are_those_of_a_converged_solution() {
    for piano in &PIANOS {
        for speed in [0.5, 1.5, 5.0] {
            let seconds = 1e-3 * piano.contact;
            let dent = seconds * 5.0 / 2.69;
            let stiffness = 1.75 * piano.hammer * 25.0 / (libm::pow(dent, 3.5));
            let frames = 400;
            // The bank has the first modes; those above, up to four times its highest frequency, give way at once.
            let all = piano.partials(96_000.0);
            let partials: Vec<_> = all.iter().take(MAX_MODES).copied().collect();
            let [wanted, reference] = converged(&all, piano.hammer, speed, stiffness, frames, 32);
            let angle = |frequency: f64| TAU * frequency / RATE;
            let above = all.iter().skip(MAX_MODES);
            let stillness = above.map(|(frequency, _, weight)| weight / (angle(*frequency) * angle(*frequency))).sum();
            // In frames: a speed is in metres a frame, and an impulse in N times frames.
            let law = HammerLaw {
                mass: piano.hammer,
                speed: speed / RATE,
                full_speed: 5.0 / RATE,
                contact: seconds * RATE,
                longest: 2400,
                stillness,
                ..HammerLaw::NONE
            };
            let (mut bank, mut hammer) = struck(&partials, 1.0, law, RATE);
            hammer.take_loss();
            let forces = strike(&mut bank, &mut hammer, frames);
            let ([time, peak], [wanted_time, wanted_peak]) = (contact(&forces, RATE), contact(&reference, 32.0 * RATE));
            let peak = peak * RATE * RATE;
            // The force of a frame is its mean, and begins and ends with it.
            let frame = 2.0 * 1e3 / RATE;
            let label = format!("{} at {speed} m/s: {time} ms of {wanted_time}, {peak} N of {wanted_peak}", piano.name);
            assert!((time - wanted_time).abs() < 0.02 * wanted_time + frame, "{label}");
            assert!((peak / wanted_peak - 1.0).abs() < 0.02, "{label}");
            let loudest = wanted.iter().copied().fold(0.0, f64::max);
            for (m, (frequency, ..)) in partials.iter().enumerate() {
                let found = libm::sqrt(bank.mass(m).1.into()) * RATE;
                let (found, wanted) = (20.0 * libm::log10(found / loudest), 20.0 * libm::log10(wanted[m] / loudest));
                // What is 25 dB below the loudest mode hangs on the last bits of the contact.
                let tolerance = if wanted > -25.0 { 0.5 } else { 0.75 };
                if wanted > -40.0 && *frequency < 5000.0 {
                    assert!((found - wanted).abs() < tolerance, "{label}, {frequency} Hz: {found} dB of {wanted}");
                }
            }
        }
    }
}

/// A body that does not give way throws the hammer back after the time that was asked for, with what the felt leaves it.
#[test]
fn at_a_wall_a_hammer_touches_for_its_contact_time() {
    for contact in [10.0, 100.0, 1000.0] {
        let law = HammerLaw { mass: 2.0, speed: 0.1, full_speed: 0.1, contact, longest: 1_000_000, ..HammerLaw::NONE };
        let mut hammer = Hammer::new(law);
        let forces: Vec<_> = (0..100_000).map(|_| f64::from(hammer.force_on(0.0))).collect();
        let touched = forces.iter().filter(|force| **force > 0.0).count() as f64;
        assert!((touched - contact).abs() < 1.5 + 0.06 * contact, "{touched} frames of {contact}");
        let back = forces.iter().sum::<f64>() / (law.mass * law.speed) - 1.0;
        assert!(back > 0.8 && back < 0.95, "{back}");
        assert!(!hammer.is_there(), "it is gone");
    }
}

/// Blocks of any length give the same bits.
#[test]
fn a_struck_bank_has_the_same_bits_in_any_division() {
    let piano = PIANOS[1].partials(20_000.0);
    let play = |pieces: &[usize]| {
        let law =
            HammerLaw { mass: 3e-3, speed: 1e-4, full_speed: 1e-4, contact: 30.0, longest: 2400, ..HammerLaw::NONE };
        let (mut bank, mut hammer) = struck(&piano[..MAX_MODES.min(piano.len())], 100.0, law, RATE);
        let mut heard = vec![];
        for tick in 0..20 {
            bank.sweep_to(1.0 + 1e-4 * f64::from(tick), CONTROL_FRAMES);
            for frames in pieces {
                let player = Some(Player::Hammer(&mut hammer)).filter(|_| tick < 12);
                heard.extend_from_slice(bank.render_played(None, player, *frames)[0]);
            }
        }
        heard
    };
    let whole = play(&[32]);
    assert!(whole.iter().any(|sample| sample.abs() > 1e-5));
    assert!(play(&[1, 20, 11]) == whole);
}
