//! Compares rendered pairs of bodies with a dense eigenproblem solved by SciPy, made by `pairs/scipy_reference.py`.

use sprung::engine::{Event, Synth};
use sprung::params::{MalletPulse, Param};
use sprung::patch::{ModeTable, Patch};
use sprung::sound::bodies::{Body, Model};
use sprung::sound::pairs::{Link, Pair};
use sprung::sound::{Kit, Sound};
use sprung::units::frequency_from_key;
use std::f64::consts::TAU;
use std::sync::Arc;

const NUMBERS: &str = include_str!("pairs/scipy_reference.csv");
const RATE: f64 = 48_000.0;
const FRAMES: usize = 24_000;

/// Frequency in Hz, T60 in seconds, and the cosine and sine of the pickup's signal: on the string and on the plate.
struct Line {
    frequency: f64,
    t60: f64,
    heard: [[f64; 2]; 2],
}

fn lines(kind: &str, key: u8) -> Vec<Line> {
    let read = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let is_wanted = cells[0] == kind && cells[1] == key.to_string();
        let number = |cell: usize| cells[cell].parse().expect("a number");
        is_wanted.then(|| {
            let heard = [[number(4), number(5)], [number(6), number(7)]];
            Line { frequency: number(2), t60: number(3), heard }
        })
    };
    NUMBERS.lines().filter(|line| line.contains(',') && !line.starts_with('#')).filter_map(read).collect()
}

/// The pair of the script: a string that follows the keys, and a plate that does not.
fn pair(kind: &str, heard: f64) -> Pair {
    let body = |model: &str, frequency: f64, count: usize, loss: [f64; 3]| {
        let mut body = Body::new(Model::find(model).expect("a model").clone());
        body.pitch = sprung::sound::bodies::Pitch::Frequency(frequency);
        (body.material.loss.b0, body.material.loss.b1, body.material.loss.power) = (loss[0], loss[1], loss[2]);
        body.modes = count;
        body
    };
    let mut string = body("string", 196.0, 12, [0.8, 2e-7, 2.0]);
    (string.strike.x, string.pickup.x, string.joint.x) = (0.12, 0.9, 0.97);
    let mut plate = body("plate", 95.0, 10, [12.0, 0.02, 1.0]);
    plate.model = Model::Plate { edge: sprung::sound::bodies::Edge::Supported, aspect: 1.4 };
    (plate.joint.x, plate.joint.y, plate.follows_key) = (0.6, 0.4, false);
    let link = match kind {
        "apart" => Link::Apart,
        "series" => Link::Series,
        _ => Link::Spring { stiffness: 600.0, damping: 0.05 },
    };
    Pair { mass: 8.0, struck: 0.0, heard, keys: [43, 67], ..Pair::new(string, plate, link) }
}

/// An impulse of full force on one key.
fn render(modes: ModeTable, decay: f64, key: u8) -> Vec<f32> {
    let mut patch = Patch { modes, ..Patch::default() };
    for (param, value) in [
        (Param::Decay, decay as f32),
        (Param::MalletPulse, MalletPulse::Impulse as u8 as f32),
        (Param::Gain, 0.0),
        (Param::Limiter, 0.0),
    ] {
        patch.set(param, value);
    }
    let mut synth = Synth::new(RATE, 1);
    synth.set_kit(&Kit::single(String::new(), Arc::new(Sound::new(patch))));
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    synth.process(&[Event::note_on(0, key, 1.0)], &mut left, &mut right);
    left
}

#[test]
fn rendered_pairs_are_those_of_scipy() {
    for kind in ["apart", "series", "spring"] {
        for (body, heard) in [(0, 0.0), (1, 1.0)] {
            // A plate that is not joined to the string is not struck.
            if kind == "apart" && body == 1 {
                continue;
            }
            let pair = pair(kind, heard);
            let (table, decay) = (pair.table().expect("poles"), pair.t60());
            table.make_tables();
            for key in [43, 55, 67] {
                let expected = lines(kind, key);
                assert_eq!(expected.len(), 22, "{kind}, key {key}");
                let frequency = frequency_from_key(key.into(), 440.0);
                let of_key = table.at(table.place(frequency));
                let amplitude = |line: &Line| libm::hypot(line.heard[body][0], line.heard[body][1]);
                let total: f64 = expected.iter().map(amplitude).sum();
                let levels: f64 = of_key.as_slice().iter().map(|mode| f64::from(mode.level)).sum();
                for (line, mode) in expected.iter().zip(of_key.as_slice()) {
                    let place = format!("{kind}, key {key}, {:.1} Hz", line.frequency);
                    let cents = 1200.0 * libm::log2(f64::from(mode.ratio) * frequency / line.frequency);
                    let t60 = f64::from(mode.decay) * decay / line.t60 - 1.0;
                    let level = f64::from(mode.level) / levels - amplitude(line) / total;
                    assert!(cents.abs() < 0.001, "{place}: {cents} cents");
                    assert!(t60.abs() < 1e-4, "{place}: T60 is off by {t60}");
                    assert!(level.abs() < 1e-6, "{place}: the level is off by {level}");
                }
                let found = render(table.clone(), decay, key);
                let mut off = [0.0, 0.0];
                for (frame, sample) in found.iter().enumerate() {
                    let seconds = (frame + 1) as f64 / RATE;
                    let value = |line: &Line| {
                        let angle = TAU * line.frequency * seconds;
                        let [cosine, sine] = line.heard[body];
                        libm::pow(0.001, seconds / line.t60) * (cosine * libm::cos(angle) + sine * libm::sin(angle))
                    };
                    let wanted = expected.iter().map(value).sum::<f64>() * levels / total;
                    let difference = f64::from(*sample) - wanted;
                    off = [off[0] + difference * difference, off[1] + wanted * wanted];
                }
                let db = 10.0 * libm::log10(off[0] / off[1]);
                println!("{kind}, body {body}, key {key}: the difference is {db:.1} dB below");
                assert!(db < -60.0, "{kind}, body {body}, key {key}: {db} dB");
            }
        }
    }
}
