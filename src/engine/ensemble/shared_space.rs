//! The space that all channels of an ensemble share, with one send for each channel, set by controller 91.
//!
//! In MIDI files every channel has a send to one reverb (controller 91), and none has a reverb of its own. The shared
//! space hears the channels after their own effects, in channel order. The list of programs defines it, so `--programs
//! gm` has a plate; `--set space=…` switches it off, since each channel then has a space of its own. The list also sets
//! the gain of the mix (`Mix::gain`) before the limiter: each sound is levelled to be heard alone, and sixteen of them
//! add up. A synth alone, and so the plugin, has no shared space, since hosts have sends. Test:
//! `tests/engine/shared_space.rs`.

use super::chunk::Chunk;
use super::part::Part;
use crate::dsp::ramp::Ramp;
use crate::engine::EventKind;
use crate::engine::event::unit;
use crate::engine::midi::DEFAULT_REVERB_SEND;
use crate::engine::midi::controller::REVERB_SEND;
use crate::engine::note::nearest_channel;
use crate::engine::space::{Space, needs_bodies};
use crate::engine::synth::flush;
use crate::params::{Param, Values};

/// Gain of a full send, −8 dB. Measured with the demo songs and a plate: the level of the return is 3 dB below that of the
/// channels at a full send, and 11 to 13 dB below at the default send. It is 16 to 20 dB below in FluidSynth 2.3, and higher
/// in an SC-55.
const FULL_SEND: f32 = 0.4;

/// Ramp time of a send in seconds.
const SMOOTHING_SECONDS: f64 = 0.02;

/// One space for sixteen channels. Its input comes after the channels' own effects, and only its wet signal is added to
/// the mix. Real-time safe once built.
pub(super) struct SharedSpace {
    space: Space,
    sends: [Ramp; 16],
    /// The last frame of each channel.
    last: [[f32; 2]; 16],
    smoothing_frames: u32,
    left: Vec<f32>,
    right: Vec<f32>,
}

impl SharedSpace {
    /// The space of these parameters, for chunks of up to `frames` frames; none if they switch it off. Allocates.
    pub(super) fn new(sample_rate: f64, params: &[(Param, f32)], frames: usize) -> Option<Self> {
        let mut values = Values::default();
        params.iter().filter(|(param, _)| param.is_of_space()).for_each(|(param, value)| values.set(*param, *value));
        // The dry signal is in the mix already, so the space is fully wet.
        values.set(Param::SpaceMix, Param::SpaceMix.info().max);
        if !needs_bodies(&values) {
            return None;
        }
        let mut space = Space::new(sample_rate);
        space.reserve();
        space.set(&values, true);
        Some(Self {
            space,
            sends: [Ramp::at_rest(FULL_SEND * DEFAULT_REVERB_SEND); 16],
            last: [[0.0; 2]; 16],
            smoothing_frames: (SMOOTHING_SECONDS * sample_rate) as u32,
            left: vec![0.0; frames],
            right: vec![0.0; frames],
        })
    }

    /// Makes room for chunks of up to `frames` frames. Allocates.
    pub(super) fn resize(&mut self, frames: usize) {
        self.left.resize(frames, 0.0);
        self.right.resize(frames, 0.0);
    }

    /// Whether the space's sound is below −120 dBFS and no setting is moving.
    pub(super) fn is_idle(&self) -> bool {
        !self.space.is_awake()
    }

    /// Processes the output of the parts in a chunk, and adds the space's sound to their mix. Returns whether it sounds.
    pub(super) fn process(&mut self, chunk: &Chunk, parts: &[Part], [left, right]: [&mut [f32]; 2]) -> bool {
        self.left[..chunk.frames].fill(0.0);
        self.right[..chunk.frames].fill(0.0);
        let mut frame = 0;
        for event in chunk.events {
            let EventKind::Control { controller: REVERB_SEND, value } = event.kind else { continue };
            let channel = nearest_channel(event.channel);
            // A member of an MPE zone sounds on its master's part, which has one send.
            if chunk.owner(event) == channel {
                let at = chunk.frame(event).max(frame);
                self.gather(parts, frame, at);
                let (to, send) = (FULL_SEND * unit(value), &mut self.sends[usize::from(channel)]);
                // On a silent channel it counts at once, so that the attack of a note at the same frame is sent by it.
                if self.last[usize::from(channel)] == [0.0; 2] {
                    *send = Ramp::at_rest(to);
                } else {
                    send.set(to, self.smoothing_frames);
                }
                frame = at;
            }
        }
        self.gather(parts, frame, chunk.frames);
        if self.is_idle() && parts.iter().all(|part| !part.is_heard) {
            self.space.skip(chunk.frames);
            return false;
        }
        let (own_left, own_right) = (&mut self.left[..chunk.frames], &mut self.right[..chunk.frames]);
        if !self.space.process(own_left, own_right) {
            return false;
        }
        flush(own_left, own_right);
        for (mix, own) in [(left, own_left), (right, own_right)] {
            mix.iter_mut().zip(own).for_each(|(mix, own)| *mix += *own);
        }
        true
    }

    /// The space's own sound in the last chunk. Valid only if it sounded.
    pub(super) fn output(&self) -> [&[f32]; 2] {
        [&self.left, &self.right]
    }

    /// Sums the sends of the channels between two frames of a chunk, in channel order.
    fn gather(&mut self, parts: &[Part], from: usize, to: usize) {
        let Self { sends, last, left, right, .. } = self;
        for ((send, last), part) in sends.iter_mut().zip(last).zip(parts) {
            if to > from {
                *last = if part.is_heard { part.output().map(|side| side[to - 1]) } else { [0.0; 2] };
            }
            if part.is_heard {
                let [part_left, part_right] = part.output();
                add(&mut left[from..to], &part_left[from..to], send);
                add(&mut right[from..to], &part_right[from..to], send);
            }
            send.advance((to - from) as u32);
        }
    }
}

/// Adds frames to a sum, with a gain that is usually constant.
fn add(sum: &mut [f32], frames: &[f32], gain: &Ramp) {
    let both = sum.iter_mut().zip(frames);
    let resting = gain.after(u32::MAX);
    if gain.after(0) == resting {
        both.for_each(|(sum, sample)| *sum += resting * sample);
    } else {
        both.zip(0..).for_each(|((sum, sample), frame)| *sum += gain.after(frame) * sample);
    }
}
