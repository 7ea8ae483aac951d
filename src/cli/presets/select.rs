//! Selects sounds of the factory or of the user for a command.

use crate::terminal::warn;
use clap::builder::PossibleValuesParser;
use sprung::internals::library::{Catalogue, Library, Listed};
use sprung::preset::Family;
use std::sync::Arc;

fn families() -> PossibleValuesParser {
    PossibleValuesParser::new(Family::ALL.iter().map(|family| family.name()).chain([Listed::KIT]))
}

/// Filters by which sounds are found.
#[derive(clap::Args)]
pub(super) struct Select {
    /// The sounds that you saved, from the window or from `play`, in place of the factory's
    #[arg(long)]
    own: bool,
    /// Only sounds of this family
    #[arg(long, value_name = "FAMILY", value_parser = families())]
    family: Option<String>,
    /// Only sounds with this tag, as `list --json` has them; may be repeated
    #[arg(long, value_name = "TAG")]
    tag: Vec<String>,
    /// Only sounds with all of these words in their name, tags, family or description
    #[arg(long, value_name = "WORDS")]
    search: Option<String>,
}

impl Select {
    /// The selected presets and kits, in the order of lists. Warns of files of the user that cannot be read.
    pub(super) fn found(&self) -> Vec<Arc<Listed>> {
        let catalogue = match (self.own, Library::of_user()) {
            (false, _) => Catalogue::of_factory(),
            (true, library) => library.as_ref().map(Catalogue::of_library).unwrap_or_default(),
        };
        catalogue.broken.iter().for_each(|error| warn(&error.to_string()));
        catalogue.sounds.into_iter().filter(|listed| self.means(listed)).collect()
    }

    fn means(&self, listed: &Listed) -> bool {
        self.family.as_deref().is_none_or(|family| family == listed.family_name())
            && self.tag.iter().all(|tag| listed.has_tag(tag))
            && self.search.as_deref().is_none_or(|words| listed.has_words(words))
    }
}
