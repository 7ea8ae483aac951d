//! `sprung presets audition`: renders the factory's sounds, and makes a page that plays and shows them.

use super::select::Select;
use crate::figure;
use crate::interrupt;
use crate::progress::Bar;
use crate::terminal::counted;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use sprung::analysis::figure::modes_of;
use sprung::engine::{Event, EventKind, Synth};
use sprung::internals::files::{Inputs, Output, Target, to_wav};
use sprung::internals::library::Listed;
use sprung::internals::measures::preset::{Measure, measure};
use sprung::internals::page::{STYLE, escaped, fill};
use sprung::internals::text::slug;
use sprung::io::{SampleFormat, Song, SongEvent};
use sprung::params::Param;
use sprung::preset::{Family, KitPreset, Playable, Preset};
use sprung::render::{Delivery, Job, Level, Options, Tail};
use sprung::sound::Kit;
use sprung::units::{frequency_from_key, note_name};
use sprung::{Error, Result};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

const RATE: u32 = 48_000;

/// Seconds from one pad of a kit to the next.
const PAD_SECONDS: f64 = 0.3;

/// How long a sound may ring after its phrase, in seconds.
const TAIL: f64 = 4.0;

/// Number of notes for measuring how fast a sound is rendered, and the length of that rendering in seconds.
const VOICES: u8 = 16;
const TIMED_SECONDS: f64 = 1.0;

#[derive(clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    select: Select,
    /// Folder for the page (index.html), the sounds and their pictures; it is made if it does not exist
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
}

/// A sound that was rendered and measured.
struct Auditioned {
    found: Arc<Listed>,
    file: String,
    measures: Vec<Measure>,
    /// How many times faster than real time 16 voices are rendered on one core.
    speed: f64,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let found = args.select.found();
    if found.is_empty() {
        return Err(Error::value("presets", "no sound is meant: expected filters that leave some"));
    }
    interrupt::catch(true)?;
    let is_new = !args.out.is_dir();
    if is_new {
        std::fs::create_dir(&args.out).map_err(|source| Error::io(args.out.display().to_string(), source))?;
    }
    let done = AtomicUsize::new(0);
    page(&found, args, &done).map_err(|error| {
        let done = done.load(Ordering::Relaxed);
        if matches!(error, Error::Interrupted) && done > 0 {
            let (all, out) = (counted(found.len(), "sound"), args.out.display());
            let left = format!("{done} of {all} are in {out}, without a page; --force makes all of them anew");
            return Error::InterruptedAfter { left };
        }
        if is_new {
            // This fails if the folder already has files: then they and the folder stay.
            let _ = std::fs::remove_dir(&args.out);
        }
        error
    })
}

/// Writes sounds, pictures and the page; `done` counts the sounds that are complete.
fn page(found: &[Arc<Listed>], args: &Args, done: &AtomicUsize) -> Result<()> {
    let page = create(&args.out, "index.html", args.force)?;
    let mut all = in_parallel(found, args, done)?;
    // One after another, since other work on the same cores would slow the measured rendering.
    for one in &mut all {
        interrupt::check()?;
        one.speed = speed(&one.found.playable.kit());
    }
    write(page, written(&all).as_bytes())
}

/// Auditions all sounds on all cores, with a progress bar.
fn in_parallel(found: &[Arc<Listed>], args: &Args, done: &AtomicUsize) -> Result<Vec<Auditioned>> {
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| found.par_iter().map(|one| audition(one, args, done)).collect());
        let mut bar = Bar::new();
        while !worker.is_finished() {
            bar.show_share(done.load(Ordering::Relaxed) as f64 / found.len() as f64);
            std::thread::sleep(Duration::from_millis(50));
        }
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

fn create(folder: &Path, name: &str, force: bool) -> Result<Output> {
    Output::create(&Target::Path(folder.join(name)), force, &Inputs::default())
}

