//! Series of ratios to which a dragged mode can snap.

use sprung::units::semitones_from_ratio;

/// A series of ratios.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Snap {
    #[default]
    Off,
    /// Strings and tubes.
    Harmonic,
    /// A bar with free ends.
    Bar,
    /// A round membrane.
    Membrane,
    /// A church bell, tuned to its prime.
    Bell,
}

/// Zeros of the Bessel functions J₀, J₁ … divided by the first one (Fletcher and Rossing, The Physics of Musical
/// Instruments, 3.2).
const MEMBRANE: [f32; 16] =
    [1.0, 1.594, 2.136, 2.296, 2.653, 2.918, 3.156, 3.501, 3.6, 3.652, 4.06, 4.154, 4.231, 4.602, 4.832, 4.904];

/// Hum, prime, tierce, quint, nominal and the partials above (Fletcher and Rossing, 21.3).
const BELL: [f32; 13] = [0.5, 1.0, 1.2, 1.5, 2.0, 2.5, 2.667, 3.0, 4.0, 5.333, 6.667, 8.0, 10.667];

impl Snap {
    pub(super) const ALL: [Self; 5] = [Self::Off, Self::Harmonic, Self::Bar, Self::Membrane, Self::Bell];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Off => "snap: off",
            Self::Harmonic => "harmonic",
            Self::Bar => "bar",
            Self::Membrane => "membrane",
            Self::Bell => "bell",
        }
    }

    /// The ratio of the series nearest to a ratio. Beyond the series, or without one, the ratio itself.
    pub(super) fn nearest(self, ratio: f32) -> f32 {
        match self {
            Self::Off => ratio,
            Self::Harmonic => ratio.round().max(1.0),
            // (2n + 1)² / 3.0112² for n > 1 (Fletcher and Rossing, 2.15).
            Self::Bar => {
                let odd = 3.0112 * ratio.max(0.0).sqrt();
                let odd = ((odd - 1.0) / 2.0).round() * 2.0 + 1.0;
                if odd <= 3.0 { 1.0 } else { (odd / 3.0112) * (odd / 3.0112) }
            }
            Self::Membrane => nearest(ratio, &MEMBRANE),
            Self::Bell => nearest(ratio, &BELL),
        }
    }
}

fn nearest(ratio: f32, series: &[f32]) -> f32 {
    let distance = |other: f32| semitones_from_ratio(f64::from(ratio / other)).abs();
    let beyond = series.last().is_some_and(|last| ratio > last * 1.03);
    let best = series.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    best.filter(|_| !beyond).unwrap_or(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_snap_to_the_nearest_of_a_series() {
        for (snap, ratio, expected) in [
            (Snap::Off, 1.37, 1.37),
            (Snap::Harmonic, 2.6, 3.0),
            (Snap::Harmonic, 0.2, 1.0),
            (Snap::Bar, 1.3, 1.0),
            (Snap::Bar, 2.8, 2.757),
            (Snap::Bar, 5.2, 5.404),
            (Snap::Bar, 9.0, 8.933),
            (Snap::Membrane, 1.6, 1.594),
            (Snap::Bell, 1.17, 1.2),
            (Snap::Bell, 20.0, 20.0),
        ] {
            let found = snap.nearest(ratio);
            assert!((found / expected - 1.0).abs() < 1e-3, "{snap:?} {ratio}: {found}");
        }
    }
}
