//! Portamento as MIDI's controllers set it: where a note glides from, and how fast.

use super::midi::{controller, seven_bits};

/// Seconds in which a glide of three octaves ends, at values of controller 5. The values between are on straight lines. MIDI leaves
/// the times to the instrument; these are a Roland SC-55's (measured by John Novak, dosbox-staging, pull request 2705, 2023).
const SECONDS: [(u8, f64); 15] = [
    (0, 0.0),
    (1, 0.006),
    (2, 0.023),
    (4, 0.05),
    (8, 0.11),
    (16, 0.25),
    (32, 0.5),
    (64, 2.06),
    (80, 4.2),
    (96, 8.4),
    (112, 19.5),
    (116, 26.7),
    (120, 40.0),
    (124, 80.0),
    (127, 480.0),
];

/// Semitones of the glides of [`SECONDS`]. The speed does not depend on the distance.
const SEMITONES: f64 = 36.0;

/// The portamento of a channel. Real-time safe.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Portamento {
    is_on: bool,
    /// Controller 5; none until it comes, for the patch's own time.
    time: Option<u8>,
    /// The key that the next note glides from, whether portamento is on or not.
    from_key: Option<u8>,
}

/// How a note glides, in place of its patch's glide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoteGlide {
    /// Seconds per semitone; none for the patch's time.
    pub(crate) pace: Option<f64>,
    /// The key that it glides from; none for the pitch of the note before.
    pub(crate) from_key: Option<u8>,
    /// The pitch of that key in semitones on the MIDI scale.
    pub(crate) from: Option<f64>,
}

impl Portamento {
    /// Handles a controller at a value 0–1.
    pub(super) fn control(&mut self, number: u8, value: f32) {
        match number {
            controller::PORTAMENTO_TIME => self.time = Some(seven_bits(value)),
            controller::PORTAMENTO => self.is_on = value >= 0.5,
            controller::PORTAMENTO_CONTROL => self.from_key = Some(seven_bits(value)),
            controller::RESET => (self.is_on, self.from_key) = (false, None),
            _ => {}
        }
    }

    /// The glide of the note that starts now; none for that of its patch.
    pub(super) fn start(&mut self) -> Option<NoteGlide> {
        let from_key = self.from_key.take();
        let glide = NoteGlide { pace: self.time.map(pace), from_key, from: None };
        (self.is_on || from_key.is_some()).then_some(glide)
    }
}

impl NoteGlide {
    /// The glide with which a voice returns to the note: from where it is.
    pub(crate) fn back(self) -> Self {
        Self { from_key: None, from: None, ..self }
    }
}

/// Seconds per semitone at a value of controller 5.
fn pace(time: u8) -> f64 {
    let above = SECONDS.iter().position(|(value, _)| *value >= time).unwrap_or(SECONDS.len() - 1);
    let ((low, from), (high, to)) = (SECONDS[above.saturating_sub(1)], SECONDS[above]);
    let share = if high == low { 0.0 } else { f64::from(time - low) / f64::from(high - low) };
    (from + (to - from) * share) / SEMITONES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_table_and_lines_between() {
        for (time, seconds) in [(0, 0.0), (1, 0.006), (3, 0.0365), (64, 2.06), (72, 3.13), (127, 480.0)] {
            assert!((pace(time) * SEMITONES - seconds).abs() < 1e-12, "{time}");
        }
    }

    #[test]
    fn a_note_glides_if_portamento_is_on_or_a_key_to_glide_from_was_named() {
        let mut portamento = Portamento::default();
        assert_eq!(portamento.start(), None);
        portamento.control(controller::PORTAMENTO_CONTROL, 48.0 / 127.0);
        let glide = portamento.start().unwrap();
        assert_eq!((glide.from_key, glide.pace), (Some(48), None));
        assert_eq!(portamento.start(), None, "only the next note");
        portamento.control(controller::PORTAMENTO, 1.0);
        portamento.control(controller::PORTAMENTO_TIME, 64.0 / 127.0);
        assert_eq!(portamento.start().unwrap().pace, Some(2.06 / 36.0));
        portamento.control(controller::RESET, 0.0);
        assert_eq!(portamento.start(), None);
    }
}
