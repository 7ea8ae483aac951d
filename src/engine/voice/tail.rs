//! When a voice will be over: known in closed form, because nothing but damping takes energy from its modes.

use super::{NEARLY_SILENT, SILENCE, STOCK_TICKS, SynthVoice};
use crate::dsp::CONTROL_FRAMES;
use crate::engine::voice_manager::Voice;

const TICK: u64 = CONTROL_FRAMES as u64;

impl SynthVoice {
    /// Frames until the voice is over if it is left alone, `to_tick` frames before the next control tick: exact to a
    /// tick once the strike has ended and neither decay nor gain slides to another value, no less than that during a
    /// strike. Without end where routes move decay or gain: nobody knows where they will be.
    ///
    /// Real-time safe. Some microseconds after a strike, release or change of gain or decay, next to nothing otherwise.
    pub(crate) fn tail_frames(&mut self, to_tick: u64) -> u64 {
        if self.is_over() {
            return to_tick;
        }
        if self.modulators.move_the_end() {
            return u64::MAX;
        }
        let end = match self.end {
            Some(end) => end,
            None => {
                let end = self.total_age + self.find_end(to_tick);
                // While energy comes in or the gain slides, the end is not known yet.
                self.end = (self.pending_energy == 0.0 && self.fader.is_level()).then_some(end);
                end
            }
        };
        let fade =
            self.fader.frames_left().map_or(u64::MAX, |frames| to_tick + round_up(frames.saturating_sub(to_tick)));
        end.saturating_sub(self.total_age).min(fade)
    }

    /// Stock is taken of the energy every [`STOCK_TICKS`], and at every tick once it has been found low: the end is
    /// the first time that it is then below the limit.
    fn find_end(&self, to_tick: u64) -> u64 {
        let gain = f64::from(self.fader.loudest()).max(1.0);
        let share = 1.0 / (self.bank.len().max(1) as f64 * gain * gain);
        let below = |amplitude: f64| amplitude * amplitude * share;
        if self.pending_energy > 0.0 {
            let frames = self.bank.frames_until_at_most(below(SILENCE), self.pending_energy);
            return to_tick
                + round_up(u64::from(self.exciter.frames_left()).saturating_add(frames))
                + STOCK_TICKS as u64 * TICK;
        }
        let silent = self.bank.frames_until(below(SILENCE));
        let every_tick = to_tick + round_up(silent.saturating_sub(to_tick));
        if self.loudest() < NEARLY_SILENT * NEARLY_SILENT {
            return every_tick;
        }
        let nearly = self.bank.frames_until(below(NEARLY_SILENT));
        let first = to_tick + u64::from(self.until_stock) * TICK;
        let interval = u64::from(STOCK_TICKS) * TICK;
        let found = first + nearly.saturating_sub(first).div_ceil(interval) * interval;
        every_tick.max(found)
    }
}

fn round_up(frames: u64) -> u64 {
    frames.div_ceil(TICK) * TICK
}
