//! Recordings of real instruments that are installed: drum kits of Hydrogen's, and a sound font that FluidSynth plays.
//!
//! `SPRUNG_SOUNDS` names a folder that Debian's packages `hydrogen-drumkits` and `fluid-soundfont-gm` were unpacked to, if not
//! `/`. Sounds that are not installed are skipped by name.

use super::played::{Played, Stereo};
use sprung::analysis::log_mel::RATE;
use sprung::io::sound_file::{read, resampled};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A recording, and others of the same instrument.
pub(crate) struct Pair {
    pub(crate) name: String,
    pub(crate) source: &'static str,
    pub(crate) sound: Stereo,
    /// Recordings of another key, stroke or velocity.
    pub(crate) others: Vec<Stereo>,
    /// The key to which it is fitted.
    pub(crate) key: f64,
    pub(crate) is_drum: bool,
}

fn installed(path: &str) -> PathBuf {
    let root = std::env::var_os("SPRUNG_SOUNDS").map_or(PathBuf::from("/"), PathBuf::from);
    root.join(path)
}

fn stereo(path: &Path) -> Option<Stereo> {
    let recording = read(File::open(path).ok()?, &path.display().to_string()).ok()?;
    let channels = resampled(&recording, RATE).ok()?.channels;
    Some([channels.first()?.clone(), channels.last()?.clone()])
}

/// Folders and files of kits: a drum, and another stroke on it.
const DRUMS: [(&str, &str, &str); 14] = [
    ("ForzeeStereo", "Kick-3.wav", "Kick-1.wav"),
    ("ForzeeStereo", "Snare-3.wav", "Snare-1.wav"),
    ("ForzeeStereo", "SnareOff-3.wav", "SnareOff-1.wav"),
    ("ForzeeStereo", "TomHigh-3.wav", "TomHigh-1.wav"),
    ("ForzeeStereo", "TomMid-3.wav", "TomLow-3.wav"),
    ("ForzeeStereo", "Ride-2.wav", "Ride-0.wav"),
    ("ForzeeStereo", "RideBell-3.wav", "RideBell-1.wav"),
    ("ForzeeStereo", "Crash18-3.wav", "Crash18-1.wav"),
    ("ForzeeStereo", "HiHatClosed-3.wav", "HiHatClosed-1.wav"),
    ("ForzeeStereo", "HiHatOpen-3.wav", "HiHatOpen-1.wav"),
    ("ForzeeStereo", "RimClick-3.wav", "RimClick-1.wav"),
    ("ForzeeStereo", "AgogoHigh-3.wav", "AgogoHigh-1.wav"),
    ("Gimme A Hand 1.0", "BongoHi-Hard.wav", "BongoHi-Soft.wav"),
    ("Gimme A Hand 1.0", "CajonSlaps-Hard.wav", "CajonSlaps-Soft.wav"),
];

