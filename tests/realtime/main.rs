//! `sprung play` without a sound card: on ALSA's file plugin, on JACK's dummy driver, and in a terminal.

mod alsa;
mod jack;
mod sandbox;
mod terminal;

use libtest_mimic::{Arguments, Trial};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let trial = |name: &str, needs: Option<&str>, test: fn()| {
        let missing = needs.filter(|program| !is_installed(program));
        if let Some(program) = missing {
            println!("{name} is ignored: it needs {program}, which ‘cargo xtask setup’ installs");
        }
        let run = move || {
            test();
            Ok(())
        };
        Trial::test(name, run).with_ignored_flag(missing.is_some())
    };
    let (jackd, tmux) = (Some("jackd"), Some("tmux"));
    let trials = vec![
        trial(
            "alsa::a_song_reaches_the_device",
            None,
            alsa::a_song_reaches_the_device_and_the_recording_with_the_bits_of_render,
        ),
        trial("alsa::integers_are_the_rounded_floats", None, alsa::integers_are_the_rounded_floats),
        trial(
            "alsa::an_interrupt_completes_the_recording",
            None,
            alsa::an_interrupt_releases_the_notes_and_completes_the_recording,
        ),
        trial("alsa::a_full_disk_keeps_the_recording", None, alsa::a_full_disk_ends_the_recording_and_keeps_it),
        trial("alsa::what_cannot_be_played_on_says_what_can", None, alsa::what_cannot_be_played_on_says_what_can),
        trial("jack::live_notes_are_in_time_and_in_tune", jackd, jack::live_notes_are_in_time_and_in_tune),
        trial("jack::a_server_that_ends_is_waited_for", jackd, jack::a_server_that_ends_is_waited_for),
        trial("jack::what_the_server_cannot_do_is_refused", jackd, jack::what_the_server_cannot_do_is_refused),
        trial(
            "terminal::the_view_plays_loads_turns_and_resizes",
            tmux,
            terminal::the_view_plays_loads_turns_and_resizes,
        ),
    ];
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// Whether a program can be run.
fn is_installed(program: &str) -> bool {
    std::env::var_os("PATH")
        .is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join(program).is_file()))
}
