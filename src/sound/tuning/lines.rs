//! The lines of a Scala file without its comments, and errors that name the line.

use crate::error::{Error, Result};
use std::io::Read;

/// Maximum size of a file in bytes: far more than any playable scale needs.
const MAX_FILE_SIZE: u64 = 1 << 20;

/// Maximum length of a quotation in an error message, in characters.
const MAX_QUOTE: usize = 40;

/// Reads a file as UTF-8, or, if it is not UTF-8, as ISO 8859-1 (used in Scala's archive), where every byte is a
/// character.
pub(super) fn read(reader: impl Read, origin: &str) -> Result<String> {
    let mut bytes = Vec::new();
    reader.take(MAX_FILE_SIZE + 1).read_to_end(&mut bytes).map_err(|source| Error::io(origin, source))?;
    if bytes.len() as u64 > MAX_FILE_SIZE {
        return Err(Error::format(origin, "too large for a Scala file: expected at most 1 MiB of text"));
    }
    Ok(String::from_utf8(bytes).unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect()))
}

/// A line without leading and trailing space.
pub(super) struct Line<'a> {
    origin: &'a str,
    /// Line number from 1, counting comments.
    pub(super) number: usize,
    pub(super) text: &'a str,
}

impl<'a> Line<'a> {
    /// An error about this line.
    pub(super) fn error(&self, message: impl Into<String>) -> Error {
        Error::format(format!("{}:{}", self.origin, self.number), message)
    }

    /// The line up to its first space.
    pub(super) fn word(&self) -> &'a str {
        self.text.split_whitespace().next().unwrap_or("")
    }

    /// The line as error messages quote it.
    pub(super) fn quote(&self) -> String {
        match self.text.char_indices().nth(MAX_QUOTE) {
            Some((end, _)) => format!("‘{}…’", &self.text[..end]),
            None => format!("‘{}’", self.text),
        }
    }
}

/// The lines of a file that are not comments, in order.
pub(super) struct Lines<'a> {
    origin: &'a str,
    lines: std::str::Split<'a, char>,
    /// Number of lines read so far, counting comments.
    count: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `text`, with line ends of Unix, Windows or the old Macintosh.
    pub(super) fn new(text: &'a str, origin: &'a str) -> Self {
        let end = if text.contains('\n') { '\n' } else { '\r' };
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self { origin, lines: text.strip_suffix(end).unwrap_or(text).split(end), count: 0 }
    }

    /// The next line that is not blank.
    ///
    /// # Errors
    /// If the file ends before it. The error says that `expected` is missing.
    pub(super) fn demand(&mut self, expected: &str) -> Result<Line<'a>> {
        let found = self.find(|line| !line.text.is_empty());
        let end = Line { origin: self.origin, number: self.count, text: "" };
        found.ok_or_else(|| end.error(format!("the file ends here: expected {expected}")))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let text = self.lines.next()?.trim();
            self.count += 1;
            if !text.starts_with('!') {
                return Some(Line { origin: self.origin, number: self.count, text });
            }
        }
    }
}

/// Whether a number ends where `rest` begins. Text and comments may follow it, but in `701,955`, `7\12` and `1e3` more
/// digits follow, so the number was not read as it was meant.
pub(super) fn ends_number(rest: &str) -> bool {
    let attached = rest.split(|c: char| c.is_whitespace() || c == '!').next().unwrap_or("");
    !attached.contains(|c: char| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(text: &str) -> Vec<(usize, &str)> {
        Lines::new(text, "a").map(|line| (line.number, line.text)).collect()
    }

    #[test]
    fn every_line_end_counts_the_same_lines() {
        let expected = [(2, "one"), (3, ""), (5, "two ! no comment")];
        for end in ["\n", "\r\n", "\r"] {
            for last in ["", end] {
                let text = ["! name", " one\t", "", " ! comment", "two ! no comment"].join(end) + last;
                assert_eq!(numbered(&text), expected, "{text:?}");
            }
        }
        assert_eq!(numbered("\u{feff}! name\none"), [(2, "one")]);
        assert_eq!(numbered(""), [(1, "")]);
    }

    #[test]
    fn bytes_that_are_not_utf_8_are_latin_1() {
        assert_eq!(read(&b"caf\xe9"[..], "a").unwrap(), "café");
        assert_eq!(read("café".as_bytes(), "a").unwrap(), "café");
        let large = vec![b'!'; MAX_FILE_SIZE as usize + 1];
        assert_eq!(
            read(&large[..], "a.scl").unwrap_err().to_string(),
            "a.scl: too large for a Scala file: expected at most 1 MiB of text"
        );
    }

    #[test]
    fn long_lines_are_quoted_in_part() {
        let text = "é".repeat(41);
        assert_eq!(Lines::new(&text, "a").next().unwrap().quote(), format!("‘{}…’", "é".repeat(40)));
    }
}
