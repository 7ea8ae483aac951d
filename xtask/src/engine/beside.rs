//! `cargo xtask measure --beside`: where the factory's sounds of General MIDI stand beside two soundfonts.

use sprung::internals::measures::from_onset;
use sprung::internals::measures::preset::{is_sustained, measure, of_sound};
use sprung::internals::measures::spectrogram::{self, Spectrogram};
use sprung::io::{Song, sound_file};
use sprung::preset::{Preset, Programs};
use sprung::render::{Job, Options, Tail};
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

/// How long the note of the figures is held, in seconds, and the velocity of all notes: as those of the presets.
const HELD: f64 = 4.0;
const VELOCITY: u8 = 100;

/// The keys of which spectrograms are compared.
const KEYS: [u8; 3] = [48, 60, 72];

/// Prints a table of all programs, how often a figure of ours lies outside both, and how far our spectrograms do.
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
    let (mut outside, mut compared, mut programs) = ([0; DIFFER.len()], [0; DIFFER.len()], vec![]);
    for program in 0..128 {
        let Some(sound) = Programs::general_midi().sound(program) else { continue };
        // Kits have no figures.
        let Ok(preset) = Preset::find(sound) else { continue };
        let key = preset.guide.home;
        let pitch = is_sustained(preset).then(|| frequency_from_key(key.into(), 440.0));
        let own = measure(preset).map_err(|error| format!("{sound}: {error}"))?;
        let theirs = fonts.map(|font| played(font, &note(program, key, HELD), folder.path()));
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
        let notes = KEYS.map(|key| note(program, key, spectrogram::HELD));
        let [one, other] = fonts.map(|font| spectrograms(&notes, |note| played(font, note, folder.path())));
        let own = spectrograms(&notes, |note| rendered(note, preset));
        programs.push(Sounds { program, preset: sound, of: [own?, one?, other?] });
    }
    for ((figure, _), (outside, compared)) in DIFFER.iter().zip(outside.iter().zip(compared)) {
        println!("{figure}: {outside} of {compared} outside both");
    }
    print_spectrograms(fonts, &programs);
    Ok(())
}

/// The notes of a program on [`KEYS`]; none where a font has no sound.
type Notes = Vec<Option<Spectrogram>>;

fn spectrograms(notes: &[Vec<u8>], sound: impl Fn(&[u8]) -> Result<Vec<f32>, String>) -> Result<Notes, String> {
    notes.iter().map(|note| sound(note).map(|sound| Spectrogram::new(&sound))).collect()
}

/// A program's notes: ours, and those of the two fonts.
struct Sounds {
    program: u8,
    preset: &'static str,
    of: [Notes; 3],
}

/// The mean of what is measured of the keys that sound.
fn mean(measured: impl Iterator<Item = Option<f64>>) -> f64 {
    let (sum, count) = measured.flatten().fold((0.0, 0.0), |(sum, count), one| (sum + one, count + 1.0));
    sum / count
}

/// Prints how far each program's notes lie outside both fonts', and the place of its own program when a font's programs are in the order
/// of their distance; then the same between the fonts, which says what a place is worth.
fn print_spectrograms(fonts: [&Path; 2], all: &[Sounds]) {
    let distance = |notes: &Notes, others: &Notes| {
        mean(notes.iter().zip(others).map(|(note, other)| Some(note.as_ref()?.distance(other.as_ref()?))))
    };
    let places = |who: usize, font: usize| -> Vec<usize> {
        let place = |own: &Sounds| {
            let least = distance(&own.of[who], &own.of[font]);
            all.iter().filter(|other| distance(&own.of[who], &other.of[font]) < least).count() + 1
        };
        all.iter().map(place).collect()
    };
    let [one, other] = fonts.map(name);
    let ours = [places(0, 1), places(0, 2)];
    println!("\n| program | preset | outside both, dB | place by {one} | by {other} |\n|--:|---|--:|--:|--:|");
    let mut sum = 0.0;
    for (n, Sounds { program, preset, of: [own, one, other] }) in all.iter().enumerate() {
        let outside = |key: usize| Some(own[key].as_ref()?.outside([one[key].as_ref()?, other[key].as_ref()?]));
        let outside = mean((0..KEYS.len()).map(outside));
        sum += outside;
        println!("| {} | {preset} | {outside:.2} | {} | {} |", program + 1, ours[0][n], ours[1][n]);
    }
    println!("outside both: {:.2} dB on average", sum / all.len() as f64);
    let [by_one, by_other] = ours;
    for (whose, by, places) in [
        ("ours", &one, by_one),
        ("ours", &other, by_other),
        (&*one, &other, places(1, 2)),
        (&*other, &one, places(2, 1)),
    ] {
        let near = places.iter().filter(|place| **place <= 5).count();
        println!("{whose} by {by}: own program among the nearest five in {near} of {}", all.len());
    }
}

fn name(font: &Path) -> String {
    font.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// A note of ours, as one channel.
fn rendered(note: &[u8], preset: &Preset) -> Result<Vec<f32>, String> {
    let render = || {
        let (song, kit) = (Song::parse(note, "note.mid")?, preset.kit());
        let options = Options { sample_rate: 44_100, tail: Tail::Seconds(1.0), ..Options::default() };
        Job::new(&song, &kit, options).samples()
    };
    let [left, right] = render().map_err(|error| format!("{}: {error}", preset.name))?;
    Ok(left.iter().zip(&right).map(|(left, right)| 0.5 * (left + right)).collect())
}

/// A note on a soundfont, as one channel, without reverb and chorus.
fn played(font: &Path, note: &[u8], folder: &Path) -> Result<Vec<f32>, String> {
    let [song, wav] = ["note.mid", "note.wav"].map(|name| folder.join(name));
    fs::write(&song, note).map_err(|error| format!("{}: {error}", song.display()))?;
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

/// A MIDI file of one note of a program, held for some seconds, at 120 beats a minute and 480 ticks a beat.
fn note(program: u8, key: u8, held: f64) -> Vec<u8> {
    // The length of the note, in two bytes of seven bits.
    let ticks = (held * 960.0) as u32;
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

    #[test]
    fn a_note_is_a_song_of_its_length() {
        let song = Song::parse(&note(13, 60, HELD), "note.mid").unwrap();
        assert!((song.seconds - HELD).abs() < 0.51, "{}", song.seconds);
    }
}
