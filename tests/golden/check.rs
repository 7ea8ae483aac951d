//! Compares a case with its accepted result, accepts a new result, and writes files that explain a failure.

use crate::score::{Score, WHOLE};
use sprung::analysis::figure::{self, Render};
use sprung::internals::measures::{Digest, diff, level};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Number of frames in the kept audio, for cases that keep audio.
const KEPT_FRAMES: usize = 12_000;

/// Left and right.
pub(crate) type Stereo = [Vec<f32>; 2];

/// The folders of accepted digests and audio, and of explanations of failures.
pub(crate) struct Store {
    pub(crate) accepted: PathBuf,
    pub(crate) failures: PathBuf,
}

impl Store {
    pub(crate) fn of_the_project() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        Self { accepted: root.join("tests/golden"), failures: root.join("target/golden") }
    }

    fn digest_path(&self, case: &str) -> PathBuf {
        self.accepted.join(format!("{case}.toml"))
    }

    fn audio_path(&self, case: &str) -> PathBuf {
        self.accepted.join(format!("{case}.wav"))
    }

    /// Digests and audio files that belong to none of `cases`.
    pub(crate) fn stale(&self, cases: &BTreeSet<String>) -> Vec<PathBuf> {
        let files = std::fs::read_dir(&self.accepted).expect("tests/golden is a folder");
        let paths = files.map(|file| file.expect("tests/golden can be listed").path());
        let kept = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "toml" || extension == "wav");
        let known = |path: &PathBuf| path.file_stem().and_then(|stem| stem.to_str()).is_some_and(|s| cases.contains(s));
        paths.filter(|path| kept(path) && !known(path)).collect()
    }

    pub(crate) fn remove_stale(&self, cases: &BTreeSet<String>) {
        for path in self.stale(cases) {
            std::fs::remove_file(path).expect("a stale golden can be removed");
        }
    }
}

/// Why a render cannot be right, even if it was accepted: a case with accepted silence would never test anything.
fn flaw(case: &Score, audio: &Stereo) -> Result<(), String> {
    let peak = level::peak(&audio[0]).max(level::peak(&audio[1]));
    let samples = audio.iter().flatten();
    if !samples.copied().all(f32::is_finite) {
        return Err(format!("{}: some samples are not finite", case.name));
    }
    if level::dbfs(peak) < -60.0 {
        return Err(format!("{}: it is all but silent", case.name));
    }
    Ok(())
}

/// Accepts the present sound of a case.
pub(crate) fn bless(store: &Store, case: &Score) {
    let audio = case.render(WHOLE);
    let digest = Digest::of(&audio[0], &audio[1], case.sample_rate);
    std::fs::write(store.digest_path(&case.name), digest.to_toml()).expect("the digest can be written");
    if case.keeps_audio {
        write_wav(&store.audio_path(&case.name), beginning(&audio), case.sample_rate);
    }
}

/// Renders a case in blocks of the first of these sizes, compares it with the accepted result, and compares renders of the other
/// sizes with it. The error is a message for people.
pub(crate) fn check(store: &Store, case: &Score, sizes: &[usize]) -> Result<(), String> {
    let (first, others) = sizes.split_first().expect("a case has a block size");
    let audio = case.render(*first);
    check_audio(store, case, &audio)?;
    for &block in others {
        let blocks = case.render(block);
        if let Some(difference) = diff::compare(&audio, &blocks) {
            let message = format!("{}: blocks of {block} differ from blocks of {first}: {difference}", case.name);
            let folder = explain(store, case, &blocks, Some(&audio), &message);
            return Err(format!("{message}\n    see {}", folder.display()));
        }
    }
    Ok(())
}

