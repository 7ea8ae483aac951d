//! Physical laws that joined bodies must obey.

use super::*;
use crate::dsp::random::Sequence;

/// Random bodies and joints.
struct Chance(Sequence);

impl Chance {
    /// A number between `2^low` and `2^(low + range + 1)`, about as often in each octave.
    fn octaves(&mut self, low: i32, range: usize) -> f64 {
        let octave = low + self.0.below(range) as i32;
        (0..octave.abs()).fold(1.0 + self.0.unit(), |x, _| if octave > 0 { 2.0 * x } else { 0.5 * x })
    }

    fn body(&mut self, modes: usize, rate: f64) -> Vec<BodyMode> {
        let mut shape = || 2.0 * self.0.unit() - 1.0;
        (0..modes)
            .map(|_| {
                let (u, v) = (shape(), shape());
                BodyMode {
                    angular_frequency: 300.0 + 60_000.0 * u * u,
                    decay_rate: rate * (0.05 + v * v),
                    joint: shape(),
                    strike: shape(),
                    pickup: shape(),
                }
            })
            .collect()
    }

    /// Two bodies, in which some modes have nearly or exactly the same frequency, and a joint from almost zero to
    /// almost rigid.
    fn pair(&mut self) -> ([Vec<BodyMode>; 2], Joint) {
        let rate = [0.0, 1.0, 50.0, 1000.0, 30_000.0][self.0.below(5)];
        let [one, other] = [(); 2].map(|()| {
            let most = [4, 12, 40][self.0.below(3)];
            1 + self.0.below(most)
        });
        let mut bodies = [self.body(one, rate), self.body(other, rate)];
        let [first, second] = &mut bodies;
        for (of_the_first, second) in first.iter().zip(second) {
            match self.0.below(8) {
                0 => second.angular_frequency = of_the_first.angular_frequency * (1.0 + 1e-10 * self.0.unit()),
                1 => second.angular_frequency = of_the_first.angular_frequency,
                2 => *second = BodyMode { joint: second.joint, strike: second.strike, ..*of_the_first },
                3 => second.joint = 0.0,
                _ => {}
            }
        }
        let joint = match self.0.below(8) {
            0 => Joint::Rigid,
            1 => Joint::Spring { stiffness: self.octaves(-60, 160), damping: 0.0 },
            2 => Joint::Spring { stiffness: 0.0, damping: self.octaves(-60, 100) },
            _ => Joint::Spring { stiffness: self.octaves(0, 40), damping: self.octaves(-10, 20) },
        };
        (bodies, joint)
    }
}

/// A sum over the mode shapes of both bodies: `Σ f(mode, sign)`, where `sign` is negative for the second body.
fn total([first, second]: &[Vec<BodyMode>; 2], of: impl Fn(&BodyMode, f64) -> f64) -> f64 {
    first.iter().map(|mode| of(mode, 1.0)).chain(second.iter().map(|mode| of(mode, -1.0))).sum()
}

/// Asserts that the cosines add up to `expected`, within `1e−10` of their magnitudes.
#[track_caller]
fn assert_sum(parts: impl Iterator<Item = Partial>, expected: f64, context: &str) {
    let (sum, size) = parts
        .fold((0.0, 1e-300), |(sum, size), Partial { cosine, sine }| (sum + cosine, size + cosine.abs() + sine.abs()));
    assert!((sum - expected).abs() <= 1e-10 * size, "{context}: {sum} of {size}, expected {expected}");
}

#[test]
fn joined_bodies_keep_the_sum_rules_and_never_grow() {
    for case in 0..1500 {
        let (bodies, joint) = Chance(Sequence::new(case)).pair();
        let modes = joined(&bodies[0], &bodies[1], joint).unwrap();
        let context = format!("case {case}, {joint:?}");
        let both = [1.0, 1.0];
        // A strike causes no displacement at once. It gives each point its momentum, without the part that a rigid joint does not
        // allow.
        let weight = total(&bodies, |mode, _| mode.joint * mode.joint);
        let taken = total(&bodies, |mode, sign| sign * mode.strike * mode.joint)
            * total(&bodies, |mode, sign| sign * mode.pickup * mode.joint)
            / weight;
        let struck = total(&bodies, |mode, _| mode.strike * mode.pickup);
        let degrees: usize = modes.iter().map(|mode| if mode.angular_frequency > 0.0 { 2 } else { 1 }).sum();
        let is_rigid = degrees < 2 * (bodies[0].len() + bodies[1].len());
        let expected = if is_rigid { struck - taken } else { struck };
        assert_sum(modes.iter().map(|mode| mode.displacement(both, both)), 0.0, &context);
        assert_sum(modes.iter().map(|mode| mode.velocity(both, both)), expected, &context);
        // The sum of all decay rates must be that of all dampers.
        if let Joint::Spring { damping, .. } = joint
            && !is_rigid
        {
            let rates = modes.iter().map(|mode| {
                let (rate, rings) = (mode.decay_rate, mode.angular_frequency > 0.0);
                Partial { cosine: if rings { 2.0 * rate } else { rate }, sine: mode.angular_frequency }
            });
            let expected = total(&bodies, |mode, _| 2.0 * mode.decay_rate) + damping * weight;
            assert_sum(rates, expected, &context);
        }
        let slowest = bodies.iter().flatten().map(|mode| mode.decay_rate).fold(f64::INFINITY, f64::min);
        for mode in &modes {
            let least = if mode.angular_frequency > 0.0 { slowest } else { 0.0 };
            assert!(mode.decay_rate >= least && mode.angular_frequency >= 0.0, "{context}: {mode:?}");
        }
    }
}

