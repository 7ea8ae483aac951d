//! Renders one sample, cuts it, and finds its loop.

use super::list::{self, Line};
use super::plan::{Part, Plan, Take};
use super::settings::Sampling;
use super::strike::strike;
use super::{release, steady};
use crate::error::Result;
use crate::io::{Inputs, Loop, Output, Target, WavFormat, WavWriter, flac};
use crate::sound::Kit;
use std::sync::Arc;

/// The lowest level that belongs to a sample, −100 dBFS.
const AUDIBLE: f32 = 1e-5;

/// Seconds in which a sample fades out that is cut while it sounds.
const FADE: f64 = 0.02;

/// Makes a sample.
pub(super) fn make(sampling: &Sampling, plan: &Plan, kit: &Arc<Kit>, take: &Take, inputs: &Inputs) -> Result<Line> {
    let (zone, velocity) = (&plan.zones[take.zone], *plan.layers[take.layer].end());
    let hold = |number, times| strike(sampling, kit, zone.key, velocity, number, times);
    let (mut sound, fall) = match take.part {
        Part::Strike(number) => (hold(number, [sampling.length, 0.0])?, None),
        Part::Release => {
            let held = (release::HELD * f64::from(sampling.rate)) as usize;
            let sound = hold(0, [release::HELD, sampling.length])?.map(|side| side[held.min(side.len())..].to_vec());
            (sound, Some(release::fall(&hold(0, [sampling.length, 0.0])?, sampling.rate)))
        }
    };
    let whole = sound[0].len();
    let is_audible = |sample: &f32| sample.abs() >= AUDIBLE;
    // A silent take is a frame long, since samplers refuse files without one.
    let end = sound.iter().filter_map(|side| side.iter().rposition(is_audible)).max().map_or(1, |last| last + 1);
    sound.iter_mut().for_each(|side| side.truncate(end));
    let may_loop = end == whole && !zone.rings_on && fall.is_none();
    let looped = if may_loop { steady::find(&mut sound, sampling.rate) } else { None };
    if end == whole && looped.is_none() {
        fade(&mut sound, (FADE * f64::from(sampling.rate)) as usize);
    }
    let frames = sound[0].len() as u64;
    let release = match zone.rings_on || fall.is_some() {
        true => None,
        false => release::seconds(sampling, kit, zone.key, velocity)?,
    };
    let file = plan.file(take, sampling);
    let path = sampling.folder.join(&file);
    // A run that is resumed replaces what an interrupted one left without a line.
    let mut output = Output::create(&Target::Path(path.clone()), sampling.resume, inputs)?;
    let format = WavFormat { sample_rate: sampling.rate, channels: 2, samples: sampling.bits };
    let write = |output: &mut Output| {
        let name = output.name().to_owned();
        let mut writer = match &looped {
            None => WavWriter::new(output.stream(), &name, format, None, Some(frames))?,
            Some(looped) => WavWriter::looped(output.stream(), &name, format, None, frames, looped, zone.key)?,
        };
        writer.write(&sound[0], &sound[1])?;
        writer.finish()
    };
    flac::write_as(sampling.format, &mut output, write)?;
    output.commit()?;
    let looped = looped.map(|Loop { start, end }| [start, end]);
    let bytes = list::bytes(&path).unwrap_or(0);
    Ok(Line { file, frames, bytes, looped, release, fall })
}

/// Fades out the last frames.
fn fade(sound: &mut [Vec<f32>; 2], frames: usize) {
    for side in sound {
        let start = side.len().saturating_sub(frames);
        let length = (side.len() - start) as f32;
        side[start..].iter_mut().zip(0..).for_each(|(sample, n)| *sample *= 1.0 - (n + 1) as f32 / length);
    }
}
