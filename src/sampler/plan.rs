//! What is sampled: zones of keys, layers of velocities, alternating strikes, and what sounds after keys are let go.

use super::settings::Sampling;
use super::strike::strikes_differ;
use crate::error::{Error, Result};
use crate::params::{Choice, NoteOff, Param};
use crate::preset::Playable;
use crate::sound::Kit;
use crate::text::slug;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Keys that one sampled key plays.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Zone {
    /// The key that is sampled.
    pub(super) key: u8,
    pub(super) keys: RangeInclusive<u8>,
    /// Name of the pad; empty for a preset.
    name: String,
    /// Choke group, 0 for none.
    pub(super) choke: u8,
    /// Whether a note rings on when its key is let go.
    pub(super) rings_on: bool,
    /// Whether its releases are samples of their own.
    pub(super) has_releases: bool,
    /// Number of strikes that alternate; 1 if all are alike.
    pub(super) strikes: usize,
    /// Cents per key.
    pub(super) tracking: f64,
}

/// What of a note a sample has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The sound from a strike on, which is one of those that alternate, from 0.
    Strike(usize),
    /// The sound from the end of the key's hold on.
    Release,
}

/// One sample of a zone in a velocity layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Take {
    pub(super) zone: usize,
    pub(super) layer: usize,
    pub(super) part: Part,
}

/// Everything that is sampled.
pub(super) struct Plan {
    pub(super) zones: Vec<Zone>,
    /// The velocities of each layer. The highest is sampled.
    pub(super) layers: Vec<RangeInclusive<u8>>,
    pub(super) takes: Vec<Take>,
}

impl Plan {
    pub(super) fn new(sampling: &Sampling, playable: &Playable, kit: &Arc<Kit>) -> Result<Self> {
        let mut zones = match playable {
            Playable::Kit(_) => pads(kit, sampling.keys.as_ref()),
            Playable::Preset(preset) => {
                let own = preset.guide.lowest..=preset.guide.highest;
                spread(kit, sampling.keys.as_ref().unwrap_or(&own), sampling.every)
            }
        };
        if zones.is_empty() {
            return Err(Error::value("--keys", "none of these keys sounds: expected some that the sound has"));
        }
        for zone in &mut zones {
            zone.has_releases = sampling.releases && !zone.rings_on;
            if sampling.strikes > 1 && strikes_differ(sampling, kit, zone.key) {
                zone.strikes = sampling.strikes.into();
            }
        }
        let count = u16::from(sampling.velocities.clamp(1, 127));
        let top = |layer: u16| (127 * layer / count) as u8;
        let layers: Vec<RangeInclusive<u8>> = (0..count).map(|layer| top(layer) + 1..=top(layer + 1)).collect();
        let mut takes = Vec::new();
        for (zone, Zone { strikes, has_releases, .. }) in zones.iter().enumerate() {
            for layer in 0..layers.len() {
                let parts = (0..*strikes).map(Part::Strike).chain(has_releases.then_some(Part::Release));
                takes.extend(parts.map(|part| Take { zone, layer, part }));
            }
        }
        Ok(Self { zones, layers, takes })
    }

    /// The file of a sample, in the folder.
    pub(super) fn file(&self, take: &Take, sampling: &Sampling) -> String {
        let zone = &self.zones[take.zone];
        let name = if zone.name.is_empty() { String::new() } else { format!("{}-", slug(&zone.name)) };
        let velocity = self.layers[take.layer].end();
        let ending = sampling.format.ending();
        let part = match take.part {
            Part::Strike(strike) => (strike + 1).to_string(),
            Part::Release => "release".to_owned(),
        };
        format!("samples/{:03}-{name}v{velocity:03}-{part}.{ending}", zone.key)
    }
}

/// A zone of one key for each pad of a kit.
fn pads(kit: &Kit, keys: Option<&RangeInclusive<u8>>) -> Vec<Zone> {
    let all = 0..=127;
    let keys = keys.unwrap_or(&all).clone();
    keys.filter_map(|key| Some(Zone { name: kit.pad(key)?.name.clone(), ..zone(kit, key, key..=key)? })).collect()
}

/// Zones around every n-th key.
fn spread(kit: &Kit, keys: &RangeInclusive<u8>, every: u8) -> Vec<Zone> {
    let every = every.max(1);
    let (below, above) = ((every - 1) / 2, every / 2);
    let (lowest, highest) = (*keys.start(), *keys.end());
    let mut zones: Vec<Zone> = (lowest..=highest)
        .step_by(every.into())
        .filter_map(|start| {
            let key = (start + below).min(highest);
            zone(kit, key, start..=(key + above).min(highest))
        })
        .collect();
    if let Some(last) = zones.last_mut() {
        last.keys = *last.keys.start()..=highest;
    }
    zones
}

fn zone(kit: &Kit, key: u8, keys: RangeInclusive<u8>) -> Option<Zone> {
    let pad = kit.pad(key)?;
    let patch = kit.sounds().get(pad.sound)?.patch();
    let rings_on = NoteOff::from_value(patch.get(Param::NoteOff)) == NoteOff::Ring;
    let choke = kit.choke(pad, kit.values().get(Param::Choke));
    let tracking = f64::from(patch.get(Param::KeyTrack));
    Some(Zone { key, keys, name: String::new(), choke, rings_on, has_releases: false, strikes: 1, tracking })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;

    #[test]
    fn zones_cover_every_key_once() {
        let kit = Kit::of_patch(&Patch::default());
        for (keys, every) in [(0..=127, 3), (36..=84, 4), (60..=60, 12), (21..=108, 1), (10..=20, 100)] {
            let zones = spread(&kit, &keys, every);
            let covered: Vec<u8> = zones.iter().flat_map(|zone| zone.keys.clone()).collect();
            assert_eq!(covered, keys.clone().collect::<Vec<u8>>(), "{keys:?} every {every}");
            assert!(zones.iter().all(|zone| zone.keys.contains(&zone.key)));
        }
    }
}