/// Compares a render of `case` with the accepted result.
pub(crate) fn check_audio(store: &Store, case: &Score, audio: &Stereo) -> Result<(), String> {
    flaw(case, audio)?;
    let name = &case.name;
    let accept = format!("accept with: cargo xtask bless {name}");
    let path = store.digest_path(name);
    let Ok(text) = std::fs::read_to_string(&path) else {
        return Err(format!("{name}: there is no {}\n    {accept}", path.display()));
    };
    let accepted = Digest::parse(&text, &path.display().to_string()).map_err(|error| format!("{name}: {error}"))?;
    let kept = if case.keeps_audio { Some(read_wav(&store.audio_path(name))?) } else { None };
    let difference = kept.as_ref().and_then(|kept| {
        // Only the beginning of accepted audio is kept.
        diff::compare(&kept[..], &beginning(audio))
    });
    let drift = accepted.compare(&Digest::of(&audio[0], &audio[1], case.sample_rate));
    let message = match (difference, drift) {
        (None, Ok(())) => return Ok(()),
        (Some(difference), Ok(())) => format!("{name}: the kept audio is not what the digest tells of: {difference}"),
        (Some(difference), Err(drift)) => format!("{name}: {difference}\n    {drift}"),
        (None, Err(drift)) if kept.is_some() => format!("{name}: {drift} (the kept audio is still the same)"),
        (None, Err(drift)) => format!("{name}: {drift}"),
    };
    let folder = explain(store, case, audio, kept.as_ref(), &message);
    Err(format!("{message}\n    see {}\n    {accept}", folder.display()))
}

/// The part of a render that is kept.
fn beginning(audio: &Stereo) -> [&[f32]; 2] {
    [&audio[0], &audio[1]].map(|channel| &channel[..channel.len().min(KEPT_FRAMES)])
}

/// Writes audio and images of a failure and returns their folder.
fn explain(store: &Store, case: &Score, actual: &Stereo, expected: Option<&Stereo>, message: &str) -> PathBuf {
    let folder = store.failures.join(&case.name);
    // Files of an earlier failure could be mistaken for files of this one.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the folder for failures can be made");
    let sample_rate = case.sample_rate;
    let channels = |audio: &'static str| folder.join(audio);
    write_wav(&channels("actual.wav"), [&actual[0], &actual[1]], sample_rate);
    let title = message.lines().next().unwrap_or_default();
    let drawn = match expected {
        Some(expected) => {
            // The kept audio may be shorter than the render.
            let frames = expected[0].len();
            let actual = [&actual[0], &actual[1]].map(|channel| &channel[..channel.len().min(frames)]);
            let difference =
                [0, 1].map(|side| actual[side].iter().zip(&expected[side]).map(|(a, e)| a - e).collect::<Vec<_>>());
            write_wav(&channels("expected.wav"), [&expected[0], &expected[1]], sample_rate);
            write_wav(&channels("difference.wav"), [&difference[0], &difference[1]], sample_rate);
            let expected = Render { left: &expected[0], right: &expected[1], sample_rate };
            let actual = Render { left: actual[0], right: actual[1], sample_rate };
            figure::comparison(expected, actual, title, &channels("figure.png"))
        }
        None => {
            let actual = Render { left: &actual[0], right: &actual[1], sample_rate };
            figure::waveform_and_spectrogram(actual, title, &channels("figure.png"))
        }
    };
    drawn.expect("the figure can be drawn");
    folder
}

fn write_wav(path: &Path, [left, right]: [&[f32]; 2], sample_rate: f64) {
    let (sample_rate, sample_format) = (sample_rate as u32, hound::SampleFormat::Float);
    let spec = hound::WavSpec { channels: 2, sample_rate, bits_per_sample: 32, sample_format };
    let mut writer = hound::WavWriter::create(path, spec).expect("the WAV can be created");
    for sample in left.iter().zip(right).flat_map(|(l, r)| [*l, *r]) {
        writer.write_sample(sample).expect("the WAV can be written");
    }
    writer.finalize().expect("the WAV can be finished");
}

fn read_wav(path: &Path) -> Result<Stereo, String> {
    let wrong = |error: hound::Error| format!("{}: {error}", path.display());
    let reader = hound::WavReader::open(path).map_err(wrong)?;
    let samples: Vec<f32> = reader.into_samples().collect::<Result<_, _>>().map_err(wrong)?;
    Ok([0, 1].map(|side| samples.iter().skip(side).step_by(2).copied().collect()))
}
