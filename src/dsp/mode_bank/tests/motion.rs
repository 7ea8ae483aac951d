//! Tests of pitches that move: energy, amplitude and decay are kept, from the bottom to the top of the spectrum.

use super::*;

/// A moving pitch neither adds nor removes energy: an octave up and down in 20 ms each, repeatedly, for as long as the
/// mode takes to fall by 60 dB. T60 is kept to 0.1 %, which is 0.06 dB at the end.
#[test]
fn decay_does_not_depend_on_the_movement_of_the_pitch() {
    for (sample_rate, frequency) in
        [(44_100.0, 55.0), (48_000.0, 440.0), (48_000.0, 4000.0), (48_000.0, 10_000.0), (192_000.0, 10_000.0)]
    {
        for t60 in [0.3, 2.0, 5.0] {
            let mut bank = bank_at(sample_rate, &[(frequency, t60)]);
            run(&mut bank, CONTROL_FRAMES, Some(&strike()));
            let start = amplitude(&mut bank);
            let ticks = (t60 * sample_rate / CONTROL_FRAMES as f64) as usize;
            for tick in 1..=ticks {
                let octaves = (tick as f64 * CONTROL_FRAMES as f64 / (0.02 * sample_rate)) % 2.0;
                glide(&mut bank, libm::exp2(1.0 - (1.0 - octaves).abs()));
            }
            let ratio = bank.ratio;
            glide(&mut bank, ratio);
            let seconds = (ticks + 1) as f64 * CONTROL_FRAMES as f64 / sample_rate;
            let measured = -3.0 * seconds / libm::log10(amplitude(&mut bank) / start);
            let percent = 100.0 * (measured / t60 - 1.0);
            println!("{frequency} Hz at {sample_rate} Hz, {t60} s: {percent:+.4} %");
            assert!(percent.abs() < 0.1, "{frequency} Hz at {sample_rate} Hz, {t60} s: {percent:+.4} %");
        }
    }
}

/// Jumps to any pitch at any time, with changes of damping: the amplitude only falls.
#[test]
fn nothing_but_a_strike_adds_energy() {
    let stream = key(23, 0);
    let unit = |n: u64| f64::from(uniform(stream, n)) * 0.5 + 0.5;
    for case in 0..400_u64 {
        let between = |n: u64, low: f64, high: f64| low * libm::pow(high / low, unit(10_000 * case + n));
        let rate = between(0, 1_000.0, 768_000.0);
        let mut bank = bank_at(rate, &[(between(1, 8.0, 0.7 * rate), between(2, 0.005, 60.0))]);
        bank.jump_to(between(3, 0.01, 100.0));
        run(&mut bank, CONTROL_FRAMES, Some(&strike()));
        // The energy that would remain if the pitch had not moved.
        let mut due = 1.0;
        for n in 0..100 {
            if unit(10_000 * case + 10 * n + 9) < 0.2 {
                bank.set_t60(0, between(10 * n + 8, 0.001, 60.0));
            }
            let frames = 1 + (unit(10_000 * case + 10 * n + 7) * 31.0) as usize;
            // As with events: ramps of any length, most of them interrupted.
            let line = frames + (unit(10_000 * case + 10 * n + 5) * (CONTROL_FRAMES - frames) as f64) as usize;
            bank.sweep_to(between(10 * n + 6, 0.01, 100.0), line);
            let peak = bank.render(None, frames)[0].iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
            // Because of rounding, a mode that hardly decays can gain 1e−7 per frame.
            let rounding = 1.0 + 4e-7 * (32 + 32 * n) as f64;
            assert!(f64::from(peak * peak) <= due * rounding + 1e-30, "{case}, {n}: {peak}, {due}");
            due *= libm::exp(2.0 * bank.ln_radius[0] * frames as f64);
            let (_, energy) = bank.mass(0);
            assert!(f64::from(energy) <= due * rounding + 1e-30, "{case}, {n}: {energy}, {due}");
        }
    }
}

