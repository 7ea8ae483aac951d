//! The resonances of the bodies: measured ones by name, and above them as many as measured densities say.

use crate::dsp::coefficients::LN_MINUS_60_DB;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::random::{Sequence, key};
use libm::{cos, log2, log10, pow, sin, sqrt};
use std::f64::consts::{FRAC_PI_4, PI, SQRT_2};
use std::sync::LazyLock;

/// One resonance of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    /// Frequency in Hz.
    pub(crate) frequency: f64,
    /// Bandwidth in Hz: where the response has fallen by 3 dB.
    pub(crate) bandwidth: f64,
    /// Gain of a lasting sine at its frequency. Its sign is that of the mode shapes at the points of drive and pick-up.
    pub(crate) gain: f64,
    /// Whether it is heard as a velocity, and not as a displacement.
    pub(crate) is_velocity: bool,
    /// Output gains, left and right: at most √2, and 1 in the middle.
    pub(crate) sides: [f32; 2],
}

impl Resonance {
    /// Frequency in Hz and T60 in seconds, with frequencies and bandwidths multiplied by a ratio.
    pub(super) fn tuned(&self, ratio: f64) -> (f64, f64) {
        (self.frequency * ratio, -LN_MINUS_60_DB / (PI * self.bandwidth * ratio))
    }
}

/// The resonances of a body. Made once, and then shared.
#[derive(Debug)]
pub struct BoxBody {
    /// For each vowel its resonances; one row for a body without vowels.
    vowels: Vec<Vec<Resonance>>,
    most_gain: f64,
    least_bandwidth: f64,
}

/// The frequencies in Hz over which a body is as loud as its input, by the same energy in each octave.
const LOUD: [f64; 2] = [50.0, 10_000.0];
/// Steps at which its response is summed over them.
const STEPS: usize = 600;

impl BoxBody {
    fn new(mut vowels: Vec<Vec<Resonance>>) -> Self {
        for modes in &mut vowels {
            modes.truncate(MAX_MODES);
            let frequency = |step: usize| LOUD[0] * pow(LOUD[1] / LOUD[0], (step as f64 + 0.5) / STEPS as f64);
            let loudness = sqrt((0..STEPS).map(|step| power(modes, frequency(step))).sum::<f64>() / STEPS as f64);
            modes.iter_mut().for_each(|mode| mode.gain /= loudness);
        }
        let norm = |modes: &Vec<Resonance>| modes.iter().map(|mode| mode.gain * mode.gain).sum::<f64>();
        // Between two vowels each gain lies between those of the two.
        let most_gain = sqrt(vowels.iter().map(norm).sum());
        let least_bandwidth = vowels.iter().flatten().map(|mode| mode.bandwidth).fold(f64::INFINITY, f64::min);
        Self { vowels, most_gain, least_bandwidth }
    }

