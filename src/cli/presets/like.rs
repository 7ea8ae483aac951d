//! `sprung presets like`: the presets that sound most like a recording.

use super::select::Select;
use crate::progress::Bar;
use crate::terminal::{complain_lines, print};
use crate::{interrupt, quantity, recording};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde_json::{Value, json};
use sprung::analysis::fit::{LOOKED_AT, Model, Nearness};
use sprung::internals::files::Inputs;
use sprung::preset::{Playable, Preset};
use sprung::units::{note_name, parse_key};
use sprung::{Error, Result};
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(clap::Args)]
pub(super) struct Args {
    /// Sound file: WAV, AIFF, FLAC, Ogg Vorbis or MP3; - is stdin
    sound: PathBuf,
    /// The note that was recorded: a name, key or frequency [default: estimated from its modes]
    #[arg(long, value_parser = quantity::note, allow_hyphen_values = true)]
    note: Option<String>,
    /// How many presets to list, 1-40
    #[arg(long, default_value_t = 10, value_name = "N", value_parser = quantity::whole::<u8>(1..=40))]
    count: u8,
    #[command(flatten)]
    select: Select,
    /// Print JSON: name, family, distance, key
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let mut inputs = Inputs::default();
    let (recording, name) = recording::read(&args.sound, &mut inputs)?;
    let key =
        args.note.as_deref().map(|note| parse_key(note, 440.0).map_err(|message| Error::value("--note", message)));
    let model = Model::new(&recording, &name, key.transpose()?)?;
    let found = args.select.found();
    let presets = found.iter().filter_map(|listed| match &listed.playable {
        Playable::Preset(preset) => Some((listed.family_name(), preset)),
        Playable::Kit(_) => None,
    });
    let presets: Vec<(&str, &Preset)> = presets.collect();
    if presets.is_empty() {
        return Err(Error::value(
            "presets",
            "no preset fits these options: expected another --family, --tag or --search",
        ));
    }
    interrupt::catch(true)?;
    let (bar, done) = (Mutex::new(Bar::new()), AtomicUsize::new(0));
    let work = presets.len() + LOOKED_AT.min(presets.len());
    let tick = || {
        let share = (1 + done.fetch_add(1, Ordering::Relaxed)) as f64 / work as f64;
        bar.lock().map_or(Ok(()), |mut bar| if bar.show_share(share) { Ok(()) } else { Err(Error::Interrupted) })
    };
    let all: Vec<usize> = (0..presets.len()).collect();
    let first = ranked(&all, |index| (*index, model.first_look(presets[*index].1)), &tick)?;
    let again = |(index, first): &(usize, Nearness)| (*index, model.nearness(presets[*index].1, first.key));
    let nearest = ranked(&first[..LOOKED_AT.min(first.len())], again, &tick)?;
    drop(bar);
    let nearest = nearest.iter().take(args.count.into()).map(|(index, nearness)| (presets[*index], *nearness));
    if args.json {
        let described = nearest.map(|((family, preset), Nearness { distance, key })| {
            json!({ "name": preset.name, "family": family, "distance_db": distance, "key": key })
        });
        return print(&format!("{:#}\n", Value::Array(described.collect())));
    }
    if args.note.is_none() {
        let found =
            if model.is_pitched { format!("key {:.2}, estimated", model.key) } else { "no pitch found".to_owned() };
        complain_lines(&format!("{name}: {found}; --note says another\n"));
    }
    let mut text = String::new();
    for ((family, preset), Nearness { distance, key }) in nearest {
        let key = note_name(key.round().clamp(0.0, 127.0) as u8);
        _ = writeln!(text, "{distance:5.1} dB  {:24} {family}, {key}", preset.name);
    }
    print(&text)
}

/// Presets by how near they are, the nearest first. `tick` is called after each, and can end the work.
fn ranked<T: Sync>(
    presets: &[T],
    near: impl Fn(&T) -> (usize, Nearness) + Sync,
    tick: &(dyn Fn() -> Result<()> + Sync),
) -> Result<Vec<(usize, Nearness)>> {
    let near = |preset: &T| {
        let found = near(preset);
        tick().map(|()| found)
    };
    let mut ranked = presets.par_iter().map(near).collect::<Result<Vec<_>>>()?;
    ranked.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance).then(a.0.cmp(&b.0)));
    Ok(ranked)
}
