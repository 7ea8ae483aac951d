//! The audio thread: follows the parameters, hands over events at their frames, renders.

use crate::events::translate;
use crate::loaded::Loaded;
use crate::params::{Look, SprungParams};
use crate::tail::Tail;
use nice_plug::prelude::*;
use nice_plug_core::midi::{Channel, Key, VoiceID};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::{PARAM_COUNT, PARAMS, Param};
use sprung::sound::kit::KEYS;
use sprung::units::mono_from_stereo;
use std::ops::Range;
use std::sync::Arc;

/// Frames that are rendered at a time where the output is mono.
const MONO_FRAMES: usize = 256;

/// Events that the wrapper hands over in a block without allocating. A host may send all of VST3's 2,080 controllers at
/// once, several times a block.
pub(crate) const EVENT_CAPACITY: usize = 8192;

/// Most voices that there ever are.
pub(crate) const MAX_VOICES: u32 = sprung::engine::voice_manager::MAX_VOICES as u32;

/// A synth that plays what the host says. Real-time safe once built.
pub(crate) struct Live {
    synth: Synth,
    /// What is played, and what positions are compared with. `SprungParams` has a handle as well, so that this one is
    /// never the last; it keeps the kit that the synth has.
    loaded: Arc<Loaded>,
    /// Where the knobs stood last.
    positions: [f32; PARAM_COUNT],
    /// How far modulation of the whole instrument turned them last.
    offsets: [f32; PARAM_COUNT],
    tempo: Option<f64>,
    /// How many voices the host believes there are.
    voices: u32,
    tail: Tail,
    /// How many of the notes that the synth says have ended the host has been told of.
    told: usize,
    /// Events that the wrapper has handed over with the part of a block before theirs.
    early: Vec<NoteEvent<()>>,
    /// What the instrument is rendered into when the host has one channel for it.
    stereo: [[f32; MONO_FRAMES]; 2],
}

impl Live {
    /// For a sample rate, and a host that plays in real time or renders to a file. Allocates.
    pub(crate) fn new(sample_rate: f64, offline: bool, params: &SprungParams) -> Self {
        let loaded = params.loaded();
        let mut synth = Synth::new(sample_rate, loaded.seed);
        // So that any kit finds room on the audio thread.
        synth.reserve(KEYS);
        synth.set_kit(&loaded.kit);
        synth.set_values(&loaded.values);
        let mut live = Self {
            synth,
            positions: loaded.positions,
            loaded,
            offsets: [0.0; PARAM_COUNT],
            tempo: None,
            voices: 0,
            tail: Tail::new(offline),
            told: 0,
            early: Vec::with_capacity(EVENT_CAPACITY),
            stereo: [[0.0; MONO_FRAMES]; 2],
        };
        live.reset(params);
        live
    }

    /// Silences everything, and starts anew with the sound as it is now.
    pub(crate) fn reset(&mut self, params: &SprungParams) {
        self.follow(params);
        self.synth.reset();
        (self.offsets, self.tempo, self.told) = ([0.0; PARAM_COUNT], None, 0);
        self.early.clear();
    }

    /// Takes over what has changed of the sound and its knobs. While another thread writes, all stays as it was until
    /// the next block.
    fn follow(&mut self, params: &SprungParams) {
        let Some(Look { positions, news }) = params.look(&self.loaded) else { return };
        let before = std::mem::replace(&mut self.positions, positions);
        let moved = |index: usize| positions[index].to_bits() != before[index].to_bits();
        // While nothing sounds, values need no slope: what a host sets before it plays holds from the first note on.
        // Of a kit that has just been loaded nothing sounds either.
        let at_once = news.is_some() || (self.synth.is_silent() && (0..PARAM_COUNT).any(moved));
        if let Some(loaded) = news {
            self.synth.set_seed(loaded.seed);
            self.synth.set_kit(&loaded.kit);
            // Only now: until here, it has kept the kit before.
            self.loaded = loaded;
        }
        if at_once {
            self.tail.forget();
            self.synth.set_values(&self.loaded.values_at(&positions));
        } else {
            for (index, info) in PARAMS.iter().enumerate() {
                if moved(index) {
                    let value = self.loaded.value(index, positions[index]);
                    self.handle(0, EventKind::Param { param: info.param, value });
                }
            }
        }
    }

