//! Several cells compared with single banks, and used cells compared with new ones.

use super::*;
use crate::dsp::mode_bank::ModeSetup;
use crate::dsp::random::{key, uniform};

const RATE: f64 = 48_000.0;

/// Loads a body of this many modes, at rest, with its excitation gains set.
fn body(cells: &mut Cells, recurrence: Recurrence, modes: usize, seed: u64) {
    let unit = |m: usize, n: u64| f64::from(uniform(key(seed, n), m as u64)) * 0.5 + 0.5;
    let ratios: Vec<f64> = (0..modes).map(|m| 0.5 + 40.0 * unit(m, 0)).collect();
    cells.ratios_mut().flatten().zip(&ratios).for_each(|(to, ratio)| *to = *ratio);
    cells.t60_scales_mut().flatten().take(modes).enumerate().for_each(|(m, to)| *to = 0.05 + unit(m, 1));
    let pans: Vec<f32> = (0..modes).map(|m| unit(m, 2) as f32).collect();
    let setup = |pans: &[f32], [ratios, scales, _]: [&[f64; MAX_MODES]; 3]| {
        let rows = pans.iter().zip(ratios).zip(scales);
        let setup = |((pan, ratio), scale): ((&f32, &f64), &f64)| ModeSetup {
            frequency: 200.0 * ratio,
            t60: *scale,
            left: *pan,
            right: 1.0,
        };
        rows.map(setup).collect()
    };
    cells.load(recurrence, RATE, &pans, setup);
    for cell in 0..Cells::count_for(modes) {
        let push = std::array::from_fn(|m| unit(cell * MAX_MODES + m, 3) as f32);
        let gains = ExcitationRows { push, pull: [0.1; MAX_MODES], ..ExcitationRows::NONE };
        cells.set_excitation_gains(cell, &gains);
    }
}

fn cells(count: usize) -> Cells {
    let mut cells = Cells::EMPTY;
    (0..count).for_each(|_| assert!(cells.add(Box::new(Cell::new(RATE))).is_none()));
    cells
}

/// Plays a strike, a sweep and a change of damping, then free ringing until tables are used. Returns all samples, the
/// remaining energy and the remaining frames.
fn play(cells: &mut Cells, ticks: usize) -> (Vec<u32>, f64, u64) {
    let mut drive = Drive::NONE;
    drive.push[3] = 0.7;
    drive.pull[5] = 0.4;
    let mut samples = vec![];
    for tick in 0..ticks {
        if tick == 5 {
            cells.damp(|scale, _| 0.5 * scale);
        }
        cells.sweep_to(if tick < 8 { 1.0 + 0.01 * tick as f64 } else { 1.08 }, CONTROL_FRAMES);
        for sides in cells.render((tick == 0).then_some(&drive), None, CONTROL_FRAMES) {
            samples.extend(sides.iter().map(|sample| sample.to_bits()));
        }
    }
    (samples, cells.settle(), cells.frames_until(1e-9))
}

#[test]
fn cells_that_were_used_give_the_bits_of_new_ones() {
    for recurrence in [Recurrence::Exact, Recurrence::Classic] {
        for (count, modes) in [(1, 1), (1, 37), (1, 64), (3, 130), (8, 512)] {
            let mut fresh = cells(count);
            body(&mut fresh, recurrence, modes, 1);
            let expected = play(&mut fresh, 40);
            assert!(expected.0.iter().any(|bits| f32::from_bits(*bits).abs() > 0.1));
            let mut used = cells(count);
            for (other, seed) in [(Recurrence::Exact, 2), (Recurrence::Classic, 3), (recurrence, 4), (recurrence, 5)] {
                body(&mut used, other, 64 * count - seed as usize, seed);
                // End in the middle of a sweep, or at a point where tables are used.
                play(&mut used, if seed == 5 { 3 } else { 30 });
            }
            body(&mut used, recurrence, modes, 1);
            assert!(play(&mut used, 40) == expected, "{recurrence:?} {modes}");
        }
    }
}

#[test]
fn many_cells_are_the_sum_of_each_by_itself() {
    let mut whole = cells(8);
    body(&mut whole, Recurrence::Exact, 500, 7);
    let (samples, energy, _) = play(&mut whole, 40);
    let mut sum = vec![0.0_f64; samples.len()];
    let mut energies = 0.0;
    for cell in 0..8 {
        // The same modes, but those of the other cells are not excited.
        let mut part = cells(8);
        body(&mut part, Recurrence::Exact, 500, 7);
        let others = (0..8).filter(|other| *other != cell);
        others.for_each(|other| part.set_excitation_gains(other, &ExcitationRows::NONE));
        let (samples, energy, _) = play(&mut part, 40);
        sum.iter_mut().zip(samples).for_each(|(sum, bits)| *sum += f64::from(f32::from_bits(bits)));
        energies += energy;
    }
    let pairs = samples.iter().zip(&sum);
    let worst = pairs.map(|(bits, sum)| (f64::from(f32::from_bits(*bits)) - sum).abs()).fold(0.0, f64::max);
    assert!(worst < 2e-5, "{worst}");
    assert!((energies / energy - 1.0).abs() < 1e-6, "{energies} {energy}");
}

#[test]
fn the_end_of_many_cells_is_when_their_energies_add_up_to_it() {
    let mut whole = cells(4);
    body(&mut whole, Recurrence::Exact, 256, 9);
    let (_, _, told) = play(&mut whole, 60);
    let mut frames = 0;
    while whole.settle() >= 1e-9 {
        whole.sweep_to(1.08, CONTROL_FRAMES);
        whole.render(None, None, CONTROL_FRAMES);
        frames += CONTROL_FRAMES as u64;
    }
    assert!(told <= frames && frames < told + CONTROL_FRAMES as u64 + 1, "{told} {frames}");
    assert_eq!(whole.take().map(|_| Cells::count_for(193)), Some(4));
}
