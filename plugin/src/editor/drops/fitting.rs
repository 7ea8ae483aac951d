//! The fit of dropped recordings that is in progress, and what becomes of it.

use super::recordings::{self, Done};
use crate::editor::background::Background;
use crate::editor::controls::{Controls, Hint, Said};
use crate::editor::widgets::progress::{Face, PAUSE, paint};
use egui::{Rect, Ui};
use sprung::preset::Playable;
use std::path::PathBuf;

/// The fit that is in progress, if there is one.
#[derive(Default)]
pub(crate) struct Fitting {
    work: Option<Background<Done>>,
}

impl Fitting {
    /// Begins to fit a sound to recordings. Returns a message.
    pub(crate) fn begin(&mut self, paths: Vec<PathBuf>) -> Said {
        if let Some(work) = &self.work {
            return Err(format!("{} is still being fitted: wait for it, or cancel it first", work.name));
        }
        self.work = Some(recordings::start(paths)?);
        Ok(String::new())
    }

    /// Shows the progress in the middle of a part of the window. When the fit ends, loads the result as one undo step
    /// and returns a message.
    pub(crate) fn show(&mut self, ui: &Ui, within: Rect, controls: &mut Controls) -> Option<Said> {
        let work = self.work.as_mut()?;
        if let Some(ended) = work.take() {
            let name = std::mem::take(&mut work.name);
            self.work = None;
            ui.ctx().request_repaint();
            return Some(ended.map(|done| {
                controls.release();
                let (step, preset) = (format!("Fit {name}"), Playable::Preset(done.preset));
                controls.history.load_new(step, preset, controls.params, controls.host);
                match controls.history.take_lost() {
                    Some(lost) => format!("{lost}; {}", done.message),
                    None => done.message,
                }
            }));
        }
        ui.ctx().request_repaint_after(PAUSE);
        let (name, share, is_ending) = (&work.name, work.share(), work.is_cancelled());
        let face = Face { verb: "Fitting", name, share, is_ending, cancel: "Cancel the fit" };
        let cancel = paint(ui, within, &face, controls.palette);
        if cancel.hovered() {
            *controls.hint = Hint::new("Cancel", "the sound stays as it is");
        }
        if cancel.clicked() {
            work.cancel();
        }
        None
    }
}