    /// A violin: of a viola at a size of 1.22, of a cello at 2.7, of a double bass at 4.
    pub fn violin() -> &'static Self {
        &BODIES[0]
    }

    /// A classical guitar.
    pub fn guitar() -> &'static Self {
        &BODIES[1]
    }

    /// The soundboard of a concert grand.
    pub fn soundboard() -> &'static Self {
        &BODIES[2]
    }

    /// A man's vocal tract, from *u* by *o*, *a* and *e* to *i*; a woman's at a size of 0.87.
    pub fn voice() -> &'static Self {
        &BODIES[3]
    }

    /// The bell of a trumpet: of a trombone at a size of 2.3, of a bassoon at 2.7, of a horn at 3, of a tuba at 5.
    pub fn horn() -> &'static Self {
        &BODIES[4]
    }

    /// The gain in dB of a lasting sine by its frequency in Hz, at a place among the vowels, 0 to 1. Allocates.
    pub fn response(&'static self, vowel: f64) -> impl Fn(f64) -> f64 {
        let modes: Vec<_> = self.at(vowel).collect();
        move |frequency| 10.0 * log10(power(&modes, frequency))
    }

    /// The resonances at a place among the vowels, 0 to 1.
    pub(super) fn at(&'static self, vowel: f64) -> impl Iterator<Item = Resonance> + use<> {
        let place = vowel * (self.vowels.len() - 1) as f64;
        let first = (place as usize).min(self.vowels.len() - 1);
        let second = (first + 1).min(self.vowels.len() - 1);
        let share = place - first as f64;
        let between = move |(a, b): (&Resonance, &Resonance)| {
            let ratio = |a: f64, b: f64| if share == 0.0 { a } else { a * pow(b / a, share) };
            let gain = a.gain + share * (b.gain - a.gain);
            let (frequency, bandwidth) = (ratio(a.frequency, b.frequency), ratio(a.bandwidth, b.bandwidth));
            Resonance { frequency, bandwidth, gain, ..*a }
        };
        self.vowels[first].iter().zip(&self.vowels[second]).map(between)
    }

    /// Root of the sum of squares of the gains, of any vowel at most.
    pub(super) fn most_gain(&self) -> f64 {
        self.most_gain
    }

    /// The smallest bandwidth in Hz.
    pub(super) fn least_bandwidth(&self) -> f64 {
        self.least_bandwidth
    }
}

/// The response to a sine, as a power, averaged over both sides.
fn power(modes: &[Resonance], frequency: f64) -> f64 {
    let mut sums = [[0.0; 2]; 2];
    for mode in modes {
        // i f b / (f₀² − f² + i f b) for a velocity, f₀ b / (f₀² − f² + i f b) for a displacement.
        let (own, width) = (mode.frequency, mode.bandwidth);
        let (real, imaginary) = (own * own - frequency * frequency, frequency * width);
        let scale = mode.gain * width / (real * real + imaginary * imaginary);
        let [x, y] =
            if mode.is_velocity { [imaginary * frequency, real * frequency] } else { [real * own, -imaginary * own] };
        for (sum, side) in sums.iter_mut().zip(mode.sides.map(f64::from)) {
            *sum = [sum[0] + side * scale * x, sum[1] + side * scale * y];
        }
    }
    sums.map(|[x, y]| 0.5 * (x * x + y * y)).iter().sum()
}

/// The many resonances above those that have names, in steps of pitch that are equal but for some chance.
///
/// A real plate has more of them than there is room for. Each is as much broader as they are fewer, so that neighbours overlap as
/// in the plate and the response has peaks and dips of the same height.
struct Dense {
    /// Frequencies in Hz between which they lie.
    from: f64,
    to: f64,
    count: usize,
    /// Quality factors at frequencies.
    q: Curve,
    /// Levels in dB at frequencies.
    level: Curve,
    seed: u64,
}

/// A line through points of a frequency in Hz and a value, straight over the logarithm of the frequency.
type Curve = &'static [(f64, f64)];

fn at(curve: Curve, frequency: f64) -> f64 {
    let last = curve.len() - 1;
    let next = curve.iter().position(|(point, _)| *point > frequency).unwrap_or(last).clamp(1, last);
    let ((low, a), (high, b)) = (curve[next - 1], curve[next]);
    let way = (log2(frequency / low) / log2(high / low)).clamp(0.0, 1.0);
    a + way * (b - a)
}

/// Largest deviation of the levels of dense resonances from their curve, in dB.
const SPREAD_DB: f64 = 6.0;

/// Frequency in Hz from which on waves in the plates are short enough for a body to send each mode to a side of its own, which it
/// does fully two octaves above.
const SIDES_FROM: f64 = 500.0;

