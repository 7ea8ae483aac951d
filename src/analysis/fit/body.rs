//! Finds the physical body, with its numbers, that explains the modes of a sound best.

use super::draft::{Draft, Partial, digits};
use super::levels::{Levels, weight};
use super::start::at_onset;
use crate::analysis::line::Line;
use crate::analysis::modes::{Mode, Strike};
use crate::params::Param;
use crate::patch::Patch;
use crate::preset::modes_of_body;
use crate::sound::bodies::{Body, BodyMode, FIELDS, LN_1000, Loss, Model, Pitch};
use libm::{fabs, log2, log10, pow};

/// Models of each family.
const STRINGS: &[&str] = &["string"];
const BARS: &[&str] = &["free_bar", "marimba", "vibraphone", "xylophone", "tine"];
const MEMBRANES: &[&str] = &["membrane", "timpani"];
const PLATES: &[&str] = &["plate", "free_plate", "disc", "free_disc"];
const BELLS: &[&str] = &["church_bell", "hand_bell", "tubular_bell", "glass", "bowl"];
/// Values that are tried: stiffnesses of strings, aspect ratios of plates, and slendernesses of glasses.
const STIFFNESSES: [f64; 12] = [0.0, 1e-5, 3e-5, 6e-5, 1e-4, 2e-4, 4e-4, 8e-4, 1.5e-3, 3e-3, 6e-3, 1.2e-2];
const ASPECTS: [f64; 13] = [1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 2.0, 2.25, 2.5, 3.0];
const SLENDERNESSES: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 5.0];
/// Distance in cents below which a partial counts as a mode of the model.
const NEAR: f64 = 60.0;
/// Distance in cents below which a mode that was found twice counts as the same.
const SAME: f64 = 5.0;
/// Number of partials, and number of the body's lowest modes, that are put on each other in turn.
const PLACED: usize = 5;
const LOWEST: usize = 6;
/// Number of modes of a body.
const MODES: usize = 48;

/// The kind of body that is to explain a sound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Family {
    /// No body, but a table of the modes as they were found.
    #[default]
    Table,
    /// A string.
    String,
    /// A bar: free, tuned, or clamped at one end.
    Bar,
    /// A drum head or a kettledrum.
    Membrane,
    /// A plate or a disc.
    Plate,
    /// A bell, a glass or a bowl.
    Bell,
}

impl Family {
    /// All families, with their names in commands.
    pub const ALL: [(&'static str, Family); 6] = [
        ("table", Family::Table),
        ("string", Family::String),
        ("bar", Family::Bar),
        ("membrane", Family::Membrane),
        ("plate", Family::Plate),
        ("bell", Family::Bell),
    ];

    fn models(self) -> &'static [&'static str] {
        match self {
            Self::Table => &[],
            Self::String => STRINGS,
            Self::Bar => BARS,
            Self::Membrane => MEMBRANES,
            Self::Plate => PLATES,
            Self::Bell => BELLS,
        }
    }
}

/// How well a body explains a sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Explained {
    /// The model's name in presets.
    pub model: &'static str,
    /// Mean distance in cents of the modes from the model's, weighted by what is heard of them: amplitude and T60.
    pub cents: f64,
    /// Number of modes of the sound that are modes of the model, and number of all modes of the sound.
    pub modes: (usize, usize),
    /// Energy of the modes that are no modes of the model, in dB relative to all modes.
    pub unexplained_db: f64,
}

/// A model compared with the partials.
struct Match {
    body: Body,
    /// For each partial the mode of the model that it is, and its distance from that in cents.
    pairs: Vec<Option<(BodyMode, f64)>>,
    score: f64,
}

/// The bodies of a model, one for each tried value of the number that sets its ratios.
fn variants(model: &Model) -> Vec<Body> {
    let with = |name: &str, values: &[f64]| {
        let field = FIELDS.iter().find(|field| field.name == name);
        let body = |value: &f64| {
            let mut body = Body { modes: MODES, ..Body::new(model.clone()) };
            if let Some(field) = field {
                (field.set)(&mut body, *value);
            }
            body
        };
        values.iter().map(body).collect()
    };
    match model {
        Model::String => with("inharmonicity", &STIFFNESSES),
        Model::Plate { .. } => with("aspect", &ASPECTS),
        Model::Glass { .. } => with("slenderness", &SLENDERNESSES),
        _ => with("inharmonicity", &[0.0]),
    }
}

