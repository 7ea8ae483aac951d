//! Tests that energy moves to higher modes and never rises, for random bodies, pitches and dampings.

use super::*;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::bank::Recurrence;
use crate::dsp::cells::Cell;
use crate::dsp::exciter::Drive;
use crate::dsp::mode_bank::{ExcitationRows, ModeSetup};
use crate::dsp::random::{key, uniform};

const RATE: f64 = 48_000.0;

#[test]
fn half_octaves_are_counted() {
    for (ratio, count) in [(1.0, 0), (1.41, 0), (SQRT_2, 1), (1.99, 1), (2.0, 2), (2.9, 3), (1000.0, 19), (1024.0, 20)]
    {
        assert_eq!(half_octaves(ratio), count, "{ratio}");
    }
    assert!(half_octaves(f64::INFINITY) > BANDS as u64);
}

/// A body of modes with these ratios and amplitudes, struck.
fn struck(ratios: &[f64], amplitudes: &[f32], t60: f64, recurrence: Recurrence) -> Cells {
    let mut cells = Cells::EMPTY;
    (0..Cells::count_for(ratios.len())).for_each(|_| assert!(cells.add(Box::new(Cell::new(RATE))).is_none()));
    cells.ratios_mut().flatten().zip(ratios).for_each(|(to, ratio)| *to = *ratio);
    let setup = |modes: &[f64], _: [&[f64; MAX_MODES]; 3]| {
        let setup = |ratio: &f64| ModeSetup { frequency: 60.0 * ratio, t60, left: 1.0, right: 1.0 };
        modes.iter().map(setup).collect()
    };
    cells.load(recurrence, RATE, ratios, setup);
    for (cell, amplitudes) in amplitudes.chunks(MAX_MODES).enumerate() {
        let mut gains = ExcitationRows::NONE;
        gains.push[..amplitudes.len()].copy_from_slice(amplitudes);
        cells.set_excitation_gains(cell, &gains);
    }
    cells.sort_into_bands();
    let mut drive = Drive::NONE;
    drive.push[0] = 1.0;
    cells.sweep_to(1.0, CONTROL_FRAMES);
    cells.render(Some(&drive), None, CONTROL_FRAMES);
    cells.settle();
    cells
}

/// The squared amplitudes of all modes.
fn energies(cells: &Cells) -> Vec<f64> {
    let squares = |cell: &Cell| cell.bank.squared_amplitudes().collect::<Vec<f64>>();
    cells.iter().flat_map(squares).collect()
}

fn sum(energies: &[f64]) -> f64 {
    energies.iter().sum()
}

#[test]
fn energy_never_rises() {
    let mut climbed = 0;
    for case in 0..12_000 {
        let stream = key(11, case);
        let unit = |n: u64| f64::from(uniform(stream, n)) * 0.5 + 0.5;
        let modes = 1 + (unit(0) * unit(1) * 150.0) as usize;
        let ratios: Vec<f64> = (0..modes).map(|m| libm::exp2(9.0 * unit(100 + m as u64))).collect();
        // Some modes are at rest, some nearly.
        let amplitude = |m: usize| [0.0, 1e-18, 1e-6, 1.0][m % 4] * uniform(stream, 500 + m as u64);
        let amplitudes: Vec<f32> = (0..modes).map(amplitude).collect();
        let mut cells = struck(&ratios, &amplitudes, 0.01 + 20.0 * unit(2), Recurrence::Exact);
        let full = libm::exp10(8.0 * unit(3) - 6.0);
        let climb = Climb { share: unit(4), speed: libm::exp10(4.0 * unit(5) - 3.0), full, key: case };
        for tick in 0..12_u64 {
            let before = energies(&cells);
            cells.climb(&climb);
            let after = energies(&cells);
            // The sums themselves are rounded.
            assert!(
                sum(&after) <= sum(&before) * (1.0 + 1e-14),
                "case {case}: {:e} from {:e}",
                sum(&after),
                sum(&before)
            );
            climbed += u32::from(before != after);
            // Both ways to render: constant pitch for some ticks, then sweeps.
            cells.sweep_to(if tick < 6 { 1.0 } else { 0.5 + unit(600 + tick) }, CONTROL_FRAMES);
            cells.render(None, None, CONTROL_FRAMES);
            cells.settle();
        }
    }
    println!("energy climbed at {climbed} of 144,000 ticks");
    assert!(climbed > 50_000, "{climbed}");
}

#[test]
fn modes_at_rest_are_woken_with_the_phases_of_the_key_and_keep_ringing() {
    let ratios: Vec<f64> = (0..100).map(|m| 1.0 + 0.45 * f64::from(m)).collect();
    let mut amplitudes = [0.0; 100];
    amplitudes[0] = 1.0;
    let run = |key: u64| {
        let mut cells = struck(&ratios, &amplitudes, 30.0, Recurrence::Exact);
        let mut heard = vec![];
        for _ in 0..300 {
            cells.climb(&Climb { share: 0.5, speed: 0.02, full: 1.0, key });
            cells.sweep_to(1.0, CONTROL_FRAMES);
            heard.extend_from_slice(cells.render(None, None, CONTROL_FRAMES)[0]);
            cells.settle();
        }
        (energies(&cells), heard)
    };
    let (energies, heard) = run(1);
    assert!(energies.iter().all(|energy| *energy > 1e-9), "{energies:?}");
    assert!(energies[0] < 0.8 && sum(&energies) > 0.9 && sum(&energies) <= 1.0, "{}", sum(&energies));
    assert_eq!(run(1).1, heard);
    assert_ne!(run(2).1, heard);
    // No click: the difference of two samples is at most what modes of this energy can make.
    let steepest = heard.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(steepest < 0.5, "{steepest}");
}

#[test]
fn a_soft_sound_keeps_its_spectrum_to_the_bit() {
    let ratios = [1.0, 2.3, 4.1, 9.0];
    for (recurrence, full) in [(Recurrence::Exact, 2e4), (Recurrence::Classic, 1.0)] {
        let mut cells = struck(&ratios, &[1.0, 0.1, 0.0, 0.0], 1.0, recurrence);
        let before = energies(&cells);
        cells.climb(&Climb { share: 1.0, speed: 0.1, full, key: 1 });
        assert_eq!(energies(&cells), before, "{recurrence:?}");
    }
}

/// An empty band counts for energy that passes over it, and the limits hold.
#[test]
fn each_band_comes_to_its_share_of_the_one_below() {
    let ratios = [1.0, 1.5, 3.2, 3.3, 6.0];
    let mut cells = struck(&ratios, &[1.0, 0.0, 0.0, 0.0, 0.0], 1e9, Recurrence::Exact);
    for _ in 0..3000 {
        cells.climb(&Climb { share: 0.5, speed: 0.2, full: 0.5, key: 1 });
    }
    let found = energies(&cells);
    // Bands 0, 1, 3 and 5.
    let bands = [found[0], found[1], found[2] + found[3], found[4]];
    for (pair, share) in bands.windows(2).zip([0.5, 0.25, 0.25]) {
        assert!((pair[1] / pair[0] - share).abs() < 0.01 * share, "{bands:?}");
    }
    assert!((found[2] / found[3] - 1.0).abs() < 1e-3);
}
