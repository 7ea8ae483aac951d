//! Tests of the bank through its public interface.

mod motion;

use super::*;
use crate::dsp::mode_bank::tuning::TOP_ANGLE;
use crate::dsp::mode_bank::{ExcitationGains, ModeSetup};
use crate::dsp::random::{key, uniform};
use crate::dsp::{Coefficients, HarmonicOscillator};
use std::f64::consts::PI;

const RATE: f64 = 48_000.0;

const PUSHED: ExcitationRows = ExcitationRows::all(ExcitationGains { push: 1.0, ..ExcitationGains::NONE });
const PULLED: ExcitationRows = ExcitationRows::all(ExcitationGains { pull: 1.0, ..ExcitationGains::NONE });

fn bank_at(sample_rate: f64, modes: &[(f64, f64)]) -> ModeBank {
    let mut bank = ModeBank::new(sample_rate);
    let setup = |(frequency, t60): &(f64, f64)| ModeSetup { frequency: *frequency, t60: *t60, left: 1.0, right: 1.0 };
    bank.load(&modes.iter().map(setup).collect());
    bank.set_excitation_gains(&PUSHED);
    bank
}

fn bank(modes: &[(f64, f64)]) -> ModeBank {
    bank_at(RATE, modes)
}

fn strike() -> Drive {
    let mut drive = Drive::NONE;
    drive.push[0] = 1.0;
    drive
}

fn pluck() -> Drive {
    let mut drive = Drive::NONE;
    drive.pull[0] = 1.0;
    drive
}

fn run(bank: &mut ModeBank, frames: usize, drive: Option<&Drive>) -> Vec<f32> {
    let mut left = vec![];
    while left.len() < frames {
        let drive = drive.filter(|_| left.is_empty());
        bank.sweep_to(bank.ratio, CONTROL_FRAMES);
        left.extend_from_slice(bank.render(drive, CONTROL_FRAMES.min(frames - left.len()))[0]);
    }
    left
}

/// Renders one control tick in which the pitch moves to `ratio`.
fn glide(bank: &mut ModeBank, ratio: f64) -> Vec<f32> {
    bank.sweep_to(ratio, CONTROL_FRAMES);
    bank.render(None, CONTROL_FRAMES)[0].to_vec()
}

fn amplitude(bank: &mut ModeBank) -> f64 {
    libm::sqrt(bank.settle())
}

/// A mode equals the double-precision oscillator, pushed or displaced, at every pitch and decay. (RMS over a second.
/// Until it has tables, a mode is stepped with single-precision coefficients, whose rounding changes the phase of a
/// high mode by some 1e−7 per frame.)
#[test]
fn one_mode_is_the_oscillator() {
    for frequency in [20.0, 100.0, 440.0, 4000.0, 12_345.6, 20_000.0, 23_000.0] {
        for t60 in [0.02, 0.3, 1.0, 10.0] {
            for pull in [false, true] {
                let mut bank = bank(&[(frequency, t60)]);
                let mut c = Coefficients::exact(frequency, t60, 1.0, RATE);
                if pull {
                    bank.set_excitation_gains(&PULLED);
                    c = Coefficients { x0: 1.0 / c.amplitude(1.0, 0.0), v0: 0.0, ..c };
                }
                let rendered = run(&mut bank, 48_000, Some(&if pull { pluck() } else { strike() }));
                let db = error_db(&rendered, &mut [HarmonicOscillator::new(&c)]);
                let most = if frequency > 10_000.0 { -110.0 } else { -120.0 };
                assert!(db < most, "{frequency} Hz, {t60} s, pull {pull}: {db:.1} dB");
            }
        }
    }
}

/// With many modes, tables are used only after nine control ticks. Until then, the rounding of the coefficients changes
/// the phase of the highest mode by some 1e−5.
#[test]
fn sixty_four_modes_are_as_many_oscillators() {
    let modes: Vec<_> = (0..64).map(|m| (60.0 * libm::pow(1.1, m.into()), 2.0 / f64::from(m + 1))).collect();
    let mut masses: Vec<_> =
        modes.iter().map(|(f, t60)| HarmonicOscillator::new(&Coefficients::exact(*f, *t60, 1.0, RATE))).collect();
    let rendered = run(&mut bank(&modes), 48_000, Some(&strike()));
    let db = error_db(&rendered, &mut masses);
    println!("{db:.1} dB");
    assert!(db < -120.0, "{db:.1} dB");
}