    /// Takes over how far the whole instrument is modulated, and the tempo.
    fn follow_host(&mut self, params: &SprungParams, tempo: Option<f64>) {
        for (index, info) in PARAMS.iter().enumerate() {
            let offset = params.knobs()[index].offset();
            if offset != self.offsets[index] {
                self.offsets[index] = offset;
                self.handle(0, EventKind::Modulate { id: None, param: info.param, offset });
            }
        }
        if let Some(tempo) = tempo
            && self.tempo != Some(tempo)
        {
            self.tempo = Some(tempo);
            self.handle(0, EventKind::Tempo(tempo as f32));
        }
    }

    fn handle(&mut self, channel: u8, kind: EventKind) {
        self.tail.forget();
        self.synth.handle(&Event { frame: 0, channel, kind });
    }

    /// Renders a block over `outputs`, one channel or two.
    pub(crate) fn process<P: Plugin<SysExMessage = ()>>(
        &mut self,
        params: &SprungParams,
        outputs: &mut [&mut [f32]],
        context: &mut impl ProcessContext<P>,
    ) -> ProcessStatus {
        self.follow(params);
        self.follow_host(params, context.transport().tempo);
        // A mode that changes lets go of the keys that wait.
        self.tell(0, context);
        let voices = self.synth.values().get(Param::Voices) as u32;
        if voices != self.voices {
            self.voices = voices;
            context.set_current_voice_capacity(voices);
        }
        let frames = outputs.first().map_or(0, |channel| channel.len());
        let mut frame = 0;
        for index in 0..self.early.len() {
            let event = self.early[index];
            self.take(&event, frame, context);
        }
        self.early.clear();
        while let Some(event) = context.next_event() {
            let at = (event.timing() as usize).max(frame);
            // The wrapper divides blocks at parameter changes, and hands events of the change's own frame over with
            // the part before. At one frame, parameters always come first, wherever the host's blocks end.
            if at >= frames && self.early.len() < self.early.capacity() {
                self.early.push(event);
                continue;
            }
            let at = at.min(frames);
            self.render(outputs, frame..at, context);
            frame = at;
            self.take(&event, frame, context);
        }
        self.render(outputs, frame..frames, context);
        self.tail.status(&mut self.synth, frames)
    }

    /// Takes in one event at a frame of the block.
    fn take<P: Plugin<SysExMessage = ()>>(
        &mut self,
        event: &NoteEvent<()>,
        frame: usize,
        context: &mut impl ProcessContext<P>,
    ) {
        if let Some((channel, kind)) = translate(event, context.plugin_api()) {
            self.handle(channel, kind);
            self.tell(frame, context);
        }
    }

    /// Renders the frames at a range of the outputs, and tells the host which notes have ended.
    fn render<P: Plugin<SysExMessage = ()>>(
        &mut self,
        outputs: &mut [&mut [f32]],
        frames: Range<usize>,
        context: &mut impl ProcessContext<P>,
    ) {
        if frames.is_empty() {
            return;
        }
        let last = frames.end - 1;
        match outputs {
            [left, right, ..] => {
                self.synth.process(&[], &mut left[frames.clone()], &mut right[frames]);
                self.told = 0;
                self.tell(last, context);
            }
            [mono] => {
                for part in mono[frames].chunks_mut(MONO_FRAMES) {
                    let [left, right] = &mut self.stereo;
                    let (left, right) = (&mut left[..part.len()], &mut right[..part.len()]);
                    self.synth.process(&[], left, right);
                    for ((mono, left), right) in part.iter_mut().zip(left).zip(right) {
                        *mono = mono_from_stereo(*left, *right);
                    }
                    self.told = 0;
                    self.tell(last, context);
                }
            }
            [] => {}
        }
    }

    /// Tells the host at a frame of the block which notes have ended since it was last told.
    fn tell<P: Plugin<SysExMessage = ()>>(&mut self, frame: usize, context: &mut impl ProcessContext<P>) {
        let ended = self.synth.ended();
        for note in ended.get(self.told..).unwrap_or_default() {
            let voice_id = note.id.map_or(VoiceID::Wildcard, |id| VoiceID::ID(id.number()));
            // A host that takes no events, or no more of them, does without.
            let _ = context.try_send_event(NoteEvent::VoiceTerminated {
                timing: frame as u32,
                voice_id,
                channel: Channel::Number(note.channel),
                key: Key::Number(note.key),
            });
        }
        self.told = ended.len();
    }
}

#[cfg(test)]
mod tests;
