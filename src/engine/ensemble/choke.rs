//! Choke groups across channels: what each part of an ensemble knows of the kits of the others.

use crate::engine::Synth;
use crate::engine::note::nearest_key;
use crate::params::Param;
use crate::sound::{Kit, Tuning};
use std::sync::Arc;

/// What a part plays, kept between chunks.
pub(super) struct Playing {
    kit: Arc<Kit>,
    /// The choke group of the kit's parameters.
    choke: f32,
}

impl Playing {
    /// The kit with its initial parameters.
    pub(super) fn new(kit: &Arc<Kit>) -> Self {
        Self { kit: kit.clone(), choke: kit.values().get(Param::Choke) }
    }

    /// Takes over what a synth plays. Real-time safe if somebody keeps the kit before.
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
    /// Those of a kit with its initial parameters.
    pub(super) fn of_kit(kit: &'a Kit) -> Self {
        Self { kit, choke: kit.values().get(Param::Choke) }
    }

    /// The parameter for the choke group has a new value.
    pub(super) fn set(&mut self, value: f32) {
        self.choke = Param::Choke.info().clamp(value);
    }

    /// The choke group of a key; 0 for one that is silent.
    pub(super) fn of_key(&self, key: u8, tuning: &Tuning) -> u8 {
        let pad = self.kit.tuned_pad(nearest_key(key), tuning);
        pad.map_or(0, |(pad, ..)| self.kit.choke(pad, self.choke))
    }
}
