//! Which of the factory's sounds a command means.

use clap::builder::PossibleValuesParser;
use sprung::preset::{Family, KitPreset, Preset};

/// The family of kits, which are no presets.
const KIT: &str = "kit";

fn families() -> PossibleValuesParser {
    PossibleValuesParser::new(Family::ALL.iter().map(|family| family.name()).chain([KIT]))
}

/// Filters by which sounds are found.
#[derive(clap::Args)]
pub(super) struct Select {
    /// Only sounds of this family
    #[arg(long, value_name = "FAMILY", value_parser = families())]
    family: Option<String>,
    /// Only sounds with this tag; may be repeated
    #[arg(long, value_name = "TAG")]
    tag: Vec<String>,
    /// Only sounds with all of these words in their name, tags, family or description
    #[arg(long, value_name = "WORDS")]
    search: Option<String>,
}

/// A factory sound.
#[derive(Clone, Copy)]
pub(super) enum Found {
    /// A preset.
    Preset(&'static Preset),
    /// A kit.
    Kit(&'static KitPreset),
}

impl Found {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Preset(preset) => &preset.name,
            Self::Kit(kit) => &kit.name,
        }
    }

    pub(super) fn author(self) -> &'static str {
        match self {
            Self::Preset(preset) => &preset.author,
            Self::Kit(kit) => &kit.author,
        }
    }

    pub(super) fn tags(self) -> &'static [String] {
        match self {
            Self::Preset(preset) => &preset.tags,
            Self::Kit(kit) => &kit.tags,
        }
    }

    pub(super) fn comment(self) -> &'static str {
        match self {
            Self::Preset(preset) => &preset.comment,
            Self::Kit(kit) => &kit.comment,
        }
    }

    /// The name of its family; [`KIT`] for a kit, and empty for none.
    pub(super) fn family(self) -> &'static str {
        match self {
            Self::Preset(preset) => preset.guide.family.map_or("", Family::name),
            Self::Kit(_) => KIT,
        }
    }
}

impl Select {
    /// The presets and kits that are meant, in the order of lists.
    pub(super) fn found(&self) -> Vec<Found> {
        let presets = Preset::factory().iter().map(Found::Preset);
        presets.chain(KitPreset::factory().iter().map(Found::Kit)).filter(|found| self.means(*found)).collect()
    }

    fn means(&self, found: Found) -> bool {
        let has_tag = |tag: &String| found.tags().iter().any(|own| own.eq_ignore_ascii_case(tag.trim()));
        let text = [found.name(), found.family(), found.comment(), &found.tags().join(" ")].join(" ").to_lowercase();
        self.family.as_deref().is_none_or(|family| family == found.family())
            && self.tag.iter().all(has_tag)
            && self
                .search
                .as_deref()
                .is_none_or(|words| words.to_lowercase().split_whitespace().all(|word| text.contains(word)))
    }
}
