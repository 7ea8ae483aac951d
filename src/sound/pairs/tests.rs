//! Tests of pairs.

use super::*;
use crate::patch::ModeTable;
use crate::sound::bodies::Model;
use crate::sound::bodies::{Body, Pitch};
use crate::sound::coupled::CoupledMode;
use crate::units::frequency_from_key;
use std::f64::consts::TAU;

fn body(model: &str, modes: usize) -> Body {
    Body { modes, ..Body::new(Model::find(model).unwrap().clone()) }
}

/// A string on a board that keeps its frequency.
fn guitar() -> Pair {
    let mut board = body("plate", 12);
    board.pitch = Pitch::Frequency(170.0);
    (board.follows_key, board.material.loss.b0) = (false, 20.0);
    let link = Link::Spring { stiffness: 700.0, damping: 0.1 };
    Pair { keys: [50, 60], ..Pair::new(body("string", 20), board, link) }
}

fn levels(table: &ModeTable) -> f64 {
    table.as_slice().iter().map(|mode| f64::from(mode.level.abs())).sum()
}

#[test]
fn a_pair_apart_has_the_levels_of_both_bodies() {
    let (first, second) = (body("free_bar", 5), body("membrane", 9));
    let mut pair = Pair::new(first.clone(), second.clone(), Link::Apart);
    pair.heard = 0.0;
    for (heard, alone) in [(0.0, &first), (1.0, &second)] {
        pair.heard = heard;
        let (table, expected) = (pair.table().unwrap(), alone.table());
        assert_eq!(table.as_slice().len(), expected.as_slice().len());
        for (m, (mode, expected)) in table.as_slice().iter().zip(expected.as_slice()).enumerate() {
            assert!((mode.ratio / expected.ratio - 1.0).abs() < 1e-6);
            assert!((f64::from(mode.level) - f64::from(expected.level).abs()).abs() < 1e-6);
            // A negative level becomes a phase of half a turn.
            let phase = if expected.level < 0.0 { std::f32::consts::PI } else { 0.0 };
            assert!((table.phase(m).abs() - phase).abs() < 1e-6, "mode {m}: {}", table.phase(m));
        }
    }
}

#[test]
fn strike_and_noise_move_each_body_by_its_own_share() {
    let (first, mut second) = (body("marimba", 6), body("box", 20));
    second.strike_share = 0.25;
    let apart = Pair::new(first.clone(), second.clone(), Link::Apart).table().unwrap();
    let shares = |table: &ModeTable| table.as_slice().iter().map(|mode| mode.strike).collect::<Vec<_>>();
    let count = |expected: f32| shares(&apart).iter().filter(|share| (**share - expected).abs() < 1e-4).count();
    assert_eq!([count(1.0), count(0.25)], [6, 20]);
    // In series, only the first body excites the second, so the first one's share counts.
    let table = Pair::new(first, second, Link::Series).table().unwrap();
    assert!(shares(&table).iter().all(|share| (share - 1.0).abs() < 1e-6), "{:?}", shares(&table));
}

#[test]
fn bodies_that_both_follow_the_keys_need_one_table() {
    let pair = Pair::new(body("marimba", 8), body("stopped_tube", 8), Link::Series);
    let table = pair.table().unwrap();
    table.make_tables();
    assert_eq!(table.keys(), None);
    assert!((levels(&table) - 1.0).abs() < 1e-5);
}

#[test]
fn every_key_has_the_modes_of_the_pair_at_its_frequency() {
    let pair = guitar();
    let table = pair.table().unwrap();
    table.make_tables();
    assert_eq!(table.keys(), Some(50..=60));
    for key in 50..=60 {
        let frequency = frequency_from_key(key.into(), 440.0);
        let (modes, of_key) = (pair.modes(frequency).unwrap(), table.at(table.place(frequency)));
        assert_eq!(of_key.as_slice().len(), 32);
        assert!(levels(of_key) <= 1.0 + 1e-5);
        for (expected, mode) in modes.iter().zip(of_key.as_slice()) {
            let found = TAU * frequency * f64::from(mode.ratio);
            assert!((found / expected.angular_frequency - 1.0).abs() < 1e-6, "key {key}");
        }
    }
    let most = table.tables().iter().map(levels).fold(0.0, f64::max);
    assert!((most - 1.0).abs() < 1e-5, "{most}");
}

#[test]
fn the_body_that_follows_the_keys_is_in_tune() {
    let mut pair = guitar();
    for link in [pair.link, Link::Rigid] {
        pair.link = link;
        if link == Link::Rigid {
            pair.mass = 300.0;
        }
        for key in 50..=60 {
            let frequency = frequency_from_key(key.into(), 440.0);
            let cents = |mode: &CoupledMode| 1200.0 * libm::log2(mode.angular_frequency / (TAU * frequency));
            let modes = pair.modes(frequency).unwrap();
            let off = modes
                .iter()
                .map(cents)
                .fold(f64::MAX, |best, cents| if cents.abs() < best.abs() { cents } else { best });
            assert!(off.abs() < 1e-4, "{link:?}, key {key}: {off} cents");
        }
    }
}

/// The direction across the strike has a weak joint: it rings longer, at nearly the same frequency.
#[test]
fn the_second_direction_of_a_string_rings_longer() {
    let mut pair = guitar();
    pair.polarisation = 0.2;
    let frequency = frequency_from_key(55.0, 440.0);
    let modes = pair.modes(frequency).unwrap();
    assert_eq!(modes.len(), 52);
    let near = |mode: &&CoupledMode| (mode.angular_frequency / (TAU * frequency) - 1.0).abs() < 0.005;
    let rates: Vec<f64> = modes.iter().filter(near).map(|mode| mode.decay_rate).collect();
    let [one, other] = rates[..] else { panic!("{rates:?}") };
    let ratio = one.max(other) / one.min(other);
    assert!(ratio > 1.5, "{rates:?}");
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let refused = |change: fn(&mut Pair)| {
        let mut pair = guitar();
        change(&mut pair);
        pair.table().unwrap_err().to_string()
    };
    assert!(refused(|pair| pair.mass = f64::NAN).contains("mass"));
    assert!(refused(|pair| pair.heard = 2.0).contains("heard"));
    assert!(refused(|pair| pair.link = Link::Spring { stiffness: 0.0, damping: 0.0 }).contains("stiffness"));
    assert!(refused(|pair| pair.first.modes = 512).contains("at most 512"));
}
