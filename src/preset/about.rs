//! The descriptive part of preset and kit files: name, author, tags, comment and details.

use super::complaints::Complaints;
use super::value::unexpected;
use crate::text::printable_lines;
use toml::{Table, Value};
use toml_writer::{ToTomlValue, TomlStringBuilder};

/// Maximum length of a name, author or tag in characters, so that it fits into lists.
pub(super) const MAX_LABEL: usize = 100;

/// Name of a preset or kit whose name cannot be read.
const UNNAMED: &str = "Unnamed";

/// The descriptive fields of a file.
pub(super) struct About {
    pub(super) name: String,
    pub(super) author: String,
    pub(super) tags: Vec<String>,
    pub(super) comment: String,
    pub(super) details: String,
}

impl About {
    /// Reads the fields. A missing name is an error.
    pub(super) fn read(table: &Table, complaints: &mut Complaints) -> Self {
        if table.get("name").is_none_or(|name| name.as_str() == Some("")) {
            complaints.add("there is no ‘name’: expected name = \"…\"");
        }
        let name = Some(label(table, "name", "", complaints)).filter(|name| !name.is_empty());
        let name = name.unwrap_or_else(|| UNNAMED.to_owned());
        let author = label(table, "author", "", complaints);
        let tags = tags(table, complaints);
        let [comment, details] =
            ["comment", "details"].map(|key| complaints.take("", text(table, key, "")).unwrap_or_default());
        Self { name, author, tags, comment, details }
    }
}

/// Writes the fields as lines of TOML; the details only if there are any.
pub(super) fn about_to_toml([name, author, comment, details]: [&str; 4], tags: &[String]) -> String {
    let tags: Vec<String> = tags.iter().map(|tag| toml_string(tag)).collect();
    let [name, author, comment] = [name, author, comment].map(toml_string);
    let details = if details.is_empty() { String::new() } else { format!("details = {}\n", toml_string(details)) };
    format!("name = {name}\nauthor = {author}\ntags = [{}]\ncomment = {comment}\n{details}", tags.join(", "))
}

fn text(table: &Table, key: &str, place: &str) -> Result<String, String> {
    match table.get(key) {
        None => Ok(String::new()),
        Some(Value::String(text)) => Ok(text.clone()),
        Some(other) => Err(unexpected(&format!("{place}{key}"), "a text", other)),
    }
}

/// Reads a single line of text in a table at `place` (empty, or ending in a dot); empty if the key is missing.
pub(super) fn label(table: &Table, key: &str, place: &str, complaints: &mut Complaints) -> String {
    let label = text(table, key, place).and_then(|label| check_label(&format!("{place}{key}"), label));
    complaints.take("", label).unwrap_or_default()
}

pub(super) fn check_label(key: &str, label: String) -> Result<String, String> {
    if label.trim() == label && label.chars().count() <= MAX_LABEL && !label.chars().any(char::is_control) {
        Ok(label)
    } else {
        Err(format!("{key}: expected one line of at most {MAX_LABEL} characters without space around it"))
    }
}

/// A name with an ending, cut before it so that all is a label.
pub fn with_ending(name: &str, ending: &str) -> String {
    let kept: String = name.chars().filter(|letter| !letter.is_control()).take(MAX_LABEL - ending.len()).collect();
    kept.trim().to_owned() + ending
}

fn tags(table: &Table, complaints: &mut Complaints) -> Vec<String> {
    let tags = match table.get("tags") {
        None => return Vec::new(),
        Some(Value::Array(tags)) => tags,
        Some(other) => {
            complaints.add(unexpected("tags", "a list of texts", other));
            return Vec::new();
        }
    };
    let tag = |(index, tag): (usize, &Value)| match tag {
        Value::String(tag) => check_label(&format!("tags[{index}]"), tag.clone()),
        other => Err(unexpected(&format!("tags[{index}]"), "a text", other)),
    };
    tags.iter().enumerate().filter_map(|each| complaints.take("", tag(each))).collect()
}

/// A text as a TOML string that is safe to print on a terminal: control characters become escapes in double quotes,
/// which read back as the same text.
pub(super) fn toml_string(text: &str) -> String {
    let builder = TomlStringBuilder::new(text);
    let plain = builder.as_default().to_toml_value();
    if printable_lines(&plain) == plain {
        return plain;
    }
    printable_lines(&builder.as_basic().to_toml_value()).into_owned()
}
