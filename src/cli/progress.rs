//! A progress bar on stderr.

use super::interrupt;
use indicatif::{ProgressBar, ProgressStyle};
use sprung::render::Progress;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Number of steps of a bar that shows a share.
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

    /// Shows the completed share of the work. Returns whether to continue: false after Ctrl-C.
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

/// A bar that counts jobs, with their rate and the time left.
pub(super) struct Count {
    bar: Option<ProgressBar>,
}

impl Count {
    pub(super) fn new() -> Self {
        Self { bar: std::io::stderr().is_terminal().then(ProgressBar::no_length) }
    }

    /// Shows the number of completed jobs out of all. `found` of them were completed earlier, and do not
    /// count for the rate.
    pub(super) fn show(&mut self, done: u64, found: u64, of: u64) {
        let Some(bar) = &self.bar else { return };
        if bar.length() != Some(of) {
            let style = ProgressStyle::with_template("{wide_bar} {msg}{human_pos}/{human_len}  {per_sec}  {eta} left");
            bar.set_style(style.expect("the template is a constant"));
            bar.set_length(of);
            bar.enable_steady_tick(Duration::from_millis(500));
        }
        if bar.position() == 0 && found > 0 {
            bar.set_position(found);
            bar.reset_eta();
        }
        bar.set_position(done);
    }
}

impl Drop for Count {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
