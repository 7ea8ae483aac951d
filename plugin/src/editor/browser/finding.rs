//! What is looked for in the browser: a category, words and tags, and the sounds that this finds.

use super::likeness::Likeness;
use super::sounds::{Category, Sounds};
use super::tags::Tags;
use sprung::internals::library::Listed;
use std::sync::Arc;

/// What is looked for.
#[derive(Default)]
pub(super) struct Finding {
    pub(super) category: Category,
    pub(super) words: String,
    pub(super) tags: Tags,
    pub(super) likeness: Likeness,
    /// Whether the search takes the focus when it is shown next.
    pub(super) searches: bool,
}

/// What was found.
pub(super) struct Found {
    pub(super) sounds: Vec<Arc<Listed>>,
    /// What is said above them; may be empty.
    pub(super) says: String,
}

impl Finding {
    /// The sounds; where there are none, those from elsewhere that come nearest.
    pub(super) fn find(&self, sounds: &Sounds) -> Found {
        let of = |category| {
            let mut found = sounds.find(category, &self.words, self.likeness.places());
            self.tags.retain(&mut found);
            found
        };
        let found = of(self.category);
        if !found.is_empty() {
            return Found { sounds: found, says: String::new() };
        }
        if self.words.trim().is_empty() && self.tags.are_empty() {
            return Found { sounds: found, says: self.category.invitation().to_owned() };
        }
        let found = of(Category::All);
        if !found.is_empty() {
            return Found { sounds: found, says: format!("None in {}. Elsewhere:", self.category.name()) };
        }
        let (near, says) = sounds.nearest(&self.words, |_| true);
        Found { sounds: near, says: says.to_owned() }
    }

    /// Shows all of a category: words and tags of another search would hide most of it.
    pub(super) fn choose(&mut self, category: Category) {
        (self.category, self.words) = (category, String::new());
        self.tags.clear();
    }

    /// What is looked for, to be compared with it later.
    pub(super) fn question(&self) -> (Category, String, Tags) {
        (self.category, self.words.clone(), self.tags.clone())
    }
}
