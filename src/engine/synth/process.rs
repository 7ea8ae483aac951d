//! How a synth renders: blocks divided at events, and the frames between events divided at control ticks.

use super::Synth;
use crate::dsp::CONTROL_FRAMES;
use crate::engine::event::Event;
use crate::params::{self, Param};

impl Synth {
    /// Renders the next frames over what the slices hold: as many as the shorter of the two has (any number; they are
    /// meant to be of one length). The rest of a longer one stays as it is. `events` are in order of their frames.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let (left, right) = (&mut left[..frames], &mut right[..frames]);
        self.manager.clear_ended();
        let mut frame = 0;
        for event in events {
            let at = (event.frame as usize).min(frames.saturating_sub(1)).max(frame);
            self.play_limited(&mut left[frame..at], &mut right[frame..at]);
            self.handle(event);
            frame = at;
        }
        self.play_limited(&mut left[frame..], &mut right[frame..]);
    }

    fn play_limited(&mut self, left: &mut [f32], right: &mut [f32]) {
        let is_heard = self.play(left, right);
        if is_heard || !self.limiter.is_idle() {
            let limiter = self.values().choice::<params::Limiter>(Param::Limiter);
            self.limiter.process(limiter == params::Limiter::On, left, right);
        }
    }

    /// Renders frames in which nothing happens over what the slices hold, without the limiter. Returns whether there
    /// may be sound in them.
    pub(in crate::engine) fn play(&mut self, left: &mut [f32], right: &mut [f32]) -> bool {
        left.fill(0.0);
        right.fill(0.0);
        let is_heard = !self.manager.is_silent();
        self.render(left, right);
        if is_heard {
            left.iter_mut().chain(right).for_each(|sample| *sample = without_subnormals(*sample));
        }
        is_heard
    }

    /// Renders frames in which nothing happens, adding to both slices.
    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let (frames, mut frame) = (left.len(), 0);
        while frame < frames {
            if self.manager.is_silent() {
                self.needs_control = false;
                return self.pass(frames - frame);
            }
            let to_tick = CONTROL_FRAMES - (self.clock % CONTROL_FRAMES as u64) as usize;
            let is_tick = to_tick == CONTROL_FRAMES;
            if is_tick {
                self.manager.active().for_each(|(_, voice)| voice.settle());
                self.manager.free_finished();
            }
            if is_tick || self.needs_control {
                self.control_tick(to_tick);
            }
            let end = frames.min(frame + to_tick);
            for (_, voice) in self.manager.active() {
                voice.render(&mut left[frame..end], &mut right[frame..end]);
            }
            self.pass(end - frame);
            frame = end;
        }
    }

    /// Has voices set out for what parameters and controllers ask for at the next control tick, `to_tick` frames from
    /// now.
    fn control_tick(&mut self, to_tick: usize) {
        self.instruments.control(self.clock, to_tick as u32);
        for (note, voice) in self.manager.active() {
            voice.control(self.instruments.of_note(note), self.channels.wheels(note.channel), to_tick);
        }
        self.manager.active().for_each(|(_, voice)| voice.sweep(to_tick));
        self.needs_control = false;
    }

    /// Lets time pass for everything but the voices: all there is to do while none sounds.
    pub(in crate::engine) fn pass(&mut self, frames: usize) {
        self.clock += frames as u64;
        self.instruments.advance(frames as u32);
        self.channels.advance(frames as u32);
    }

    /// Frames until silence if nothing more happens: exact to a control tick ([`CONTROL_FRAMES`]) once strikes have
    /// ended and parameters have arrived where they slide to, no less than that during a strike; 0 if nothing sounds.
    /// Real-time safe: some microseconds a voice when something has happened to it, next to nothing otherwise.
    pub fn tail_frames(&mut self) -> u64 {
        let to_tick = (CONTROL_FRAMES as u64 - self.clock % CONTROL_FRAMES as u64) % CONTROL_FRAMES as u64;
        self.manager.active().map(|(_, voice)| voice.tail_frames(to_tick)).max().unwrap_or(0)
    }
}

/// Zero for a number so small that CPUs take a hundred times as long for it: what is left of −60 dB of gain or of the
/// far end of a pan law when the sound itself has all but died away.
fn without_subnormals(sample: f32) -> f32 {
    if sample.abs() < f32::MIN_POSITIVE { 0.0 } else { sample }
}
