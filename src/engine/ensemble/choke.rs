//! Choke groups across channels: the information that each part of an ensemble needs about the kits of the others.

use crate::engine::Synth;
use crate::engine::note::nearest_key;
use crate::params::Param;
use crate::sound::{Kit, Tuning};
use std::sync::Arc;

/// The kit that a part plays, and its choke group. Copied between chunks.
pub(super) struct Playing {
    kit: Arc<Kit>,
    /// The value of the kit's choke group parameter.
    choke: f32,
}

impl Playing {
    /// The kit with its initial parameters.
    pub(super) fn new(kit: &Arc<Kit>) -> Self {
        Self { kit: kit.clone(), choke: kit.values().get(Param::Choke) }
    }

    /// Copies a synth's kit and choke group. Real-time safe as long as the previous kit is also held elsewhere, so that it
    /// is not freed here.
    pub(super) fn follow(&mut self, synth: &Synth) {
        if !Arc::ptr_eq(&self.kit, synth.kit()) {
            self.kit = synth.kit().clone();
        }
        self.choke = synth.values().get(Param::Choke);
    }

    pub(super) fn choke_groups(&self) -> ChokeGroups<'_> {
        ChokeGroups { kit: &self.kit, choke: self.choke }
    }
}

/// The choke groups of the keys of a part, while a chunk is played.
#[derive(Clone, Copy)]
pub(super) struct ChokeGroups<'a> {
    kit: &'a Kit,
    choke: f32,
}

impl<'a> ChokeGroups<'a> {
    /// The choke groups of a kit with its initial parameters.
    pub(super) fn of_kit(kit: &'a Kit) -> Self {
        Self { kit, choke: kit.values().get(Param::Choke) }
    }

    /// Sets the choke group parameter.
    pub(super) fn set(&mut self, value: f32) {
        self.choke = Param::Choke.info().clamp(value);
    }

    /// The choke group of a key; 0 if the key is silent.
    pub(super) fn of_key(&self, key: u8, tuning: &Tuning) -> u8 {
        let pad = self.kit.tuned_pad(nearest_key(key), tuning);
        pad.map_or(0, |(pad, ..)| self.kit.choke(pad, self.choke))
    }
}
