//! `sprung fit`: makes a preset from recordings of a struck sound.

use super::interrupt;
use super::progress::Bar;
use super::quantity;
use super::recording::{ending, read};
use super::terminal::{complain, counted, print};
use sprung::analysis::fit::{Family, Fitted, Settings, Take, VELOCITY, fit, report, take_velocities_from_names};
use sprung::internals::files::{Inputs, Output, Target};
use sprung::units::parse_key;
use sprung::{Error, Result};
use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung fit marimba-c4.wav -o marimba.toml --note C4
  sprung fit bell.flac -o bell.toml --body bell --report bell.html
  sprung fit soft.wav@C4@40 middle.wav@C4@80 hard.wav@C4@120 -o vibraphone.toml
  sprung fit low.wav@C3 high.wav@C5 -o kalimba.toml --force
  sprung render --preset marimba.toml --note C4,E4,G4 -o chord.wav";

#[derive(clap::Args)]
pub(super) struct Args {
    /// Recordings of one struck note each: WAV, AIFF, FLAC, Ogg Vorbis or MP3; with @KEY and @KEY@VELOCITY where they differ; -
    /// is stdin
    #[arg(required = true, value_name = "IN.wav[@KEY[@VELOCITY]]")]
    recordings: Vec<PathBuf>,
    /// Key that was struck (C4, 60, 261.6Hz), if all recordings have the same [default: estimated]
    #[arg(long, value_parser = quantity::note, allow_hyphen_values = true)]
    note: Option<String>,
    /// Velocities of the recordings, 1-127, in their order, with commas between them [default: from
    /// the names of all files (tom-v40.wav, tom-pp.wav), else 100]
    #[arg(long, value_name = "N,…", value_delimiter = ',', allow_hyphen_values = true,
        value_parser = quantity::whole::<u8>(1..=127))]
    velocity: Vec<u8>,
    /// What explains the modes: a table of them as they are, or a physical body
    #[arg(long, default_value = "table", value_name = "MODEL",
        value_parser = clap::builder::PossibleValuesParser::new(Family::ALL.map(|(name, _)| name)))]
    body: String,
    /// Most modes, 1-256
    #[arg(long, default_value_t = 192, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u16>(1..=256))]
    modes: u16,
    /// Name of the preset [default: that of the output]
    #[arg(long, value_parser = no_blank)]
    name: Option<String>,
    /// Write a page with both sounds, what they look like, and their modes
    #[arg(long, value_name = "OUT.html")]
    report: Option<PathBuf>,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
    /// Preset file to write; - is stdout
    #[arg(short, long, value_name = "OUT.toml|-")]
    output: PathBuf,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let target = Target::new(&args.output);
    if let Target::Path(path) = &target {
        ending("--output", path, &["toml"])?;
    }
    if let Some(path) = &args.report {
        ending("--report", path, &["html"])?;
    }
    if !args.velocity.is_empty() && args.velocity.len() != args.recordings.len() {
        let (given, recordings) = (args.velocity.len(), counted(args.recordings.len(), "recording"));
        let message = format!("{given} of them for {recordings}: expected one for each");
        return Err(Error::value("--velocity", message));
    }
    let mut inputs = Inputs::default();
    let mut takes: Vec<Take> =
        (0..args.recordings.len()).map(|index| take(args, index, &mut inputs)).collect::<Result<_>>()?;
    if !tells_velocities(args)
        && let Some(velocities) = take_velocities_from_names(&mut takes)
    {
        complain("note", format!("the names of the recordings tell their velocities: {velocities}"));
    }
    interrupt::catch(true)?;
    let mut output = Output::create(&target, args.force, &inputs)?;
    let page = args.report.as_ref().map(|path| Output::create(&Target::Path(path.clone()), args.force, &inputs));
    let page = page.transpose()?;
    let family = Family::ALL.iter().find(|(name, _)| *name == args.body).map_or(Family::Table, |(_, family)| *family);
    let settings = Settings { most_modes: args.modes.into(), family };
    let mut bar = Bar::new();
    let fitted = fit(&takes, &settings, &mut |share| bar.show_share(share));
    drop(bar);
    let fitted = fitted?;
    fitted.warnings.iter().for_each(|warning| complain("warning", warning));

    let preset = fitted.named(&name(args), &takes);
    write(&mut output, preset.to_toml().as_bytes())?;
    if let Some(mut page) = page {
        let title = format!("{}: fitted to {}", preset.name, file_name(&takes[fitted.base].name));
        write(&mut page, report::html(&fitted, &title)?.as_bytes())?;
        page.commit()?;
    }
    output.commit()?;
    // With `-`, stdout has the preset.
    if target == Target::Stdout { Ok(()) } else { print(&text(&takes, &fitted)) }
}