#[test]
fn a_sweep_reaches_its_pitch_exactly_and_keeps_the_amplitude() {
    let mut bank = bank(&[(1000.0, 60.0)]);
    run(&mut bank, 320, Some(&strike()));
    for step in 1..=100 {
        glide(&mut bank, 1.0 + f64::from(step) * 0.05);
    }
    assert!((bank.settle() - 1.0).abs() < 0.02, "{}", bank.settle());
    let samples = run(&mut bank, 48_000, None);
    let crossings = samples.windows(2).filter(|w| w[0] <= 0.0 && w[1] > 0.0).count();
    assert!((5999..=6001).contains(&crossings), "{crossings}");
}

#[test]
fn a_strike_is_as_strong_at_any_pitch() {
    for ratio in [0.1, 1.0, 12.0, 20.0, 40.0] {
        let mut bank = bank(&[(1000.0, 60.0)]);
        bank.jump_to(ratio);
        run(&mut bank, 32, Some(&strike()));
        assert!((bank.settle() - 1.0).abs() < 0.01, "{ratio}: {}", bank.settle());
    }
}

#[test]
fn modes_beyond_nyquist_are_silent() {
    let mut bank = bank(&[(24_000.0, 1.0), (30_000.0, 1.0)]);
    assert!(run(&mut bank, 4800, Some(&strike())).iter().all(|sample| *sample == 0.0));
}

#[test]
fn a_strike_above_the_spectrum_is_heard_when_the_sweep_comes_down() {
    let mut bank = bank(&[(2000.0, 60.0)]);
    bank.jump_to(32.0);
    assert!(run(&mut bank, 64, Some(&strike())).iter().all(|sample| *sample == 0.0));
    assert!((bank.settle() - 1.0).abs() < 0.01, "silent, but not at rest");
    for step in (10..32 * 4).rev() {
        glide(&mut bank, f64::from(step) / 4.0);
    }
    glide(&mut bank, 1.0);
    let heard = run(&mut bank, 480, None).iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    assert!((heard - 1.0).abs() < 0.02, "{heard}");
}

/// The fade at the top of the spectrum moves linearly to the right value, in mono and in stereo.
#[test]
fn modes_fade_at_the_top_of_the_spectrum() {
    for right in [1.0, 0.5] {
        let mut bank = ModeBank::new(RATE);
        bank.load(&[ModeSetup { frequency: 12_000.0, t60: 60.0, left: 1.0, right }].into_iter().collect());
        bank.set_excitation_gains(&PUSHED);
        run(&mut bank, 320, Some(&strike()));
        for (ratio, expected) in [(1.9, 1.0), (1.98, 0.5), (2.0, 0.0), (1.99, 0.25), (1.5, 1.0)] {
            glide(&mut bank, ratio);
            for _ in 0..8 {
                bank.sweep_to(ratio, CONTROL_FRAMES);
                bank.render(None, CONTROL_FRAMES);
            }
            let full = if ratio < 1.96 { 1.0 } else { (2.0 - ratio) / 0.04 };
            let gain = f64::from(bank.modes.left.0[0]);
            assert!((gain - full).abs() < 1e-4 && (full - expected).abs() < 0.3, "{ratio}: {gain}, not {full}");
            assert!((bank.modes.right.0[0] / right - bank.modes.left.0[0]).abs() < 1e-6);
        }
        assert!(!bank.faded);
    }
}

#[test]
fn retuning_is_continuous_and_reaches_every_pitch() {
    for (from, to) in [(440.0, 110.0), (300.0, 4000.0), (9000.0, 50.0)] {
        let mut bank = bank(&[(from, 60.0), (from * 5.0, 60.0)]);
        let before = run(&mut bank, 3217, Some(&strike()));
        let mut kept = bank.clone();
        bank.retune([(to, 60.0), (to * 5.0, 60.0)].into_iter());
        let after = glide(&mut bank, from / to);
        // The same pitch from other coefficients must give the same samples.
        let expected = run(&mut kept, 32, None);
        let worst = after.iter().zip(&expected).fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(worst < 2e-3, "{from} to {to}: {worst} after {}", before[3216]);
        glide(&mut bank, 1.0);
        let samples = run(&mut bank, 48_000, None);
        assert!(samples.iter().any(|sample| sample.abs() > 0.1), "{from} to {to}");
    }
}
