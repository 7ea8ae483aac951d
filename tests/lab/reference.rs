//! Compares the lab's true motions with SciPy's independent integrator; numbers from `scipy_reference.py`.

use sprung::internals::lab::reference;
use sprung::lab::{ClosedForm, Force, Spring, State, System};

const NUMBERS: &str = include_str!("scipy_reference.csv");

/// One line: the case, its initial state, and SciPy's state at a time.
struct Line {
    name: String,
    system: System,
    start: State,
    t: f64,
    expected: State,
}

fn lines() -> Vec<Line> {
    NUMBERS.lines().filter(|line| !line.starts_with('#')).skip(1).map(read).collect()
}

fn read(line: &str) -> Line {
    let (name, rest) = line[1..].split_once("\",").expect("a quoted name");
    let (spring, numbers) = rest.split_once(',').expect("a spring");
    let numbers: Vec<f64> = numbers.split(',').map(|number| number.parse().expect("a number")).collect();
    let [mass, stiffness, damping, cubic, target, amplitude, frequency, phase, x0, v0, t, x, v] = numbers[..] else {
        panic!("{line}: 13 numbers")
    };
    let spring = match spring {
        "linear" => Spring::Linear,
        "duffing" => Spring::Duffing { cubic },
        "pendulum" => Spring::Pendulum,
        _ => panic!("{line}: a known spring"),
    };
    let force = Force { amplitude, frequency, phase };
    Line {
        name: name.to_owned(),
        system: System { mass, stiffness, damping, target, spring, force },
        start: State { x: x0, v: v0 },
        t,
        expected: State { x, v },
    }
}

#[test]
fn true_motions_agree_with_scipy() {
    let lines = lines();
    assert!(lines.len() >= 12 * 4);
    for Line { name, system, start, t, expected } in lines {
        let steps = (t / 0.05_f64).round() as usize;
        let got = *reference::states(&system, start, t / steps as f64, steps).unwrap().last().unwrap();
        let (dx, dv) = ((got.x - expected.x).abs(), (got.v - expected.v).abs());
        assert!(dx < 1e-9 && dv < 1e-9, "{name} at {t} s: {dx:e} m, {dv:e} m/s");
        assert_eq!(ClosedForm::new(&system, start).is_ok(), system.is_linear());
    }
}
