//! A progress bar on stderr.

use indicatif::{ProgressBar, ProgressStyle};
use sprung::render::Progress;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// The bar appears only after this time.
const PATIENCE: Duration = Duration::from_secs(1);

pub(super) struct Bar {
    started: Instant,
    wanted: bool,
    bar: Option<ProgressBar>,
}

impl Bar {
    pub(super) fn new() -> Self {
        Self { started: Instant::now(), wanted: std::io::stderr().is_terminal(), bar: None }
    }

    pub(super) fn show(&mut self, progress: Progress) {
        if !self.wanted || (self.bar.is_none() && self.started.elapsed() < PATIENCE) {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let style =
                ProgressStyle::with_template("{wide_bar} {percent} %  {eta} left").expect("the template is a constant");
            ProgressBar::new(progress.expected).with_style(style).with_elapsed(self.started.elapsed())
        });
        bar.set_length(progress.expected);
        bar.set_position(progress.frames);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
