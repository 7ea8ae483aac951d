//! `cargo xtask measure --beside`: where the factory's sounds of General MIDI stand beside two soundfonts.

use sprung::internals::measures::from_onset;
use sprung::internals::measures::preset::{is_sustained, measure, of_sound};
use sprung::io::sound_file;
use sprung::preset::{Preset, Programs};
use sprung::units::frequency_from_key;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};

/// How far apart two values of a figure are that differ.
const DIFFER: [(&str, f64); 8] = [
    ("attack flatness", 6.0),
    ("energy above 2 kHz", 6.0),
    ("motion", 1.0),
    ("partials", 12.0),
    ("valleys between partials", 12.0),
    ("entry of partials", 15.0),
    ("wobble at one rate", 0.25),
    ("change of colour", 0.4),
];

/// How long the note is held, in seconds, and its velocity: as those of the presets.
const HELD: u32 = 4;
const VELOCITY: u8 = 100;

/// Prints a table of all programs, and how often a figure of ours lies outside both.
pub(crate) fn run(fonts: [&Path; 2]) -> Result<(), String> {
    for font in fonts {
        File::open(font).map_err(|error| format!("{}: {error}", font.display()))?;
    }
    let folder = tempfile::tempdir().map_err(|error| format!("a folder for the notes: {error}"))?;
    println!(
        "| program | preset | figure | ours | {} | {} | |\n|--:|---|---|--:|--:|--:|---|",
        name(fonts[0]),
        name(fonts[1])
    );
    let (mut outside, mut compared) = ([0; DIFFER.len()], [0; DIFFER.len()]);
    for program in 0..128 {
        let Some(sound) = Programs::general_midi().sound(program) else { continue };
        // Kits have no figures.
        let Ok(preset) = Preset::find(sound) else { continue };
        let key = preset.guide.home;
        let pitch = is_sustained(preset).then(|| frequency_from_key(key.into(), 440.0));
        let own = measure(preset).map_err(|error| format!("{sound}: {error}"))?;
        let theirs = fonts.map(|font| played(font, program, key, folder.path()));
        let theirs = theirs.into_iter().collect::<Result<Vec<_>, _>>()?;
        let theirs: Vec<_> = theirs.iter().map(|sound| of_sound(from_onset(sound), pitch)).collect();
        for (place, (figure, differ)) in DIFFER.iter().enumerate() {
            let ours = own.iter().find(|measure| measure.name == *figure).and_then(|measure| measure.value);
            let of = |font: usize| theirs[font].iter().find(|(name, ..)| name == figure).and_then(|(.., value)| *value);
            let (Some(ours), Some(one), Some(other)) = (ours, of(0), of(1)) else { continue };
            let verdict = match (ours < one.min(other) - differ, ours > one.max(other) + differ) {
                (true, _) => "below both",
                (_, true) => "above both",
                _ if (one - other).abs() > *differ => "they disagree",
                _ => "",
            };
            compared[place] += 1;
            outside[place] += usize::from(verdict.ends_with("both"));
            println!("| {} | {sound} | {figure} | {ours:.2} | {one:.2} | {other:.2} | {verdict} |", program + 1);
        }
    }
    for ((figure, _), (outside, compared)) in DIFFER.iter().zip(outside.iter().zip(compared)) {
        println!("{figure}: {outside} of {compared} outside both");
    }
    Ok(())
}

fn name(font: &Path) -> String {
    font.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// A note of a program on a soundfont, as one channel, without reverb and chorus.
fn played(font: &Path, program: u8, key: u8, folder: &Path) -> Result<Vec<f32>, String> {
    let [song, wav] = ["note.mid", "note.wav"].map(|name| folder.join(name));
    fs::write(&song, note(program, key)).map_err(|error| format!("{}: {error}", song.display()))?;
    let mut fluidsynth = Command::new("fluidsynth");
    fluidsynth.args(["-ni", "-R", "0", "-C", "0", "-g", "0.8", "-r", "44100", "-F"]).arg(&wav).arg(font).arg(&song);
    let status = fluidsynth.stdout(Stdio::null()).stderr(Stdio::null()).status();
    match status {
        Ok(status) if status.success() => {}
        Ok(status) => return Err(format!("fluidsynth with {}: {status}", font.display())),
        Err(error) => return Err(format!("fluidsynth: {error}; install it with: sudo apt-get install fluidsynth")),
    }
    let file = File::open(&wav).map_err(|error| format!("{}: {error}", wav.display()))?;
    let recording = sound_file::read(file, "note.wav").map_err(|error| error.to_string())?;
    let sides = recording.channels.len() as f32;
    let mean = |frame: usize| recording.channels.iter().map(|side| side[frame]).sum::<f32>() / sides;
    Ok((0..recording.frames()).map(mean).collect())
}

/// A MIDI file of one note of a program, at 120 beats a minute and 480 ticks a beat.
fn note(program: u8, key: u8) -> Vec<u8> {
    // The length of the note, in two bytes of seven bits.
    let ticks = HELD * 960;
    let [high, low] = [(ticks >> 7) as u8 | 0x80, (ticks & 0x7f) as u8];
    let events =
        [&[0, 0xc0, program, 0, 0x90, key, VELOCITY][..], &[high, low, 0x80, key, 64], &[0x83, 0x60, 0xff, 0x2f, 0]]
            .concat();
    let head = *b"MThd\0\0\0\x06\0\0\0\x01\x01\xe0MTrk";
    [&head[..], &(events.len() as u32).to_be_bytes(), &events].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::io::Song;

    #[test]
    fn a_note_is_a_song_of_its_length() {
        let song = Song::parse(&note(13, 60), "note.mid").unwrap();
        assert!((song.seconds - f64::from(HELD)).abs() < 0.51, "{}", song.seconds);
    }
}
