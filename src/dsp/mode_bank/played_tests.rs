//! Tests of the upper bounds of what bow and breath add, and of the sound of a bank under them.

use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::{Bow, Breath, Drive, JetLaw, Mouthpiece, MouthpieceLaw, Player, ValveLaw};
use crate::dsp::mode_bank::{ExcitationGains, ExcitationRows, MAX_MODES, ModeBank, ModeSetup};
use crate::dsp::random::{key, uniform};

const RATE: f64 = 48_000.0;
const SETTINGS: u64 = 10_000;

/// A sequence of numbers from 0 to 1.
pub(super) struct Stream(pub(super) u64, pub(super) u64);

impl Stream {
    fn next(&mut self) -> f64 {
        self.1 += 1;
        f64::from(uniform(self.0, self.1)) * 0.5 + 0.5
    }

    /// A number around 1, evenly over so many decades.
    pub(super) fn spread(&mut self, decades: f64) -> f64 {
        libm::pow(10.0, decades * (self.next() - 0.5))
    }
}

fn bank(stream: &mut Stream) -> ModeBank {
    let mut bank = ModeBank::new(RATE);
    let len = 1 + (stream.next() * MAX_MODES as f64) as usize;
    let modes: Vec<_> = (0..len)
        .map(|_| {
            let (frequency, t60) = (20.0 * libm::pow(1000.0, stream.next()), 0.01 * libm::pow(3000.0, stream.next()));
            ModeSetup { frequency, t60, left: 1.0, right: 0.5 }
        })
        .collect();
    bank.load(&modes.into_iter().collect());
    let weights: Vec<f64> = (0..bank.len()).map(|_| 2.0 * stream.next() - 1.0).collect();
    let scale = 1.0 / libm::sqrt(weights.iter().map(|weight| weight * weight).sum::<f64>());
    for (m, weight) in weights.iter().enumerate() {
        let weight = (weight * scale) as f32;
        bank.set_contact(m, weight, weight);
    }
    bank.set_excitation_gains(&ExcitationRows::all(ExcitationGains { push: 1.0, ..ExcitationGains::NONE }));
    bank
}

fn energy(bank: &ModeBank) -> f64 {
    (0..bank.len()).map(|m| f64::from(bank.mass(m).1)).sum()
}

/// For all bows, bodies, states and pitch changes, no frame adds more energy than friction at the bow's speed.
#[test]
fn a_bow_gives_no_more_than_friction_at_its_speed() {
    let mut gained = 0;
    for seed in 0..SETTINGS {
        let mut stream = Stream(key(77, seed), 0);
        let mut bank = bank(&mut stream);
        let speed = [libm::pow(10.0, 4.0 * stream.next() - 3.0) as f32, 0.0];
        let force = [speed[0] * libm::pow(10.0, 5.0 * stream.next() - 4.0) as f32, 0.0];
        let mut bow = Bow { speed, force, passed: 0, width: (0.01 + stream.next()) as f32 };
        let most = 2.0 * f64::from(force[0]) * f64::from(speed[0]);
        let mut strike = Drive::NONE;
        strike.push[0] = (stream.next() * stream.next() * 4.0) as f32;
        bank.sweep_to(0.5 + stream.next(), CONTROL_FRAMES);
        bank.render(Some(&strike), CONTROL_FRAMES);
        for _ in 0..2 {
            bank.sweep_to(0.5 + stream.next(), CONTROL_FRAMES);
            for _ in 0..CONTROL_FRAMES {
                let before = energy(&bank);
                bank.render_played(None, Some(Player::Bow(bow)), 1);
                bow.passed += 1;
                let after = energy(&bank);
                gained += u32::from(after > before);
                assert!(after <= before * (1.0 + 1e-6) + most * (1.0 + 1e-3), "{seed}: {before} {after} {most}");
            }
        }
    }
    assert!(gained > 50_000, "the bow moved what it was to move: {gained}");
}

/// The force is at most the given friction, and its direction is towards the bow's speed.
#[test]
fn friction_pulls_towards_the_speed_of_the_bow() {
    let mut stream = Stream(key(78, 0), 0);
    for _ in 0..SETTINGS {
        let (speed, force) = (stream.next() as f32, stream.next() as f32);
        let bow = Bow { speed: [speed, 0.0], force: [force, 0.0], passed: 0, width: 0.2 };
        let velocity = (8.0 * stream.next() - 4.0) as f32;
        let found = bow.force_on(0, velocity);
        assert!(found.abs() <= force && found * (speed - velocity) >= 0.0, "{bow:?} {velocity}: {found}");
    }
    let bow = Bow { speed: [0.0; 2], force: [0.0; 2], passed: 0, width: 0.2 };
    assert_eq!(bow.force_on(0, 0.0), 0.0);
}

