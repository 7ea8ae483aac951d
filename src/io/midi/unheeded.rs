//! Counts what a song asks for and the engine does not do, for one warning.

use crate::engine::midi::controller;
use std::collections::BTreeMap;

/// Controllers that are obeyed, beside those of the engine: bank selects, omni modes, and the rest of the numbers of parameters.
const OBEYED: [u8; 3] = [0, 32, 37];

/// What was not obeyed, with how often.
#[derive(Clone, Debug, Default)]
pub(super) struct Unheeded {
    controllers: BTreeMap<u8, usize>,
    exclusive: usize,
    /// Where it was first.
    first: Option<String>,
}

impl Unheeded {
    /// Counts a controller if it is not obeyed and asks for something.
    pub(super) fn control(&mut self, number: u8, value: u8, place: impl Fn() -> String) {
        if !is_obeyed(number) && !is_neutral(number, value) {
            *self.controllers.entry(number).or_default() += 1;
            self.first.get_or_insert_with(place);
        }
    }

    /// Counts a system exclusive message.
    pub(super) fn exclusive(&mut self, place: impl Fn() -> String) {
        self.exclusive += 1;
        self.first.get_or_insert_with(place);
    }

    /// The warning; none if everything was obeyed.
    pub(super) fn warning(&self) -> Option<String> {
        let first = self.first.as_ref()?;
        let times = |count: usize| if count == 1 { "once".to_owned() } else { format!("{count} times") };
        let controller = |(number, count): (&u8, &usize)| {
            let name = name(*number).map(|name| format!(" {name}")).unwrap_or_default();
            format!("{number}{name} ({})", times(*count))
        };
        let mut parts: Vec<String> = self.controllers.iter().map(controller).collect();
        if let Some(first) = parts.first_mut() {
            first.insert_str(0, if self.controllers.len() == 1 { "controller " } else { "controllers " });
        }
        if self.exclusive > 0 {
            parts.push(format!("system exclusive messages ({})", times(self.exclusive)));
        }
        Some(format!("not obeyed: {}; first at {first}", parts.join(", ")))
    }
}

fn is_obeyed(number: u8) -> bool {
    use controller as c;
    OBEYED.contains(&number)
        || matches!(
            number,
            c::WHEEL | c::BREATH | c::PORTAMENTO_TIME | c::DATA | c::VOLUME | c::BALANCE | c::PAN | c::EXPRESSION
        )
        || matches!(number, c::DATA_FINE | c::SUSTAIN..=c::LEGATO | c::BRIGHTNESS | c::PORTAMENTO_CONTROL | c::REVERB_SEND)
        // A parameter that is not registered counts once, with its more significant byte.
        || matches!(number, c::INCREMENT..=c::NRPN_FINE | c::RPN_FINE | c::RPN | c::ALL_SOUND_OFF | c::RESET | 123..)
}

/// Whether a controller at this value asks for nothing: effects that are off, sounds that are as they are.
fn is_neutral(number: u8, value: u8) -> bool {
    match number {
        70..80 => value == 64,
        92..96 => value == 0,
        // The end of a parameter's number.
        controller::NRPN => value == 127,
        _ => false,
    }
}

/// What General MIDI 2 and the MIDI specification call a controller.
fn name(number: u8) -> Option<&'static str> {
    Some(match number {
        4 => "foot",
        33..64 => "(fine)",
        70 => "sound variation",
        71 => "resonance",
        72 => "release time",
        73 => "attack time",
        75 => "decay time",
        76 => "vibrato rate",
        77 => "vibrato depth",
        78 => "vibrato delay",
        92 => "tremolo",
        93 => "chorus",
        94 => "celeste or variation",
        95 => "phaser",
        controller::NRPN => "non-registered parameter",
        122 => "local control",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_says_what_how_often_and_where_first() {
        let mut unheeded = Unheeded::default();
        for (number, value) in [(7, 100), (93, 0), (71, 64), (65, 127), (91, 40), (101, 0), (121, 0), (126, 1), (98, 8)]
        {
            unheeded.control(number, value, || "nowhere".to_owned());
        }
        assert_eq!(unheeded.warning(), None);
        for (number, value) in [(93, 40), (93, 50), (71, 0), (99, 1)] {
            unheeded.control(number, value, || format!("bar {value}"));
        }
        unheeded.exclusive(|| "bar 9".to_owned());
        let expected = "not obeyed: controllers 71 resonance (once), 93 chorus (2 times), 99 non-registered parameter (once), \
                        system exclusive messages (once); first at bar 40";
        assert_eq!(unheeded.warning().as_deref(), Some(expected));
    }
}