fn write(mut output: Output, bytes: &[u8]) -> Result<()> {
    output.stream().write_all(bytes).map_err(|source| Error::io(output.name(), source))?;
    output.commit()
}

/// Renders a sound to its files and measures it.
fn audition(found: &Arc<Listed>, args: &Args, done: &AtomicUsize) -> Result<Auditioned> {
    interrupt::check()?;
    // The user's own sounds may have equal names, but not equal file names.
    let own = found.path.as_ref().and_then(|path| path.file_stem());
    let file = own.map_or_else(|| slug(found.name()), |own| own.to_string_lossy().into_owned());
    let (song, modes) = match &found.playable {
        Playable::Preset(preset) => {
            let a4_hz = f64::from(preset.patch.get(Param::Tuning));
            (phrase(preset), modes_of(&preset.patch, frequency_from_key(preset.guide.home.into(), a4_hz)))
        }
        Playable::Kit(kit) => (pads(kit), Vec::new()),
    };
    let (kit, options) =
        (found.playable.kit(), Options { sample_rate: RATE, seed: 0, block: 4096, tail: Tail::Seconds(TAIL) });
    let job = Job::new(&song, &kit, options);
    let mut output = create(&args.out, &format!("{file}.wav"), args.force)?;
    let delivery = Delivery { samples: SampleFormat::Int16, dither: false, mono: false, level: Level::Gain(0.0) };
    to_wav(&job, &delivery, &mut output, |_| interrupt::check())?;
    output.commit()?;
    let picture = create(&args.out, &format!("{file}.png"), args.force)?;
    write(picture, &figure::drawn(&job, found.name(), &modes, "png")?)?;
    let measures = match &found.playable {
        Playable::Preset(preset) => measure(preset)?,
        Playable::Kit(_) => Vec::new(),
    };
    done.fetch_add(1, Ordering::Relaxed);
    Ok(Auditioned { found: found.clone(), file, measures, speed: 0.0 })
}

fn song(notes: impl Iterator<Item = (f64, f64, u8, u8)>) -> Song {
    let mut events = Vec::new();
    for (start, seconds, key, velocity) in notes {
        let velocity = f32::from(velocity) / 127.0;
        let on = EventKind::NoteOn { key, detune: 0.0, velocity, id: None };
        let off = EventKind::NoteOff { key, velocity: 0.5, id: None };
        events.extend([(start, on), (start + 0.98 * seconds, off)].map(|(seconds, kind)| SongEvent {
            seconds,
            channel: 0,
            kind,
        }));
    }
    events.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let seconds = events.last().map_or(0.0, |event| event.seconds);
    Song { events, seconds }
}

/// The phrase of a preset, or a note on its home key.
fn phrase(preset: &Preset) -> Song {
    match &preset.guide.phrase {
        Some(phrase) => song(phrase.notes().iter().map(|note| (note.start, note.seconds, note.key, note.velocity))),
        None => song([(0.0, 1.0, preset.guide.home, 100)].into_iter()),
    }
}

/// The pads of a kit, one after the other.
fn pads(kit: &KitPreset) -> Song {
    song(kit.pads.iter().enumerate().map(|(n, (key, _))| (PAD_SECONDS * n as f64, PAD_SECONDS, *key, 100)))
}

/// How many times faster than real time 16 notes of a kit are rendered on this core.
fn speed(kit: &Arc<Kit>) -> f64 {
    let mut synth = Synth::new(RATE.into(), 0);
    synth.set_kit(kit);
    synth.reset();
    let keys: Vec<u8> = (0..128).filter(|key| kit.pad(*key).is_some()).collect();
    let from = keys.iter().position(|key| *key >= 48).unwrap_or(0).min(keys.len().saturating_sub(VOICES.into()));
    let struck = keys[from..].iter().take(VOICES.into());
    let events: Vec<_> = struck.map(|key| Event::note_on(0, *key, 0.8)).collect();
    let [mut left, mut right] = [0, 1].map(|_| vec![0.0; (TIMED_SECONDS * f64::from(RATE)) as usize]);
    let start = Instant::now();
    synth.process(&events, &mut left, &mut right);
    TIMED_SECONDS / start.elapsed().as_secs_f64()
}

