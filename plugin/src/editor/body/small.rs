//! The small picture of the sound that is shown, made again when that is another.

use crate::editor::controls::shown::{Shown, Subject};
use sprung_picture::{Figure, small_figure};

/// The picture.
#[derive(Default)]
pub(crate) struct Small(Option<(Subject, Figure)>);

impl Small {
    /// The picture of this sound.
    pub(crate) fn get(&mut self, shown: &Shown) -> &Figure {
        let known = self.0.take().filter(|(subject, _)| *subject == shown.subject());
        let of = || small_figure(&shown.patch().modes, shown.family(), shown.tags());
        &self.0.insert(known.unwrap_or_else(|| (shown.subject(), of()))).1
    }
}
