//! The energy of a voice, and when it will be over: known, because nothing but damping takes energy from its modes.

use super::strike::Strike;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::cells::Cells;
use crate::engine::fader::Fader;

/// A voice is over when its modes could not add up to more than this: −120 dBFS.
const SILENCE: f64 = 1e-6;

/// The energy is measured every so many control ticks, and at every tick below −110 dBFS.
const MEASURING_TICKS: u32 = 8;
const NEARLY_SILENT: f64 = 3.2e-6;

const TICK: u64 = CONTROL_FRAMES as u64;

/// The energy of a voice: sums of squared amplitudes. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy {
    /// What the exciter has still to bring.
    pending: f64,
    /// That of the bank when it was last measured.
    measured: f64,
    /// Control ticks until it is measured again.
    until_measured: u32,
    /// The frame since the voice's start at which it will be over, if it is known.
    end: Option<u64>,
}

impl Energy {
    /// Of a voice at rest.
    pub(super) const NONE: Self = Self { pending: 0.0, measured: 0.0, until_measured: 0, end: None };

    /// The exciter will bring so much more: less, if negative.
    pub(super) fn expect(&mut self, more: f64) {
        self.pending += more;
    }

    /// Decay, gain or a strike has changed when the voice will be over.
    pub(super) fn forget_end(&mut self) {
        self.end = None;
    }

    /// Measures the remaining energy and puts silent modes to rest, at control ticks. Every few ticks are enough, until
    /// the voice is nearly silent or its strike has just ended.
    pub(super) fn settle(&mut self, bank: &mut Cells, strike: &Strike, fader: &Fader) {
        let strike_over = self.pending > 0.0 && !strike.is_active();
        if self.until_measured == 0 || strike_over || self.is_below(NEARLY_SILENT, bank, fader) {
            self.measured = bank.settle();
            self.until_measured = MEASURING_TICKS;
            if !strike.is_active() {
                self.pending = 0.0;
            }
        }
        self.until_measured -= 1;
    }

    /// Whether the modes could not add up to an amplitude, were they all in phase: n amplitudes whose squares sum to E
    /// add up to √(n E) at most.
    fn is_below(&self, amplitude: f64, bank: &Cells, fader: &Fader) -> bool {
        let gain = f64::from(fader.loudest()).max(1.0);
        self.measured * bank.len() as f64 * gain * gain < amplitude * amplitude
    }

    /// What orders voices by how loud they are.
    pub(super) fn rank(&self, fader: &Fader) -> f64 {
        self.measured.max(self.pending) * fader.remaining()
    }

    /// Whether the voice will be silent until it is struck again.
    pub(super) fn is_over(&self, bank: &Cells, fader: &Fader) -> bool {
        fader.is_closed() || (self.pending == 0.0 && self.is_below(SILENCE, bank, fader))
    }

    /// Frames until the voice is over if it is left alone, `now` frames after its start and `to_tick` frames before the
    /// next control tick: exact to a tick once the strike has ended and neither decay nor gain slides to another value,
    /// no less than that during a strike.
    pub(super) fn tail_frames(&mut self, bank: &Cells, strike: &Strike, fader: &Fader, now: u64, to_tick: u64) -> u64 {
        let end = match self.end {
            Some(end) => end,
            None => {
                let end = now + self.find_end(bank, strike, fader, to_tick);
                // While energy comes in or the gain slides, the end is not known yet.
                self.end = (self.pending == 0.0 && fader.is_level()).then_some(end);
                end
            }
        };
        let fade = fader.frames_left().map_or(u64::MAX, |frames| to_tick + round_up(frames.saturating_sub(to_tick)));
        end.saturating_sub(now).min(fade)
    }

    /// The energy is measured every [`MEASURING_TICKS`], and at every tick once it has been found low: the end is the
    /// first time that it is then below the limit.
    fn find_end(&self, bank: &Cells, strike: &Strike, fader: &Fader, to_tick: u64) -> u64 {
        let gain = f64::from(fader.loudest()).max(1.0);
        let share = 1.0 / (bank.len().max(1) as f64 * gain * gain);
        let below = |amplitude: f64| amplitude * amplitude * share;
        if self.pending > 0.0 {
            let frames = bank.frames_until_at_most(below(SILENCE), self.pending);
            return to_tick
                + round_up(u64::from(strike.frames_left()).saturating_add(frames))
                + u64::from(MEASURING_TICKS) * TICK;
        }
        let silent = bank.frames_until(below(SILENCE));
        let every_tick = to_tick + round_up(silent.saturating_sub(to_tick));
        if self.is_below(NEARLY_SILENT, bank, fader) {
            return every_tick;
        }
        let nearly = bank.frames_until(below(NEARLY_SILENT));
        let first = to_tick + u64::from(self.until_measured) * TICK;
        let interval = u64::from(MEASURING_TICKS) * TICK;
        let found = first + nearly.saturating_sub(first).div_ceil(interval) * interval;
        every_tick.max(found)
    }
}

fn round_up(frames: u64) -> u64 {
    frames.div_ceil(TICK) * TICK
}
