//! Finds how an instrument's sound follows velocity and key, from several takes.

use super::draft::Draft;
use crate::analysis::line::Line;
use crate::params::Param;
use crate::patch::Patch;
use crate::patch::routes::Source;
use libm::{log, log10};

/// Distance in semitones below which two takes have the same key.
pub(super) const SAME_KEY: f64 = 0.5;
/// Places of the routes. Those of a new patch are in the last places, so that they never meet.
const HARDNESS_ROUTE: usize = 0;
const DECAY_ROUTE: usize = 1;
const GAIN_ROUTE: usize = 2;

/// A take's draft, and what was measured of the take.
pub(super) struct Layer {
    pub(super) draft: Draft,
    /// RMS of its first 50 ms.
    pub(super) level: f64,
    /// The T60 in seconds with which it loses its first 20 dB. No mode of the draft tells that: one can be a knock, or hum on.
    pub(super) t60: f64,
}

impl Layer {
    /// Its key as a fractional MIDI key.
    pub(super) fn key(&self) -> f64 {
        self.draft.key()
    }
}

/// The take with which the others are compared: the one nearest to the middle of the keys, and the hardest struck of these.
pub(super) fn base(layers: &[Layer]) -> usize {
    let middle = layers.iter().map(Layer::key).sum::<f64>() / layers.len().max(1) as f64;
    let distance = |layer: &Layer| (layer.key() - middle).abs();
    let least = layers.iter().map(distance).fold(f64::INFINITY, f64::min);
    let near = (0..layers.len()).filter(|n| distance(&layers[*n]) < least + SAME_KEY);
    near.max_by(|a, b| layers[*a].draft.velocity.total_cmp(&layers[*b].draft.velocity)).unwrap_or(0)
}

/// How much velocity sets the force, 0–1: the amplitude is proportional to velocity to the power of twice this number.
/// 1 if no two takes of the key differ in velocity.
pub(super) fn follow(layers: &[Layer], base: usize) -> f64 {
    let points = of_the_key(layers, base).map(|layer| (log(layer.draft.velocity), log(layer.level.max(1e-9))));
    slope(points).map_or(1.0, |slope| (0.5 * slope).clamp(0.0, 1.0))
}

fn of_the_key(layers: &[Layer], base: usize) -> impl Iterator<Item = &Layer> {
    let key = layers[base].key();
    layers.iter().filter(move |layer| (layer.key() - key).abs() < SAME_KEY)
}

/// Adds the routes that make the patch of layer `base` follow velocity and key as the layers do.
pub(super) fn route(mut patch: Patch, layers: &[Layer], base: usize) -> Patch {
    let own = &layers[base];
    // A body that was tuned has a hardness and a decay of its own.
    let hardness = own.draft.hardness.map(|_| 0.01 * f64::from(patch.get(Param::MalletHardness)));
    let hardnesses = of_the_key(layers, base).filter_map(|layer| Some((layer.draft.velocity, layer.draft.hardness?)));
    if let (Some(hardness), Some(slope)) = (hardness, slope(hardnesses)) {
        // In travel of the knob, 0 to 100 %.
        let slope = slope.clamp(0.0, 1.0);
        let softest = (hardness - slope * own.draft.velocity).clamp(0.0, 1.0);
        let amount = rounded(100.0 * (hardness - softest) / own.draft.velocity);
        if amount > 0.0 {
            patch.set(Param::MalletHardness, rounded(100.0 * softest));
            patch = patch.with_route(HARDNESS_ROUTE, Source::Velocity, Param::MalletHardness, amount);
        }
    }
    let decays = layers.iter().map(|layer| ((layer.key() - 60.0) / 60.0, log(layer.t60)));
    if let Some(slope) = slope(decays) {
        let info = Param::Decay.info();
        let travel = log(f64::from(info.max) / f64::from(info.min));
        let amount = rounded((100.0 * slope / travel).clamp(-100.0, 100.0));
        let at_c4 = f64::from(patch.get(Param::Decay))
            * libm::exp(-0.01 * f64::from(amount) * travel * (own.key() - 60.0) / 60.0);
        if amount != 0.0 {
            patch.set(Param::Decay, info.clamp(at_c4 as f32));
            patch = patch.with_route(DECAY_ROUTE, Source::Key, Param::Decay, amount);
        }
    }
    patch
}

