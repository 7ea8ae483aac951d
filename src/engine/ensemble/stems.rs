//! What each channel and the shared space give to the mix, before the limiter: the stems of a song. Offline only: it allocates.

use super::part::Part;
use crate::engine::synth::PadGroup;
use std::collections::BTreeMap;

/// The stems of the frames since [`Stems::clear`], with the gain of the mix. Together, channels and space are the mix.
#[derive(Default)]
pub(crate) struct Stems {
    frames: usize,
    channels: [[Vec<f32>; 2]; 16],
    space: [Vec<f32>; 2],
    /// The pads of channels that play a kit, before the channel's effects.
    pads: BTreeMap<(u8, PadGroup), [Vec<f32>; 2]>,
}

impl Stems {
    /// Starts again at the frame that is rendered next.
    pub(crate) fn clear(&mut self) {
        let all = self.channels.iter_mut().chain([&mut self.space]).chain(self.pads.values_mut());
        all.flatten().for_each(Vec::clear);
        self.frames = 0;
    }

    /// Appends the output of all parts in a chunk, and that of the space if it sounds.
    pub(super) fn take(&mut self, frames: usize, parts: &mut [Part], space: Option<[&[f32]; 2]>, gain: f32) {
        let start = self.frames;
        self.frames += frames;
        for (channel, part) in (0..).zip(parts) {
            if part.is_heard {
                append(
                    &mut self.channels[usize::from(channel)],
                    start,
                    part.output().map(|side| &side[..frames]),
                    gain,
                );
            }
            part.synth.take_pads(|group, sums| {
                append(self.pads.entry((channel, group)).or_default(), start, sums, gain);
            });
        }
        if let Some(space) = space {
            append(&mut self.space, start, space.map(|side| &side[..frames]), gain);
        }
    }

    /// Left and right of a channel. What is missing at the end is silence; so with the others.
    pub(crate) fn channel(&self, channel: u8) -> [&[f32]; 2] {
        self.channels[usize::from(channel)].each_ref().map(Vec::as_slice)
    }

    /// Left and right of the shared space.
    pub(crate) fn space(&self) -> [&[f32]; 2] {
        self.space.each_ref().map(Vec::as_slice)
    }

    /// Left and right of pads, before the effects of their channel.
    pub(crate) fn pads(&self, channel: u8, group: PadGroup) -> [&[f32]; 2] {
        self.pads.get(&(channel, group)).map_or([&[], &[]], |sums| sums.each_ref().map(Vec::as_slice))
    }
}

/// Appends frames that begin at `start`, after silence where there was nothing.
fn append(stem: &mut [Vec<f32>; 2], start: usize, frames: [&[f32]; 2], gain: f32) {
    for (stem, frames) in stem.iter_mut().zip(frames) {
        stem.resize(start, 0.0);
        stem.extend(frames.iter().map(|sample| sample * gain));
    }
}