/// RMS difference from the sum of masses, in dB; full scale is one mass of amplitude 1.
fn error_db(rendered: &[f32], masses: &mut [HarmonicOscillator<f64>]) -> f64 {
    let difference = |sample: &f32| f64::from(*sample) - masses.iter_mut().map(HarmonicOscillator::step).sum::<f64>();
    let squares: f64 = rendered.iter().map(difference).map(|difference| difference * difference).sum();
    10.0 * libm::log10(squares / rendered.len() as f64) - 20.0 * libm::log10(masses.len() as f64)
}

/// Modes that are put to rest below an amplitude change no sample by more than this amplitude for each of them, and are not
/// computed any more.
#[test]
fn modes_at_rest_below_an_amplitude_change_no_sample_by_more() {
    const LEAST: f32 = 1e-4;
    let modes: Vec<_> = (0..64).map(|m| (100.0 + 150.0 * f64::from(m), 3.0 / f64::from(m + 1))).collect();
    let [mut whole, mut part] = [bank(&modes), bank(&modes)];
    let (mut difference, mut live) = (0.0_f32, vec![]);
    for tick in 0..1500 {
        let drive = (tick == 0).then(strike);
        let sounds = [&mut whole, &mut part].map(|bank| run(bank, CONTROL_FRAMES, drive.as_ref()));
        let differences = sounds[0].iter().zip(&sounds[1]).map(|(whole, part)| (whole - part).abs());
        difference = differences.fold(difference, f32::max);
        part.rest_below(LEAST);
        live.push(part.live);
    }
    assert!(difference > 0.0 && difference < 64.0 * LEAST, "{difference}");
    assert!(live[0] == 64 && live[1499] == LANES && whole.live == 64, "{} modes are left", live[1499]);
}

/// However the bank renders, and although the mode is at rest behind all that are live, a nudge is a push of this mode alone.
#[test]
fn a_nudge_is_a_push_of_one_mode() {
    const NUDGED: usize = 50;
    let modes: Vec<_> = (0..64).map(|m| (200.0 + 10.0 * f64::from(m), if m % 50 == 0 { 10.0 } else { 0.02 })).collect();
    for (ticks, moves) in [(3, false), (40, false), (41, false), (40, true)] {
        for passed in [0, 5, 31] {
            let mut nudged = bank(&modes);
            let mut gains = PUSHED;
            gains.push[NUDGED] = 0.0;
            nudged.set_excitation_gains(&gains);
            run(&mut nudged, 1000 * CONTROL_FRAMES, Some(&strike()));
            nudged.settle();
            assert!(nudged.live <= NUDGED, "the mode is at rest");
            run(&mut nudged, ticks * CONTROL_FRAMES, None);
            nudged.sweep_to(if moves { 1.1 } else { 1.0 }, CONTROL_FRAMES);
            nudged.render(None, passed);
            let mut pushed = nudged.clone();
            let mut gains = ExcitationRows::NONE;
            gains.push[NUDGED] = 1.0;
            pushed.set_excitation_gains(&gains);
            nudged.nudge(NUDGED, 1.0);
            let left = CONTROL_FRAMES - passed;
            let [mut a, mut b] =
                [nudged.render(None, left)[0].to_vec(), pushed.render(Some(&strike()), left)[0].to_vec()];
            for (bank, sound) in [(&mut nudged, &mut a), (&mut pushed, &mut b)] {
                sound.extend(run(bank, 20 * CONTROL_FRAMES, None));
            }
            let difference = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            let loudest = a.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
            assert!(difference < 2e-5 && loudest > 1.5, "{ticks} {moves} {passed}: {difference} of {loudest}");
        }
    }
}

