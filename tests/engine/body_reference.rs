//! Compares bodies with independent numbers from SciPy, made by `bodies/scipy_reference.py`.

use crate::bodies::{Line, NUMBERS, body, groups, lines};
use sprung::sound::bodies::Model;

#[test]
fn bodies_agree_with_scipy() {
    let lines: Vec<Line> = lines();
    assert!(lines.len() > 300, "{} lines", lines.len());
    let mut breaches = Vec::new();
    for group in groups(&lines) {
        let modes = body(&group[0].model, &group[0].set).modes();
        for line in group {
            let mode = &modes[line.place];
            let name = format!("{} {} {}", line.model, line.set, line.place);
            if (mode.ratio / line.ratio - 1.0).abs() > line.tolerance {
                breaches.push(format!("{name}: ratio {} for {}", mode.ratio, line.ratio));
            }
            // A tenth of a decibel; near nodes, a small share of the largest levels, which are about 2.
            if (mode.level - line.product).abs() > 0.0115 * line.product.abs() + 1e-5 {
                breaches.push(format!("{name}: level {} for {}", mode.level, line.product));
            }
            // The T60 is a function of the frequency, so its error is similar; the numbers in the tables have four
            // digits.
            if (mode.t60 / line.t60 - 1.0).abs() > 3e-4 + line.tolerance {
                breaches.push(format!("{name}: {} s for {} s", mode.t60, line.t60));
            }
        }
    }
    assert!(breaches.is_empty(), "\n{}", breaches.join("\n"));
}

#[test]
fn every_model_with_a_law_of_its_own_is_among_them() {
    // A mass has only one mode. Beds are random and have their own tests.
    let without = ["mass", "shell", "box", "wires", "wash", "air"];
    for (id, _) in Model::ALL.iter().filter(|(id, _)| !without.contains(id)) {
        assert!(NUMBERS.lines().any(|line| line.split(',').next() == Some(*id)), "{id}");
    }
}
