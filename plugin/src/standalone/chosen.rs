//! The choice of the device: from the command line or from the last run.

use crate::devices::Chosen;
use sprung::internals::realtime::device;
use sprung::realtime::Choice;

/// Opens the device of the command line, or of the last run; if that cannot be opened now, a [`substitute`]. What the command line says
/// of the device has none.
///
/// # Errors
/// Why the first of them cannot be opened, if none can; with that choice if the program can wait for it.
pub(super) fn open_first<T>(
    given: Chosen,
    last: Chosen,
    open: impl Fn(&Chosen) -> sprung::Result<T>,
    systems: impl Fn() -> Vec<String>,
    say: impl Fn(String),
) -> Result<(Chosen, T), (String, Option<Chosen>)> {
    let says = |chosen: &Chosen| Chosen { midi_in: None, ..chosen.clone() } != Chosen::default();
    let is_given = says(&given);
    let first = merged(given, last);
    let error = match open(&first) {
        Ok(opened) => return Ok((first, opened)),
        Err(error) if is_given => return Err((error.to_string(), None)),
        Err(error) => plain(&error),
    };
    match substitute(&first, open, systems) {
        Some(opened) => {
            // Who has chosen nothing misses nothing.
            if says(&first) {
                say(format!("not as chosen the last time: {error}"));
            }
            Ok(opened)
        }
        None => Err((error, Some(first))),
    }
}

/// Opens another device if the first choice cannot be opened: the system's default, or that of the first sound system that has
/// devices. Sample rate and block size belong to the first device.
pub(super) fn substitute<T>(
    first: &Chosen,
    open: impl Fn(&Chosen) -> sprung::Result<T>,
    systems: impl Fn() -> Vec<String>,
) -> Option<(Chosen, T)> {
    let usual = Chosen { midi_in: first.midi_in.clone(), ..Chosen::default() };
    let of = |host| Chosen { host: Some(host), ..usual.clone() };
    let others = std::iter::once_with(systems).flatten().map(of);
    let mut all = std::iter::once(usual.clone()).chain(others).filter(|chosen| chosen != first);
    all.find_map(|chosen| open(&chosen).ok().map(|opened| (chosen, opened)))
}

/// The sound systems that have devices.
pub(super) fn systems() -> Vec<String> {
    let mut systems: Vec<String> = device::outputs().into_iter().map(|output| output.host).collect();
    systems.dedup();
    systems
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

/// An error of a device as a line for the window, without the options of the command line: the window lists the devices itself.
pub(super) fn plain(error: &sprung::Error) -> String {
    let error = error.to_string();
    let message = error.split("; ‘--list’").next().unwrap_or(&error);
    let of_option = message.split_once(": ").filter(|(option, _)| option.starts_with("--"));
    of_option.map_or(message, |(_, what)| what).trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::realtime::Found;

    #[test]
    fn a_device_that_was_given_must_be_there() {
        let tape = Chosen { host: Some("tape".to_owned()), ..Chosen::default() };
        let open = |chosen: &Chosen| Found::find(&choice(chosen));
        let failed = open_first(tape, Chosen::default(), open, || unreachable!(), |_| unreachable!()).err().unwrap();
        assert!(failed.0.contains("no ‘tape’ here") && failed.1.is_none(), "{failed:?}");
    }

    #[test]
    fn other_sound_systems_are_tried_if_nothing_was_given() {
        let opened = |given: &Chosen, last: &Chosen, has: &[Option<&str>]| {
            let open = |chosen: &Chosen| match has.contains(&chosen.host.as_deref()) {
                true => Ok(()),
                false => Err(sprung::Error::value("--device", "none; ‘--list’ shows what there is".to_owned())),
            };
            let systems = || ["alsa", "jack"].map(str::to_owned).to_vec();
            let is_told = std::cell::Cell::new(false);
            let opened = open_first(given.clone(), last.clone(), open, systems, |_| is_told.set(true));
            let misses = opened.is_ok() && last.host.is_some();
            assert_eq!(is_told.get(), misses, "{given:?}, {last:?}");
            opened.map(|(chosen, ())| chosen)
        };
        let none = Chosen::default();
        let keys = Chosen { midi_in: Some("Key".to_owned()), ..Chosen::default() };
        assert_eq!(opened(&keys, &none, &[None, Some("jack")]), Ok(keys.clone()));
        let jack = Chosen { host: Some("jack".to_owned()), ..keys.clone() };
        assert_eq!(opened(&keys, &none, &[Some("jack")]), Ok(jack.clone()));
        let silent = |waits: &Chosen| Err(("none".to_owned(), Some(waits.clone())));
        assert_eq!(opened(&keys, &none, &[]), silent(&keys));
        let last = Chosen { host: Some("tape".to_owned()), rate: Some(96_000), ..keys.clone() };
        assert_eq!(opened(&none, &last, &[None]), Ok(keys.clone()), "its rate is that of the device");
        assert_eq!(opened(&none, &last, &[]), silent(&last), "the user’s device is waited for");
        let (rate, buffer) = (Chosen { rate: Some(8_000), ..none.clone() }, Chosen { buffer: Some(1), ..none.clone() });
        for given in [jack, rate, buffer] {
            assert!(opened(&given, &none, &[]).is_err_and(|(_, waits)| waits.is_none()), "it was given: {given:?}");
        }
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
        assert_eq!(plain(&error), "ALSA has no device ‘x’, or several");
    }
}
