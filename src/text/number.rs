//! Formats numbers for users.

use libm::{floor, log10};

/// A number with no more decimals than necessary; with a power of ten if it is very large or small.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value.is_nan() {
            "–".to_owned()
        } else if value > 0.0 {
            "∞".to_owned()
        } else {
            "−∞".to_owned()
        };
    }
    let magnitude = floor(log10(value.abs()));
    let text = if (-4.0..6.0).contains(&magnitude) {
        let decimals = (4.0 - magnitude).clamp(0.0, 8.0) as usize;
        let text = format!("{value:.decimals$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        let text = format!("{value:.1e}");
        text.replace(".0e", "e")
    };
    text.replace('-', "−")
}

/// A number to three significant digits, for tables.
pub fn measured(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return short(value);
    }
    // Round first, so that 0.9999 becomes 1.00 and not 1.000.
    let rounded = format!("{value:.2e}");
    let magnitude = rounded.rsplit('e').next().and_then(|power| power.parse::<i32>().ok()).unwrap_or(0);
    let text =
        if (-3..5).contains(&magnitude) { format!("{value:.*}", (2 - magnitude).max(0) as usize) } else { rounded };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (0.1 + 0.2, "0.3"),
            (20_000.0, "20000"),
            (0.000_25, "0.00025"),
            (-1.5, "−1.5"),
            (1e-15, "1e−15"),
            (2.5e8, "2.5e8"),
            (f64::INFINITY, "∞"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn measurements_have_three_digits() {
        for (value, text) in [
            (1.0, "1.00"),
            (0.012_345, "0.0123"),
            (123.4, "123"),
            (0.999_99, "1.00"),
            (-9.996, "−10.0"),
            (1.234e-9, "1.23e−9"),
            (f64::NAN, "–"),
            (0.0, "0"),
        ] {
            assert_eq!(measured(value), text);
        }
    }
}
