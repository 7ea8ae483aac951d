//! The one file of a rendering: WAV or FLAC, as it is or as a loop.

use super::args::Args;
use super::{figure, report};
use crate::progress::Bar;
use crate::terminal::warn;
use crate::{interrupt, recording};
use sprung::internals::files::{Inputs, Output, Target, to_looped_wav, to_wav};
use sprung::internals::flac;
use sprung::internals::request::Request;
use sprung::internals::threads::on_threads;
use sprung::render::Progress;
use sprung::{Error, Result};
use std::io::IsTerminal;

/// Renders a request into a file.
pub(super) fn run(args: &Args, request: &Request, target: &Target) -> Result<()> {
    if *target == Target::Stdout && std::io::stdout().is_terminal() {
        return Err(Error::value("--output", "stdout is a terminal: expected a file, or stdout sent to one"));
    }
    let format = target.file_format(args.format)?;
    format.check_options(args.bits, args.rate)?;
    let mut inputs = Inputs::default();
    let prepared = request.prepare(&mut inputs, &mut warn)?;
    let (job, delivery) = (prepared.job(), &prepared.delivery);
    args.check_length(format, &job)?;
    if args.json {
        inputs.check_stdout()?;
    }
    let mut output = Output::create(target, args.force, &inputs)?;
    let figure = recording::open_figure(args.figure.as_deref(), args.force, &inputs)?;
    interrupt::catch(output.is_seekable())?;
    let mut bar = Bar::new();
    let progress = |progress: Progress| {
        bar.show(progress);
        interrupt::check()
    };
    let write = |output: &mut Output| match args.is_loop {
        true => to_looped_wav(&job, delivery, output, progress),
        false => to_wav(&job, delivery, output, progress),
    };
    let report = on_threads(args.threads, || flac::write_as(format, &mut output, write))??;
    drop(bar);
    if let Some(figure) = figure {
        let title = target.name();
        figure.write(|format| figure::draw(&args.note, &title, &job, format))?;
    }
    output.commit()?;
    report::tell(&report, target, args.sound.mix_gain_db, args.json)
}