/// Vectors also hold places behind the last mode. What an earlier sound left there must not grow when damping changes.
#[test]
fn places_behind_the_last_mode_stay_finite() {
    let mut bank = bank(&[(200.0, 0.0005); 64]);
    (0..64).for_each(|m| bank.set_t60(m, 1.0));
    run(&mut bank, CONTROL_FRAMES, Some(&strike()));
    bank.load(&std::iter::once(ModeSetup { frequency: 300.0, t60: 1.0, left: 1.0, right: 1.0 }).collect());
    // An event in each frame breaks off each ramp at its beginning.
    for frame in 0..1_000 {
        bank.set_t60(0, if frame % 2 == 0 { 1.0 } else { 1.1 });
        bank.sweep_to(1.0, CONTROL_FRAMES);
        assert_eq!(bank.render(None, 1)[0], [0.0], "frame {frame}");
    }
}

/// The two states swap roles after every tick that is rendered by tables. Neither may keep old values of modes at rest.
#[test]
fn a_mode_at_rest_stays_at_rest_until_it_is_struck() {
    for ticks in 0..4 {
        // More modes at rest than a vector has lanes.
        let modes: Vec<_> = (0..64).map(|m| (200.0, if m == 0 { 10.0 } else { 0.02 })).collect();
        let mut bank = bank(&modes);
        let mut drive = Some(strike());
        let mut tick = |bank: &mut ModeBank| {
            bank.settle();
            run(bank, CONTROL_FRAMES, drive.take().as_ref());
        };
        while bank.live != LANES {
            tick(&mut bank);
        }
        (0..ticks).for_each(|_| tick(&mut bank));
        assert!(matches!(bank.motion, Motion::Tabled { .. }) && bank.live == LANES);
        let mut gains = ExcitationRows::NONE;
        gains.push[0] = 1.0;
        bank.set_excitation_gains(&gains);
        run(&mut bank, 1, Some(&strike()));
        assert!((1..64).all(|m| bank.mass(m).1 == 0.0), "{ticks} ticks: {:?}", bank.mass(40));
    }
}

/// Modes that were loaded before do not sound, for any number of lanes of a vector.
#[test]
fn a_bank_that_is_loaded_again_has_forgotten_its_modes() {
    let many: Vec<_> = (0..64).map(|m| (200.0 + 50.0 * f64::from(m), 10.0)).collect();
    let few = &many[..20];
    let mut used = bank(&many);
    run(&mut used, 32 * 20, Some(&strike()));
    let setup = |(frequency, t60): &(f64, f64)| ModeSetup { frequency: *frequency, t60: *t60, left: 1.0, right: 1.0 };
    used.load(&few.iter().map(setup).collect());
    used.set_excitation_gains(&PUSHED);
    let mut fresh = bank(few);
    for _ in 0..3 {
        let [found, expected] = [&mut used, &mut fresh].map(|bank| run(bank, 32 * 20, Some(&strike())));
        assert_eq!(found, expected);
    }
}

/// No invalid argument makes a bank louder or a call hang.
#[test]
fn odd_requests_are_brought_into_range() {
    let mut bank = bank(&[(1000.0, 1.0)]);
    run(&mut bank, 32, Some(&strike()));
    bank.set_t60(0, -1.0);
    bank.sweep_to(2.0, 0);
    bank.sweep_to(1.5, CONTROL_FRAMES);
    for _ in 0..100 {
        assert!(
            bank.render(None, CONTROL_FRAMES.min(bank.until_tick))[0].iter().all(|sample| sample.abs() <= 1.0 + 1e-4)
        );
        bank.sweep_to(1.5, CONTROL_FRAMES);
    }
}

/// Modes at rest are left out of a sweep. If they are struck during one, they must have its present pitch.
#[test]
fn a_mode_that_wakes_is_where_the_sweep_is() {
    let modes: Vec<_> = (0..64).map(|m| (200.0, if m == 0 { 10.0 } else { 0.02 })).collect();
    let mut bank = bank(&modes);
    run(&mut bank, CONTROL_FRAMES, Some(&strike()));
    for tick in 1..2000 {
        bank.settle();
        glide(&mut bank, 1.0 + 0.001 * f64::from(tick));
    }
    assert_eq!(bank.live, LANES);
    bank.sweep_to(3.0, CONTROL_FRAMES);
    bank.render(None, 16);
    // As for an event: every voice starts a new ramp at its frame.
    bank.sweep_to(3.0, 16);
    bank.render(Some(&strike()), 16);
    // The modes of the first group have not been at rest.
    let Modes { beta, beta_step, .. } = &bank.modes;
    let beta: Vec<_> = beta.0.iter().zip(&beta_step.0).map(|(start, step)| start + 16.0 * step).collect();
    assert!(beta[1..].iter().all(|mode| (mode / beta[1] - 1.0).abs() < 1e-6), "{beta:?}");
}

