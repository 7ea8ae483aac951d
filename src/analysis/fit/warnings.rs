//! Warnings of recordings and of what was made of them.

use super::draft::{Draft, Partial};
use super::layers::{Layer, SAME_KEY};
use super::pitch::{key_name, wrong_key};
use super::take::Take;
use crate::analysis::level::dbfs;
use crate::analysis::modes::Strike;

/// Distance below which two velocities of 0–1 are the same.
const SAME_VELOCITY: f64 = 0.5 / 127.0;

/// Least number of dB that is told by which takes are softer. Recordings often reach full scale, 0.9 dB above the limiter's threshold.
const WORTH_TELLING_DB: f64 = 1.0;

/// A warning that takes are fitted softer than they are: by this gain.
pub(super) fn softer(takes: &[Take], gain: f64) -> Option<String> {
    let db = -dbfs(gain);
    let which = match takes {
        [take] => format!("{}: it is", take.name),
        _ => "the recordings are".to_owned(),
    };
    (db > WORTH_TELLING_DB).then(|| {
        format!("{which} fitted {db:.1} dB softer: expected peaks below full scale, which the limiter lets pass")
    })
}

/// Warnings of takes that have another pitch than their key, or the key and velocity of another one.
pub(super) fn of_takes(takes: &[Take], layers: &[Layer]) -> Vec<String> {
    let named = takes.iter().zip(layers);
    let with_key = named.clone().filter(|(take, _)| take.key.is_some());
    let wrong = with_key.filter_map(|(take, layer)| wrong_key(&layer.draft, &take.name));
    let is_same = |a: &Layer, b: &Layer| {
        (a.key() - b.key()).abs() < SAME_KEY && (a.draft.velocity - b.draft.velocity).abs() < SAME_VELOCITY
    };
    let twice = named.clone().enumerate().filter_map(|(n, (take, layer))| {
        let (first, _) = named.clone().take(n).find(|(_, first)| is_same(first, layer))?;
        let (key, velocity) = (key_name(layer.key().round()), (127.0 * layer.draft.velocity).round());
        Some(format!(
            "{}: it has the key and velocity of {} ({key} at velocity {velocity}), and a preset plays both alike: expected those that \
             they were played with",
            take.name, first.name
        ))
    });
    wrong.chain(twice).collect()
}

/// Residual of a strike in dB below which its tones are believed.
const EXPLAINED_DB: f64 = -20.0;
/// Distance in Hz from a tone and T60 in seconds of a mode that plays hum, and its least amplitude relative to the loudest mode: −60 dB.
const NEAR: f64 = 1.0;
const LASTS: f64 = 20.0;
const HEARD: f64 = 1e-3;

/// A warning of a tone, such as hum, that goes on while a stroke falls, and that a mode of the draft plays.
pub(super) fn hum(take: &Take, draft: &Draft, strike: &Strike) -> Option<String> {
    if draft.is_held || strike.residual_db > EXPLAINED_DB {
        return None;
    }
    let amplitude = |partial: &Partial| partial.amplitude.abs();
    let loudest = draft.partials.iter().map(amplitude).fold(0.0, f64::max);
    let plays = |frequency: f64| {
        let mut lasting = draft.partials.iter().filter(|partial| partial.struck && partial.t60 > LASTS);
        lasting.any(|partial| (partial.frequency - frequency).abs() < NEAR && amplitude(partial) > HEARD * loudest)
    };
    let frequency = strike.steady.iter().map(|tone| tone.frequency).find(|frequency| plays(*frequency))?;
    Some(format!("{}: a tone of {frequency:.2} Hz does not decay, and the preset plays it: expected no hum", take.name))
}

/// Distance in dB above which a preset hardly sounds like its recording.
const FAR_DB: f64 = 6.0;

