//! Prints clap's usage errors, safe for the terminal and with a tip that leads to valid usage.

use super::terminal::complain_lines;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Error};
use std::process::ExitCode;

/// Prints a usage error and returns the exit code.
pub(super) fn refuse(mut error: Error, command: &Command) -> ExitCode {
    let args: Vec<String> = std::env::args_os().map(|arg| arg.to_string_lossy().into_owned()).collect();
    if let Some(tip) = tip(&error, subcommand(command, &args)) {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    let plain = error.render().to_string();
    if sprung::internals::text::printable_lines(&plain) == plain {
        // Printed with colours. If stderr is closed, nothing can be reported.
        let _ = error.print();
    } else {
        complain_lines(&plain);
    }
    ExitCode::from(error.exit_code() as u8)
}

/// The innermost subcommand among the arguments.
fn subcommand<'a>(command: &'a Command, args: &[String]) -> &'a Command {
    let words = args.iter().skip(1).take_while(|arg| !arg.starts_with('-'));
    words
        .fold((command, true), |(command, deeper), word| match command.find_subcommand(word) {
            Some(inner) if deeper => (inner, true),
            _ => (command, false),
        })
        .0
}

/// A tip that leads to valid usage, for errors where clap gives none.
fn tip(error: &Error, command: &Command) -> Option<String> {
    let Some(ContextValue::String(wrong)) = error.get(ContextKind::InvalidArg) else {
        let missing = matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::Strings(missing))
            if missing.iter().any(|arg| arg.starts_with("--output")));
        let tip = "name the file to write, as in '-o out.wav'";
        return (error.kind() == ErrorKind::MissingRequiredArgument && missing).then(|| tip.to_owned());
    };
    let takes = |long: &str| command.get_arguments().any(|arg| arg.get_long() == Some(long));
    match (error.kind(), wrong.strip_prefix('-')) {
        (ErrorKind::UnknownArgument, Some(short)) if !short.starts_with('-') => {
            let longs = command.get_arguments().filter(|arg| !arg.is_hide_set()).filter_map(|arg| arg.get_long());
            let longs: Vec<_> =
                longs.filter(|long| long.starts_with(short)).map(|long| format!("'--{long}'")).collect();
            (!longs.is_empty()).then(|| format!("there is no short '{wrong}'; there is {}", longs.join(" and ")))
        }
        (ErrorKind::UnknownArgument, None) if takes("output") && !wrong.contains(' ') => {
            Some(format!("to write to it, put '-o' before it: '-o {wrong}'"))
        }
        (ErrorKind::InvalidValue, _) if wrong.starts_with("--output") => {
            Some("name the file to write, as in '-o out.wav'".to_owned())
        }
        _ => None,
    }
}
