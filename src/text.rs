//! Makes text from outside (files, names, devices) safe for terminals and file names; formats [`number`]s.

pub mod number;

use std::borrow::Cow;

/// Replaces every character that could control a terminal or reorder the text by its code, such as `\u001b`: control
/// characters (line ends and tabs included), bidirectional formatting, and the line and paragraph separators.
///
/// This is also how TOML and JSON write these characters between double quotes.
pub fn printable(text: &str) -> Cow<'_, str> {
    escape(text, is_printable)
}

/// [`printable`] for several lines: keeps line ends (`\n`) and tabs.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escape(text, |character| matches!(character, '\n' | '\t') || is_printable(character))
}

/// Longest [`slug`] in bytes: file systems take names of 255 bytes, and of 143 if they encrypt them.
const LONGEST_SLUG: usize = 120;

/// A file name made from a name: in lower case, with dashes in place of all characters but letters and digits of any script.
pub fn slug(name: &str) -> String {
    let name = name.to_lowercase();
    let words = name.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty());
    shortened(words.collect::<Vec<_>>().join("-"), LONGEST_SLUG)
}

/// A [`slug`] of at most this many bytes.
pub(crate) fn shortened(mut slug: String, bytes: usize) -> String {
    slug.truncate(slug.floor_char_boundary(bytes));
    slug.truncate(slug.trim_end_matches('-').len());
    slug
}

/// [`slug`], or `sound` for a name that has no letter and no digit.
pub fn file_stem(name: &str) -> String {
    Some(slug(name)).filter(|slug| !slug.is_empty()).unwrap_or_else(|| "sound".to_owned())
}

fn escape(text: &str, stays: impl Fn(char) -> bool) -> Cow<'_, str> {
    if text.chars().all(&stays) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if stays(character) {
            escaped.push(character);
        } else {
            // Four digits are enough: all unprintable characters are below 65,536.
            escaped += &format!("\\u{:04x}", u32::from(character));
        }
    }
    Cow::Owned(escaped)
}

/// Whether a character is safe to print. Bidirectional formatting: Unicode Standard Annex #9, 2. "Directional
/// Formatting Characters".
fn is_printable(character: char) -> bool {
    let reorders = matches!(
        character,
        '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    !(character.is_control() || reorders || matches!(character, '\u{2028}' | '\u{2029}'))
}

/// A number with its noun, which gets a plural s unless the number is 1.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_spelled_out() {
        for (text, expected) in [
            ("\u{1b}[31mred\u{7}", "\\u001b[31mred\\u0007"),
            ("a\u{9b}2Jb\u{7f}", "a\\u009b2Jb\\u007f"),
            ("exe.\u{202e}vaw", "exe.\\u202evaw"),
            ("\u{2066}x\u{2069}\u{200f}\u{061c}", "\\u2066x\\u2069\\u200f\\u061c"),
            ("two\r\nlines\u{2028}\tand more", "two\\u000d\\u000alines\\u2028\\u0009and more"),
        ] {
            assert_eq!(printable(text), expected);
        }
        assert_eq!(printable_lines("a\n\tx\u{1b}[2Jb\n\r"), "a\n\tx\\u001b[2Jb\n\\u000d");
    }

    #[test]
    fn names_of_any_script_are_names_of_files() {
        for (name, file) in [
            ("Church Bell", "church-bell"),
            (" Friend’s  Bell (2) ", "friend-s-bell-2"),
            ("Ω", "ω"),
            ("Гонг Ёлка", "гонг-ёлка"),
            ("锣/../鼓", "锣-鼓"),
            ("★ \u{202e}", "sound"),
        ] {
            assert_eq!(file_stem(name), file);
        }
        assert_eq!(slug(&"锣".repeat(100)), "锣".repeat(40));
        assert_eq!(shortened("ab-é".to_owned(), 4), "ab");
    }

    #[test]
    fn what_people_write_stays_as_it_is() {
        for text in ["Glockenspiel “laut”, 12 dB × 3", "Гонг", "锣", "é", "שלום", "\\u001b", ""] {
            assert!(matches!(printable(text), Cow::Borrowed(same) if same == text), "{text}");
        }
        assert!(matches!(printable_lines("a\nb"), Cow::Borrowed("a\nb")));
    }
}
