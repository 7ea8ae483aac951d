//! The chord that the effect holds while nobody plays: which of its notes begin and end, and when.

use sprung::engine::{EventKind, NoteId, Notes};

/// How many notes of the host can be held at once before more are not noticed.
const MOST_PLAYED: usize = 128;

/// The least identifier of the chord's notes. Hosts count from 0, and would get here after two thousand million notes.
const FIRST_ID: i32 = i32::MAX - 127;

/// The velocity of `sprung render --note`, with which the same chord has the same bits. It matters if a mallet or the like is on.
const VELOCITY: f32 = 100.0 / 127.0;

/// A chord, and the notes that somebody plays instead. Real-time safe once made.
pub(crate) struct Chord {
    /// The keys to hold while nobody plays, a bit for each.
    wanted: u128,
    /// The keys that the chord holds now.
    sounding: u128,
    /// Those that end once more before they are held.
    again: u128,
    /// What somebody plays: it never holds more than it had room for at first.
    played: Vec<Notes>,
}

impl Default for Chord {
    fn default() -> Self {
        Self { wanted: 0, sounding: 0, again: 0, played: Vec::with_capacity(MOST_PLAYED) }
    }
}

impl Chord {
    /// The channel of the chord's notes, that of `sprung render --note`.
    pub(crate) const CHANNEL: u8 = 0;

    /// Whether an identifier is that of a chord's note.
    pub(crate) fn is_own(id: NoteId) -> bool {
        id.number() >= FIRST_ID
    }

    /// Holds these keys from now on, a bit for each.
    pub(crate) fn hold(&mut self, keys: u128) {
        self.wanted = keys;
    }

    /// Forgets all that sounds, as the engine does when it is reset.
    pub(crate) fn reset(&mut self) {
        (self.sounding, self.again) = (0, 0);
        self.played.clear();
    }

    /// Lets the notes end and begin anew, for what only a new note follows: another sound or body.
    pub(crate) fn strike_again(&mut self) {
        self.again = self.sounding;
    }

    /// Notes an event that the engine is about to handle. Returns whether the chord must end before it.
    pub(crate) fn note_event(&mut self, channel: u8, kind: &EventKind) -> bool {
        match *kind {
            EventKind::NoteOn { key, id, .. } => {
                if self.played.len() < self.played.capacity() {
                    self.played.push(Notes { id, ..Notes::on(channel.min(15), key.min(127)) });
                }
                return true;
            }
            EventKind::NoteOff { key, id, .. } => self.end(Notes { id, ..Notes::on(channel.min(15), key.min(127)) }),
            EventKind::Release { notes, .. } | EventKind::Silence { notes } => self.end(notes),
            // All sound off, all notes off, and the modes that imply it.
            EventKind::Control { controller: 120 | 123..=127, .. } => {
                self.end(Notes { channel: Some(channel.min(15)), ..Notes::default() });
            }
            _ => {}
        }
        false
    }

    /// These notes end, those of the chord among them.
    fn end(&mut self, ended: Notes) {
        self.played.retain(|note| !includes(ended, *note));
        for key in 0..128 {
            if includes(ended, own(key)) {
                self.sounding &= !(1 << key);
            }
        }
    }

    /// The next event that the chord needs at this frame.
    pub(crate) fn next_event(&mut self) -> Option<EventKind> {
        let target = if self.played.is_empty() { self.wanted } else { 0 };
        let ending = self.sounding & (!target | self.again);
        if ending != 0 {
            let key = ending.trailing_zeros() as u8;
            self.sounding &= !(1 << key);
            return Some(EventKind::Release { notes: own(key), velocity: 0.5 });
        }
        self.again = 0;
        let beginning = target & !self.sounding;
        (beginning != 0).then(|| {
            let key = beginning.trailing_zeros() as u8;
            self.sounding |= 1 << key;
            EventKind::NoteOn { key, detune: 0.0, velocity: VELOCITY, id: own(key).id }
        })
    }
}

/// The chord's note on a key.
fn own(key: u8) -> Notes {
    Notes { id: NoteId::new(FIRST_ID + i32::from(key)), ..Notes::on(Chord::CHANNEL, key) }
}

/// Whether an event for `these` notes is also for one.
fn includes(these: Notes, note: Notes) -> bool {
    these.id.is_none_or(|id| note.id.is_none_or(|own| own == id))
        && these.channel.is_none_or(|channel| note.channel == Some(channel))
        && these.key.is_none_or(|key| note.key == Some(key))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(chord: &mut Chord) -> Vec<(bool, u8)> {
        let event = |kind| match kind {
            EventKind::NoteOn { key, .. } => (true, key),
            EventKind::Release { notes, .. } => (false, notes.key.unwrap()),
            other => panic!("{other:?}"),
        };
        std::iter::from_fn(|| chord.next_event()).map(event).collect()
    }

    fn on(key: u8, id: i32) -> EventKind {
        EventKind::NoteOn { key, detune: 0.0, velocity: 0.5, id: NoteId::new(id) }
    }

    #[test]
    fn it_ends_before_a_note_and_begins_after_the_last_one() {
        let mut chord = Chord::default();
        chord.hold(1 << 48 | 1 << 55);
        assert_eq!(keys(&mut chord), [(true, 48), (true, 55)]);
        assert!(chord.note_event(3, &on(60, 1)), "it must end first");
        assert_eq!(keys(&mut chord), [(false, 48), (false, 55)]);
        chord.note_event(3, &on(60, 2));
        let off = |id| EventKind::Release { notes: Notes { id: NoteId::new(id), ..Notes::default() }, velocity: 0.5 };
        chord.note_event(0, &off(1));
        assert_eq!(keys(&mut chord), [], "one is held");
        chord.note_event(0, &off(2));
        assert_eq!(keys(&mut chord), [(true, 48), (true, 55)]);
        assert_eq!(keys(&mut chord), [], "it is held once");
    }

    #[test]
    fn a_changed_chord_keeps_what_both_have_and_what_ends_it_is_noticed() {
        let mut chord = Chord::default();
        chord.hold(1 << 48 | 1 << 55);
        keys(&mut chord);
        chord.hold(1 << 48 | 1 << 51);
        assert_eq!(keys(&mut chord), [(false, 55), (true, 51)]);
        chord.strike_again();
        assert_eq!(keys(&mut chord), [(false, 48), (false, 51), (true, 48), (true, 51)]);
        chord.note_event(0, &EventKind::Silence { notes: Notes::default() });
        assert_eq!(keys(&mut chord), [(true, 48), (true, 51)], "who silences all does not silence the effect");
        chord.note_event(0, &EventKind::Control { controller: 123, value: 0.0 });
        assert_eq!(keys(&mut chord), [(true, 48), (true, 51)]);
        chord.note_event(1, &EventKind::Control { controller: 123, value: 0.0 });
        assert_eq!(keys(&mut chord), []);
    }

    #[test]
    fn no_number_of_notes_makes_it_allocate() {
        let mut chord = Chord::default();
        let room = chord.played.capacity();
        assert!((0..9999).all(|id| chord.note_event(0, &on((id % 128) as u8, id))));
        assert_eq!(chord.played.capacity(), room);
    }
}
