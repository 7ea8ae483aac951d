//! HTML pages that work offline as one file each: their style, and templates with places to fill in.

/// The style of all pages, light and dark.
pub const STYLE: &str = include_str!("page.css");

/// Fills a template: `insert` returns the text for each `{{name}}`. Inserted text is not searched for names.
pub fn fill(template: &str, mut insert: impl FnMut(&str) -> String) -> String {
    let mut out = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, tail) = after.split_once("}}").unwrap_or((after, ""));
        out += before;
        out += &insert(name);
        rest = tail;
    }
    out + rest
}

/// Escapes any text for HTML.
pub fn escaped(text: &str) -> String {
    let escape = |letter: char| match letter {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        other => other.to_string(),
    };
    text.chars().map(escape).collect()
}

/// A link that contains a file's bytes (RFC 2397, RFC 4648).
pub(crate) fn data_link(kind: &str, bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut link = format!("data:{kind};base64,");
    link.reserve(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |n: usize| u32::from(group.get(n).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for n in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * n) & 63) as usize];
            link.push(if n <= group.len() { char::from(digit) } else { '=' });
        }
    }
    link
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_filled_once() {
        let insert = |name: &str| if name == "a" { "{{b}}".to_owned() } else { name.to_uppercase() };
        assert_eq!(fill("<{{a}}>{{c}}.", insert), "<{{b}}>C.");
        assert_eq!(escaped("a<b>\"&"), "a&lt;b&gt;&quot;&amp;");
    }

    #[test]
    fn links_contain_their_bytes() {
        // The test vectors of RFC 4648.
        for (text, expected) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg==")] {
            assert_eq!(data_link("text/plain", text.as_bytes()), format!("data:text/plain;base64,{expected}"));
        }
    }
}
