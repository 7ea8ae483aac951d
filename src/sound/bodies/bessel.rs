//! Bessel functions that `libm` does not have, and zeros of Bessel functions.

use super::roots;
use libm::{exp, jn};

/// All zeros of `J_m` up to `limit`.
///
/// Neighbouring zeros are more than 3 apart (the smallest distance is 3.115, for `J_0`), and the first one is above
/// `m`.
pub(super) fn zeros_below(m: u32, limit: f64) -> Vec<f64> {
    roots::all(|x| jn(m as i32, x), f64::from(m).max(1.0), limit, 1.5)
}

/// `I_{n+1}(x) / I_n(x)` for `x > 0`: Gauss's continued fraction `1/(2(n+1)/x + 1/(2(n+2)/x + …))`, computed backwards.
pub(super) fn i_ratio(n: u32, x: f64) -> f64 {
    // Later terms do not change even the last bit: above order x the ratio falls quickly.
    let last = n + 40 + 2 * (x as u32);
    (n + 1..=last).rev().fold(0.0, |ratio, order| 1.0 / (2.0 * f64::from(order) / x + ratio))
}

/// `I_n(x r) / I_n(x)` for `0 ≤ r ≤ 1` and `x > 0`.
pub(super) fn i_relative(n: u32, x: f64, r: f64) -> f64 {
    if r <= 0.0 {
        return if n == 0 { i_scaled(0, 0.0) * exp(-x) / i_scaled(0, x) } else { 0.0 };
    }
    i_scaled(n, x * r) * exp(x * r - x) / i_scaled(n, x)
}

/// `e^−x I_n(x)`: Miller's backward recurrence, scaled by `I_0 + 2 (I_1 + I_2 + …) = e^x` (Abramowitz and Stegun
/// 9.6.37).
fn i_scaled(n: u32, x: f64) -> f64 {
    if x <= 0.0 {
        return if n == 0 { 1.0 } else { 0.0 };
    }
    let (mut above, mut here, mut sum, mut wanted) = (0.0, 1e-300, 0.0, 0.0);
    for order in (0..=n + 40 + 2 * (x as u32)).rev() {
        if order == n {
            wanted = here;
        }
        sum += if order == 0 { here } else { 2.0 * here };
        (above, here) = (here, above + 2.0 * f64::from(order) / x * here);
        if here > 1e200 {
            (above, here, sum, wanted) = (above * 1e-200, here * 1e-200, sum * 1e-200, wanted * 1e-200);
        }
    }
    wanted / sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with Abramowitz and Stegun, tables 9.5 and 9.8.
    #[test]
    fn tables_are_met() {
        for (m, n, zero) in [(0, 1, 2.4048255577), (1, 1, 3.8317059702), (2, 3, 11.6198411721), (8, 1, 12.2250922640)] {
            assert!((zeros_below(m, 20.0)[n - 1] - zero).abs() < 1e-10, "{m} {n}");
        }
        for (n, x, scaled) in
            [(0, 1.0, 0.4657596077), (1, 1.0, 0.2079104154), (0, 10.0, 0.1278333371), (1, 10.0, 0.1212626814)]
        {
            assert!((i_scaled(n, x) - scaled).abs() < 1e-9, "{n} {x}");
        }
        assert!((i_ratio(0, 10.0) - 0.1212626814 / 0.1278333371).abs() < 1e-9);
        assert_eq!(i_relative(3, 7.0, 1.0), 1.0);
        assert!((i_relative(0, 7.0, 0.0) * 168.593_908_5 - 1.0).abs() < 1e-8);
    }

    #[test]
    fn zeros_interlace() {
        let mut before = zeros_below(0, 80.0);
        for m in 1..70 {
            let zeros = zeros_below(m, 80.0);
            assert!(zeros.iter().zip(&before).all(|(zero, low)| zero > low), "{m}");
            assert!(zeros.iter().zip(&before[1..]).all(|(zero, high)| zero < high), "{m}");
            before = zeros;
        }
    }
}
