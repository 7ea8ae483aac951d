//! Checks that every factory preset sounds like its name: pitch, partials, decay, attack, brightness, level and end.

use sprung::analysis::level::{dbfs, peak};
use sprung::analysis::spectrum::{Spectrum, peaks, spectrum};
use sprung::engine::{Ensemble, Event, EventKind};
use sprung::patch::Patch;
use sprung::preset::Preset;

const RATE: f64 = 48_000.0;

/// Properties of a note with velocity 100. Ranges are from–to, both inclusive.
struct Promise {
    preset: &'static str,
    key: u8,
    /// Seconds until the key is released.
    held: f64,
    /// Frequency of ratio 1 in Hz, ratios that must be audible, and the time in seconds from which they are (after any
    /// sweep).
    pitch: (f64, &'static [f64], f64),
    /// T60 measured over the first 20 dB, in seconds.
    t60: (f64, f64),
    /// Time of the loudest moment, in ms.
    attack: (f64, f64),
    /// Spectral centroid of the first half second, in Hz.
    centroid: (f64, f64),
    /// Time after which the level stays 60 dB below the peak, in seconds.
    gone: f64,
}

const fn promise(
    preset: &'static str,
    (key, held): (u8, f64),
    pitch: (f64, &'static [f64], f64),
    t60: (f64, f64),
    attack: (f64, f64),
    centroid: (f64, f64),
    gone: f64,
) -> Promise {
    Promise { preset, key, held, pitch, t60, attack, centroid, gone }
}

/// For sounds without a promised pitch.
const NOISE: (f64, &[f64], f64) = (0.0, &[], 0.0);

#[rustfmt::skip]
const PROMISES: &[Promise] = &[
    //       preset            key, held     ratio 1 in Hz, ratios, from      T60           attack, ms      centroid, Hz      gone by, s
    promise("init",           (60, 2.0),  (261.63, &[1.0], 0.0),            (0.98, 1.02),  (0.0, 5.0),    (255.0, 270.0),    1.1),
    promise("Kick",           (60, 0.1),  (55.0, &[1.0], 0.09),             (0.3, 0.5),    (0.0, 10.0),   (70.0, 200.0),     0.5),
    promise("Deep Kick",      (60, 0.1),  (42.0, &[1.0], 0.13),             (0.9, 1.2),    (0.0, 25.0),   (40.0, 90.0),      1.3),
    promise("Click Kick",     (60, 0.1),  (68.0, &[1.0], 0.04),             (0.15, 0.3),   (0.0, 10.0),   (100.0, 400.0),    0.3),
    promise("Long Kick",      (60, 0.1),  (65.41, &[1.0], 0.07),            (2.9, 3.4),    (0.0, 25.0),   (60.0, 85.0),      3.5),
    promise("Low Tom",        (60, 0.1),  (92.0, &[1.0, 1.5933], 0.16),     (0.5, 1.0),    (0.0, 15.0),   (90.0, 200.0),     1.0),
    promise("High Tom",       (60, 0.1),  (185.0, &[1.0, 1.5933], 0.11),    (0.3, 0.65),   (0.0, 15.0),   (180.0, 400.0),    0.7),
    promise("Snare",          (60, 0.1),  (185.0, &[1.0], 0.03),            (0.15, 0.4),   (0.0, 20.0),   (1200.0, 4000.0),  0.35),
    promise("Tight Snare",    (60, 0.1),  (255.0, &[1.0], 0.02),            (0.08, 0.25),  (0.0, 20.0),   (1800.0, 5000.0),  0.25),
    promise("Closed Hat",     (60, 0.1),  NOISE,                            (0.05, 0.15),  (0.0, 12.0),   (5000.0, 10000.0), 0.2),
    promise("Open Hat",       (60, 0.1),  NOISE,                            (0.7, 1.3),    (0.0, 40.0),   (5000.0, 10000.0), 1.5),
    promise("Clap",           (60, 0.1),  NOISE,                            (0.08, 0.25),  (0.0, 30.0),   (900.0, 2500.0),   0.3),
    promise("Rim",            (60, 0.1),  (430.0, &[1.0, 1.93], 0.0),       (0.03, 0.09),  (0.0, 6.0),    (600.0, 1800.0),   0.12),
    promise("Cowbell",        (60, 0.1),  (540.0, &[1.0, 1.4815], 0.0),     (0.4, 0.55),   (0.0, 10.0),   (550.0, 900.0),    0.6),
    promise("Woodblock",      (60, 0.1),  (880.0, &[1.0, 1.47], 0.0),       (0.07, 0.13),  (0.0, 6.0),    (850.0, 1400.0),   0.15),
    promise("Clave",          (60, 0.1),  (2400.0, &[1.0, 2.756], 0.0),     (0.08, 0.12),  (0.0, 6.0),    (2350.0, 2900.0),  0.12),
    promise("Shaker",         (60, 0.1),  NOISE,                            (0.05, 0.25),  (0.0, 40.0),   (4500.0, 8500.0),  0.2),
    promise("Triangle",       (60, 0.1),  NOISE,                            (1.5, 4.5),    (0.0, 40.0),   (3000.0, 8000.0),  4.5),
    promise("Blip",           (72, 1.0),  (523.25, &[1.0], 0.0),            (0.09, 0.12),  (0.0, 6.0),    (500.0, 550.0),    0.12),
    promise("Zap",            (60, 1.0),  (65.41, &[1.0], 0.13),            (0.4, 0.5),    (0.0, 10.0),   (300.0, 1200.0),   0.5),
    promise("Laser",          (60, 1.0),  (130.81, &[1.0, 2.005], 0.42),    (0.8, 1.1),    (0.0, 40.0),   (900.0, 2500.0),   1.1),
    promise("Droplet",        (60, 1.0),  (523.25, &[1.0], 0.11),           (0.14, 0.2),   (0.0, 6.0),    (180.0, 400.0),    0.2),
    promise("Sine Lead",      (69, 3.0),  (440.0, &[1.0], 0.0),             (3.0, 25.0),   (0.0, 10.0),   (430.0, 450.0),    3.3),
    promise("Sub Bass",       (36, 2.0),  (65.41, &[1.0, 2.0, 3.0], 0.0),   (1.5, 8.5),    (0.0, 25.0),   (60.0, 80.0),      2.3),
    promise("Pluck Bass",     (36, 3.0),  (65.41, &[1.0, 2.0, 3.0, 5.0], 0.0), (4.0, 7.0), (0.0, 40.0),   (90.0, 250.0),     3.3),
    promise("Plucked String", (52, 3.0),  (164.81, &[1.0, 2.0, 3.0, 4.0, 5.0], 0.0), (2.0, 5.5), (0.0, 40.0), (200.0, 500.0),  3.3),
    promise("Swell",          (60, 3.0),  (261.63, &[1.0, 2.0], 0.0),       (1.0, 9.0),    (150.0, 2000.0), (250.0, 600.0),  5.0),
    promise("Marimba",        (60, 0.5),  (261.63, &[1.0, 3.92, 9.24], 0.0), (1.3, 1.6),   (0.0, 12.0),   (255.0, 400.0),    1.7),
    promise("Vibraphone",     (65, 6.0),  (349.23, &[1.0, 4.0, 10.1], 0.0), (5.0, 8.0),    (0.0, 12.0),   (340.0, 500.0),    6.5),
    promise("Xylophone",      (72, 0.5),  (523.25, &[1.0, 3.0, 6.02], 0.0), (0.4, 0.6),    (0.0, 8.0),    (550.0, 1200.0),   0.6),
    promise("Glockenspiel",   (84, 0.5),  (1046.5, &[1.0, 2.756, 5.404], 0.0), (2.3, 3.6), (0.0, 10.0),   (1050.0, 2200.0),  3.8),
    promise("Kalimba",        (67, 0.5),  (392.0, &[1.0, 6.2669], 0.0),     (1.2, 2.1),    (0.0, 12.0),   (380.0, 600.0),    2.2),
    promise("Music Box",      (84, 0.5),  (1046.5, &[1.0, 6.2669], 0.0),    (1.0, 1.8),    (0.0, 10.0),   (1050.0, 1800.0),  2.0),
    promise("Chimes",         (65, 0.5),  (349.23, &[1.2099, 2.0, 2.9877, 4.1729], 0.0), (3.0, 7.0), (0.0, 40.0), (700.0, 1500.0), 8.0),
    promise("Timpani",        (45, 0.5),  (110.0, &[1.0, 1.51, 1.99, 2.44, 2.89], 0.25), (2.0, 5.0), (0.0, 15.0), (110.0, 250.0), 5.5),
    promise("Membrane",       (60, 0.5),  (130.81, &[1.0, 1.5933, 2.1355, 2.6531, 2.9173], 0.15), (0.5, 1.4), (0.0, 25.0), (150.0, 500.0), 1.4),
    promise("Free Bar",       (60, 0.5),  (261.63, &[1.0, 2.7565, 3.75, 8.933], 0.0), (3.5, 5.5), (0.0, 40.0), (400.0, 1500.0), 5.5),
    promise("Church Bell",    (60, 0.5),  (261.63, &[0.5, 1.0, 1.183, 1.506, 2.0, 2.514, 3.011, 4.166, 5.433], 0.0), (6.0, 25.0), (0.0, 60.0), (350.0, 900.0), 25.0),
    promise("Gong",           (60, 0.5),  (65.41, &[1.0, 1.7235, 2.3269, 3.8984], 0.5), (4.0, 11.0), (30.0, 600.0), (300.0, 1200.0), 12.0),
    promise("Wine Glass",     (76, 0.5),  (659.26, &[1.0, 2.8284, 5.4233], 0.0), (2.0, 3.5), (0.0, 15.0),  (700.0, 1500.0),   3.5),
    promise("Tam-Tam",        (60, 0.5),  (65.41, &[1.0], 0.5),             (6.0, 14.0),   (0.0, 800.0),  (60.0, 400.0),     13.5),
    promise("Opera Gong",     (60, 0.5),  (261.63, &[1.7407], 0.8),         (1.2, 2.8),    (0.0, 60.0),   (350.0, 1500.0),   2.8),
    promise("Floor Tom",      (60, 0.1),  (82.0, &[1.0, 1.5933], 0.3),      (0.5, 1.3),    (0.0, 25.0),   (70.0, 300.0),     1.2),
    promise("Slack String",   (60, 3.0),  (261.63, &[1.0, 2.0, 3.0, 4.0], 1.5), (3.0, 6.5), (0.0, 40.0),  (300.0, 800.0),    3.4),
    promise("Resonator Marimba", (60, 0.5), (261.63, &[1.0, 4.0], 0.0),       (0.8, 1.2),  (0.0, 120.0),  (255.0, 500.0),    1.5),
    promise("Guitar",         (52, 3.0),  (164.81, &[1.0, 2.0, 3.0], 0.0),  (3.0, 6.0),    (0.0, 60.0),   (150.0, 700.0),    5.0),
    promise("Shell Tom",      (60, 0.1),  (110.0, &[1.0, 1.5933], 0.16),    (0.4, 1.0),    (0.0, 25.0),   (100.0, 500.0),    1.2),
];

/// Range of the peak of a note with velocity 100, in dBFS.
const PEAK: (f64, f64) = (-15.0, -6.0);

/// Maximum deviation of a partial from its promised frequency, in cents: slightly more than the widest split pair.
const CENTS: f64 = 15.0;

/// A partial must be the highest spectral peak within this frequency ratio.
const NEIGHBOURHOOD: f64 = 1.04;

struct Stereo {
    left: Vec<f32>,
    right: Vec<f32>,
}

impl Stereo {
    fn mono(&self) -> Vec<f32> {
        self.left.iter().zip(&self.right).map(|(left, right)| 0.5 * (left + right)).collect()
    }

    fn peak(&self) -> f64 {
        dbfs(peak(&self.left).max(peak(&self.right)))
    }

    /// Energy of each frame.
    fn energy(&self) -> Vec<f64> {
        let square = |x: &f32| f64::from(*x) * f64::from(*x);
        self.left.iter().zip(&self.right).map(|(left, right)| square(left) + square(right)).collect()
    }
}

fn note(channel: u8, key: u8, on: bool, velocity: f32) -> Event {
    let kind = if on {
        EventKind::NoteOn { key, detune: 0.0, velocity: velocity / 127.0, id: None }
    } else {
        EventKind::NoteOff { key, velocity: 0.5, id: None }
    };
    Event { frame: 0, channel, kind }
}

fn play(patch: &Patch, keys: &[u8], velocity: f32, held: f64, seconds: f64) -> Stereo {
    let mut ensemble = Ensemble::new(RATE, 1, patch, &[]);
    let (frames, off) = ((seconds * RATE) as usize, (held * RATE) as usize);
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    let events = |on| keys.iter().map(|key| note(0, *key, on, velocity)).collect::<Vec<_>>();
    ensemble.process(&events(true), &mut left[..off], &mut right[..off]);
    ensemble.process(&events(false), &mut left[off..], &mut right[off..]);
    Stereo { left, right }
}

/// Spectrum of half a second from `start`, with a window that is highest at its start, so that the attack counts fully.
fn onset_spectrum(mono: &[f32], start: f64) -> Spectrum {
    let (start, half) = ((start * RATE) as usize, (0.5 * RATE) as usize);
    let mut samples = vec![0.0; half];
    samples.extend_from_slice(&mono[start..(start + half).min(mono.len())]);
    samples.resize(2 * half, 0.0);
    spectrum(&samples, RATE)
}

fn centroid(mono: &[f32]) -> f64 {
    let spectrum = onset_spectrum(mono, 0.0);
    let power = spectrum.levels.iter().map(|level| libm::exp10(level / 10.0));
    let (moment, sum) = power.enumerate().fold((0.0, 0.0), |(moment, sum), (bin, power)| {
        (moment + power * bin as f64 * spectrum.bin_width, sum + power)
    });
    moment / sum
}

/// T60 by Schroeder's backward integration, from −5 to −25 dB.
fn t60(energy: &[f64]) -> f64 {
    let mut left = energy.to_vec();
    for n in (0..left.len() - 1).rev() {
        left[n] += left[n + 1];
    }
    let falls_to = |db: f64| left.partition_point(|energy| *energy > left[0] * libm::exp10(db / 10.0)) as f64;
    (falls_to(-25.0) - falls_to(-5.0)) / RATE * 3.0
}

/// The end of the 3 ms that have the most energy, in ms.
fn attack(energy: &[f64]) -> f64 {
    let window = (0.003 * RATE) as usize;
    let sums: Vec<f64> = energy.windows(window).map(|window| window.iter().sum()).collect();
    let loudest = (0..sums.len()).max_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap();
    (loudest + window) as f64 / RATE * 1e3
}

/// The last time at which the sound is within 60 dB of its peak, in seconds.
fn last_heard(energy: &[f64]) -> f64 {
    let most = energy.iter().fold(0.0, |most: f64, energy| most.max(*energy));
    energy.iter().rposition(|energy| *energy > most * 1e-6).unwrap_or(0) as f64 / RATE
}

/// Promised partials that are missing.
fn missing_partials(mono: &[f32], (base, ratios, start): (f64, &[f64], f64)) -> Vec<String> {
    let spectrum = onset_spectrum(mono, start);
    let found = peaks(&spectrum, -100.0);
    let missing = |ratio: &f64| {
        let promised = base * ratio;
        let near = |frequency: f64| frequency < promised * NEIGHBOURHOOD && frequency > promised / NEIGHBOURHOOD;
        // The loudest first.
        match found.iter().find(|peak| near(peak.frequency)) {
            None => Some(format!("no partial near {promised:.1} Hz")),
            Some(peak) => {
                let cents = 1200.0 * libm::log2(peak.frequency / promised);
                (cents.abs() > CENTS).then(|| format!("{promised:.1} Hz is off by {cents:.1} ct"))
            }
        }
    };
    ratios.iter().filter_map(missing).collect()
}

/// The promises that are not kept.
fn breaches(promise: &Promise, patch: &Patch) -> Vec<String> {
    let sound = play(patch, &[promise.key], 100.0, promise.held, promise.gone.max(promise.held) + 2.0);
    let (mono, energy) = (sound.mono(), sound.energy());
    let mut breaches = missing_partials(&mono, promise.pitch);
    for (what, value, (from, to)) in [
        ("peak, dBFS", sound.peak(), PEAK),
        ("T60, s", t60(&energy), promise.t60),
        ("attack, ms", attack(&energy), promise.attack),
        ("centroid, Hz", centroid(&mono), promise.centroid),
        ("last heard, s", last_heard(&energy), (0.0, promise.gone)),
    ] {
        if !(from..=to).contains(&value) {
            breaches.push(format!("{what}: {value:.3} is not from {from} to {to}"));
        }
    }
    breaches
}

#[test]
fn every_preset_keeps_its_promises() {
    let promised: Vec<&str> = PROMISES.iter().map(|promise| promise.preset).collect();
    let presets: Vec<&str> = Preset::factory().iter().map(|preset| preset.name.as_str()).collect();
    assert_eq!(promised, presets, "each factory preset has a row, in order");
    let mut broken = Vec::new();
    for (promise, preset) in PROMISES.iter().zip(Preset::factory()) {
        for breach in breaches(promise, &preset.patch) {
            broken.push(format!("{}: {breach}", preset.name));
        }
    }
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

#[test]
fn a_broken_preset_is_noticed() {
    use sprung::params::Param;
    let clave = PROMISES.iter().find(|promise| promise.preset == "Clave").unwrap();
    let patch = Preset::find("Clave").unwrap().patch.clone();
    for (param, factor, word) in [
        (Param::Tune, 1.01, "Hz is off"),
        (Param::Decay, 2.0, "T60"),
        (Param::Decay, 2.0, "last heard"),
        (Param::Gain, -3.0, "peak"),
        (Param::Tune, 0.5, "centroid"),
    ] {
        let changed = patch.clone().with(param, patch.get(param) * factor);
        let breaches = breaches(clave, &changed);
        assert!(breaches.iter().any(|breach| breach.contains(word)), "{param:?} × {factor}: {breaches:?}");
    }
}

#[test]
fn quiet_notes_are_quieter_and_chords_bearable() {
    for (promise, preset) in PROMISES.iter().zip(Preset::factory()) {
        let peak = |keys: &[u8], velocity| play(&preset.patch, keys, velocity, 0.5, 1.5).peak();
        let key = promise.key;
        let (full, soft) = (peak(&[key], 100.0), peak(&[key], 40.0));
        assert!((6.0..25.0).contains(&(full - soft)), "{}: {full:.1} dBFS, softly {soft:.1}", preset.name);
        let chord = peak(&[0, 4, 7, 11, 14, 18, 21, 26].map(|interval| key + interval), 100.0);
        assert!(chord < 12.0, "{}: eight notes peak at {chord:.1} dBFS", preset.name);
    }
}

#[test]
fn a_closed_hat_chokes_an_open_one() {
    let [open, closed] = ["Open Hat", "Closed Hat"].map(|name| Preset::find(name).unwrap().patch.clone());
    let mut ensemble = Ensemble::new(RATE, 1, &open, &[closed]);
    let (mut left, mut right) = (vec![0.0; 9_600], vec![0.0; 9_600]);
    let mut energy = |events: &[Event]| {
        ensemble.process(events, &mut left, &mut right);
        left.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>()
    };
    energy(&[note(0, 60, true, 100.0)]);
    let ringing = energy(&[]);
    // As quiet as possible, so that only the open hi-hat remains.
    energy(&[Event { frame: 0, channel: 1, kind: EventKind::Program(0) }, note(1, 60, true, 1.0)]);
    let choked = energy(&[]);
    assert!(choked < ringing * 1e-5, "{choked} of {ringing} is left");
}
