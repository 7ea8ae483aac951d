//! Tests of properties that all bodies must have.

use super::body::T60_RANGE;
use super::fields::Field;
use super::*;
use proptest::collection::vec;
use proptest::prelude::*;

/// Random bodies: each number from its whole range, a third of the numbers at an end of the range.
fn bodies() -> impl Strategy<Value = Body> {
    let number = prop_oneof![2 => 0.0..=1.0, 1 => prop_oneof![Just(0.0), Just(1.0)]];
    // Most sizes and constants span decades, so they are drawn at random on a logarithmic scale.
    let value = |field: &Field, share: f64| {
        let low = if field.max / field.min.max(1e-9) > 1e3 { field.min.max(field.max * 1e-9) } else { 0.0 };
        if low > 0.0 { low * libm::pow(field.max / low, share) } else { field.min + share * (field.max - field.min) }
    };
    let set = prop::option::weighted(0.3, number);
    (0..Model::ALL.len(), vec(set, FIELDS.len())).prop_map(move |(model, shares)| {
        let mut body = Body::new(Model::ALL[model].1.clone());
        for (field, share) in FIELDS.iter().zip(shares) {
            let exists = (field.get)(&body).is_some() || ["frequency", "length"].contains(&field.name);
            if let Some(share) = share.filter(|_| exists) {
                (field.set)(&mut body, value(field, share));
            }
        }
        body
    })
}

