//! The computer's keyboard as a piano, in the standalone program only.

use crate::link::{Link, Touch};
use egui::{Event, Key, Ui};
use sprung::units::note_name;

/// The two rows of keys, and their first key's semitones above the lower C.
const ROWS: [(&[Key], u8); 2] = [
    (&[Key::Z, Key::S, Key::X, Key::D, Key::C, Key::V, Key::G, Key::B, Key::H, Key::N, Key::J, Key::M], 0),
    (
        &[
            Key::Q,
            Key::Num2,
            Key::W,
            Key::Num3,
            Key::E,
            Key::R,
            Key::Num5,
            Key::T,
            Key::Num6,
            Key::Y,
            Key::Num7,
            Key::U,
            Key::I,
            Key::Num9,
            Key::O,
            Key::Num0,
            Key::P,
        ],
        12,
    ),
];

/// The octaves that the lower C can have, and the one at the start.
const OCTAVES: std::ops::RangeInclusive<u8> = 0..=8;
const OCTAVE: u8 = 4;

const VELOCITY: f32 = 0.75;

/// The keys of the computer that are held, and the notes that they play.
pub(crate) struct ComputerKeyboard {
    octave: u8,
    held: Vec<(Key, u8)>,
    /// Keys released in the last pass. X11 repeats a held key by releasing and pressing it again.
    lifted: Vec<Key>,
}

impl Default for ComputerKeyboard {
    fn default() -> Self {
        Self { octave: OCTAVE, held: vec![], lifted: vec![] }
    }
}

impl ComputerKeyboard {
    /// Plays the pressed keys, unless the user types text. Returns a message for the user.
    pub(crate) fn follow(&mut self, ui: &Ui, link: &Link) -> Option<String> {
        let (modifiers, is_focused) = ui.input(|input| (input.modifiers, input.focused));
        if ui.ctx().egui_wants_keyboard_input() || modifiers.ctrl || modifiers.alt || modifiers.command || !is_focused {
            self.release(link);
            return None;
        }
        let mut gone = std::mem::take(&mut self.lifted);
        let octave = self.octave;
        for event in ui.input(|input| input.events.clone()) {
            let Event::Key { key, pressed, .. } = event else { continue };
            match (key, pressed) {
                (Key::OpenBracket, true) => self.octave = octave.saturating_sub(1).max(*OCTAVES.start()),
                (Key::CloseBracket, true) => self.octave = (octave + 1).min(*OCTAVES.end()),
                (_, true) if self.held.iter().any(|(held, _)| *held == key) => {
                    gone.retain(|one| *one != key);
                    self.lifted.retain(|one| *one != key);
                }
                (_, true) => self.press(key, link),
                (_, false) => self.lifted.push(key),
            }
        }
        gone.into_iter().for_each(|key| self.lift(key, link));
        if !self.lifted.is_empty() {
            ui.ctx().request_repaint();
        }
        (self.octave != octave).then(|| format!("the key z plays {}", note_name(12 + 12 * self.octave)))
    }

    /// Releases all held keys.
    pub(crate) fn release(&mut self, link: &Link) {
        self.lifted.clear();
        for (_, key) in self.held.drain(..) {
            link.play(Touch::Up { key });
        }
    }

    fn press(&mut self, pressed: Key, link: &Link) {
        let semitone = ROWS.iter().find_map(|(row, first)| {
            let place = row.iter().position(|key| *key == pressed)?;
            Some(first + place as u8)
        });
        let key = semitone.map(|semitone| 12 + 12 * self.octave + semitone).filter(|key| *key < 128);
        if let Some(key) = key {
            self.held.push((pressed, key));
            link.play(Touch::Down { key, velocity: VELOCITY });
        }
    }

    fn lift(&mut self, lifted: Key, link: &Link) {
        if let Some(place) = self.held.iter().position(|(key, _)| *key == lifted) {
            let (_, key) = self.held.swap_remove(place);
            link.play(Touch::Up { key });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Modifiers, RawInput};

    #[test]
    fn keys_play_repeat_without_a_strike_and_go_up() {
        let (link, context) = (Link::default(), egui::Context::default());
        let mut touches = link.connect(48_000.0);
        let mut piano = ComputerKeyboard::default();
        let mut pass = |keys: &[(Key, bool)]| {
            let event = |&(key, pressed): &(Key, bool)| {
                let modifiers = Modifiers::NONE;
                Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
            };
            let input = RawInput { events: keys.iter().map(event).collect(), ..RawInput::default() };
            let mut message = None;
            context.run_ui(input, |ui| message = piano.follow(ui, &link)).textures_delta.clear();
            (std::iter::from_fn(|| touches.pop().ok()).collect::<Vec<_>>(), message)
        };
        let down = |key| Touch::Down { key, velocity: VELOCITY };
        assert_eq!(pass(&[(Key::Z, true), (Key::Q, true)]).0, [down(60), down(72)]);
        assert_eq!(pass(&[(Key::Z, false), (Key::Z, true)]).0, [], "a repeated key is held on");
        assert_eq!(pass(&[(Key::Z, false)]).0, []);
        assert_eq!(pass(&[(Key::Z, true)]).0, [], "also when the two halves come in different passes");
        assert_eq!(pass(&[(Key::Z, false), (Key::A, true)]).0, []);
        assert_eq!(pass(&[]).0, [Touch::Up { key: 60 }], "a key that stays up goes up");
        assert_eq!(pass(&[(Key::CloseBracket, true)]).1.as_deref(), Some("the key z plays C5"));
        assert_eq!(pass(&[(Key::Q, false), (Key::X, true)]).0, [down(74)]);
        assert_eq!(pass(&[]).0, [Touch::Up { key: 72 }], "the key that went down, not one an octave higher");
    }
}