/// Adds the route by which the patch of layer `base` becomes louder or softer over the keys, as the layers do. `played` gives the
/// RMS of a patch's first 50 ms when it plays a layer's note.
pub(super) fn route_gain(
    mut patch: Patch,
    layers: &[Layer],
    base: usize,
    played: &mut dyn FnMut(&Patch, &Layer) -> f64,
) -> Patch {
    let middle = |layer: &Layer| (layer.key() - 60.0) / 60.0;
    let missing = |layer| (middle(layer), 20.0 * log10(layer.level.max(1e-9) / played(&patch, layer).max(1e-9)));
    if let Some(slope) = slope(layers.iter().map(missing)) {
        let info = Param::Gain.info();
        let range = f64::from(info.max) - f64::from(info.min);
        let amount = rounded((100.0 * slope / range).clamp(-100.0, 100.0));
        if amount != 0.0 {
            // At its own key the layer stays as loud as it was.
            let at_c4 = f64::from(patch.get(Param::Gain)) - 0.01 * f64::from(amount) * range * middle(&layers[base]);
            patch.set(Param::Gain, info.clamp(rounded(at_c4)));
            patch = patch.with_route(GAIN_ROUTE, Source::Key, Param::Gain, amount);
        }
    }
    patch
}

fn rounded(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0) as f32
}

/// The slope of a line through some points; none if they do not differ in `x`.
pub(super) fn slope(points: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let points: Vec<[f64; 3]> = points.map(|(x, y)| [x, y, 1.0]).collect();
    Line::through(points.iter().copied()).filter(|line| line.spread > 1e-4).map(|line| line.slope)
}

#[cfg(test)]
mod tests {
    use super::super::correct::tests::draft;
    use super::*;
    use crate::patch::routes::amount_param;

    fn layer(note: f64, velocity: f64, hardness: f64) -> Layer {
        Layer {
            draft: Draft { note, velocity, hardness: Some(hardness), ..draft([0.5, 0.1]) },
            level: velocity,
            t60: 2.0,
        }
    }

    #[test]
    fn the_hardest_of_the_middle_key_is_compared_with_the_others() {
        let layers = [layer(220.0, 1.0, 0.5), layer(440.0, 0.3, 0.5), layer(441.0, 0.8, 0.5), layer(880.0, 1.0, 0.5)];
        assert_eq!(base(&layers), 2);
    }

    #[test]
    fn routes_begin_at_what_the_patch_has() {
        let mut layers = [layer(440.0, 0.5, 0.3), layer(440.0, 1.0, 0.6), layer(880.0, 1.0, 0.6)];
        layers[2].t60 = 1.0;
        let mut tuned = layers[1].draft.patch();
        tuned.set(Param::MalletHardness, 80.0);
        tuned.set(Param::Decay, 2.5);
        let routed = route(tuned, &layers, 1);
        let amount = |place| routed.get(amount_param(place));
        // At velocity 1 the route adds all of its amount.
        let hardness = routed.get(Param::MalletHardness) + amount(HARDNESS_ROUTE);
        assert!((hardness - 80.0).abs() < 0.1, "{hardness}");
        // A4 is 9 of the 60 keys above C4 over which the route adds all of its amount.
        let info = Param::Decay.info();
        let decay = routed.get(Param::Decay) * libm::powf(info.max / info.min, 0.01 * amount(DECAY_ROUTE) * 9.0 / 60.0);
        assert!((decay - 2.5).abs() < 0.01 && amount(DECAY_ROUTE) < 0.0, "{decay}");
    }
}