#[test]
fn the_energy_is_that_of_the_amplitudes() {
    let mut bank = bank(&[(100.0, 1.0), (3000.0, 1.0), (19_000.0, 1.0)]);
    run(&mut bank, 48_000, Some(&strike()));
    assert!((bank.settle() / 3e-6 - 1.0).abs() < 1e-4, "{}", bank.settle());
}

#[test]
fn a_pull_and_a_push_give_the_same_amplitude() {
    for frequency in [50.0, 5000.0, 20_000.0] {
        let mut pulled = bank(&[(frequency, 1.0)]);
        pulled.set_excitation_gains(&PULLED);
        run(&mut pulled, 1, Some(&pluck()));
        assert!((pulled.settle() - 1.0).abs() < 1e-3, "{frequency}: {}", pulled.settle());
    }
}

/// A force that acts alone uses a form of the kernel that reads no other force. The state must be that of the form that reads
/// all forces, bit for bit. There, the other forces act with gains of zero.
#[test]
fn a_force_alone_gives_the_bits_of_the_form_that_reads_all() {
    let modes: Vec<_> = (0..40).map(|m| (90.0 * f64::from(m + 1), 0.7)).collect();
    for phase in [0.0, 0.8] {
        for alone in 0..3 {
            let mut found = [vec![], vec![]];
            for (all, found) in [false, true].into_iter().zip(&mut found) {
                let mut bank = bank(&modes);
                let gains = [0, 1, 2].map(|force| if force == alone { 0.5 } else { 0.0 });
                let [push, pull, noise] = gains;
                let turn = [libm::cosf(phase), libm::sinf(phase)];
                bank.set_excitation_gains(&ExcitationRows::all(ExcitationGains { push, pull, noise, turn }));
                let mut drive = Drive::NONE;
                let Drive { push, pull, noise } = &mut drive;
                for (force, row) in [push, pull, noise].into_iter().enumerate() {
                    if all || force == alone {
                        row[..9].copy_from_slice(&[0.3, -0.1, 0.7, 0.0, 0.2, 0.01, 0.5, -0.6, 0.11]);
                    }
                }
                bank.sweep_to(1.01, CONTROL_FRAMES);
                let mut left = bank.render(Some(&drive), CONTROL_FRAMES)[0].to_vec();
                left.extend(run(&mut bank, 64, Some(&drive)));
                *found = left;
            }
            assert!(found[0].iter().any(|sample| *sample != 0.0));
            assert!(found[0] == found[1], "force {alone} at phase {phase}");
        }
    }
}

/// Also in the middle of a tick for which the bank has tables.
#[test]
fn a_copy_with_another_state_goes_on_from_it() {
    for ticks in [1, 40] {
        let mut whole = bank(&[(440.0, 1.0)]);
        run(&mut whole, ticks * CONTROL_FRAMES, Some(&strike()));
        let mut part = whole.clone();
        part.take_state_of(&whole);
        for frames in [5, CONTROL_FRAMES - 5, 7] {
            if frames == 5 || frames == 7 {
                whole.sweep_to(1.0, CONTROL_FRAMES);
            }
            let before = std::mem::replace(&mut part, whole.clone());
            part.take_state_of(&before);
            let expected = whole.render(None, frames)[0].to_vec();
            let found = part.render(Some(&Drive::NONE), frames)[0];
            let worst = expected.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-5, "{ticks} ticks, {frames} frames: {worst}");
        }
    }
}

