//! Struck banks at work, which the benches time and whose instructions `cargo xtask callgrind` counts.

use sprung::dsp::Drive;
use sprung::dsp::{ExcitationGains, ExcitationRows, MAX_MODES, ModeBank, ModeSetup};
use sprung::internals::CONTROL_FRAMES;
use sprung::internals::exciter::{BurstSetup, Exciter, Stroke};

/// The kinds of work of a bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// Rings freely, rendered by tables.
    Ringing,
    /// Moves to another pitch at every control tick.
    Modulated,
    /// Driven by a noise burst.
    Driven,
}

impl Work {
    pub(crate) const ALL: [Work; 3] = [Work::Ringing, Work::Modulated, Work::Driven];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Work::Ringing => "ringing",
            Work::Modulated => "modulated",
            Work::Driven => "driven",
        }
    }
}

/// A bank that has been struck and rings for longer than any measurement.
pub(crate) struct StruckBank {
    pub(crate) bank: ModeBank,
    work: Work,
    noise: Drive,
    ticks: usize,
}

impl StruckBank {
    /// A bank of at most [`MAX_MODES`] modes, after some ticks of this work.
    pub(crate) fn new(modes: usize, work: Work) -> Self {
        let mut bank = ModeBank::new(48_000.0);
        let mode = |m: usize| ModeSetup { frequency: 100.0 + 310.0 * m as f64, t60: 10_000.0, left: 1.0, right: 1.0 };
        bank.load(&(0..modes).map(mode).collect());
        let gains = ExcitationGains { push: 1.0, noise: 1.0, ..ExcitationGains::NONE };
        bank.set_excitation_gains(&ExcitationRows::all(gains));
        let mut strike = Drive::NONE;
        strike.push[0] = 1.0;
        bank.sweep_to(1.0, CONTROL_FRAMES);
        bank.render(Some(&strike), CONTROL_FRAMES);

        let (mut burst, mut noise) = (Exciter::REST, Drive::NONE);
        // So weak that the masses' amplitudes stay small, however long it lasts.
        let noise_setup = BurstSetup { force: 1e-6, frames: u32::MAX, key: 7, ..BurstSetup::NONE };
        burst.strike(&Stroke { noise: noise_setup, ..Stroke::NONE }, 48_000.0);
        burst.fill(CONTROL_FRAMES, &mut noise);
        let mut struck = Self { bank, work, noise, ticks: 0 };
        // Tables are only made after a bank has rung freely for a while.
        (0..20).for_each(|_| _ = struck.tick());
        struck
    }

    /// This many modes, in banks of at most [`MAX_MODES`].
    pub(crate) fn many(modes: usize, work: Work) -> Vec<Self> {
        let whole = (0..modes / MAX_MODES).map(|_| Self::new(MAX_MODES, work));
        let rest = modes % MAX_MODES;
        whole.chain((rest > 0).then(|| Self::new(rest, work))).collect()
    }

    /// One control tick of work.
    pub(crate) fn tick(&mut self) -> f32 {
        self.ticks += 1;
        let ratio = if self.work == Work::Modulated { 1.0 + 0.001 * (self.ticks % 7) as f64 } else { 1.0 };
        self.bank.sweep_to(ratio, CONTROL_FRAMES);
        let drive = (self.work == Work::Driven).then_some(&self.noise);
        self.bank.render(drive, CONTROL_FRAMES)[0][0]
    }
}