/// A glass under a bow: it starts to ring without a strike, and its amplitude stays near the bow's speed.
#[test]
fn a_bowed_mode_rings_for_as_long_as_it_is_bowed() {
    let mut bank = ModeBank::new(RATE);
    bank.load(&[ModeSetup { frequency: 440.0, t60: 2.0, left: 1.0, right: 1.0 }].into_iter().collect());
    bank.set_contact(0, 1.0, 1.0);
    let bow = Bow { speed: [0.5, 0.0], force: [0.02, 0.0], passed: 0, width: 0.2 };
    let mut rms = vec![];
    for _ in 0..10 {
        let mut squares = 0.0;
        for _ in 0..150 {
            bank.sweep_to(1.0, CONTROL_FRAMES);
            let [left, _] = bank.render_played(None, Some(Player::Bow(bow)), CONTROL_FRAMES);
            squares += left.iter().map(|sample| f64::from(sample * sample)).sum::<f64>();
        }
        rms.push(libm::sqrt(squares / 4800.0));
    }
    assert!(rms[9] > 0.25 && rms[9] < 0.8 && (rms[9] / rms[8] - 1.0).abs() < 0.01, "{rms:?}");
}

#[test]
fn a_bowed_bank_has_the_same_bits_in_any_division() {
    let play = |pieces: &[usize]| {
        let mut bank = bank(&mut Stream(key(79, 1), 0));
        let mut bow = Bow { speed: [0.3, 0.001], force: [0.05, -0.0001], passed: 0, width: 0.3 };
        let mut sides = [vec![], vec![]];
        for tick in 0..20 {
            bank.sweep_to(1.0 + 0.01 * f64::from(tick), CONTROL_FRAMES);
            bow.passed = 0;
            for frames in pieces {
                let rendered = bank.render_played(None, Some(Player::Bow(bow)), *frames);
                sides.iter_mut().zip(rendered).for_each(|(side, part)| side.extend_from_slice(part));
                bow.passed += *frames as u32;
            }
        }
        sides
    };
    let whole = play(&[32]);
    assert!(whole[0].iter().any(|sample| sample.abs() > 0.01));
    assert!(play(&[1, 20, 11]) == whole);
}

/// A tube of `modes` (ratio, share of the flow), all with one T60, whose left output is the pressure behind the mouthpiece.
fn tube(frequency: f64, t60: f64, modes: &[(f64, f32)], rate: f64) -> (ModeBank, Breath) {
    let mut bank = ModeBank::new(rate);
    let setup = |(ratio, _): &(f64, f32)| ModeSetup { frequency: ratio * frequency, t60, left: 1.0, right: 1.0 };
    bank.load(&modes.iter().map(setup).collect());
    modes.iter().enumerate().for_each(|(m, (_, share))| bank.set_contact(m, *share, 1.0));
    let shares = modes.iter().map(|(_, share)| share).sum();
    (bank, Breath { shares, per_frame: (frequency / rate) as f32, ..Breath::NONE })
}

/// For all valves, jets, tubes, breaths and pitch changes, no frame adds more energy than the mouth's work, and none without breath.
#[test]
fn a_breath_gives_no_more_than_its_work() {
    let mut gained = 0;
    for seed in 0..2 * SETTINGS {
        let mut stream = Stream(key(80, seed), 0);
        let len = 1 + (stream.next() * MAX_MODES as f64) as usize;
        let modes: Vec<_> = (0..len)
            .map(|_| (0.25 * libm::pow(200.0, stream.next()), libm::pow(10.0, 4.0 * stream.next() - 3.0) as f32))
            .collect();
        let rate = 8000.0 * libm::pow(96.0, stream.next());
        let frequency = 0.2 * rate * libm::pow(1e-4, stream.next());
        let (mut bank, tube) = tube(frequency, 0.001 * libm::pow(3e4, stream.next()), &modes, rate);
        let mut mouthpiece = Mouthpiece::REST;
        let reach = if stream.next() < 0.5 { -1.0 } else { libm::pow(100.0, stream.next()) };
        let quality = 0.6 * libm::pow(100.0, stream.next());
        let own = rate * libm::pow(1e-4, stream.next());
        let is_jet = seed % 2 == 1;
        let law = if is_jet {
            MouthpieceLaw::Jet(JetLaw { frequency: own })
        } else {
            MouthpieceLaw::Valve(ValveLaw { frequency: own, quality, reach })
        };
        mouthpiece.set(law, rate);
        let mouth = if seed % 8 < 2 { 0.0 } else { libm::pow(10.0, 4.0 * stream.next() - 2.0) as f32 };
        let opening = libm::pow(10.0, 4.0 * stream.next() - 2.0) as f32;
        mouthpiece.breath = Breath { pressure: [mouth, 0.0], opening, noise: stream.next() as f32, ..tube };
        // Turbulence is a sum of numbers below 1 whose weights add up to 1, times a factor.
        let most_mouth = f64::from(mouth) * 30.0;
        let (q, opening_wide) = (f64::from(tube.per_frame), f64::from(opening));
        let most = if is_jet {
            // The jet turns from all outside to all inside in a frame, and turbulence has all of its force.
            let driven = 0.016 * opening_wide * (2.0 + 6.0 * q) * most_mouth;
            0.77 * libm::pow(driven, 1.5) / libm::sqrt(2.0 * q)
        } else {
            0.77 * 64.0 * q * opening_wide * libm::pow(most_mouth, 1.5)
        };
        let norm = |bank: &ModeBank| -> f64 {
            modes.iter().enumerate().map(|(m, (_, share))| f64::from(bank.mass(m).1) / f64::from(*share)).sum()
        };
        let mut strike = Drive::NONE;
        strike.push[0] = (stream.next() * stream.next() * 4.0) as f32;
        bank.set_excitation_gains(&ExcitationRows::all(ExcitationGains { push: 1.0, ..ExcitationGains::NONE }));
        bank.sweep_to(0.5 + stream.next(), CONTROL_FRAMES);
        bank.render(Some(&strike), CONTROL_FRAMES);
        for _ in 0..2 {
            bank.sweep_to(0.5 + stream.next(), CONTROL_FRAMES);
            for _ in 0..CONTROL_FRAMES {
                let before = norm(&bank);
                bank.render_played(None, Some(Player::Breath(&mut mouthpiece)), 1);
                let after = norm(&bank);
                gained += u32::from(after > before * (1.0 + 1e-5));
                assert!(after <= before * (1.0 + 1e-5) + most * (1.0 + 1e-3), "{seed}: {before} {after} {most}");
            }
        }
    }
    assert!(gained > 50_000, "the breath moved what it was to move: {gained}");
}