fn write(output: &mut Output, bytes: &[u8]) -> Result<()> {
    output.stream().write_all(bytes).map_err(|source| Error::io(output.name(), source))
}

/// Reads a recording, with its key and velocity if they are given.
fn take(args: &Args, index: usize, inputs: &mut Inputs) -> Result<Take> {
    let (path, key, velocity) = parts(&args.recordings[index])?;
    let wrong = |message: String| Error::value("recording", message);
    let common = args.note.as_deref();
    if key.is_some() && common.is_some() {
        let message = format!("{}: its key is given twice: expected @KEY or --note", path.display());
        return Err(wrong(message));
    }
    let named = |message| wrong(format!("{}: {message}", path.display()));
    let key = key.as_deref().or(common).map(|note| parse_key(note, 440.0)).transpose().map_err(named)?;
    let velocity = velocity.or_else(|| args.velocity.get(index).copied());
    let (recording, name) = read(&path, inputs)?;
    Ok(Take { name, recording, key, velocity: velocity.map_or(VELOCITY, f64::from) })
}

/// Whether the user has told the velocity of any recording. Then that of the others is the default.
fn tells_velocities(args: &Args) -> bool {
    let is_told = |argument: &PathBuf| parts(argument).is_ok_and(|(.., velocity)| velocity.is_some());
    !args.velocity.is_empty() || args.recordings.iter().any(is_told)
}

/// Splits `take.wav@C4@100` into a path, a key and a velocity. If a file with the whole name exists, that is the path.
fn parts(argument: &Path) -> Result<(PathBuf, Option<String>, Option<u8>)> {
    let whole = || (argument.to_owned(), None, None);
    let Some(text) = argument.to_str().filter(|text| text.contains('@') && !argument.exists()) else {
        return Ok(whole());
    };
    let mut pieces = text.split('@');
    let path = PathBuf::from(pieces.next().unwrap_or_default());
    let (key, velocity) = (pieces.next().map(str::to_owned), pieces.next());
    if pieces.next().is_some() {
        let message = format!("‘{text}’ has too many @: expected FILE@KEY@VELOCITY");
        return Err(Error::value("recording", message));
    }
    let velocity = velocity.map(quantity::whole::<u8>(1..=127)).transpose();
    let velocity = velocity.map_err(|message| Error::value("recording", format!("‘{text}’: velocity {message}")))?;
    Ok((path, key.filter(|key| !key.is_empty()), velocity))
}

fn file_name(name: &str) -> String {
    Path::new(name).file_name().map_or(name.to_owned(), |name| name.to_string_lossy().into_owned())
}

/// A name that can be seen.
fn no_blank(name: &str) -> std::result::Result<String, String> {
    if name.trim().is_empty() { Err("it is blank: expected a name".to_owned()) } else { Ok(name.to_owned()) }
}

/// The preset's name: the one in `--name`, or that of the output file. Stdout has none.
fn name(args: &Args) -> String {
    let stem = args.output.file_stem().and_then(OsStr::to_str).filter(|stem| *stem != "-");
    args.name.as_deref().or(stem).unwrap_or_default().to_owned()
}

fn text(takes: &[Take], fitted: &Fitted) -> String {
    let mut text = fitted.summary() + "\n";
    if takes.len() > 1 {
        for (take, distance) in takes.iter().zip(&fitted.distances) {
            text += &format!("{}: {distance:.2} dB\n", take.name);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_bring_key_and_velocity_along() {
        let of = |text: &str| parts(Path::new(text)).map_err(|error| error.to_string());
        assert_eq!(of("a.wav"), Ok(("a.wav".into(), None, None)));
        assert_eq!(of("a.wav@C4"), Ok(("a.wav".into(), Some("C4".to_owned()), None)));
        assert_eq!(of("a.wav@C4@80"), Ok(("a.wav".into(), Some("C4".to_owned()), Some(80))));
        assert_eq!(of("a.wav@@80"), Ok(("a.wav".into(), None, Some(80))));
        assert!(of("a.wav@C4@200").unwrap_err().contains("expected"));
        assert!(of("a.wav@C4@8@0").unwrap_err().contains("too many @"));
    }
}
