//! The choice of the device: from the command line or from the last run.

use crate::devices::Chosen;
use sprung::realtime::{Choice, Found};

/// Finds the device of the command line, or of the last run; if the latter is not available now, the system's default.
pub(super) fn find(given: Chosen, last: Chosen, say: impl Fn(String)) -> Result<(Chosen, Found), String> {
    let is_given = Chosen { midi_in: None, ..given.clone() } != Chosen::default();
    let chosen = merged(given, last);
    let midi_in = chosen.midi_in.clone();
    match Found::find(&choice(&chosen)) {
        Ok(found) => Ok((chosen, found)),
        Err(error) if is_given => Err(error.to_string()),
        Err(error) => {
            let chosen = Chosen { midi_in, ..Chosen::default() };
            let found = Found::find(&Choice::default()).map_err(|error| error.to_string())?;
            say(format!("not on the device of the last time: {}", plain(&error)));
            Ok((chosen, found))
        }
    }
}

/// The options of the command line, completed by the choice of the last run. The sample rate and block size of the last
/// run belong to its device.
fn merged(given: Chosen, last: Chosen) -> Chosen {
    let midi_in = given.midi_in.or(last.midi_in);
    if given.host.is_some() || given.device.is_some() {
        return Chosen { midi_in, ..given };
    }
    Chosen { midi_in, rate: given.rate.or(last.rate), buffer: given.buffer.or(last.buffer), ..last }
}

/// The choice in the library's form.
pub(super) fn choice(Chosen { host, device, rate, buffer, .. }: &Chosen) -> Choice {
    Choice { host: host.clone(), device: device.clone(), rate: *rate, buffer: *buffer }
}

/// An error of a device as a line for the window, without the command-line options: the window lists the devices
/// itself.
pub(super) fn plain(error: &sprung::Error) -> String {
    let error = error.to_string();
    let message = error.split("; ‘--list’").next().unwrap_or(&error);
    message.trim_start_matches("--").trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_was_given_must_be_there() {
        let tape = Chosen { host: Some("tape".to_owned()), ..Chosen::default() };
        let message = find(tape, Chosen::default(), |_| unreachable!()).err().unwrap();
        assert!(message.contains("no ‘tape’ here"), "{message}");
    }

    #[test]
    fn options_change_what_was_chosen_the_last_time() {
        let text = |text: &str| Some(text.to_owned());
        let last =
            Chosen { host: text("alsa"), device: text("hw:1"), rate: Some(96_000), buffer: Some(64), midi_in: None };
        let given = Chosen { buffer: Some(128), midi_in: text("Key"), ..Chosen::default() };
        let expected = Chosen { buffer: Some(128), midi_in: text("Key"), ..last.clone() };
        assert_eq!(merged(given, last.clone()), expected, "the device stays");
        let given = Chosen { host: text("jack"), ..Chosen::default() };
        assert_eq!(merged(given.clone(), last.clone()), given, "another one has its own rate and blocks");
        assert_eq!(merged(Chosen::default(), last.clone()), last);
    }

    #[test]
    fn errors_name_no_options() {
        let error =
            sprung::Error::value("--device", "ALSA has no device ‘x’, or several; ‘--list’ shows them all".to_owned());
        assert_eq!(plain(&error), "device: ALSA has no device ‘x’, or several");
    }
}
