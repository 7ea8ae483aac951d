//! A mode of a strike, and the strike with all its modes.

/// The kinds of groups of modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Modes of nearly the same frequency, which beat: one mode of a perfect body, split by imperfections.
    SplitPair,
    /// A mode that decays fast at first and slowly later: modes of one frequency and different T60, as of a string's two
    /// directions (Weinreich 1977).
    TwoStageDecay,
}

/// Modes of a strike that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The kind.
    pub kind: Kind,
    /// Their places in the list of modes.
    pub modes: Vec<usize>,
}

/// Standard deviations, if the residual is noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// Hz.
    pub frequency: f64,
    /// Seconds.
    pub t60: f64,
    /// dB.
    pub level_db: f64,
    /// Radians.
    pub phase: f64,
}

/// A damped sinusoid, `a · 0.001^(t / t60) · sin(2π · frequency · t + phase)` with `t` in seconds from the strike's onset.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Hz.
    pub frequency: f64,
    /// Seconds in which it decays by 60 dB.
    pub t60: f64,
    /// `a` in dBFS: 0 dB is a sine of full scale.
    pub level_db: f64,
    /// Radians, −π to π.
    pub phase: f64,
    /// The uncertainties of these values.
    pub uncertainty: Uncertainty,
    /// Energy of the mode over the power density of the noise at its frequency, in dB. Detection depends on it.
    pub snr_db: f64,
    /// Level in dBFS and phase in each channel, where there are several.
    pub channels: Vec<(f64, f64)>,
}

impl Mode {
    /// Whether all of its numbers are known.
    pub(super) fn is_finite(&self) -> bool {
        let Uncertainty { frequency, t60, level_db, phase } = self.uncertainty;
        let own = [self.frequency, self.t60, self.level_db, self.phase, self.snr_db, frequency, t60, level_db, phase];
        let channels = self.channels.iter().flat_map(|(level, phase)| [*level, *phase]);
        own.into_iter().chain(channels).all(f64::is_finite)
    }
}

/// One strike and its modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Strike {
    /// Seconds from the recording's beginning to the strike's.
    pub onset: f64,
    /// Seconds from there to the end of the part that was analysed.
    pub seconds: f64,
    /// Seconds from the recording's beginning to where the strike is damped from outside and the analysis ends; none if
    /// it rings to its end.
    pub damped: Option<f64>,
    /// By rising frequency.
    pub modes: Vec<Mode>,
    /// Tones that do not decay measurably, such as hum and sustained notes, by rising frequency. They are no modes;
    /// their T60 is a guess, of 2000 s at most.
    pub steady: Vec<Mode>,
    /// Modes that are heard as one partial, by their indices in `modes`.
    pub groups: Vec<Group>,
    /// Energy of the residual, in dB relative to the whole.
    pub residual_db: f64,
    /// The sound from `fitted_from` on.
    pub samples: Vec<f32>,
    /// The sound minus its modes, from `fitted_from` on.
    pub residual: Vec<f32>,
    /// Seconds from the recording's beginning to the first of `samples`, where the exciter has let go.
    pub fitted_from: f64,
}
