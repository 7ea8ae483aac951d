//! What preset and kit files say of themselves: name, author, tags, comment.

use super::value::unexpected;
use crate::text::printable_lines;
use toml::{Table, Value};
use toml_writer::{ToTomlValue, TomlStringBuilder};

/// Longest name, author or tag, in characters: what a list can still show.
const MAX_LABEL: usize = 100;

/// What a file says of itself.
pub(super) struct About {
    pub(super) name: String,
    pub(super) author: String,
    pub(super) tags: Vec<String>,
    pub(super) comment: String,
}

impl About {
    /// Reads it. A file has a name.
    pub(super) fn read(table: &Table) -> Result<Self, String> {
        let name = label(table, "name", "")?;
        if name.is_empty() {
            return Err("there is no ‘name’: expected name = \"…\"".to_owned());
        }
        Ok(Self { name, author: label(table, "author", "")?, tags: tags(table)?, comment: text(table, "comment", "")? })
    }
}

/// Writes it as lines of TOML: name, author and comment, and the tags.
pub(super) fn about_to_toml([name, author, comment]: [&str; 3], tags: &[String]) -> String {
    let tags: Vec<String> = tags.iter().map(|tag| toml_string(tag)).collect();
    let [name, author, comment] = [name, author, comment].map(toml_string);
    format!("name = {name}\nauthor = {author}\ntags = [{}]\ncomment = {comment}\n", tags.join(", "))
}

fn text(table: &Table, key: &str, place: &str) -> Result<String, String> {
    match table.get(key) {
        None => Ok(String::new()),
        Some(Value::String(text)) => Ok(text.clone()),
        Some(other) => Err(unexpected(&format!("{place}{key}"), "a text", other)),
    }
}

/// A line of text in a table at `place` (empty, or ending in a dot); empty where there is none.
pub(super) fn label(table: &Table, key: &str, place: &str) -> Result<String, String> {
    text(table, key, place).and_then(|label| check_label(&format!("{place}{key}"), label))
}

fn check_label(key: &str, label: String) -> Result<String, String> {
    if label.trim() == label && label.chars().count() <= MAX_LABEL && !label.chars().any(char::is_control) {
        Ok(label)
    } else {
        Err(format!("{key}: expected one line of at most {MAX_LABEL} characters without space around it"))
    }
}

fn tags(table: &Table) -> Result<Vec<String>, String> {
    let tags = match table.get("tags") {
        None => return Ok(Vec::new()),
        Some(Value::Array(tags)) => tags,
        Some(other) => return Err(unexpected("tags", "a list of texts", other)),
    };
    let tag = |(index, tag): (usize, &Value)| match tag {
        Value::String(tag) => check_label(&format!("tags[{index}]"), tag.clone()),
        other => Err(unexpected(&format!("tags[{index}]"), "a text", other)),
    };
    tags.iter().enumerate().map(tag).collect()
}

/// A text between quotes, so that whoever prints the file has nothing in it that steers the terminal: where the text has
/// such characters, they are escapes between double quotes, which read back as they were.
pub(super) fn toml_string(text: &str) -> String {
    let builder = TomlStringBuilder::new(text);
    let plain = builder.as_default().to_toml_value();
    if printable_lines(&plain) == plain {
        return plain;
    }
    printable_lines(&builder.as_basic().to_toml_value()).into_owned()
}
