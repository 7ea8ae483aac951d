//! The browser's keys: arrows lead along the shelves, Space plays the sound again, Enter keeps it.

use super::list::row;
use egui::{Event, Id, Key, Modifiers, Popup, Ui};
use std::ops::Range;

/// What is asked for by a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// Try the sound that lies there from the loaded one.
    Go(Way),
    /// Play the loaded sound again.
    Again,
    /// Keep the loaded sound; a sound or a file whose name was typed is loaded first.
    Keep,
}

/// A way along the shelves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    /// To the next sound, or back to the one before.
    Beside(isize),
    /// By so many shelves down, or up.
    Shelves(isize),
    /// By as many shelves as are seen at once.
    Pages(isize),
    First,
    Last,
}

impl Way {
    /// The place of the sound to which it leads, among those on these shelves, of which `seen` are seen at once.
    pub(super) fn from(self, place: Option<usize>, shelves: &[Range<usize>], seen: usize) -> Option<usize> {
        let last = shelves.last()?.end - 1;
        let Some(place) = place else { return Some(if self == Self::Last { last } else { 0 }) };
        let by_shelves = |by: isize| {
            // A shorter shelf: its last sound. Stops at the first and the last shelf.
            let here = shelves.partition_point(|shelf| shelf.end <= place);
            let there = &shelves[here.saturating_add_signed(by).min(shelves.len() - 1)];
            (there.start + place - shelves[here].start).min(there.end - 1)
        };
        Some(match self {
            Self::Beside(by) => place.saturating_add_signed(by).min(last),
            Self::Shelves(by) => by_shelves(by),
            Self::Pages(by) => by_shelves(by * seen as isize),
            Self::First => 0,
            Self::Last => last,
        })
    }
}

/// The keys that lead along the shelves, the first four also while there are words in the search, in which the others move.
const WAYS: [(Key, Way); 8] = [
    (Key::ArrowDown, Way::Shelves(1)),
    (Key::ArrowUp, Way::Shelves(-1)),
    (Key::PageDown, Way::Pages(1)),
    (Key::PageUp, Way::Pages(-1)),
    (Key::ArrowRight, Way::Beside(1)),
    (Key::ArrowLeft, Way::Beside(-1)),
    (Key::Home, Way::First),
    (Key::End, Way::Last),
];

/// What has the focus, as far as the keys go.
#[derive(Clone, Copy, PartialEq)]
enum Focus {
    /// Nothing, or the search while it is empty.
    Free,
    /// The search with words in it.
    Words,
    /// A sound in the list.
    Sound,
    /// Something else, to which all keys belong.
    Other,
}

/// What is asked for with the keys while a list of so many sounds is shown below a search with these words. To be called before the
/// search, which would take a space as a word.
pub(super) fn asked(ui: &Ui, search: Id, words: &str, count: usize) -> Option<Command> {
    let focused = ui.memory(|memory| memory.focused());
    let focus = match focused {
        None => Focus::Free,
        Some(focused) if focused == search => {
            if words.is_empty() {
                Focus::Free
            } else {
                Focus::Words
            }
        }
        Some(focused) if (0..count).any(|place| focused == row(place)) => Focus::Sound,
        Some(_) => Focus::Other,
    };
    let (modifiers, is_open) = (ui.input(|input| input.modifiers), Popup::is_any_open(ui.ctx()));
    // A knob that is held is that of the loaded sound.
    if focus == Focus::Other || modifiers.any() || is_open || ui.input(|input| input.pointer.any_down()) {
        return None;
    }
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    let ways = if focus == Focus::Words { &WAYS[..4] } else { &WAYS[..] };
    if let Some((key, way)) = ways.iter().find(|(key, _)| pressed(*key)) {
        if focused == Some(search) {
            // It would move in the words as well.
            ui.input_mut(|input| input.consume_key(Modifiers::NONE, *key));
        }
        return Some(Command::Go(*way));
    }
    // A sound that has the focus is pressed by it, as buttons are. To the search it comes as a text.
    let is_space = |event: &Event| matches!(event, Event::Text(text) if text == " ");
    let is_again = match focused {
        None => pressed(Key::Space),
        Some(_) => focus == Focus::Free && ui.input(|input| input.events.iter().any(is_space)),
    };
    if is_again {
        ui.input_mut(|input| input.events.retain(|event| !is_space(event)));
        return Some(Command::Again);
    }
    // One that is held since the browser was opened with it closes nothing.
    let is_entered = |event: &Event| matches!(event, Event::Key { key: Key::Enter, pressed: true, repeat: false, .. });
    ui.input(|input| input.events.iter().any(is_entered)).then_some(Command::Keep)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_stay_on_the_shelves() {
        // Three full shelves of four, and one of two.
        let shelves = [0..4, 4..8, 8..12, 12..14];
        for (way, from, to) in [
            (Way::Beside(1), 3, 4),
            (Way::Beside(-1), 0, 0),
            (Way::Beside(1), 13, 13),
            (Way::Shelves(1), 1, 5),
            (Way::Shelves(1), 11, 13),
            (Way::Shelves(1), 13, 13),
            (Way::Shelves(-1), 2, 2),
            (Way::Shelves(-1), 13, 9),
            (Way::Pages(1), 1, 9),
            (Way::Pages(1), 7, 13),
            (Way::Pages(-1), 7, 3),
            (Way::First, 9, 0),
            (Way::Last, 9, 13),
        ] {
            assert_eq!(way.from(Some(from), &shelves, 2), Some(to), "{way:?} from {from}");
        }
        assert_eq!(Way::Shelves(1).from(None, &shelves, 2), Some(0), "from a sound that is not listed");
        assert_eq!(Way::Last.from(None, &shelves, 2), Some(13));
        assert_eq!(Way::First.from(None, &[], 2), None);
        // A shelf is not full above a heading.
        for (way, from, to) in [(1, 3, 4), (1, 4, 5), (1, 1, 4), (1, 9, 9), (-1, 7, 4), (-1, 4, 0)] {
            let found = Way::Shelves(way).from(Some(from), &[0..4, 4..5, 5..9, 9..10], 2);
            assert_eq!(found, Some(to), "{way} from {from}");
        }
    }
}
