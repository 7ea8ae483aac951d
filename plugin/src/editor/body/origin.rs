//! The origin of the modes of the sound that is shown.

use crate::editor::controls::shown::{Shown, Subject};
use sprung_picture::Origin;

/// The origin of the loaded sound's modes, read again only when another sound is loaded.
#[derive(Default)]
pub(crate) struct OriginShown(Option<(Subject, Origin)>);

impl OriginShown {
    pub(crate) fn get(&mut self, shown: &Shown) -> Origin {
        match &self.0 {
            Some((subject, origin)) if *subject == shown.subject() => origin.clone(),
            _ => {
                let origin = Origin::of(&shown.patch().modes);
                self.0 = Some((shown.subject(), origin.clone()));
                origin
            }
        }
    }
}