impl Dense {
    fn modes(&self) -> impl Iterator<Item = Resonance> {
        let Self { from, to, count, q, level, seed } = *self;
        let mut random = Sequence::new(key(seed, 0));
        (0..count).map(move |n| {
            let mut chance = || f64::from(random.uniform());
            let way = (n as f64 + 0.5 + 0.35 * chance()) / count as f64;
            let frequency = from * pow(to / from, way);
            let decibels = at(level, frequency) + SPREAD_DB * chance();
            let sign = if chance() < 0.0 { -1.0 } else { 1.0 };
            let aside = 0.7 * (log2(frequency / SIDES_FROM) / 2.0).clamp(0.0, 1.0) * chance();
            mode(frequency, at(q, frequency), decibels, sign, aside)
        })
    }
}

/// A resonance of plates and enclosed air. It is heard as a velocity. `aside` is its place, −1 to 1.
fn mode(frequency: f64, q: f64, decibels: f64, sign: f64, aside: f64) -> Resonance {
    let angle = FRAC_PI_4 * (1.0 + aside);
    let sides = [cos(angle), sin(angle)].map(|side| (SQRT_2 * side) as f32);
    let gain = sign * pow(10.0, decibels / 20.0);
    Resonance { frequency, bandwidth: frequency / q, gain, is_velocity: true, sides }
}

/// The body of named resonances (frequency in Hz, quality factor, level in dB), whose signs take turns, and of dense ones. The loudest
/// named one is in phase with the input, to which a mix adds it.
fn body(named: &[[f64; 3]], dense: &[Dense]) -> BoxBody {
    let loudest = (0..named.len()).max_by(|a, b| named[*a][2].total_cmp(&named[*b][2])).unwrap_or(0);
    let sign = |n: usize| if n.abs_diff(loudest) % 2 == 0 { 1.0 } else { -1.0 };
    let named = named.iter().enumerate();
    let named = named.map(|(n, [frequency, q, decibels])| mode(*frequency, *q, *decibels, sign(n), 0.0));
    BoxBody::new(vec![named.chain(dense.iter().flat_map(Dense::modes)).collect()])
}

/// Air (A0), corpus (CBR, B1−, B1+) and plates: frequencies as J. Woodhouse's *Euphonics* (5.3) gives them, the hill of the bridge at
/// 2.4 kHz and the fall from 4 kHz on as G. Bissinger (2008) does. Quality factors and levels are estimates, within some 40 % and
/// 4 dB.
const VIOLIN: &[[f64; 3]] = &[
    [272.0, 20.0, -2.0],
    [407.0, 30.0, -14.0],
    [462.0, 35.0, 0.0],
    [551.0, 35.0, 0.0],
    [700.0, 35.0, -6.0],
    [820.0, 35.0, -9.0],
    [920.0, 35.0, -7.0],
];
const ABOVE_VIOLIN: Dense = Dense {
    from: 980.0,
    to: 9000.0,
    count: 57,
    q: &[(1000.0, 38.0), (1300.0, 30.0), (2400.0, 17.0), (4000.0, 9.0), (8000.0, 5.0)],
    level: &[
        (1000.0, -6.0),
        (1450.0, -10.0),
        (2000.0, -4.0),
        (2400.0, -2.0),
        (3000.0, -4.0),
        (3500.0, -5.0),
        (4500.0, -10.0),
        (6000.0, -16.0),
        (9000.0, -25.0),
    ],
    seed: 1,
};

/// Air, top and back of a classical guitar: frequencies as others quote them from O. Christensen and B. Vistisen (1980) and from
/// N. Fletcher and T. Rossing (1998, chapter 9). Quality factors and levels are estimates.
const GUITAR: &[[f64; 3]] = &[
    [98.0, 16.0, 0.0],
    [204.0, 22.0, 0.0],
    [240.0, 26.0, -5.0],
    [285.0, 28.0, -10.0],
    [385.0, 34.0, -7.0],
    [455.0, 36.0, -9.0],
    [550.0, 40.0, -9.0],
    [650.0, 44.0, -12.0],
];
const ABOVE_GUITAR: Dense = Dense {
    from: 700.0,
    to: 8000.0,
    count: 56,
    q: &[(700.0, 30.0), (1600.0, 16.0), (2600.0, 9.0), (5000.0, 5.0)],
    level: &[(700.0, -11.0), (1000.0, -12.0), (2000.0, -15.0), (3000.0, -18.0), (5000.0, -24.0), (8000.0, -30.0)],
    seed: 2,
};

