//! Finds a key that an object of JSON has twice: the parser would keep the last and drop the other without a word.

use std::collections::BTreeSet;

/// The first key that is twice in one object of a text that is known to be JSON.
pub(super) fn key_twice(json: &str) -> Option<String> {
    let (mut objects, mut rest) = (Vec::<BTreeSet<String>>::new(), json);
    while let Some(at) = rest.find(['{', '}', '"']) {
        let found = &rest[at..];
        if found.starts_with('"') {
            let mut strings = serde_json::Deserializer::from_str(found).into_iter::<String>();
            let string = strings.next()?.ok()?;
            rest = &found[strings.byte_offset()..];
            if rest.trim_start().starts_with(':') && !objects.last_mut()?.insert(string.clone()) {
                return Some(string);
            }
            continue;
        }
        if found.starts_with('{') {
            objects.push(BTreeSet::new());
        } else {
            objects.pop();
        }
        rest = &found[1..];
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_may_be_in_several_objects_but_in_each_once() {
        for (json, twice) in [
            (r#"{"note": "C4", "set": {"decay": 1}, "channel": {"1": "set"}, "x": [{"a": 1}, {"a": 2}]}"#, None),
            (r#"{"note": "C4", "note": "C5"}"#, Some("note")),
            (r#"{"set": {"decay": 1, "decay" : 2}}"#, Some("decay")),
            (r#"{"a": "{\"b\": 1, \"b\": 2}", "b": ["a", "b", "b"]}"#, None),
            (r#"{"a": {}, "\u0061": "é}{"}"#, Some("a")),
        ] {
            assert!(serde_json::from_str::<serde_json::Value>(json).is_ok());
            assert_eq!(key_twice(json).as_deref(), twice, "{json}");
        }
    }
}
