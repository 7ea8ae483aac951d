//! Makes all samples of an instrument on all cores, and then its files.

use super::list::{Line, List};
use super::plan::{self, Plan};
use super::settings::Sampling;
use super::{instrument, take};
use crate::error::{Error, Result};
use crate::io::{Inputs, Output, Target, WavFormat};
use crate::preset::Playable;
use crate::render::on_threads;
use crate::sound::Kit;
use crate::text::file_stem;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::fs;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampled {
    /// Number of samples.
    pub samples: usize,
    /// Of these, those that were finished before.
    pub found: usize,
    /// Number of samples with a loop.
    pub loops: usize,
}

impl Sampling {
    /// Samples a preset or kit that plays as `kit`. `progress` is called with the number of finished samples and of all, by several
    /// threads, and can end the work by returning an error.
    ///
    /// # Errors
    /// [`Error::Value`] for settings out of range, for a sound without keys, and for a folder with another instrument;
    /// [`Error::Io`]; and the errors of `progress`.
    pub fn run(
        &self,
        playable: &Playable,
        kit: &Arc<Kit>,
        inputs: &Inputs,
        progress: &(dyn Fn(usize, usize) -> Result<()> + Sync),
    ) -> Result<Sampled> {
        self.format.check_options(self.bits, self.rate)?;
        let format = WavFormat { sample_rate: self.rate, channels: 2, samples: self.bits };
        let frames = self.length * f64::from(self.rate);
        if frames < 1.0 {
            return Err(Error::value("--length", "no frame is as short: expected a longer time"));
        }
        self.format.check_length(&format, frames.ceil() as u64)?;
        let plan = Plan::new(self, playable, kit)?;
        let samples = self.folder.join("samples");
        fs::create_dir_all(&samples).map_err(|source| Error::io(samples.display().to_string(), source))?;
        let list = List::open(self, playable)?;
        // Opened before the work, which would be lost if a file were in the way.
        let name = file_stem(playable.name());
        let open = |ending: &str| {
            let path = self.folder.join(format!("{name}.{ending}"));
            Output::create(&Target::Path(path), self.resume, inputs)
        };
        let outputs = [open("sfz")?, open("dspreset")?];
        list.begin()?;
        let done = AtomicUsize::new(0);
        let of = plan.takes.len();
        let make = |take: &plan::Take| -> Result<(Line, bool)> {
            progress(done.load(Ordering::Relaxed), of)?;
            let (line, was_found) = match list.find(&self.folder, &plan.file(take, self)) {
                Some(line) => (line, true),
                None => (take::make(self, &plan, kit, take, inputs)?, false),
            };
            if !was_found {
                list.add(&line)?;
            }
            progress(1 + done.fetch_add(1, Ordering::Relaxed), of)?;
            Ok((line, was_found))
        };
        let made = on_threads(self.at_once, || plan.takes.par_iter().map(make).collect::<Result<Vec<_>>>())??;
        let lines: Vec<Line> = made.iter().map(|(line, _)| line.clone()).collect();
        let texts = [instrument::sfz(&plan, &lines, playable.name()), instrument::decent_sampler(&plan, &lines)];
        for (mut output, text) in outputs.into_iter().zip(texts) {
            output.stream().write_all(text.as_bytes()).map_err(|source| Error::io(output.name(), source))?;
            output.commit()?;
        }
        Ok(Sampled {
            samples: lines.len(),
            found: made.iter().filter(|(_, was_found)| *was_found).count(),
            loops: lines.iter().filter(|line| line.looped.is_some()).count(),
        })
    }
}
