//! `sprung render`: renders a MIDI file or some notes to a WAV or FLAC file, or a song to its stems.

mod args;
mod figure;
mod output;
mod report;
mod stems;

pub(super) use args::Args;
use sprung::internals::files::Target;
use sprung::{Error, Result};

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung render song.mid -o song.wav
  sprung render song.mid --preset mine.toml --normalize lufs=-14 --bits 16 --dither -o song.wav
  sprung render --note C4 --preset Kick --tail none --length 0.5 -o kick.wav
  sprung render --note C4,E4,67.5,440Hz --set decay=\"3 s\" --set mallet_pulse=contact -o chord.wav
  sprung render song.mid --preset Marimba --channel 10=drums.toml --programs none -o song.wav
  sprung render --note C4 --preset Marimba --figure marimba.png -o marimba.wav
  sprung render --note C3 --preset Gong --set input_level=0 --input voice.wav -o spoken.wav
  sprung render song.mid --scale mine.scl --keymap mine.kbm -o song.wav
  sprung render song.mid -o song.flac
  sprung render song.mid --stems stems
  sprung render song.mid --from bar9 --to bar17 --loop -o chorus.wav
  sprung render song.mid -o - | lame - song.mp3";

pub(super) fn run(args: &Args) -> Result<()> {
    let request = args.request();
    request.check()?;
    match (&args.stems, &args.output) {
        (Some(folder), _) => stems::run(args, &request, folder),
        (None, Some(output)) => output::run(args, &request, &Target::new(output)),
        (None, None) => Err(Error::value("--output", "expected it, or --stems")),
    }
}