fn lay(body: &Body, frequency: f64, partials: &[Partial]) -> Match {
    let body = Body { pitch: Pitch::Frequency(frequency), ..body.clone() };
    let modes = body.modes();
    let mut score = 0.0;
    let pair = |partial: &Partial| {
        let cents: Vec<f64> = modes.iter().map(|mode| 1200.0 * log2(partial.frequency / mode.frequency)).collect();
        let (nearest, off) = modes.iter().zip(&cents).min_by(|a, b| fabs(*a.1).total_cmp(&fabs(*b.1)))?;
        score -= weight(partial) * by_chance(&cents);
        (fabs(*off) < NEAR).then(|| {
            score += weight(partial) * (1.0 - (off / NEAR) * (off / NEAR));
            (*nearest, *off)
        })
    };
    let pairs: Vec<_> = partials.iter().map(pair).collect();
    // A mode of the model that should sound below the highest partial, but is no partial, lowers the score.
    let highest = partials.iter().map(|partial| partial.frequency).fold(0.0, f64::max);
    let missing = modes
        .iter()
        .filter(|mode| mode.frequency < highest && mode.strike != 0.0)
        .filter(|mode| !pairs.iter().flatten().any(|(met, _)| met.frequency == mode.frequency));
    let mean = partials.iter().map(weight).sum::<f64>() / partials.len().max(1) as f64;
    let score = score - 0.08 * mean * missing.count() as f64;
    Match { body, pairs, score }
}

/// The mean score of a partial anywhere between the two modes around it, from the distances of all modes in cents: where modes are
/// dense, one is near any partial, which means nothing.
fn by_chance(cents: &[f64]) -> f64 {
    let (below, above) = cents.iter().fold((f64::INFINITY, f64::INFINITY), |(below, above), off| {
        if *off < 0.0 { (below, above.min(-off)) } else { (below.min(*off), above) }
    });
    // Within NEAR of a mode the mean of the score is two thirds.
    (2.0 / 3.0) * (2.0 * NEAR / (below + above)).min(1.0)
}

/// The mode that is a partial of this frequency in Hz. The frequencies differ if the partial was found later in the sound.
fn nearest(modes: &[Mode], frequency: f64) -> Option<&Mode> {
    let off = |mode: &&Mode| fabs(1200.0 * log2(mode.frequency / frequency));
    modes.iter().min_by(|a, b| off(a).total_cmp(&off(b))).filter(|mode| off(mode) < SAME)
}

/// Finds the body of a family that explains a draft best, given the strike in which its modes were found. None without
/// modes.
pub(super) fn find(draft: &Draft, strike: Option<&Strike>, family: Family) -> Option<(Body, Levels, Explained)> {
    let mut partials: Vec<Partial> = draft.partials.iter().copied().filter(|partial| partial.struck).collect();
    // The draft's amplitudes were corrected by bands. Levels of single modes are needed here: those that were found.
    for partial in &mut partials {
        let own = strike.and_then(|strike| Some((nearest(&strike.modes, partial.frequency)?, strike)));
        partial.amplitude =
            own.map_or(partial.amplitude, |(mode, strike)| at_onset(mode, strike.fitted_from - strike.onset));
    }
    partials.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    partials.truncate(2 * MODES);
    let mut best: Option<(&'static str, Match)> = None;
    for (id, model) in Model::ALL.iter().filter(|(id, _)| family.models().contains(id)) {
        for body in variants(model) {
            let ratios: Vec<f64> = body.modes().iter().take(LOWEST).map(|mode| mode.ratio).collect();
            for partial in partials.iter().take(PLACED) {
                for ratio in &ratios {
                    let found = lay(&body, partial.frequency / ratio, &partials);
                    if best.as_ref().is_none_or(|(_, best)| found.score > best.score) {
                        best = Some((id, found));
                    }
                }
            }
        }
    }
    let (model, mut found) = best?;
    let (off, weights) = pairs(&found, &partials).fold((0.0, 0.0), |(off, weights), (partial, _, cents)| {
        (off + weight(partial) * cents, weights + weight(partial))
    });
    let frequency = found.body.frequency() * pow(2.0, off / weights.max(1e-9) / 1200.0);
    found = lay(&found.body, digits(frequency, 6), &partials);
    found.body.material.loss = loss(&found, &partials);
    let levels = Levels(pairs(&found, &partials).map(|(partial, mode, _)| (*partial, mode.ratio)).collect());
    let placed = levels.placed(&found.body, &[draft.hardness]).pop();
    found.body = placed.map_or(found.body, |(_, body)| body);
    // The model's modes above the highest mode of the sound are only guessed, so leave them out.
    let highest = pairs(&found, &partials).map(|(_, mode, _)| mode.frequency).fold(0.0, f64::max);
    found.body.modes = found.body.modes().iter().filter(|mode| mode.frequency <= 1.001 * highest).count().max(1);
    let explained = explained(model, &found, &partials);
    Some((found.body, levels, explained))
}

/// Partials with their modes, and the cents between them.
fn pairs<'a>(
    found: &'a Match,
    partials: &'a [Partial],
) -> impl Iterator<Item = (&'a Partial, &'a BodyMode, f64)> + Clone {
    let pairs = partials.iter().zip(&found.pairs);
    pairs.filter_map(|(partial, pair)| pair.as_ref().map(|(mode, cents)| (partial, mode, *cents)))
}

