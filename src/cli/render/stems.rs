//! The stems of a song: a file for each, of the same length. None gets its name before all are complete.

use super::args::Args;
use crate::interrupt;
use crate::progress::Bar;
use crate::terminal::{complain, complain_lines, counted, warn};
use sprung::internals::files::{Inputs, Output, Stem, Target, stems_of, to_stem_wavs};
use sprung::internals::flac;
use sprung::internals::request::Request;
use sprung::internals::threads::on_threads;
use sprung::io::FileFormat;
use sprung::{Error, Result};
use std::fs;
use std::path::Path;

/// Renders a request into the stems of its song.
pub(super) fn run(args: &Args, request: &Request, folder: &Path) -> Result<()> {
    let format = args.format.unwrap_or(FileFormat::Wav);
    format.check_options(args.bits, args.rate)?;
    let mut inputs = Inputs::default();
    let prepared = request.prepare(&mut inputs, &mut warn)?;
    let job = prepared.job();
    args.check_length(format, &job)?;
    let stems = stems_of(&job);
    let new: Vec<&Path> = folder.ancestors().take_while(|folder| !folder.exists()).collect();
    let others = others(folder, &stems, format);
    if !args.force && !others.is_empty() {
        return Err(Error::value("--stems", format!("{}: expected another folder, or --force", told(folder, &others))));
    }
    fs::create_dir_all(folder).map_err(|source| Error::io(folder.display().to_string(), source))?;
    let write = || {
        let mut outputs = Vec::with_capacity(stems.len());
        for stem in &stems {
            let path = folder.join(format!("{}.{}", stem.name, format.ending()));
            outputs.push(Output::create(&Target::Path(path), args.force, &inputs)?);
        }
        interrupt::catch(true)?;
        let mut wavs = match format {
            FileFormat::Wav => Vec::new(),
            FileFormat::Flac => outputs.iter().map(Output::scratch).collect::<Result<_>>()?,
        };
        let into = if wavs.is_empty() { &mut outputs } else { &mut wavs };
        let mut bar = Bar::new();
        let progress = |progress| {
            bar.show(progress);
            interrupt::check()
        };
        let report = on_threads(args.threads, || to_stem_wavs(&job, &prepared.delivery, &stems, into, progress))??;
        drop(bar);
        // A file of an earlier run that is in the place of an inaudible stem is replaced too: it would belong to another mix.
        let exists = |output: &Output| Path::new(output.name()).exists();
        let is_wanted: Vec<bool> =
            outputs.iter().zip(&report.is_wanted).map(|(output, wanted)| *wanted || exists(output)).collect();
        for ((wav, output), is_wanted) in wavs.iter_mut().zip(&mut outputs).zip(&is_wanted) {
            if *is_wanted {
                let name = output.name().to_owned();
                flac::encode(wav.stream(), output.stream(), &name)?;
            }
        }
        let wanted = outputs.into_iter().zip(&is_wanted).filter(|(_, is_wanted)| **is_wanted);
        wanted.map(|(output, _)| output.commit()).collect::<Result<Vec<()>>>().map(|written| (written.len(), report))
    };
    let (written, report) = write().inspect_err(|_| {
        // Only folders that are empty are removed.
        new.iter().for_each(|folder| _ = fs::remove_dir(folder));
    })?;
    if !others.is_empty() {
        complain("warning", format_args!("{}: they stay there, and are no part of this mix", told(folder, &others)));
    }
    if report.clipped > 0 {
        let clipped = report.clipped;
        complain(
            "warning",
            format_args!("{clipped} samples clipped; lower the stems with --mix-gain-db, or keep them with --bits 32f"),
        );
    }
    let seconds = report.rendered.frames as f64 / f64::from(args.rate);
    complain_lines(&format!(
        "{}: {} of {seconds:.3} s at {} Hz\n",
        folder.display(),
        counted(written, "stem"),
        args.rate
    ));
    Ok(())
}

/// The files in a folder that look like stems, by their names, and are none of these.
fn others(folder: &Path, stems: &[Stem], format: FileFormat) -> Vec<String> {
    let own: Vec<String> = stems.iter().map(|stem| format!("{}.{}", stem.name, format.ending())).collect();
    let is_stem = |name: &str| {
        let Some((stem, "wav" | "flac")) = name.rsplit_once('.') else { return false };
        let channel = stem.split('-').next().unwrap_or(stem);
        stem == "space" || (channel.len() == 2 && channel.parse().is_ok_and(|number: u8| (1..=16).contains(&number)))
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut others: Vec<String> = names.filter(|name| is_stem(name) && !own.contains(name)).collect();
    others.sort();
    others
}

/// Says what other stems are in a folder.
fn told(folder: &Path, others: &[String]) -> String {
    let more = if others.len() > 1 { format!(" and {} more", others.len() - 1) } else { String::new() };
    format!("{} has stems of another run ({}{more})", folder.display(), others[0])
}
