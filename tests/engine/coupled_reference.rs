//! Compares joined bodies with a dense eigenproblem solved by SciPy, made by `coupled/scipy_reference.py`.

use sprung::internals::coupled::{BodyMode, CoupledMode, Joint, joined};
use sprung::internals::random::Sequence;
use std::collections::BTreeMap;

const NUMBERS: &str = include_str!("coupled/scipy_reference.csv");

/// The bodies and the joint of a case, created in the same order and from the same numbers as by `pair` in the script.
fn pair(case: u64) -> ([Vec<BodyMode>; 2], Joint) {
    let mut chance = Sequence::new(case);
    let mut size = || {
        let bound = 1 + chance.below(64);
        1 + chance.below(bound)
    };
    let sizes = if case.is_multiple_of(20) { [128, 128] } else { [size(), size()] };
    let loss = [0.0, 1.0, 30.0, 400.0][chance.below(4)];
    let mut bodies = sizes.map(|size| {
        let mode = |_| {
            let (u, v) = (chance.unit(), chance.unit());
            let [joint, strike, pickup] = [(); 3].map(|()| 2.0 * chance.unit() - 1.0);
            let (angular_frequency, decay_rate) = (300.0 + 60000.0 * u * u, loss * (0.1 + v));
            BodyMode { angular_frequency, decay_rate, joint, strike, pickup }
        };
        (0..size).map(mode).collect::<Vec<_>>()
    });
    let kind = case as usize % 5;
    let [first, second] = &mut bodies;
    for (first, second) in first.iter().zip(second) {
        if kind != 0 && chance.below(2) == 0 {
            let near = [0.0, 1e-2, 1e-4, 1e-6, 0.0][kind] * chance.unit();
            second.angular_frequency = first.angular_frequency * (1.0 + near);
            if kind == 4 {
                second.decay_rate = first.decay_rate;
            }
        }
    }
    let stiffness = chance.unit() * (1_u64 << (8 + chance.below(26))) as f64;
    let damping = [0.0, chance.unit() * (1_u64 << chance.below(8)) as f64][chance.below(2)];
    let rigid = chance.below(8) == 0;
    (bodies, if rigid { Joint::Rigid } else { Joint::Spring { stiffness, damping } })
}

/// Angular frequency, decay rate, cosine and sine of the pickup's velocity; and the number of poles.
type Line = ([f64; 4], usize);

fn cases() -> BTreeMap<u64, Vec<Line>> {
    let mut cases: BTreeMap<u64, Vec<Line>> = BTreeMap::new();
    for line in NUMBERS.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let mut fields = line.split(',');
        let mut whole = || fields.next().and_then(|field| field.parse::<u64>().ok()).expect("a whole number");
        let (case, poles) = (whole(), whole() as usize);
        let numbers: Vec<f64> = fields.map(|field| field.parse().expect("a number")).collect();
        cases.entry(case).or_default().push((numbers.try_into().expect("4 numbers"), poles));
    }
    cases
}

fn numbers(mode: &CoupledMode) -> [f64; 4] {
    let heard = mode.velocity([1.0, 0.5], [-0.75, 1.0]);
    [mode.angular_frequency, mode.decay_rate, heard.cosine, heard.sine]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt()
}

#[test]
fn poles_and_residues_agree_with_scipy() {
    let cases = cases();
    assert_eq!(cases.len(), 200);
    let mut worst = [(0.0, 0); 2];
    for (case, lines) in cases {
        let ([first, second], joint) = pair(case);
        let modes: Vec<[f64; 4]> = joined(&first, &second, joint).unwrap().iter().map(numbers).collect();
        let largest = modes.iter().fold(0.0, |largest: f64, mode| largest.max(distance(&mode[2..], &[0.0; 2])));
        for (expected, poles) in lines {
            assert_eq!(modes.len(), poles, "case {case}: number of poles");
            let got = modes
                .iter()
                .min_by(|a, b| distance(*a, &expected).total_cmp(&distance(*b, &expected)))
                .expect("at least one");
            let off = [
                distance(got, &expected) / distance(&expected, &[0.0; 2]),
                distance(&got[2..], &expected[2..]) / largest,
            ];
            for (worst, off) in worst.iter_mut().zip(off) {
                if off > worst.0 {
                    *worst = (off, case);
                }
            }
        }
    }
    let [(pole, of_pole), (residue, of_residue)] = worst;
    println!(
        "at worst {pole:.1e} of a pole (case {of_pole}), {residue:.1e} of the largest residue (case {of_residue})"
    );
    assert!(pole < 1e-12 && residue < 1e-12);
}
