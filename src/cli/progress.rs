//! A progress bar on stderr.

use super::interrupt;
use indicatif::{ProgressBar, ProgressStyle};
use sprung::render::Progress;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Steps of a bar that shows shares.
const STEPS: u64 = 1000;
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

    /// Shows which share of the work is done. Returns whether to go on: not after Ctrl-C.
    pub(super) fn show_share(&mut self, share: f64) -> bool {
        self.show(Progress { frames: (share * STEPS as f64) as u64, expected: STEPS });
        interrupt::check().is_ok()
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