/// Displacements and velocities of the modes of the free bodies after a strike on both bodies. Computed from the joined
/// modes, heard at one free mode at a time.
fn motion(bodies: &[Vec<BodyMode>; 2], joint: Joint, t: f64) -> Vec<[f64; 2]> {
    let mut places = Vec::new();
    for (body, k) in (0..2).flat_map(|body| (0..bodies[body].len()).map(move |k| (body, k))) {
        let mut heard = bodies.clone();
        for mode in heard.iter_mut().flatten() {
            mode.pickup = 0.0;
        }
        heard[body][k].pickup = 1.0;
        let modes = joined(&heard[0], &heard[1], joint).unwrap();
        let at = |part: &dyn Fn(&CoupledMode) -> Partial| -> f64 {
            modes
                .iter()
                .map(|mode| {
                    let (sin, cos) = libm::sincos(mode.angular_frequency * t);
                    let Partial { cosine, sine } = part(mode);
                    libm::exp(-mode.decay_rate * t) * (cosine * cos + sine * sin)
                })
                .sum()
        };
        places.push([at(&|mode| mode.displacement([1.0; 2], [1.0; 2])), at(&|mode| mode.velocity([1.0; 2], [1.0; 2]))]);
    }
    places
}

/// Kinetic energy, and the energy in the springs of bodies and joint.
fn energy(bodies: &[Vec<BodyMode>; 2], joint: Joint, motion: &[[f64; 2]]) -> f64 {
    let modes = bodies[0].iter().map(|mode| (mode, 1.0)).chain(bodies[1].iter().map(|mode| (mode, -1.0)));
    let (mut sum, mut apart) = (0.0, 0.0);
    for ((mode, sign), [x, v]) in modes.zip(motion) {
        let square = mode.angular_frequency * mode.angular_frequency + mode.decay_rate * mode.decay_rate;
        sum += 0.5 * (v * v + square * x * x);
        apart += sign * mode.joint * x;
    }
    let stiffness = if let Joint::Spring { stiffness, .. } = joint { stiffness } else { 0.0 };
    sum + 0.5 * stiffness * apart * apart
}

#[test]
fn energy_is_what_a_blow_brings_and_only_falls() {
    for (case, rate, stiffness, damping) in
        [(1, 0.0, 1e7, 0.0), (2, 20.0, 1e8, 0.0), (3, 20.0, 1e6, 30.0), (4, 0.0, 3e9, 2.0), (5, 0.0, 1e5, 1e5)]
    {
        let mut chance = Chance(Sequence::new(case));
        let bodies = [chance.body(5, rate), chance.body(7, rate)];
        let joint = Joint::Spring { stiffness, damping };
        let brought = total(&bodies, |mode, _| 0.5 * mode.strike * mode.strike);
        let mut last = brought;
        for step in 0..40 {
            let now = energy(&bodies, joint, &motion(&bodies, joint, 2e-4 * f64::from(step)));
            let tolerance = 1e-11 * brought;
            if step == 0 || (rate == 0.0 && damping == 0.0) {
                assert!((now - brought).abs() < tolerance, "case {case}, step {step}: {now} of {brought}");
            }
            assert!(now < last + tolerance, "case {case}, step {step}: {now} after {last}");
            last = now;
        }
        assert!(rate == 0.0 && damping == 0.0 || last < 0.999 * brought, "case {case}: {last} of {brought}");
    }
}

