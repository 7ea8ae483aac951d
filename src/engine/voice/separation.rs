//! Strikes on one voice, told apart for labels: what each of them has given the modes, while others still ring or act.

use super::strike::Strike;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::cells::Cells;
use crate::dsp::exciter::{Drive, Player};
use crate::engine::note::Note;

/// A strike, and modes that hear it alone.
pub(super) struct SeparateStrike {
    pub(super) note: Note,
    /// The number of its blow in the exciter; none if another strike has taken its place there.
    blow: Option<usize>,
    pub(super) modes: Cells,
}

impl SeparateStrike {
    /// Whether any of its forces is still to come.
    pub(super) fn is_acting(&self, strike: &Strike) -> bool {
        self.blow.is_some_and(|blow| strike.is_acting(blow))
    }
}

/// The strikes of a voice that overlap with others, or that were made while it rang. A strike on a voice at rest needs no modes of
/// its own until another one follows, since the voice's modes hear nothing else.
pub(super) struct Separation {
    /// The note that was struck last.
    struck: Note,
    pub(super) strikes: Vec<SeparateStrike>,
}

impl Separation {
    pub(super) const NONE: Self = Self { struck: Note::NONE, strikes: Vec::new() };

    /// A strike on a voice at rest.
    pub(super) fn begin(&mut self, note: &Note) {
        self.struck = *note;
        self.strikes.clear();
    }

    /// Gives the strike in progress, if it is the only one, modes of its own: those of the voice. To be called before the voice
    /// gets another note.
    pub(super) fn separate(&mut self, strike: &Strike, modes: &Cells) {
        if strike.is_active() && !self.strikes.iter().any(|share| share.is_acting(strike)) {
            let blow = Some(strike.exciter().newest());
            self.strikes.push(SeparateStrike { note: self.struck, blow, modes: modes.clone() });
        }
    }

    /// A further strike, which has just begun.
    pub(super) fn add(&mut self, note: &Note, strike: &Strike, modes: &Cells) {
        self.struck = *note;
        let blow = Some(strike.exciter().newest());
        self.strikes.iter_mut().filter(|share| share.blow == blow).for_each(|share| share.blow = None);
        let mut modes = modes.clone();
        modes.rest();
        self.strikes.push(SeparateStrike { note: *note, blow, modes });
    }

    /// Renders the next frames of each strike's own modes. The voice's modes are about to render the same frames.
    pub(super) fn render(&mut self, strike: &Strike, modes: &Cells, frames: usize) {
        let (is_hammered, mut forces) = (strike.hammering.is_on() && !self.strikes.is_empty(), [0.0; CONTROL_FRAMES]);
        if is_hammered {
            let (mut hammer, mut all, mut drive) = (strike.hammering.hammer, modes.clone(), Drive::NONE);
            strike.exciter().clone().fill(frames, &mut drive);
            forces = all.render_hammered(&drive, &mut Player::Hammer(&mut hammer), frames);
        }
        for share in &mut self.strikes {
            let mut drive = Drive::NONE;
            if let Some(blow) = share.blow {
                strike.exciter().only(blow).fill(frames, &mut drive);
            }
            let forces = if share.blow == Some(strike.exciter().newest()) { &forces } else { &[0.0; CONTROL_FRAMES] };
            let before = std::mem::replace(&mut share.modes, modes.clone());
            share.modes.take_state_of(&before);
            share.modes.render(Some(&drive), is_hammered.then_some(Player::Forces(forces)), frames);
        }
    }
}