/// The first modes, the mean spacing of 22 Hz below and the losses of 2 % are those that K. Ege, X. Boutillon and M. Rébillat
/// (2013) measured; above 1.1 kHz ribs divide the board, and a point of it has a fifth of the modes.
const LOW_SOUNDBOARD: Dense = Dense {
    from: 52.0,
    to: 490.0,
    count: 22,
    q: &[(50.0, 20.0), (200.0, 30.0), (490.0, 40.0)],
    level: &[(55.0, -10.0), (70.0, -4.0), (100.0, 0.0), (490.0, 0.0)],
    seed: 3,
};
const HIGH_SOUNDBOARD: Dense = Dense {
    from: 490.0,
    to: 10_000.0,
    count: 42,
    q: &[(490.0, 30.0), (1100.0, 22.0), (2000.0, 13.0), (4000.0, 6.5), (8000.0, 3.3)],
    level: &[(490.0, 0.0), (1000.0, 0.0), (2000.0, -1.0), (4000.0, -3.0), (8000.0, -7.0)],
    seed: 4,
};

/// Formants of a tenor who sings u, o, a, e, i: frequency in Hz and level in dB, from the tables in Csound's manual.
const VOWELS: [[[f64; 2]; 5]; 5] = [
    [[350.0, 0.0], [600.0, -20.0], [2700.0, -17.0], [2900.0, -14.0], [3300.0, -26.0]],
    [[400.0, 0.0], [800.0, -10.0], [2600.0, -12.0], [2800.0, -12.0], [3000.0, -26.0]],
    [[650.0, 0.0], [1080.0, -6.0], [2650.0, -7.0], [2900.0, -8.0], [3250.0, -22.0]],
    [[400.0, 0.0], [1700.0, -14.0], [2600.0, -12.0], [3200.0, -14.0], [3580.0, -20.0]],
    [[290.0, 0.0], [1870.0, -15.0], [2800.0, -18.0], [3250.0, -20.0], [3540.0, -30.0]],
];
/// Their bandwidths in Hz, which hardly depend on the vowel: the first three as B. Bogert (1953) measured them.
const BANDWIDTHS: [f64; 5] = [130.0, 100.0, 185.0, 200.0, 200.0];

/// The resonances of a vocal tract. The air at the lips follows that at the throat as a displacement, with signs in turn, as the
/// partial fractions of a chain of resonances have them.
fn tract(formants: [[f64; 2]; 5]) -> Vec<Resonance> {
    let formant = |(n, [frequency, decibels]): (usize, [f64; 2])| {
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        Resonance { is_velocity: false, ..mode(frequency, frequency / BANDWIDTHS[n], decibels, sign, 0.0) }
    };
    formants.into_iter().enumerate().map(formant).collect()
}

/// The formants of a trumpet as E. Sengpiel lists them, a fifth to an octave broad. Those of larger brass and of double reeds have
/// about the same ratios. Levels are estimates.
const HORN: &[[f64; 3]] = &[[450.0, 1.4, -10.0], [1200.0, 2.0, 0.0], [2500.0, 2.0, -5.0], [5000.0, 2.0, -12.0]];

static BODIES: LazyLock<[BoxBody; 5]> = LazyLock::new(|| {
    [
        body(VIOLIN, &[ABOVE_VIOLIN]),
        body(GUITAR, &[ABOVE_GUITAR]),
        body(&[], &[LOW_SOUNDBOARD, HIGH_SOUNDBOARD]),
        BoxBody::new(VOWELS.map(tract).into()),
        body(HORN, &[]),
    ]
});
