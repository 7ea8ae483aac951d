//! Roots of functions. Every step is an exactly rounded operation, so the bits are the same on every machine.

/// A root of `f` between `low` and `high`, where `f` must have different signs.
///
/// Ridders, "A new algorithm for computing a single root of a real continuous function" (1979): as fast as Newton's
/// method, but never outside the bracket. It ends when a step changes only the last bits.
pub(super) fn between(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let (mut f_low, mut f_high) = (f(low), f(high));
    if f_low == 0.0 {
        return low;
    }
    if f_high == 0.0 {
        return high;
    }
    let mut last = f64::NAN;
    // Each step at least halves the bracket, so 64 steps are always enough.
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        let f_middle = f(middle);
        // The two values have different signs, so their product is negative, and this root is real and not 0.
        let scale = (f_middle * f_middle - f_low * f_high).sqrt();
        let toward = if f_low > f_high { f_middle } else { -f_middle };
        let root = middle + (middle - low) * (toward / scale);
        if f_middle == 0.0 || !root.is_finite() {
            return middle;
        }
        if (root - last).abs() <= 2.0 * f64::EPSILON * root.abs() {
            return root;
        }
        last = root;
        let f_root = f(root);
        if f_root == 0.0 {
            return root;
        }
        if (f_middle < 0.0) != (f_root < 0.0) {
            (low, f_low, high, f_high) =
                if middle < root { (middle, f_middle, root, f_root) } else { (root, f_root, middle, f_middle) };
        } else if (f_low < 0.0) != (f_root < 0.0) {
            (high, f_high) = (root, f_root);
        } else {
            (low, f_low) = (root, f_root);
        }
    }
    last
}

/// All roots of `f` from `from` to `to`. No two roots may be closer than `step`.
pub(super) fn all(f: impl Fn(f64) -> f64, from: f64, to: f64, step: f64) -> Vec<f64> {
    let mut roots = Vec::new();
    let (mut left, mut f_left) = (from, f(from));
    let mut n = 0.0;
    while left < to {
        n += 1.0;
        let right = (from + n * step).min(to);
        let f_right = f(right);
        if (f_left < 0.0) != (f_right < 0.0) {
            roots.push(between(&f, left, right));
        }
        (left, f_left) = (right, f_right);
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::{exp, log, sin};
    use std::cell::Cell;
    use std::f64::consts::PI;

    #[test]
    fn roots_are_found_to_the_last_bits() {
        for n in 1..200 {
            let n = f64::from(n);
            let root = between(sin, (n - 0.4) * PI, (n + 0.3) * PI);
            assert!((root - n * PI).abs() <= 4.0 * f64::EPSILON * n * PI, "{n}");
        }
        assert_eq!(between(|x| x, 0.0, 1.0), 0.0);
        assert_eq!(all(|x| x - 0.5, 0.0, 1.0, 0.5), [0.5]);
        assert_eq!(all(sin, 1.0, 100.0, 1.5).len(), 31);
    }

    #[test]
    fn few_steps_are_enough() {
        let calls = Cell::new(0);
        let f = |x: f64| {
            calls.set(calls.get() + 1);
            exp(x) - 10.0
        };
        let root = between(f, 0.0, 10.0);
        assert!((root - log(10.0)).abs() < 1e-14);
        assert!(calls.get() < 25, "{}", calls.get());
    }
}