#[test]
fn a_joint_of_nothing_gives_both_bodies_back() {
    let mut chance = Chance(Sequence::new(7));
    let [first, second] = [chance.body(9, 40.0), chance.body(6, 3.0)];
    let joint = Joint::Spring { stiffness: 0.0, damping: 0.0 };
    let modes = joined(&first, &second, joint).unwrap();
    assert_eq!(modes, apart(&first, &second).unwrap());
    assert_eq!(modes.len(), 15);
    for (body, free) in [(0, &first), (1, &second)] {
        for mode in free {
            let found = modes.iter().find(|found| found.angular_frequency == mode.angular_frequency).unwrap();
            assert_eq!(found.decay_rate, mode.decay_rate);
            let only = [1.0 - body as f64, body as f64];
            let heard = found.displacement(only, only);
            assert_eq!(heard.cosine, 0.0);
            assert!((heard.sine * mode.angular_frequency / (mode.strike * mode.pickup) - 1.0).abs() < 1e-15);
            assert_eq!(found.displacement([1.0, 1.0], [only[1], only[0]]), Partial::default());
        }
    }
    // The same at both limits: almost no joint, and an almost rigid one.
    for (weak, strong) in [(1e-12, 1e25), (1e-30, 1e60)] {
        let nearly = joined(&first, &second, Joint::Spring { stiffness: weak, damping: weak }).unwrap();
        let rigid = joined(&first, &second, Joint::Rigid).unwrap();
        let stiff = joined(&first, &second, Joint::Spring { stiffness: strong, damping: 0.0 }).unwrap();
        for (got, expected) in nearly.iter().zip(&modes).chain(stiff.iter().zip(&rigid)) {
            assert!((got.angular_frequency - expected.angular_frequency).abs() < 1e-9);
            assert!((got.decay_rate - expected.decay_rate).abs() < 1e-9);
            let [got, expected] = [got, expected].map(|mode| mode.velocity([1.0; 2], [1.0; 2]));
            assert!((got.cosine - expected.cosine).abs() < 1e-9 && (got.sine - expected.sine).abs() < 1e-9);
        }
    }
}

#[test]
fn two_equal_oscillators_split_into_sum_and_difference() {
    let mode = BodyMode { angular_frequency: 3000.0, decay_rate: 0.0, joint: 1.0, strike: 1.0, pickup: 1.0 };
    let modes = joined(&[mode], &[mode], Joint::Spring { stiffness: 1e6, damping: 0.0 }).unwrap();
    let frequencies: Vec<f64> = modes.iter().map(|mode| mode.angular_frequency).collect();
    assert_eq!(frequencies[0], 3000.0);
    assert!((frequencies[1] - 11e6_f64.sqrt()).abs() < 1e-9);
    let across: Vec<f64> = modes.iter().map(|mode| mode.velocity([1.0, 0.0], [0.0, 1.0]).cosine).collect();
    assert!((across[0] - 0.5).abs() < 1e-14 && (across[1] + 0.5).abs() < 1e-14, "{across:?}");
    // A rigid joint does not change the sum of the two; a strong damper makes a pair of overdamped modes from the
    // difference.
    assert_eq!(joined(&[mode], &[mode], Joint::Rigid).unwrap().len(), 1);
    let overdamped = joined(&[mode], &[mode], Joint::Spring { stiffness: 0.0, damping: 1e4 }).unwrap();
    let rates: Vec<f64> = overdamped[..2].iter().map(|mode| mode.decay_rate).collect();
    let root = (1e8_f64 - 9e6).sqrt();
    assert!(overdamped[..2].iter().all(|mode| mode.angular_frequency == 0.0), "{overdamped:?}");
    assert!((rates[0] / (1e4 - root) - 1.0).abs() < 1e-12 && (rates[1] / (1e4 + root) - 1.0).abs() < 1e-12);
    // Critically damped: the double pole becomes two poles that nearly cancel, x = t e^(−3000 t) / 2 of the difference.
    let critical = joined(&[mode], &[mode], Joint::Spring { stiffness: 0.0, damping: 3e3 }).unwrap();
    let t = 1e-3;
    let heard = critical.iter().map(|mode| {
        let Partial { cosine, sine } = mode.displacement([1.0, 0.0], [1.0, 0.0]);
        let (sin, cos) = libm::sincos(mode.angular_frequency * t);
        libm::exp(-mode.decay_rate * t) * (cosine * cos + sine * sin)
    });
    let expected = 0.5 * t * libm::exp(-3.0) + 0.5 * libm::sin(3.0) / 3000.0;
    assert!((heard.sum::<f64>() / expected - 1.0).abs() < 1e-5);
}

