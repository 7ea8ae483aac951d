//! The manual's Markdown, split into blocks.

/// A block of a page.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Block {
    Title(String),
    Heading(String),
    Paragraph(String),
    /// A list item with its mark: a bullet or a number.
    Item(String, String),
    Code(String),
    /// Rows of cells, the first with the names of the columns.
    Table(Vec<Vec<String>>),
}

impl Block {
    /// All that is written in it.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Title(text)
            | Self::Heading(text)
            | Self::Paragraph(text)
            | Self::Item(_, text)
            | Self::Code(text) => text.clone(),
            Self::Table(rows) => rows.iter().map(|row| row.join(" ")).collect::<Vec<_>>().join(" "),
        }
    }
}

/// The style of a piece of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Style {
    Plain,
    Strong,
    Code,
}

/// Splits a page into blocks.
pub(super) fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut lines = page.lines().peekable();
    // Whether the next line continues the last block.
    let mut is_open = false;
    while let Some(line) = lines.next() {
        let text = line.trim();
        if text.starts_with("```") {
            let code: Vec<&str> = lines.by_ref().take_while(|line| !line.trim().starts_with("```")).collect();
            blocks.push(Block::Code(code.join("\n")));
            is_open = false;
        } else if text.is_empty() || text.starts_with("![") {
            is_open = false;
        } else if let Some(title) = text.strip_prefix("# ") {
            blocks.push(Block::Title(title.to_owned()));
            is_open = false;
        } else if let Some(heading) = text.strip_prefix("##") {
            blocks.push(Block::Heading(heading.trim_start_matches('#').trim().to_owned()));
            is_open = false;
        } else if text.starts_with('|') {
            let mut rows = vec![cells(text)];
            while let Some(row) = lines.next_if(|line| line.trim().starts_with('|')) {
                rows.push(cells(row.trim()));
            }
            // The line below the header row has only dashes.
            rows.retain(|row| !row.iter().all(|cell| cell.chars().all(|letter| "-: ".contains(letter))));
            blocks.push(Block::Table(rows));
            is_open = false;
        } else if let Some((mark, item)) = item(text) {
            blocks.push(Block::Item(mark, item));
            is_open = true;
        } else {
            match blocks.last_mut().filter(|_| is_open) {
                Some(Block::Paragraph(before) | Block::Item(_, before)) => *before += &format!(" {text}"),
                _ => blocks.push(Block::Paragraph(text.to_owned())),
            }
            is_open = true;
        }
    }
    blocks
}

/// The mark and text of a list item.
fn item(text: &str) -> Option<(String, String)> {
    if let Some(item) = text.strip_prefix("- ").or(text.strip_prefix("* ")) {
        return Some(("•".to_owned(), item.to_owned()));
    }
    let (number, item) = text.split_once(". ")?;
    number.parse::<u8>().is_ok().then(|| (format!("{number}."), item.to_owned()))
}

fn cells(row: &str) -> Vec<String> {
    row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
}

/// Splits a line by its marks: `code`, **strong**, and the texts of links.
pub(super) fn pieces(text: &str) -> Vec<(Style, String)> {
    let mut pieces: Vec<(Style, String)> = Vec::new();
    let mut rest = text;
    let mut push = |style: Style, text: &str| match pieces.last_mut() {
        Some((last, before)) if *last == style => *before += text,
        _ if text.is_empty() => {}
        _ => pieces.push((style, text.to_owned())),
    };
    while let Some(letter) = rest.chars().next() {
        let closed = |open: &str, close: &str| rest.strip_prefix(open)?.split_once(close);
        if let Some((inside, after)) = closed("`", "`") {
            push(Style::Code, inside);
            rest = after;
        } else if let Some((inside, after)) = closed("**", "**") {
            push(Style::Strong, inside);
            rest = after;
        } else if let Some((inside, after)) = closed("*", "*").filter(|(inside, _)| !inside.starts_with(' ')) {
            push(Style::Plain, inside);
            rest = after;
        } else if let Some((inside, after)) = closed("[", "](").filter(|_| letter == '[') {
            push(Style::Plain, inside);
            rest = after.split_once(')').map_or("", |(_, after)| after);
        } else {
            let (one, after) = rest.split_at(letter.len_utf8());
            push(Style::Plain, one);
            rest = after;
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::internals::text::PAGES;

    #[test]
    fn every_page_becomes_blocks_without_marks() {
        for (name, page) in PAGES {
            let blocks = blocks(page);
            assert!(matches!(blocks[0], Block::Title(_)), "{name}: {:?}", blocks[0]);
            for block in &blocks {
                let texts: Vec<&String> = match block {
                    Block::Table(rows) => {
                        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{name}: {rows:?}");
                        rows.iter().flatten().collect()
                    }
                    Block::Code(_) => vec![],
                    Block::Title(text) | Block::Heading(text) | Block::Paragraph(text) | Block::Item(_, text) => {
                        vec![text]
                    }
                };
                for (style, text) in texts.into_iter().flat_map(|text| pieces(text)) {
                    assert!(style == Style::Code || (!text.contains("**") && !text.contains("](")), "{name}: {text}");
                }
            }
        }
    }

    #[test]
    fn lines_belong_together_until_an_empty_one() {
        let page = "# A\n\none\ntwo\n\n- point\n  goes on\n- **b**\n\n| x | y |\n|---|---|\n| 1 | `2` |\n\n```sh\na\n\nb\n```\n1. first";
        let owned = |texts: [&str; 2]| texts.map(str::to_owned).to_vec();
        assert_eq!(
            blocks(page),
            [
                Block::Title("A".to_owned()),
                Block::Paragraph("one two".to_owned()),
                Block::Item("•".to_owned(), "point goes on".to_owned()),
                Block::Item("•".to_owned(), "**b**".to_owned()),
                Block::Table(vec![owned(["x", "y"]), owned(["1", "`2`"])]),
                Block::Code("a\n\nb".to_owned()),
                Block::Item("1.".to_owned(), "first".to_owned()),
            ]
        );
        let pieces = pieces("a **b** `c*d` [e](f.md) 2 * 3");
        assert_eq!(
            pieces,
            [
                (Style::Plain, "a ".to_owned()),
                (Style::Strong, "b".to_owned()),
                (Style::Plain, " ".to_owned()),
                (Style::Code, "c*d".to_owned()),
                (Style::Plain, " e 2 * 3".to_owned()),
            ]
        );
    }
}
