//! The computer's keyboard and the mouse as a piano.

use sprung::engine::EventKind;
use sprung::realtime::LiveSender;
use std::time::{Duration, Instant};

/// The lower and the upper row of keys, an octave apart, in semitones above the lower C.
const PIANO: [(&str, u8); 2] = [("zsxdcvgbhnjm", 0), ("q2w3er5t6y7ui9o0p", 12)];

/// How long a note is held after the last repetition of its key, if the terminal does not report key releases.
const HOLD: Duration = Duration::from_millis(600);

/// MIDI key of the lower C in octave 0.
const LOWEST_C: i32 = 12;

/// The note of a computer key, in semitones above the lower C; none if the key has no note.
fn semitone(character: char) -> Option<u8> {
    PIANO.iter().find_map(|(row, offset)| {
        let place = row.chars().position(|key| key == character)?;
        Some(place as u8 + offset)
    })
}

/// The computer key of a note, which is given in semitones above the lower C.
pub(super) fn character(semitone: u8) -> Option<char> {
    let [(lower, _), (upper, _)] = PIANO;
    let place = usize::from(semitone);
    lower.chars().nth(place).or_else(|| upper.chars().nth(place.checked_sub(12)?))
}

/// The key or mouse that holds a note.
#[derive(Clone, Copy, PartialEq)]
enum Holder {
    Character(char),
    Mouse,
}

struct Down {
    holder: Holder,
    channel: u8,
    key: u8,
    until: Option<Instant>,
}

/// The notes that are held, and the octave of the computer's keyboard.
pub(super) struct Keyboard {
    sender: LiveSender,
    /// Whether the terminal reports key releases.
    pub(super) releases: bool,
    /// Octave of the lower C, 0–8.
    pub(super) octave: i32,
    /// 1–127.
    pub(super) velocity: i32,
    down: Vec<Down>,
}

impl Keyboard {
    pub(super) fn new(sender: LiveSender) -> Self {
        Self { sender, releases: false, octave: 4, velocity: 96, down: vec![] }
    }

    /// MIDI key of the lower C.
    pub(super) fn lowest(&self) -> u8 {
        (LOWEST_C + 12 * self.octave) as u8
    }

    /// Plays the note of a character. Returns false if it has none.
    pub(super) fn press(&mut self, character: char, channel: u8, now: Instant) -> bool {
        let Some(semitone) = semitone(character) else { return false };
        let until = (!self.releases).then_some(now + HOLD);
        if let Some(down) = self.down.iter_mut().find(|down| down.holder == Holder::Character(character)) {
            // The key repeats because it is held down.
            down.until = until;
            return true;
        }
        let key = self.lowest() + semitone;
        if key < 128 {
            self.hold(Holder::Character(character), channel, key, self.velocity as f32 / 127.0, until);
        }
        true
    }

    fn hold(&mut self, holder: Holder, channel: u8, key: u8, velocity: f32, until: Option<Instant>) {
        self.sender.send_now(channel, EventKind::NoteOn { key, detune: 0.0, velocity, id: None });
        self.down.push(Down { holder, channel, key, until });
    }

    /// Plays the piano key under the mouse instead of the previous one; with none, only releases that. The velocity is
    /// 0–1.
    pub(super) fn point(&mut self, channel: u8, key: Option<(u8, f32)>) {
        if self.down.iter().any(|down| down.holder == Holder::Mouse && Some(down.key) == key.map(|(key, _)| key)) {
            return;
        }
        self.let_go(|down| down.holder == Holder::Mouse);
        if let Some((key, velocity)) = key {
            self.hold(Holder::Mouse, channel, key, velocity, None);
        }
    }

    /// Handles the release of a computer key.
    pub(super) fn release(&mut self, character: char) {
        self.let_go(|down| down.holder == Holder::Character(character));
    }

    /// Releases notes whose hold time is over.
    pub(super) fn tick(&mut self, now: Instant) {
        self.let_go(|down| down.until.is_some_and(|until| until <= now));
    }

    /// Sends an event that is not a note.
    pub(super) fn send(&mut self, channel: u8, kind: EventKind) {
        self.sender.send_now(channel, kind);
    }

    /// Releases and silences everything, on all channels.
    pub(super) fn panic(&mut self) {
        self.down.clear();
        self.sender.release_all();
        self.sender.silence_all();
    }

    fn let_go(&mut self, over: impl Fn(&Down) -> bool) {
        for down in self.down.extract_if(.., |down| over(down)) {
            self.sender.send_now(down.channel, EventKind::NoteOff { key: down.key, velocity: 0.5, id: None });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rows_make_two_and_a_half_octaves() {
        for (typed, expected) in [('z', Some(0)), ('m', Some(11)), ('q', Some(12)), ('p', Some(28)), ('a', None)] {
            assert_eq!(semitone(typed), expected, "{typed}");
        }
        for semitone_up in 0..=28 {
            assert_eq!(semitone(character(semitone_up).unwrap()), Some(semitone_up));
        }
        assert_eq!(character(29), None);
    }
}