fn check(body: &Body) -> Result<(), TestCaseError> {
    let modes = body.modes();
    prop_assert!((1..=body.modes).contains(&modes.len()), "{} modes", modes.len());
    prop_assert!(modes.is_sorted_by(|a, b| a.ratio <= b.ratio));
    for mode in &modes {
        prop_assert!((RATIO_RANGE.0..=RATIO_RANGE.1).contains(&mode.ratio), "{mode:?}");
        prop_assert!((T60_RANGE.0..=T60_RANGE.1).contains(&mode.t60), "{mode:?}");
        prop_assert!((-1.0..=1.0).contains(&mode.pan), "{mode:?}");
        prop_assert_eq!(mode.frequency, mode.ratio * body.frequency());
        prop_assert!(
            [mode.strike, mode.pickup, mode.joint, mode.level].iter().all(|value| value.is_finite()),
            "{:?}",
            mode
        );
        // No shape with mean square 1 is larger than this, except where a body has almost no mass.
        prop_assert!(mode.strike.abs() < 1e4, "{mode:?}");
    }
    let table = body.table();
    for mode in table.as_slice() {
        for ((name, min, max), value) in crate::patch::Mode::FIELDS.into_iter().zip(mode.fields()) {
            prop_assert!((min..=max).contains(&value), "{name} {value}");
        }
    }
    let sum: f64 = table.as_slice().iter().map(|mode| f64::from(mode.level.abs())).sum();
    prop_assert!(sum < 1.0 + 1e-4, "{sum}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]
    #[test]
    fn any_numbers_make_a_body_that_can_be_played(body in bodies()) {
        check(&body)?;
    }
}

#[test]
fn every_model_gives_as_many_modes_as_there_are() {
    for (id, model) in Model::ALL {
        for modes in [1, 2, 63, 512] {
            for split in [0.0, 5.0] {
                let body = Body { modes, split, ..Body::new(model.clone()) };
                check(&body).unwrap_or_else(|error| panic!("{id} {modes} {split}: {error}"));
                // Ratios of bars and rings exceed 1,000 before that; a mass has only one mode.
                assert!(
                    body.modes().len() == modes || modes > 15 || *model == Model::Mass,
                    "{id}: {} of {modes}",
                    body.modes().len()
                );
            }
        }
    }
}

#[test]
fn places_move_levels_and_nothing_else() {
    for (id, model) in Model::ALL {
        let here = Body { split: 3.0, ..Body::new(model.clone()) };
        let there = Body { strike: Point { x: 0.31, y: 0.47 }, ..here.clone() };
        for (a, b) in here.modes().iter().zip(&there.modes()) {
            assert_eq!((a.ratio, a.t60, a.pickup, a.pan), (b.ratio, b.t60, b.pickup, b.pan), "{id}");
        }
    }
}

#[test]
fn shapes_at_the_places_of_strike_and_pickup_are_those_of_the_modes() {
    for (id, model) in Model::ALL {
        let body = Body { split: 3.0, ..Body::new(model.clone()) };
        for (mode, shape) in body.modes_at(&[body.strike, body.pickup]) {
            assert_eq!(shape, [mode.strike, mode.pickup], "{id} {}", mode.ratio);
        }
    }
}

#[test]
fn places_to_begin_with_are_heard() {
    for (id, model) in Model::ALL {
        let modes = Body::new(model.clone()).modes();
        for shape in [|mode: &BodyMode| mode.level, |mode: &BodyMode| mode.joint] {
            assert!(modes.iter().filter(|mode| shape(mode).abs() > 0.01).count() * 3 > modes.len() * 2, "{id}");
        }
    }
}

#[test]
fn a_pair_is_its_mode_divided() {
    for model in [Model::String, Model::Membrane, Model::ChurchBell, Model::FreeBar] {
        let one = Body { modes: 8, ..Body::new(model.clone()) };
        let two = Body { modes: 64, split: 1e-9, ..one.clone() };
        let pairs = two.modes();
        for mode in one.modes() {
            let near = pairs.iter().filter(|pair| (pair.ratio / mode.ratio - 1.0).abs() < 1e-9);
            let sum: f64 = near.map(|pair| pair.level).sum();
            assert!((sum - mode.level).abs() < 1e-9, "{model:?}: {sum} for {}", mode.level);
        }
        let split = Body { modes: 2, split: 12.0, ..Body::new(model.clone()) }.modes();
        if model != Model::Membrane {
            let cents = crate::units::semitones_from_ratio(split[1].ratio / split[0].ratio) * 100.0;
            assert!((cents - 12.0).abs() < 1e-9, "{model:?}: {cents}");
        }
    }
}

#[test]
fn the_pitch_is_where_it_is_said_to_be() {
    // A tubular bell is heard at a pitch where it has no mode, and a bed has no pitch.
    let pitched = |model: &Model| !matches!(model, Model::Bed(_) | Model::TubularBell);
    for (id, model) in Model::ALL.iter().filter(|(_, model)| pitched(model)) {
        let body = Body { inharmonicity: 1e-3, spread: 50.0, ..Body::new(model.clone()) };
        assert!(body.modes().iter().any(|mode| (mode.ratio - 1.0).abs() < 1e-6), "{id}");
    }
}

#[test]
fn a_table_has_the_t60s_of_its_body() {
    for (id, model) in Model::ALL {
        let body = Body { modes: 5, ..Body::new(model.clone()) };
        let (t60, sum) = (body.t60(), body.modes().iter().map(|mode| mode.level.abs()).sum::<f64>());
        for mode in body.table().as_slice() {
            let same = |of: &&BodyMode| (f64::from(mode.ratio) / of.ratio - 1.0).abs() < 1e-6;
            let of = body.modes().iter().find(same).copied().unwrap();
            assert!((of.level / sum - f64::from(mode.level)).abs() < 1e-6, "{id}");
            assert!((f64::from(mode.decay) * t60 / of.t60 - 1.0).abs() < 1e-6, "{id}");
        }
    }
}

#[test]
fn a_size_that_a_mass_does_not_have_leaves_its_frequency() {
    let sized = Body { pitch: Pitch::Size(Size::DEFAULT), ..Body::new(Model::Mass) };
    assert_eq!(sized.frequency(), DEFAULT_FREQUENCY);
}

#[test]
fn no_modes_at_all_are_one_mass() {
    let silent = Body::new(Model::Custom([].into()));
    assert_eq!(silent.modes().len(), 1);
    let modes =
        [CustomMode { ratio: 2.0, level: -0.5, decay: 0.5 }, CustomMode { ratio: 1.0, level: 0.25, decay: 1.0 }];
    let custom = Body { pickup: Point { x: 0.0, y: 0.0 }, ..Body::new(Model::Custom(modes.into())) };
    let [low, high] = custom.modes()[..] else { panic!("two modes") };
    assert_eq!((low.level, high.level), (0.25, -0.5));
    assert_eq!(low.t60, LN_1000 / custom.material.loss.rate(DEFAULT_FREQUENCY));
    assert_eq!(high.t60, 0.5 * (LN_1000 / custom.material.loss.rate(2.0 * DEFAULT_FREQUENCY)));
}

/// FNV-1a over the bits of every number of every mode.
fn digest(bodies: impl IntoIterator<Item = Body>) -> u64 {
    let mut hash = 0xCBF2_9CE4_8422_2325_u64;
    for mode in bodies.into_iter().flat_map(|body| body.modes()) {
        for number in [mode.frequency, mode.ratio, mode.t60, mode.strike, mode.pickup, mode.joint, mode.level, mode.pan]
        {
            for byte in number.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
            }
        }
    }
    hash
}

/// Samples depend on these numbers, so they must be the same on every machine and in every build.
#[test]
fn bits_are_pinned() {
    let grid = Model::ALL.iter().flat_map(|(_, model)| {
        [(1, 0.0, 0.0), (48, 4.0, 1e-3), (512, 0.0, 0.02)].map(|(modes, cents, inharmonicity)| {
            let plain = Body::new(model.clone());
            Body {
                modes,
                split: cents,
                spread: cents,
                pan: 0.1 * cents,
                tilt: -cents,
                inharmonicity,
                seed: modes as u64,
                ..plain
            }
        })
    });
    let sized =
        Model::ALL.iter().map(|(_, model)| Body { pitch: Pitch::Size(Size::DEFAULT), ..Body::new(model.clone()) });
    assert_eq!(format!("{:016x}", digest(grid.chain(sized))), "6b7cc6c6c27baed4");
}
