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
#[derive(Default)]
pub(super) struct Found {
    pub(super) sounds: Vec<Arc<Listed>>,
    /// Headings, each with the place of the first sound below it.
    pub(super) headings: Vec<(usize, String)>,
    /// How many of the sounds are of the chosen category.
    pub(super) own: usize,
}

impl Found {
    /// Appends sounds, under a heading unless that is empty.
    fn with(mut self, says: &str, sounds: Vec<Arc<Listed>>) -> Self {
        if !says.is_empty() {
            self.headings.push((self.sounds.len(), says.to_owned()));
        }
        self.sounds.extend(sounds);
        self
    }
}

impl Finding {
    /// The sounds, and those that the words find elsewhere; where there are none, those that come nearest.
    pub(super) fn find(&self, sounds: &Sounds) -> Found {
        let of = |category| {
            let mut found = sounds.find(category, &self.words, self.likeness.places());
            self.tags.retain(&mut found);
            found
        };
        let (found, words) = (of(self.category), self.words.trim().to_lowercase());
        let all = Found { own: found.len(), ..Found::default() };
        if !found.is_empty() && (words.is_empty() || self.category == Category::All) {
            return all.with("", found);
        }
        if words.is_empty() && self.tags.are_empty() {
            return all.with(self.category.invitation(), found);
        }
        let mut elsewhere = of(Category::All);
        if elsewhere.is_empty() {
            let (near, says) = sounds.nearest(&self.words, |_| true);
            return all.with(says, near);
        }
        let name = match (self.category, &self.likeness.found) {
            (Category::Like, Some((other, _))) => format!("“Like {other}”"),
            (category, _) => category.name(),
        };
        if found.is_empty() {
            return all.with(&format!("None in {name}. Elsewhere:"), elsewhere);
        }
        elsewhere.retain(|sound| !found.iter().any(|own| Arc::ptr_eq(own, sound)));
        let is_named = |sound: &Arc<Listed>| sound.name().to_lowercase() == words;
        // Enter loads the first. Whoever types a whole name means that sound, even if another family is still chosen.
        let comes_first = |sound: &Arc<Listed>| is_named(sound) && !found.iter().any(is_named);
        let (named, others): (Vec<_>, Vec<_>) = elsewhere.into_iter().partition(comes_first);
        let own = if named.is_empty() { String::new() } else { format!("In {name}:") };
        let parts =
            [(format!("With this name, not in {name}:"), named), (own, found), ("Elsewhere:".to_owned(), others)];
        let parts = parts.into_iter().filter(|(_, part)| !part.is_empty());
        parts.fold(all, |all, (says, part)| all.with(&says, part))
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

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::internals::library::Library;
    use sprung::preset::{Family, Playable, Preset};

    #[test]
    fn words_find_sounds_outside_the_family_too_and_first_those_that_they_name() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::at(folder.path());
        let (name, comment) = ("My Glass Room".to_owned(), "A marimba.".to_owned());
        let own = Preset { name, comment, ..Preset::find("Marimba").unwrap().clone() };
        library.save(&Playable::Preset(own), false).unwrap();
        let sounds = Sounds::read(Some(library));
        let found =
            |category, words: &str| Finding { category, words: words.to_owned(), ..Finding::default() }.find(&sounds);
        let find = |category, words: &str| {
            let Found { sounds, headings, .. } = found(category, words);
            (sounds.iter().map(|sound| sound.name().to_owned()).collect::<Vec<_>>(), headings)
        };
        let (mut names, headings) = find(Category::Own, "marimba");
        let place = names.iter().position(|name| name == "My Glass Room").unwrap();
        assert!(names[0] == "Marimba" && names[..place].iter().all(|name| name.contains("Marimba")), "{names:?}");
        let says = [(0, "With this name, not in Your own:".to_owned()), (place, "In Your own:".to_owned())];
        assert_eq!(headings[..2], says);
        let (mut everywhere, none) = find(Category::All, "marimba");
        names.sort_unstable();
        everywhere.sort_unstable();
        assert_eq!(names, everywhere, "none is lost, and none is twice");
        assert!(none.is_empty(), "{none:?}");
        let all = find(Category::Own, "glass");
        assert_eq!((all.0[0].as_str(), &all.1[..]), ("My Glass Room", &[(1, "Elsewhere:".to_owned())][..]));
        assert_eq!(find(Category::Own, " "), (vec!["My Glass Room".to_owned()], vec![]));
        let says = [(0, "None in Mallet. Elsewhere:".to_owned())];
        assert_eq!(find(Category::Family(Family::Mallet), "church bell").1, says);
        assert_eq!(found(Category::Own, "marimba").own, 1);
        assert_eq!(found(Category::Family(Family::Mallet), "church bell").own, 0);
    }
}