/// The page as HTML.
fn written(all: &[Auditioned]) -> String {
    let off = all.iter().filter(|one| one.measures.iter().any(|measure| !measure.is_kept())).count();
    let heaviest = all.iter().min_by(|a, b| a.speed.total_cmp(&b.speed));
    let heaviest = heaviest.map_or(String::new(), |one| {
        format!(" {VOICES} voices of the heaviest, {}, are rendered {:.1} times faster than real time on one core of this machine.", escaped(one.found.name()), one.speed)
    });
    let summary = format!("{} sounds, of which {off} have a measure that is off.{heaviest}", all.len());
    let option = |family: &str| format!("<option>{family}</option>");
    fill(include_str!("audition.html"), |name| match name {
        "style" => STYLE.to_owned(),
        "summary" => summary.clone(),
        "families" => Family::ALL.iter().map(|family| option(family.name())).chain([option(Listed::KIT)]).collect(),
        "sounds" => all.iter().map(article).collect(),
        other => unreachable!("the template has no place ‘{other}’"),
    })
}

fn article(one: &Auditioned) -> String {
    let (found, playable) = (&one.found, &one.found.playable);
    let (name, file) = (escaped(found.name()), &one.file);
    let tags = found.tags().join(", ");
    let text =
        [found.name(), playable.comment(), playable.details(), &tags, found.family_name()].join(" ").to_lowercase();
    let keys = match playable {
        Playable::Preset(preset) => {
            let [lowest, highest, home] = [preset.guide.lowest, preset.guide.highest, preset.guide.home].map(note_name);
            let macros = preset.guide.macros.join(", ");
            format!(
                " · keys {lowest} to {highest}, at home on {home}{}",
                if macros.is_empty() { macros } else { format!(" · macros: {macros}") }
            )
        }
        Playable::Kit(kit) => format!(" · {} pads", kit.pads.len()),
    };
    let details = match playable.details() {
        "" => String::new(),
        details => format!("<p class=\"note\">{}</p>\n", escaped(details)),
    };
    let rows: String = one.measures.iter().map(row).collect();
    let table = if rows.is_empty() {
        rows
    } else {
        format!(
            "<details><summary>Measures</summary><div class=\"scroll\"><table><tbody>\n{rows}</tbody></table></div></details>\n"
        )
    };
    format!(
        "<article data-family=\"{family}\" data-text=\"{text}\"><h2>{name}</h2>\n<p>{comment}</p>\n{details}<p class=\"note\">{family} · {tags}{keys} · 16 voices {speed:.0}× real time</p>\n<audio controls preload=\"none\" src=\"{file}.wav\"></audio>\n<img loading=\"lazy\" alt=\"Waveform, spectrogram and modes of {name}\" src=\"{file}.png\">\n{table}</article>\n",
        family = found.family_name(),
        text = escaped(&text),
        comment = escaped(playable.comment()),
        tags = escaped(&tags),
        keys = escaped(&keys),
        speed = one.speed,
    )
}

fn row(measure: &Measure) -> String {
    let Measure { name, unit, value, wanted, note } = measure;
    let number = |number: f64| if number.is_infinite() { String::new() } else { format!("{number:.2}") };
    let wanted = wanted
        .as_ref()
        .map_or(String::new(), |wanted| format!("{} to {}", number(*wanted.start()), number(*wanted.end())));
    let class = if measure.is_kept() { "" } else { " class=\"off\"" };
    let value = value.map_or("–".to_owned(), |value| format!("{value:.2} {unit}"));
    format!(
        "<tr{class}><th scope=\"row\">{name}</th><td>{value}</td><td>{wanted}</td><td>{}</td></tr>\n",
        escaped(note)
    )
}
