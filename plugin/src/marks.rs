//! What the host says of parameters: the controller that one is mapped to, and its automation.

use crate::lock::lock;
use std::collections::BTreeMap;
use std::sync::Mutex;

/// A colour of the host's: red, green and blue.
pub(crate) type Colour = [u8; 3];

/// A controller that a parameter is mapped to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mapping {
    pub(crate) colour: Option<Colour>,
    /// Short, such as ‘Knob 3’; may be empty.
    pub(crate) label: String,
    /// Long; may be empty.
    pub(crate) description: String,
}

/// The automation of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Automation {
    /// There is some, which does not play now.
    Present,
    Playing,
    Recording,
    /// The user holds the knob against it.
    Overriding,
}

impl Automation {
    /// Whether it moves the knob or is made by it now.
    pub(crate) fn is_running(self) -> bool {
        matches!(self, Self::Playing | Self::Recording)
    }
}

/// What the host says of one parameter.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mark {
    pub(crate) mapping: Option<Mapping>,
    pub(crate) automation: Option<(Automation, Option<Colour>)>,
}

impl Mark {
    /// What it says, in a few words.
    pub(crate) fn text(&self) -> String {
        let mapping = self.mapping.as_ref().map(|Mapping { label, description, .. }| {
            let to: Vec<&str> =
                [label, description].map(|part| part.trim()).into_iter().filter(|part| !part.is_empty()).collect();
            if to.is_empty() { "mapped by the host".to_owned() } else { format!("mapped to {}", to.join(", ")) }
        });
        let automation = self.automation.map(|(automation, _)| match automation {
            Automation::Present => "has automation",
            Automation::Playing => "automation plays",
            Automation::Recording => "automation is recorded",
            Automation::Overriding => "automation is overridden",
        });
        mapping.into_iter().chain(automation.map(str::to_owned)).collect::<Vec<_>>().join("; ")
    }
}

/// The marks of all parameters that have one, by their places in the table. Not for the audio thread.
#[derive(Default)]
pub(crate) struct Marks(Mutex<BTreeMap<usize, Mark>>);

impl Marks {
    /// Changes the mark of a parameter.
    pub(crate) fn change(&self, index: usize, change: impl FnOnce(&mut Mark)) {
        let mut marks = lock(&self.0);
        let mark = marks.entry(index).or_default();
        change(mark);
        if *mark == Mark::default() {
            marks.remove(&index);
        }
    }

    /// The mark of a parameter, if it has one.
    pub(crate) fn of(&self, index: usize) -> Option<Mark> {
        lock(&self.0).get(&index).cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_say_what_they_are_and_go() {
        let marks = Marks::default();
        let mapping = |label: &str, description: &str| {
            let (label, description) = (label.to_owned(), description.to_owned());
            Some(Mapping { colour: None, label, description })
        };
        let text = || marks.of(3).map(|mark| mark.text());
        assert_eq!(text(), None);
        for (label, description, expected) in [
            ("", " ", "mapped by the host"),
            ("Knob 3", "", "mapped to Knob 3"),
            ("Knob 3", "page 2 of the controller", "mapped to Knob 3, page 2 of the controller"),
        ] {
            marks.change(3, |mark| mark.mapping = mapping(label, description));
            assert_eq!(text().as_deref(), Some(expected));
        }
        marks.change(3, |mark| mark.automation = Some((Automation::Playing, None)));
        assert!(text().unwrap().ends_with("the controller; automation plays"));
        marks.change(3, |mark| mark.mapping = None);
        assert_eq!(text().as_deref(), Some("automation plays"));
        marks.change(3, |mark| mark.automation = None);
        assert_eq!((text(), marks.0.lock().unwrap().len()), (None, 0));
    }
}