/// RMS of the pressure behind a fast reed on a tube of odd modes that loses little, in the fourth second.
fn clarinet(pressure: f32) -> f64 {
    let modes: Vec<_> = (0..30).map(|n| (f64::from(2 * n + 1), 1.0)).collect();
    let (mut bank, tube) = tube(150.0, 4.0, &modes, RATE);
    let mut mouthpiece = Mouthpiece::REST;
    mouthpiece.set(MouthpieceLaw::Valve(ValveLaw { frequency: 12_000.0, quality: 1.0, reach: -1.0 }), RATE);
    mouthpiece.breath = Breath { pressure: [pressure, 0.0], opening: 1.0, ..tube };
    let mut heard = vec![];
    for _ in 0..6000 {
        bank.sweep_to(1.0, CONTROL_FRAMES);
        let [left, _] = bank.render_played(None, Some(Player::Breath(&mut mouthpiece)), CONTROL_FRAMES);
        heard.extend(left.iter().map(|sample| f64::from(*sample)));
    }
    let last = &heard[144_000..];
    // A steady flow leaves a little steady pressure.
    let mean = last.iter().sum::<f64>() / last.len() as f64;
    libm::sqrt(last.iter().map(|sample| (sample - mean) * (sample - mean)).sum::<f64>() / last.len() as f64)
}

/// Without losses and without a mass of the reed, a clarinet speaks from a third of the closing pressure on, and its pressure is
/// a square wave of `√((1−γ)(3γ−1))` (Raman's model: J. Kergomard, "Elementary considerations on reed-instrument oscillations",
/// in Mechanics of Musical Instruments, 1995). That holds until the reed beats, at half of that pressure.
#[test]
fn a_clarinet_speaks_as_ramans_model_says() {
    assert!(clarinet(0.31) < 1e-3, "{}", clarinet(0.31));
    assert!(clarinet(0.37) > 0.2, "{}", clarinet(0.37));
    for pressure in [0.44_f32, 0.46, 0.48] {
        let (found, mouth) = (clarinet(pressure), f64::from(pressure));
        let wanted = libm::sqrt((1.0 - mouth) * (3.0 * mouth - 1.0));
        assert!((found / wanted - 1.0).abs() < 0.03, "{pressure}: {found}, {wanted} expected");
    }
}

#[test]
fn a_blown_bank_has_the_same_bits_in_any_division() {
    let lips = MouthpieceLaw::Valve(ValveLaw { frequency: 180.0, quality: 8.0, reach: 3.0 });
    let play = |law, pieces: &[usize]| {
        let (mut bank, tube) = tube(220.0, 0.3, &[(1.0, 1.0), (2.0, 1.0), (3.0, 0.7)], RATE);
        let mut mouthpiece = Mouthpiece::REST;
        mouthpiece.set(law, RATE);
        mouthpiece.breath = Breath { opening: 1.0, noise: 0.2, ..tube };
        let mut left = vec![];
        for tick in 0..60 {
            bank.sweep_to(1.0 + 0.001 * f64::from(tick), CONTROL_FRAMES);
            (mouthpiece.breath.pressure, mouthpiece.breath.passed) = ([1.0, 0.01], 0);
            for frames in pieces {
                left.extend_from_slice(bank.render_played(None, Some(Player::Breath(&mut mouthpiece)), *frames)[0]);
                mouthpiece.breath.passed += *frames as u32;
            }
        }
        left
    };
    for law in [lips, MouthpieceLaw::Jet(JetLaw { frequency: 220.0 })] {
        let whole = play(law, &[32]);
        assert!(whole.iter().any(|sample| sample.abs() > 0.01));
        assert!(play(law, &[1, 20, 11]) == whole);
    }
}
