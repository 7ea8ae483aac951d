//! Sounds like one: compares the presets of the catalogue with it by ear, in the background.

use super::sounds::{Category, Place, Sounds, place};
use super::tags::Tags;
use crate::editor::background::{Background, Progress};
use sprung::analysis::fit::{LOOKED_AT, Model, Nearness};
use sprung::internals::library::Listed;
use sprung::preset::{Playable, Preset};
use sprung::{Error, Result};
use std::sync::Arc;

/// The search for sounds like one, and its last result.
#[derive(Default)]
pub(super) struct Likeness {
    pub(super) search: Option<Background<Vec<Place>>>,
    /// The category, words and tags in which one looked when it began.
    pub(super) asked: Option<(Category, String, Tags)>,
    /// The name of the sound, and the presets that are most like it, the nearest first.
    pub(super) found: Option<(String, Vec<Place>)>,
}

impl Likeness {
    /// Begins to compare a preset with the presets of the catalogue.
    ///
    /// # Errors
    /// A message, if the system has no thread for it.
    pub(super) fn start(&mut self, preset: Preset, sounds: &Sounds) -> std::result::Result<(), String> {
        let presets: Vec<Arc<Listed>> = sounds.all().cloned().collect();
        let name = preset.name.clone();
        self.search = Some(Background::start(name, move |progress| nearest(&preset, &presets, progress))?);
        Ok(())
    }

    /// The presets of the last result.
    pub(super) fn places(&self) -> &[Place] {
        self.found.as_ref().map_or(&[], |(_, places)| places)
    }
}

/// The presets that are nearest to one: all are compared at a first look, and the nearest of them again.
fn nearest(preset: &Preset, sounds: &[Arc<Listed>], progress: &Progress) -> Result<Vec<Place>> {
    let model = Model::of_preset(preset)?;
    let presets = sounds.iter().filter_map(|sound| match &sound.playable {
        Playable::Preset(other) => Some((other, place(sound)?)),
        Playable::Kit(_) => None,
    });
    let presets: Vec<(&Preset, Place)> = presets.collect();
    let work = presets.len() + LOOKED_AT.min(presets.len());
    let mut done = 0;
    let mut step = |near: Nearness, index: usize| {
        done += 1;
        if progress.report(done as f64 / work as f64) { Ok((near, index)) } else { Err(Error::Interrupted) }
    };
    let by_distance = |a: &(Nearness, usize), b: &(Nearness, usize)| a.0.distance.total_cmp(&b.0.distance);
    let first = presets.iter().enumerate().map(|(index, (other, _))| step(model.first_look(other), index));
    let mut first = first.collect::<Result<Vec<_>>>()?;
    first.sort_by(by_distance);
    first.truncate(LOOKED_AT);
    let again = first.into_iter().map(|(near, index)| step(model.nearness(presets[index].0, near.key), index));
    let mut nearest = again.collect::<Result<Vec<_>>>()?;
    nearest.sort_by(by_distance);
    Ok(nearest.into_iter().map(|(_, index)| presets[index].1.clone()).collect())
}
