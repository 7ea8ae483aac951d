//! What may be wrong with recordings that are given together.

use super::layers::{Layer, SAME_KEY};
use super::pitch::{key_name, wrong_key};
use super::take::Take;
use crate::analysis::level::{dbfs, peak};

/// Distance below which two velocities of 0–1 are the same.
const SAME_VELOCITY: f64 = 0.5 / 127.0;

/// Least number of dB beyond full scale that is told.
const WORTH_TELLING_DB: f64 = 0.05;

/// Peak of a recording in full scale.
fn peak_of(take: &Take) -> f64 {
    take.recording.channels.iter().map(|channel| peak(channel)).fold(0.0, f64::max)
}

/// The factor that brings the loudest of some takes to full scale; 1 if none is beyond it.
pub(super) fn gain_to_full_scale(takes: &[Take]) -> f64 {
    1.0 / takes.iter().map(peak_of).fold(1.0, f64::max)
}

/// Warnings of takes that are beyond full scale, have another pitch than their key, or the key and velocity of another one.
pub(super) fn of_takes(takes: &[Take], layers: &[Layer]) -> Vec<String> {
    let loudest = takes.iter().max_by(|a, b| peak_of(a).total_cmp(&peak_of(b)));
    let beyond = loudest.map(|take| (take, dbfs(peak_of(take)))).filter(|(_, db)| *db > WORTH_TELLING_DB);
    let softer = if takes.len() > 1 { "all are" } else { "it is" };
    let too_loud = beyond.map(|(take, db)| {
        format!("{}: it peaks {db:.1} dB above full scale: {softer} fitted {db:.1} dB softer", take.name)
    });
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
    too_loud.into_iter().chain(wrong).chain(twice).collect()
}

#[cfg(test)]
mod tests {
    use super::super::correct::tests::draft;
    use super::super::draft::Draft;
    use super::super::take::{Prepared, VELOCITY};
    use super::*;
    use crate::io::sound_file::Recording;

    /// A take of some peak, as it is prepared, and its layer of some velocity.
    fn given(name: &str, peak: f32, velocity: f64) -> (Take, Layer) {
        let samples = (0..4800).map(|n| peak * libm::cosf(0.06 * n as f32)).collect();
        let recording =
            Recording { sample_rate: 48_000, channels: vec![samples], encoding: String::new(), warnings: Vec::new() };
        let take = Take { name: name.to_owned(), recording, key: None, velocity: VELOCITY };
        (take, Layer { draft: Draft { velocity, ..draft([0.5, 0.1]) }, level: 0.1 })
    }

    #[test]
    fn takes_that_are_alike_or_too_loud_are_doubted() {
        let (takes, layers): (Vec<Take>, Vec<Layer>) =
            [given("a", 0.5, 0.5), given("b", 2.0, 1.0), given("c", 0.5, 0.5)].into_iter().unzip();
        let gain = gain_to_full_scale(&takes);
        assert_eq!(gain, 0.5);
        let peak = Prepared::new(&takes[1], gain).unwrap().peak();
        assert!(peak < 1.01, "{peak}");
        let doubts = of_takes(&takes, &layers);
        assert!(
            doubts[0].starts_with("b: it peaks 6.0 dB above full scale: all are fitted 6.0 dB softer"),
            "{doubts:?}"
        );
        assert!(doubts[1].starts_with("c: it has the key and velocity of a (") && doubts.len() == 2, "{doubts:?}");
        assert_eq!(of_takes(&takes[..1], &layers[..1]), [""; 0]);
    }
}
