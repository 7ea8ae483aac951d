//! How a synth renders: it splits blocks at events, and the frames between events at control ticks.
//!
//! All voices compute their pitches first, then all start their sweeps: 177 instead of 162 × real time, because each
//! voice waits for the latency of its own exponential and sine. Replacing those of `libm` by series of our own was no
//! faster, and vibrato even lost a tenth. (Measured once.)

use super::{Outputs, Synth};
use crate::dsp::CONTROL_FRAMES;
use crate::engine::event::Event;
use crate::engine::workers::{Alone, Workers};
use crate::params::{self, Param};

/// The next frames, up to the next control tick: within them, all that moves is on a ramp.
pub(super) struct Stretch {
    /// Whether it starts with a control tick.
    pub(super) is_tick: bool,
    /// Frames to the next control tick.
    pub(super) to_tick: usize,
    pub(super) frames: usize,
}

impl Stretch {
    /// The stretch from frame `clock` on, if `frames` frames are wanted.
    pub(super) fn new(clock: u64, frames: usize) -> Self {
        let to_tick = CONTROL_FRAMES - (clock % CONTROL_FRAMES as u64) as usize;
        Self { is_tick: to_tick == CONTROL_FRAMES, to_tick, frames: frames.min(to_tick) }
    }
}

impl Synth {
    /// Renders the next frames and overwrites the slices: as many frames as the shorter one has (any number; they are
    /// meant to be equally long). The rest of a longer one stays unchanged. `events` are in order of their frames.
    /// Real-time safe.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.process_with_input(events, &[], left, right);
    }

    /// As [`Synth::process`], with incoming sound: it drives the modes of notes whose keys are held, at the input level of
    /// their sounds ([`Param::InputLevel`]). `input` has a sample for each frame; missing samples count as silence.
    pub fn process_with_input(&mut self, events: &[Event], input: &[f32], left: &mut [f32], right: &mut [f32]) {
        self.process_split(events, input, left, right, None);
    }

    /// As [`Synth::process_with_input`], with notes on outputs of their own: a pad's on that of the pad, and in a kit of one sound those of
    /// MIDI channels 2 to 16 on the output of that number. All the rest is on the main one: also what the effects after the voices make
    /// of the sum, less what the other outputs carry, so that the outputs always add up to the one of [`Synth::process`], to within
    /// rounding, as long as the limiter passes it; it works on the main output alone. All outputs are overwritten.
    pub fn process_with_outputs(
        &mut self,
        events: &[Event],
        input: &[f32],
        left: &mut [f32],
        right: &mut [f32],
        outputs: &mut Outputs<'_>,
    ) {
        outputs.silence();
        self.process_split(events, input, left, right, Some(outputs));
    }

    fn process_split(
        &mut self,
        events: &[Event],
        input: &[f32],
        left: &mut [f32],
        right: &mut [f32],
        mut outputs: Option<&mut Outputs<'_>>,
    ) {
        let frames = left.len().min(right.len());
        let (left, right) = (&mut left[..frames], &mut right[..frames]);
        self.manager.clear_ended();
        let mut frame = 0;
        for event in events {
            let at = (event.frame as usize).min(frames.saturating_sub(1)).max(frame);
            let outputs = outputs.as_deref_mut().map(|outputs| outputs.cut(frame..at));
            self.play_limited(part(input, frame, at), &mut left[frame..at], &mut right[frame..at], outputs);
            self.handle(event);
            frame = at;
        }
        let outputs = outputs.map(|outputs| outputs.cut(frame..frames));
        self.play_limited(part(input, frame, frames), &mut left[frame..], &mut right[frame..], outputs);
    }

    fn play_limited(&mut self, input: &[f32], left: &mut [f32], right: &mut [f32], mut outputs: Option<Outputs<'_>>) {
        let is_heard = self.play(&Alone, input, left, right, outputs.as_mut());
        if let Some(outputs) = &mut outputs {
            outputs.each_used(silence_inaudible);
        }
        if is_heard || !self.limiter.is_idle() {
            let limiter = self.values().choice::<params::Limiter>(Param::Limiter);
            self.limiter.process(limiter == params::Limiter::On, left, right);
            silence_inaudible(left, right);
        }
    }

    /// Renders frames without events and without the limiter, and overwrites the slices. Returns whether they may
    /// contain sound. `input` is the incoming sound; `outputs`, if any, are silent. As real-time safe as `workers` are.
    pub(in crate::engine) fn play(
        &mut self,
        workers: &impl Workers,
        input: &[f32],
        left: &mut [f32],
        right: &mut [f32],
        mut outputs: Option<&mut Outputs<'_>>,
    ) -> bool {
        left.fill(0.0);
        right.fill(0.0);
        if self.is_silent() {
            self.needs_control = false;
            self.rest(left.len());
            return false;
        }
        if workers.shares_notes() && outputs.is_none() && self.has_notes_to_share(left.len()) {
            self.render_apart(workers, input, left, right);
        } else {
            self.render(input, left, right, outputs.as_deref_mut());
        }
        // The effects hear all notes.
        let mut elsewhere = outputs.filter(|_| self.space.is_on());
        if let Some(outputs) = &mut elsewhere {
            outputs.add_to([left, right], 1.0);
        }
        flush(left, right);
        if self.space.process(left, right) {
            if let Some(outputs) = &mut elsewhere {
                outputs.add_to([left, right], -1.0);
            }
            flush(left, right);
        }
        true
    }

    /// Advances by frames in which nothing sounds.
    pub(in crate::engine) fn rest(&mut self, frames: usize) {
        self.pass(frames);
        self.space.skip(frames);
    }

    /// Renders frames without events, and adds each voice to both slices, or to its output if that is there.
    fn render(&mut self, input: &[f32], left: &mut [f32], right: &mut [f32], mut outputs: Option<&mut Outputs<'_>>) {
        let (frames, mut frame) = (left.len(), 0);
        while frame < frames {
            if self.manager.is_silent() {
                self.needs_control = false;
                return self.pass(frames - frame);
            }
            let Stretch { is_tick, to_tick, frames: now } = Stretch::new(self.clock, frames - frame);
            if is_tick {
                self.manager.active().for_each(|(_, voice)| voice.settle());
                self.manager.free_finished();
            }
            if is_tick || self.needs_control {
                self.control_tick(to_tick);
            }
            let end = frame + now;
            for (note, voice) in self.manager.active() {
                let (input, left, right) = (part(input, frame, end), &mut left[frame..end], &mut right[frame..end]);
                let own = outputs.as_deref_mut().and_then(|outputs| outputs.of(note.output, frame..end));
                let [left, right] = own.unwrap_or([left, right]);
                match &mut self.pads {
                    None => voice.render(input, left, right),
                    Some(pads) => pads.render(note, voice, input, [left, right]),
                }
            }
            self.pass(now);
            frame = end;
        }
    }

    /// Lets all voices compute their targets for the next control tick, `to_tick` frames from now, from parameters and
    /// controllers.
    fn control_tick(&mut self, to_tick: usize) {
        self.instruments.control(self.clock, to_tick as u32);
        for (note, voice) in self.manager.active() {
            voice.control(self.instruments.of_note(note), self.channels.wheels(note.channel), to_tick);
        }
        self.manager.active().for_each(|(_, voice)| voice.sweep(to_tick));
        self.needs_control = false;
    }

    /// Advances everything except the voices and the effects by `frames` frames.
    pub(super) fn pass(&mut self, frames: usize) {
        self.clock += frames as u64;
        self.instruments.advance(frames as u32);
        self.channels.advance(frames as u32);
        if let Some(pads) = &mut self.pads {
            pads.pass(frames);
        }
    }

    /// Frames until silence if no more events come; 0 if nothing sounds. Exact to a control tick ([`CONTROL_FRAMES`])
    /// after strikes have ended and smoothed parameters have reached their targets; an upper bound during a strike, and
    /// while an effect after the voices is on. Real-time safe: takes some microseconds for each voice that has changed,
    /// and nearly no time for the others.
    pub fn tail_frames(&mut self) -> u64 {
        let to_tick = (CONTROL_FRAMES as u64 - self.clock % CONTROL_FRAMES as u64) % CONTROL_FRAMES as u64;
        let (mut frames, mut peak) = (0, 0.0);
        for (_, voice) in self.manager.active() {
            frames = voice.tail_frames(to_tick).max(frames);
            peak += voice.peak();
        }
        self.space.tail_frames(frames, peak)
    }
}