/// The law of loss that fits the T60s best: rates of `b0 + b1 f` by least squares of their relative errors, neither below 0.
fn loss(found: &Match, partials: &[Partial]) -> Loss {
    let point = |(partial, ..): (&Partial, _, _)| {
        let rate = LN_1000 / partial.t60;
        [partial.frequency, rate, weight(partial) / (rate * rate)]
    };
    let Some(line) = Line::through(pairs(found, partials).map(point)) else { return found.body.material.loss };
    let Line { middle, y, slope, spread, weight } = line;
    let (b0, b1) = if slope < 0.0 {
        (y, 0.0)
    } else if line.at(0.0) < 0.0 {
        (0.0, (slope * spread + weight * middle * y) / (spread + weight * middle * middle))
    } else {
        (line.at(0.0), slope)
    };
    Loss { b0: digits(b0, 4), b1: digits(b1, 4), power: 1.0 }
}

/// The patch of a body that plays a draft's note. Its gain is still to be set.
pub(super) fn patch(draft: &Draft, body: &Body) -> Patch {
    let mut patch = Patch { modes: modes_of_body(body), ..draft.patch() };
    patch.set(Param::Decay, Param::Decay.info().clamp(body.t60() as f32));
    let semitones = 12.0 * log2(body.frequency() / draft.note);
    let tune = semitones.round().clamp(-48.0, 48.0);
    patch.set(Param::Tune, tune as f32);
    patch.set(Param::Fine, Param::Fine.info().clamp(digits(100.0 * (semitones - tune), 4) as f32));
    patch
}

fn explained(model: &'static str, found: &Match, partials: &[Partial]) -> Explained {
    let all: f64 = partials.iter().map(Partial::energy).sum();
    let (mut met, mut off, mut weights, mut count) = (0.0, 0.0, 0.0, 0);
    for (partial, _, cents) in pairs(found, partials) {
        met += partial.energy();
        off += weight(partial) * fabs(cents);
        weights += weight(partial);
        count += 1;
    }
    Explained {
        model,
        cents: off / weights.max(1e-12),
        modes: (count, partials.len()),
        unexplained_db: 10.0 * log10(((all - met) / all.max(1e-300)).max(1e-12)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::correct::tests::draft;
    use super::*;
    use crate::dsp::random::{key, uniform};

    #[test]
    fn a_bar_is_found_among_modes_of_other_things() {
        let partial =
            |frequency, amplitude, t60| Partial { frequency, t60, amplitude, phase: 0.0, pan: 0.0, struck: true };
        let (_, model) = Model::ALL.iter().find(|(id, _)| *id == "marimba").unwrap();
        let bar = Body { pitch: Pitch::Frequency(262.0), ..Body::new(model.clone()) };
        let own = bar.modes().into_iter().take(5).enumerate();
        let own = own.map(|(n, mode)| partial(mode.frequency, pow(0.5, n as f64), 1.0 / (n as f64 + 1.0)));
        // A very low bar has modes near all of these.
        let other = |n: u64| {
            let place = 0.5 * (1.0 + f64::from(uniform(key(4, 0), n)));
            partial(180.0 * pow(30.0, place), 0.04, 0.2)
        };
        let draft = Draft { partials: own.chain((0..60).map(other)).collect(), ..draft([0.0; 2]) };
        let (body, _, explained) = find(&draft, None, Family::Bar).unwrap();
        assert_eq!(explained.model, "marimba");
        assert!((body.frequency() / 262.0 - 1.0).abs() < 0.01, "{} Hz", body.frequency());
    }
}
