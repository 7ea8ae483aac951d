//! The audio thread: follows the parameters, hands over events at their frames, renders.

use crate::events::translate;
use crate::params::SprungParams;
use crate::plugin::Sprung;
use crate::slate::Loaded;
use nice_plug::prelude::*;
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::{PARAM_COUNT, PARAMS};
use std::ops::Range;

/// Frames that are rendered at a time where the output is mono.
const MONO_FRAMES: usize = 256;

/// A synth that plays what the host says. Real-time safe once built.
pub(crate) struct Live {
    synth: Synth,
    /// The loaded patch that positions are compared with, and its generation.
    loaded: Loaded,
    generation: Option<u32>,
    /// Where the knobs stood last.
    positions: [f32; PARAM_COUNT],
    /// What the instrument is rendered into when the host has one channel for it.
    stereo: [[f32; MONO_FRAMES]; 2],
}

impl Live {
    /// Allocates.
    pub(crate) fn new(sample_rate: f64, params: &SprungParams) -> Self {
        let loaded = params.state().loaded;
        let mut live = Self {
            synth: Synth::new(sample_rate, loaded.seed),
            loaded,
            generation: None,
            positions: loaded.positions,
            stereo: [[0.0; MONO_FRAMES]; 2],
        };
        live.reset(params);
        live
    }

    /// Silences everything, and starts anew with the patch as it is now.
    pub(crate) fn reset(&mut self, params: &SprungParams) {
        self.generation = None;
        self.follow(params);
        self.synth.reset();
    }

    /// Takes over what has changed of the patch and its knobs.
    fn follow(&mut self, params: &SprungParams) {
        // While another thread writes, all stays as it was until the next block.
        let Some((positions, news)) = params.look(self.generation) else { return };
        if let Some((generation, mut loaded)) = news {
            (self.generation, self.loaded) = (Some(generation), loaded);
            for (index, info) in PARAMS.iter().enumerate() {
                loaded.patch.set(info.param, self.loaded.value(index, positions[index]));
            }
            self.synth.set_patch(&loaded.patch);
        } else {
            for (index, info) in PARAMS.iter().enumerate() {
                if positions[index].to_bits() != self.positions[index].to_bits() {
                    let value = self.loaded.value(index, positions[index]);
                    self.handle(0, EventKind::Param { param: info.param, value });
                }
            }
        }
        self.positions = positions;
    }

    fn handle(&mut self, channel: u8, kind: EventKind) {
        self.synth.handle(&Event { frame: 0, channel, kind });
    }

    /// Renders a block over `outputs`, one channel or two.
    pub(crate) fn process(
        &mut self,
        params: &SprungParams,
        outputs: &mut [&mut [f32]],
        context: &mut impl ProcessContext<Sprung>,
    ) -> ProcessStatus {
        self.follow(params);
        let frames = outputs.first().map_or(0, |channel| channel.len());
        let mut frame = 0;
        while let Some(event) = context.next_event() {
            // The wrapper divides blocks at parameter changes; an event just before such a change comes with a time
            // at the end of the part before it, and is handed over after that part's last frame.
            let at = (event.timing() as usize).clamp(frame, frames);
            self.render(outputs, frame..at);
            frame = at;
            if let Some((channel, kind)) = translate(&event) {
                self.handle(channel, kind);
            }
        }
        self.render(outputs, frame..frames);
        if self.synth.is_silent() { ProcessStatus::Normal } else { ProcessStatus::KeepAlive }
    }

    fn render(&mut self, outputs: &mut [&mut [f32]], frames: Range<usize>) {
        match outputs {
            [left, right, ..] => self.synth.process(&[], &mut left[frames.clone()], &mut right[frames]),
            [mono] => {
                for part in mono[frames].chunks_mut(MONO_FRAMES) {
                    let [left, right] = &mut self.stereo;
                    let (left, right) = (&mut left[..part.len()], &mut right[..part.len()]);
                    self.synth.process(&[], left, right);
                    for ((mono, left), right) in part.iter_mut().zip(left).zip(right) {
                        *mono = 0.5 * (*left + *right);
                    }
                }
            }
            [] => {}
        }
    }
}