/// Warnings of takes that the preset is far from: it has the sound of take `base`, and a body if there is one.
pub(super) fn of_distances(takes: &[Take], distances: &[f64], base: usize, has_body: bool) -> Vec<String> {
    let far = takes.iter().zip(distances).enumerate().filter(|(_, (_, distance))| **distance > FAR_DB);
    let warning = |(n, (take, distance)): (usize, (&Take, &f64))| {
        let expected = match (n == base, has_body) {
            (false, _) => "expected strokes on one instrument that differ in key and velocity only",
            (true, false) => "expected a dry stroke that rings, no speech, vibrato or phrase",
            (true, true) => "expected the sound of such a body alone; a table of modes may come nearer",
        };
        format!("{}: the preset is {distance:.1} dB from it: {expected}", take.name)
    };
    far.map(warning).collect()
}

#[cfg(test)]
mod tests {
    use super::super::correct::tests::draft;
    use super::super::start::tests::mode;
    use super::super::take::VELOCITY;
    use super::*;
    use crate::analysis::modes::Mode;
    use crate::io::sound_file::Recording;

    fn take(name: &str) -> Take {
        let recording =
            Recording { sample_rate: 48_000, channels: Vec::new(), encoding: String::new(), warnings: Vec::new() };
        Take { name: name.to_owned(), recording, key: None, velocity: VELOCITY }
    }

    #[test]
    fn takes_that_are_alike_are_doubted() {
        let takes = ["a", "b", "c"].map(take);
        let layers = [0.5, 1.0, 0.5].map(|velocity| Layer {
            draft: Draft { velocity, ..draft([0.5, 0.1]) },
            level: 0.1,
            t60: 1.0,
        });
        let warnings = of_takes(&takes, &layers);
        assert!(
            warnings[0].starts_with("c: it has the key and velocity of a (") && warnings.len() == 1,
            "{warnings:?}"
        );
        assert_eq!(of_takes(&takes[..2], &layers[..2]), [""; 0]);
    }

    #[test]
    fn hum_is_told_if_a_mode_plays_it() {
        let strike = Strike {
            onset: 0.0,
            damped: None,
            seconds: 1.0,
            steady: [50.0, 100.0].map(|frequency| Mode { frequency, ..mode(0.0, 0.1) }).to_vec(),
            groups: Vec::new(),
            modes: Vec::new(),
            residual_db: -60.0,
            samples: Vec::new(),
            residual: Vec::new(),
            fitted_from: 0.0,
        };
        let partial = |frequency, t60, amplitude| Partial { frequency, t60, amplitude, ..draft([0.5; 2]).partials[0] };
        let told = |hum| {
            let partials = vec![partial(440.0, 1.0, 0.5), hum];
            super::hum(&take("a"), &Draft { partials, ..draft([0.5; 2]) }, &strike)
        };
        assert!(told(partial(100.1, 60.0, 0.01)).unwrap().starts_with("a: a tone of 100.00 Hz does not decay"));
        for other in [partial(100.1, 3.7, 0.01), partial(100.1, 60.0, 1e-4), partial(103.0, 60.0, 0.01)] {
            assert_eq!(told(other), None);
        }
    }

    #[test]
    fn what_is_made_softer_and_what_is_far_is_told() {
        let takes = ["a", "b"].map(take);
        assert_eq!((softer(&takes, 1.0), softer(&takes, 0.9)), (None, None));
        assert!(softer(&takes, 0.25).unwrap().starts_with("the recordings are fitted 12.0 dB softer"));
        assert!(softer(&takes[..1], 0.25).unwrap().starts_with("a: it is fitted 12.0 dB softer"));
        let far = |distances, has_body| of_distances(&takes, distances, 1, has_body);
        assert_eq!(far(&[1.0, 5.9], false), [""; 0]);
        let warnings = far(&[7.0, 8.04], true);
        assert!(warnings[0].starts_with("a: the preset is 7.0 dB from it: expected strokes on one"), "{warnings:?}");
        assert!(warnings[1].starts_with("b: the preset is 8.0 dB from it: expected the sound of such"), "{warnings:?}");
        assert!(far(&[7.0, 8.0], false)[1].contains("expected a dry stroke"));
    }
}