/// The samples of an input from `start` up to, but not including, `end`. Shorter if the input ends earlier.
pub(in crate::engine) fn part(input: &[f32], start: usize, end: usize) -> &[f32] {
    &input[start.min(input.len())..end.min(input.len())]
}

/// Below this amplitude, −200 dBFS, samples at the output are 0.
const INAUDIBLE: f32 = 1e-10;

/// Replaces inaudible samples at the output by silence, so that no host's effect comes to compute with subnormal numbers. Samples
/// that are not a number stay.
pub(in crate::engine) fn silence_inaudible(left: &mut [f32], right: &mut [f32]) {
    let silence = |sample: &mut f32| *sample = if sample.abs() < INAUDIBLE { 0.0 } else { *sample };
    left.iter_mut().chain(right).for_each(silence);
}

/// Adds frames to a sum.
pub(in crate::engine) fn add(sum: &mut [f32], part: &[f32]) {
    sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
}

/// Replaces subnormal numbers in both slices.
pub(in crate::engine) fn flush(left: &mut [f32], right: &mut [f32]) {
    left.iter_mut().chain(right).for_each(|sample| *sample = without_subnormals(*sample));
}

/// Replaces subnormal numbers by zero, since CPUs may take a hundred times as long for them. They result from a very low
/// gain, or from the far side of a pan law, while the sound itself has nearly decayed.
fn without_subnormals(sample: f32) -> f32 {
    if sample.abs() < f32::MIN_POSITIVE { 0.0 } else { sample }
}
