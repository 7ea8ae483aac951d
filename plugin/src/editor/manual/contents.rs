//! The manual's table of contents, by groups, and the pages that have some words.

use super::text::{Block, blocks};
use sprung::internals::text::{CONTENTS, PAGES};

/// A line of the contents.
#[derive(Debug, PartialEq)]
pub(super) enum Entry {
    /// The name of a group.
    Group(String),
    /// The place of a page, its title, and what it is about.
    Page(usize, String, String),
}

/// All lines, in the order of the manual's own contents.
pub(super) fn entries() -> Vec<Entry> {
    let page = |row: &Vec<String>| {
        let (title, rest) = row.first()?.strip_prefix('[')?.split_once("](")?;
        let place = PAGES.iter().position(|(name, _)| rest.strip_suffix(".md)") == Some(*name))?;
        Some(Entry::Page(place, title.to_owned(), row.get(1)?.replace('`', "")))
    };
    let lines = |block| match block {
        Block::Heading(name) => vec![Entry::Group(name)],
        Block::Table(rows) => rows.iter().filter_map(page).collect(),
        _ => Vec::new(),
    };
    blocks(CONTENTS).into_iter().flat_map(lines).collect()
}

/// Whether a text has all of these words. Case does not matter.
pub(super) fn has(text: &str, words: &str) -> bool {
    let text = text.to_lowercase();
    words.to_lowercase().split_whitespace().all(|word| text.contains(word))
}

/// The first block of a page in which all of these words are, or else the first with one of them.
pub(super) fn first_with(page: &[Block], words: &str) -> Option<usize> {
    let with = |words: &str| page.iter().position(|block| has(&block.text(), words));
    with(words).or_else(|| words.split_whitespace().filter_map(with).min())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_is_in_a_group() {
        let entries = entries();
        assert!(matches!(entries[0], Entry::Group(_)));
        let pages = entries.iter().filter_map(|entry| match entry {
            Entry::Page(place, title, about) => {
                assert!(!title.is_empty() && !about.is_empty());
                Some(*place)
            }
            Entry::Group(_) => None,
        });
        assert_eq!(pages.collect::<Vec<_>>(), (0..PAGES.len()).collect::<Vec<_>>());
        assert!(entries.len() - PAGES.len() >= 4);
    }

    #[test]
    fn words_are_found_where_they_are() {
        let page = blocks("# A\nfirst\n\nsecond\n\nfirst and second");
        assert_eq!(first_with(&page, "SECOND first"), Some(3));
        assert_eq!(first_with(&page, "second third"), Some(2));
        assert_eq!(first_with(&page, "third"), None);
    }
}