/// A drum of a kit; the error is the name of one that is not installed.
fn drum((kit, file, other): &(&'static str, &str, &str)) -> Result<Pair, String> {
    let folder = installed("usr/share/hydrogen/data/drumkits").join(kit);
    let pair = stereo(&folder.join(file)).zip(stereo(&folder.join(other)));
    let (sound, other) = pair.ok_or_else(|| format!("{kit}: {file}"))?;
    let name = file.trim_end_matches(".wav").to_owned();
    Ok(Pair { name, source: kit, sound, others: vec![other], key: 60.0, is_drum: true })
}

/// All recordings that are installed; says which are not.
pub(crate) fn all() -> Vec<Pair> {
    let all = DRUMS.iter().map(drum).chain(INSTRUMENTS.iter().map(instrument));
    all.filter_map(|pair| pair.map_err(|name| println!("skipped: {name} is not installed")).ok()).collect()
}

/// Name, channel, program, key and another key.
const INSTRUMENTS: [(&str, u8, u8, u8, u8); 18] = [
    ("marimba", 0, 12, 60, 61),
    ("vibraphone", 0, 11, 65, 66),
    ("glockenspiel", 0, 9, 84, 85),
    ("tubular bell", 0, 14, 67, 68),
    ("timpani", 0, 47, 45, 46),
    ("nylon guitar", 0, 24, 52, 53),
    ("steel guitar", 0, 25, 52, 53),
    ("kalimba", 0, 108, 67, 68),
    ("celesta", 0, 8, 72, 73),
    ("music box", 0, 10, 84, 85),
    ("xylophone", 0, 13, 72, 73),
    ("harp", 0, 46, 64, 65),
    ("steel drum", 0, 114, 60, 61),
    ("wood block", 0, 115, 60, 62),
    ("taiko", 0, 116, 60, 62),
    ("kick", 9, 0, 36, 35),
    ("triangle", 9, 0, 81, 80),
    ("cowbell", 9, 0, 56, 67),
];
const DRUMS_OF_THE_FONT: [&str; 6] = ["wood block", "taiko", "timpani", "kick", "triangle", "cowbell"];
/// Velocities of a recording and of another one.
const VELOCITIES: [u8; 2] = [100, 60];

const FONT: &str = "usr/share/sounds/sf2/FluidR3_GM.sf2";

/// A note of the sound font; the error is its name if it is not installed.
fn instrument((name, channel, program, key, other): &(&str, u8, u8, u8, u8)) -> Result<Pair, String> {
    let note = |key, velocity| note(*channel, *program, key, velocity).ok_or_else(|| (*name).to_owned());
    let others = vec![note(*other, VELOCITIES[0])?, note(*key, VELOCITIES[1])?];
    let sound = note(*key, VELOCITIES[0])?;
    let is_drum = DRUMS_OF_THE_FONT.contains(name);
    Ok(Pair { name: (*name).to_owned(), source: "FluidR3", sound, others, key: f64::from(*key), is_drum })
}

/// Instruments of the sound font that have layers of velocity and key, each with a function that plays a key at a velocity.
pub(crate) fn layered() -> impl Iterator<Item = (&'static str, impl Fn((u8, u8)) -> Option<Played> + Copy)> {
    const LAYERED: [(&str, u8); 3] = [("marimba", 12), ("vibraphone", 11), ("nylon guitar", 24)];
    LAYERED.into_iter().map(|(name, program)| {
        let play = move |(key, velocity): (u8, u8)| {
            note(0, program, key, velocity).map(|sound| Played { sound, key, velocity })
        };
        (name, play)
    })
}

/// A note of four seconds without reverberation and chorus.
fn note(channel: u8, program: u8, key: u8, velocity: u8) -> Option<Stereo> {
    let font = Some(installed(FONT)).filter(|font| font.is_file())?;
    let folder = tempfile::tempdir().ok()?;
    let (song, sound) = (folder.path().join("note.mid"), folder.path().join("note.wav"));
    let mut track = vec![0, 0xc0 | channel, program, 0, 0x90 | channel, key, velocity];
    // 3840 ticks, and 480 ticks until the end of the track; a quarter note has 480 ticks and lasts half a second.
    track.extend([0x9e, 0x00, 0x80 | channel, key, 0, 0x83, 0x60, 0xff, 0x2f, 0]);
    let mut file = b"MThd\0\0\0\x06\0\0\0\x01\x01\xe0MTrk".to_vec();
    file.extend((track.len() as u32).to_be_bytes());
    file.extend(track);
    std::fs::write(&song, file).ok()?;
    let options = ["-ni", "-r", "44100", "-R", "0", "-C", "0", "-g", "0.8", "-O", "float", "-T", "wav", "-F"];
    let mut command = Command::new("fluidsynth");
    command.args(options).arg(&sound).arg(font).arg(&song).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().ok().filter(std::process::ExitStatus::success)?;
    stereo(&sound)
}
