//! The device that was chosen: by options, or the last time.

use crate::devices::Chosen;
use sprung::realtime::{Choice, Found};

/// Finds the device that was given, or that of the last time, or if that is not there now, the system's.
pub(super) fn find(given: Chosen, last: Chosen, say: impl Fn(String)) -> Result<(Chosen, Found), String> {
    let midi_in = given.midi_in.clone().or(last.midi_in.clone());
    let is_given = Chosen { midi_in: None, ..given.clone() } != Chosen::default();
    // Sample rate and block size of the last time belong to the device of that time.
    let chosen = Chosen { midi_in: midi_in.clone(), ..if is_given { given } else { last } };
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

/// What is chosen, as the library has it.
pub(super) fn choice(Chosen { host, device, rate, buffer, .. }: &Chosen) -> Choice {
    Choice { host: host.clone(), device: device.clone(), rate: *rate, buffer: *buffer }
}

/// An error of a device as a line for the window, where nothing is called by its option.
pub(super) fn plain(error: &sprung::Error) -> String {
    error.to_string().trim_start_matches("--").trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_was_given_must_be_there() {
        let tape = Chosen { host: Some("tape".to_owned()), ..Chosen::default() };
        let said = find(tape, Chosen::default(), |_| unreachable!()).err().unwrap();
        assert!(said.contains("no ‘tape’ here"), "{said}");
    }
}