/// A phase turns the response to each sample of a force, so the output is the force convolved with `sin(nθ + φ)`.
#[test]
fn every_force_is_convolved_with_a_turned_response() {
    let force = [0.3, -0.1, 0.7, 0.0, 0.2, 0.01, 0.5, -0.6, 0.11];
    let (frequency, t60, phase) = (1000.0, 0.2, 0.8_f32);
    let (angle, ln_radius) = (2.0 * PI * frequency / 48_000.0, -6.907_755_278_982_137 / (t60 * 48_000.0));
    for which in 0..2 {
        let mut bank = bank(&[(frequency, t60)]);
        let [push, noise] = [0, 1].map(|force| if force == which { 0.5 } else { 0.0 });
        let turn = [libm::cosf(phase), libm::sinf(phase)];
        let gains = ExcitationRows::all(ExcitationGains { push, pull: 0.0, noise, turn });
        bank.set_excitation_gains(&ExcitationRows { turned_noise: true, ..gains });
        let mut drive = Drive::NONE;
        let Drive { push, noise, .. } = &mut drive;
        [push, noise][which][..9].copy_from_slice(&force);
        bank.sweep_to(1.0, CONTROL_FRAMES);
        let mut left = bank.render(Some(&drive), CONTROL_FRAMES)[0].to_vec();
        left.extend(run(&mut bank, 640, None));
        for (frame, sample) in left.iter().enumerate() {
            let expected: f64 =
                force.iter().enumerate().filter(|(at, _)| *at <= frame).fold(0.0, |sum, (at, force)| {
                    let n = (frame - at + 1) as f64;
                    sum + 0.5 * f64::from(*force) * libm::exp(n * ln_radius) * libm::sin(n * angle + f64::from(phase))
                });
            assert!((f64::from(*sample) - expected).abs() < 2e-6, "force {which}, frame {frame}: {sample}, {expected}");
        }
    }
}

/// A damper changes the decay from its frame on, but neither pitch nor displacement.
#[test]
fn a_damper_acts_at_once() {
    let (mut ringing, mut damped) = (bank(&[(1000.0, 10.0)]), bank(&[(1000.0, 10.0)]));
    for bank in [&mut ringing, &mut damped] {
        run(bank, 3200, Some(&strike()));
    }
    damped.set_t60(0, 0.05);
    let [expected, found] = [&mut ringing, &mut damped].map(|bank| run(bank, 2400, None));
    let radius = |t60: f64| libm::exp(LN_MINUS_60_DB / (t60 * RATE));
    let per_frame = radius(0.05) / radius(10.0);
    let mut factor = 1.0;
    for (n, (expected, found)) in expected.iter().zip(&found).enumerate() {
        factor *= per_frame;
        assert!((f64::from(*expected) * factor - f64::from(*found)).abs() < 2e-6, "frame {n}");
    }
}

/// Random coefficients as the bank rounds them, over the whole parameter range: no radius is wrong by more than rounding.
#[test]
fn random_parameter_sets_are_stable() {
    let stream = key(5, 0);
    let unit = |n: u64| f64::from(uniform(stream, n)) * 0.5 + 0.5;
    let between = |n: u64, low: f64, high: f64| low * libm::pow(high / low, unit(n));
    let mut worst = 0.0_f64;
    for case in 0..20_000_u64 {
        let rate = between(3 * case, 1_000.0, 768_000.0);
        let modes: Vec<_> = (0..MAX_MODES as u64)
            .map(|m| {
                let n = 3 * (20_000 + case * 64 + m);
                (between(n + 1, 8.0, 0.5 * rate), between(n + 2, 0.0005, 240.0))
            })
            .collect();
        let mut bank = bank_at(rate, &modes);
        bank.jump_to(1.0);
        for (m, (frequency, _)) in modes.iter().enumerate() {
            let (alpha, beta) = (f64::from(bank.modes.alpha.0[m]), f64::from(bank.modes.beta.0[m]));
            let radius = libm::sqrt((1.0 - alpha) * (1.0 - alpha) + beta * beta);
            let wanted = libm::exp(bank.ln_radius[m]);
            worst = worst.max((radius - wanted).abs());
            let theta = libm::atan2(beta, 1.0 - alpha);
            let angle = (2.0 * PI * frequency / rate).min(TOP_ANGLE);
            assert!(wanted < 0.5 || (theta / angle - 1.0).abs() < 1e-6, "{case}: {theta} for {angle}");
        }
    }
    println!("radii within {worst:.1e}");
    assert!(worst < 2.5e-7, "{worst:e}");
}