#[test]
fn bodies_in_series_are_the_product_of_their_responses() {
    let mut chance = Chance(Sequence::new(11));
    let first = chance.body(6, 30.0);
    let mut second = chance.body(8, 100.0);
    second[3].angular_frequency = first[2].angular_frequency;
    second[3].decay_rate = first[2].decay_rate;
    let stiffness = 1e6;
    let modes = series(&first, &second, stiffness).unwrap();
    let partials = |struck, heard| modes.iter().map(move |mode| mode.displacement(struck, heard));
    let along = || partials([1.0, 0.0], [0.0, 1.0]);
    assert_sum(along(), 0.0, "displacement");
    assert_sum(modes.iter().map(|mode| mode.velocity([1.0, 0.0], [0.0, 1.0])), 0.0, "velocity");
    assert!(partials([0.0, 1.0], [1.0, 0.0]).all(|partial| partial == Partial::default()), "one way");
    // The response to e^(st), far to the right of all poles.
    let s = 2000.0;
    let response = |body: &[BodyMode], shape: &dyn Fn(&BodyMode) -> f64| -> f64 {
        let q = |mode: &BodyMode| {
            (s + mode.decay_rate) * (s + mode.decay_rate) + mode.angular_frequency * mode.angular_frequency
        };
        body.iter().map(|mode| shape(mode) / q(mode)).sum()
    };
    let expected = stiffness
        * response(&first, &|mode| mode.strike * mode.joint)
        * response(&second, &|mode| mode.joint * mode.pickup);
    let transformed: f64 = modes
        .iter()
        .zip(along())
        .map(|(mode, Partial { cosine, sine })| {
            let (to_the_right, frequency) = (s + mode.decay_rate, mode.angular_frequency);
            (cosine * to_the_right + sine * frequency) / (to_the_right * to_the_right + frequency * frequency)
        })
        .sum();
    assert!((transformed / expected - 1.0).abs() < 1e-4, "{transformed} for {expected}");
    // Two modes with the same pole nearly cancel, but not so much that single precision would be audible.
    let largest = |partial: Partial| partial.cosine.abs().max(partial.sine.abs());
    let alone = first[2].strike * first[2].joint * second[3].joint * second[3].pickup * stiffness
        / (2.0 * first[2].angular_frequency * first[2].angular_frequency * first[2].decay_rate);
    assert!(along().map(largest).fold(0.0, f64::max) < 2000.0 * alone.abs().max(1e-9));
}

#[test]
fn what_is_out_of_range_is_refused_by_name() {
    let mode = BodyMode { angular_frequency: 1000.0, decay_rate: 1.0, joint: 1.0, strike: 1.0, pickup: 1.0 };
    let refused = |mode: BodyMode| apart(&[mode], &[]).unwrap_err();
    assert!(matches!(refused(BodyMode { angular_frequency: 0.0, ..mode }), Error::Value { .. }));
    assert!(matches!(refused(BodyMode { decay_rate: -1.0, ..mode }), Error::Value { .. }));
    assert!(matches!(refused(BodyMode { joint: f64::NAN, ..mode }), Error::Value { .. }));
    assert!(joined(&[mode], &[mode], Joint::Spring { stiffness: -1.0, damping: 0.0 }).is_err());
    assert!(joined(&[mode], &[mode], Joint::Spring { stiffness: 0.0, damping: f64::NAN }).is_err());
    assert!(series(&[mode], &[mode], f64::INFINITY).is_err());
    assert_eq!(joined(&[], &[], Joint::Rigid).unwrap(), []);
    assert_eq!(joined(&[mode], &[], Joint::Rigid).unwrap(), [], "held fast");
    assert_eq!(mode.with_mass(4.0).strike, 0.5);
}

/// FNV-1a hash over all bits, which must be the same on every machine.
#[test]
fn bits_are_frozen() {
    let mut hash = 0xCBF2_9CE4_8422_2325_u64;
    for case in 0..40 {
        let ([first, second], joint) = Chance(Sequence::new(case)).pair();
        let modes = [joined(&first, &second, joint), series(&first, &second, 1e6)];
        for mode in modes.into_iter().flatten().flatten() {
            let shapes = mode.strike.into_iter().chain(mode.pickup).flat_map(|shape| [shape.re, shape.im]);
            for number in [mode.angular_frequency, mode.decay_rate].into_iter().chain(shapes) {
                hash = (hash ^ (number + 0.0).to_bits()).wrapping_mul(0x0100_0000_01B3);
            }
        }
    }
    assert_eq!(hash, 0x8C2D_A378_F733_F8B9, "{hash:#018X}");
}
