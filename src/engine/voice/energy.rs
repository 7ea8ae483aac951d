//! The energy of a voice, and the predicted time of its end, which is known because only damping removes energy.

use super::strike::Strike;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::cells::Cells;
use crate::dsp::fader::Fader;
use libm::sqrt;

/// A voice is over when the sum of its modes is below this amplitude, −120 dBFS, for any phases.
const SILENCE: f64 = 1e-6;

/// Modes that are set to rest before their voice is over. Together they stay below this amplitude, −150 dBFS, whatever their
/// phases, at the gain at which the voice is judged and before effects. They have at most a thousandth of the energy at which a
/// voice is over, so its end moves by T60/14,000 at most. If the body blooms later, they start in a new phase, as all modes at
/// rest do.
const LEFT_OUT: f64 = 3.2e-8;

/// A voice is judged as if its gain were at least this, and at least 1 while it moves, since it may rise. To rise to 1 makes what was
/// left out 20 dB louder than said above at most, and a voice that has ended would be below −100 dBFS.
const LEAST_GAIN: f64 = 0.1;

/// Control ticks between two measurements of the energy. Below −110 dBFS it is measured at every tick.
const MEASURING_TICKS: u32 = 8;
const NEARLY_SILENT: f64 = 3.2e-6;

const TICK: u64 = CONTROL_FRAMES as u64;

/// The energy of a voice: sums of squared amplitudes. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy {
    /// Upper bound of the energy that strikes in progress have added and will add.
    pending: f64,
    /// Energy of the bank when it was last measured.
    measured: f64,
    /// Control ticks until the next measurement.
    until_measured: u32,
    /// Control ticks between two measurements, unless the voice is nearly silent.
    interval: u32,
    /// Frames from the voice's start to its end, if already known.
    end: Option<u64>,
}

impl Energy {
    /// The energy of a voice at rest.
    pub(super) const NONE: Self =
        Self { pending: 0.0, measured: 0.0, until_measured: 0, interval: MEASURING_TICKS, end: None };

    /// Adds the energy of a strike. `more` may be negative.
    pub(super) fn expect(&mut self, more: f64) {
        self.pending += more;
    }

    /// Adds an amplitude to one mode. Until the next measurement the energy is an upper bound, except with the original formulas,
    /// which give high modes more than was asked for.
    pub(super) fn nudge(&mut self, amplitude: f64) {
        let most = sqrt(self.measured) + amplitude;
        (self.measured, self.until_measured, self.end) = (most * most, 0, None);
    }

    /// Discards the known end, after a change of decay or gain or after a strike.
    pub(super) fn forget_end(&mut self) {
        self.end = None;
    }

    /// Sets whether the energy is measured at every control tick.
    pub(super) fn measure_always(&mut self, always: bool) {
        let interval = if always { 1 } else { MEASURING_TICKS };
        if self.interval != interval {
            (self.interval, self.until_measured, self.end) = (interval, 0, None);
        }
    }

    /// The energy now, or, if it is greater, what the pulses of the last strike will have brought (`coming`).
    pub(super) fn now(&self, coming: f64) -> f64 {
        self.measured.max(coming)
    }

    /// Measures the remaining energy and puts silent modes to rest. Called at control ticks, but only measures every
    /// few ticks, until the voice is nearly silent or its strike has just ended. If the voice `rings` freely, so that no force and
    /// no other mode will bring them back, modes that cannot be heard are put to rest too.
    pub(super) fn settle(&mut self, bank: &mut Cells, strike: &Strike, fader: &Fader, rings: bool) {
        let strike_over = self.pending > 0.0 && !strike.is_active();
        if self.until_measured == 0 || strike_over || self.is_below(NEARLY_SILENT, bank, fader) {
            self.measured = bank.settle();
            self.until_measured = self.interval;
            if !strike.is_active() {
                self.pending = 0.0;
            }
            if rings {
                bank.rest_below((LEFT_OUT / (gain(fader) * bank.len() as f64)) as f32);
            }
        }
        self.until_measured -= 1;
    }

    /// Whether the sum of the modes cannot reach an amplitude, even with all modes in phase: n amplitudes whose squares
    /// sum to E add up to √(n E) at most.
    fn is_below(&self, amplitude: f64, bank: &Cells, fader: &Fader) -> bool {
        let gain = gain(fader);
        self.measured * bank.len() as f64 * gain * gain < amplitude * amplitude
    }

    /// Upper bound of the amplitude from now on: the amplitude with all modes in phase, at a gain of 1 if the voice's is less, since
    /// it may rise.
    pub(super) fn peak(&self, bank: &Cells, fader: &Fader) -> f64 {
        let gain = f64::from(fader.loudest()).max(1.0);
        (sqrt(self.measured) + sqrt(self.pending.max(0.0))) * sqrt(bank.len() as f64) * gain
    }

    /// How loud the voice is, or will be by what acts on it, for voice stealing; at least `least`.
    pub(super) fn rank(&self, least: f64, fader: &Fader) -> f64 {
        self.measured.max(self.pending).max(least) * fader.remaining()
    }

    /// Whether the voice will be silent until it is struck again.
    pub(super) fn is_over(&self, bank: &Cells, fader: &Fader) -> bool {
        fader.is_closed() || (self.pending == 0.0 && self.is_below(SILENCE, bank, fader))
    }

    /// Frames until the voice is over if no event comes, `now` frames after its start and `to_tick` frames before the next
    /// control tick. Exact to a tick after the strike has ended and while neither decay nor gain changes; an upper bound
    /// during a strike, and while energy moves to higher modes (`blooms`).
    pub(super) fn tail_frames(
        &mut self,
        bank: &Cells,
        strike: &Strike,
        fader: &Fader,
        blooms: bool,
        [now, to_tick]: [u64; 2],
    ) -> u64 {
        let end = match self.end {
            Some(end) => end,
            None => {
                let end = now + self.find_end(bank, strike, fader, blooms, to_tick);
                // While the strike adds energy, the gain changes or energy moves to higher modes, the end may still change.
                self.end = (self.pending == 0.0 && fader.is_level() && !blooms).then_some(end);
                end
            }
        };
        let fade = fader.frames_left().map_or(u64::MAX, |frames| to_tick + round_up(frames.saturating_sub(to_tick)));
        end.saturating_sub(now).min(fade)
    }

    /// Frames until the end is detected. The energy is measured every [`MEASURING_TICKS`] ticks, or at every tick if the
    /// interval is 1 or the voice is nearly silent. The voice ends at the first measurement below the limit.
    fn find_end(&self, bank: &Cells, strike: &Strike, fader: &Fader, blooms: bool, to_tick: u64) -> u64 {
        let gain = gain(fader);
        let share = 1.0 / (bank.len().max(1) as f64 * gain * gain);
        let below = |amplitude: f64| amplitude * amplitude * share;
        if self.pending > 0.0 || blooms {
            // With bloom, energy may reach any mode, so all of it is assumed to decay as slowly as the slowest mode.
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
        let interval = u64::from(self.interval) * TICK;
        let found = first + nearly.saturating_sub(first).div_ceil(interval) * interval;
        every_tick.max(found)
    }
}

/// The gain at which a voice is judged.
fn gain(fader: &Fader) -> f64 {
    f64::from(fader.loudest()).max(if fader.is_level() { LEAST_GAIN } else { 1.0 })
}

fn round_up(frames: u64) -> u64 {
    frames.div_ceil(TICK) * TICK
}
