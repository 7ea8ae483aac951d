//! Velocities in the names of recordings, as libraries of samples write them.

/// The dynamic marks of scores, with the velocities that notation programs play them with.
const MARKS: [(&str, f64); 8] =
    [("ppp", 16.0), ("pp", 33.0), ("p", 49.0), ("mp", 64.0), ("mf", 80.0), ("f", 96.0), ("ff", 112.0), ("fff", 127.0)];

/// Words before a velocity in a name.
const WORDS: [&str; 3] = ["velocity", "vel", "v"];

/// If the loudest of several recordings has a smaller number than this, the numbers are those of versions or layers.
const LEAST_LOUDEST: f64 = 32.0;

/// The velocities of recordings of one instrument by the names of their files, 1–127: numbers as in `bell-C5-v40.wav`,
/// `bell vel 100.wav` or `A0v127.wav`, or dynamic marks as in `bell-pp.wav`. None unless there are at least two recordings,
/// each name has a velocity, and two of them differ; or if the numbers are so small that they count versions.
///
/// ```
/// use sprung::analysis::fit::velocities;
///
/// assert_eq!(velocities(&["bell-v40.wav", "bell-v120.wav"]), Some(vec![40.0, 120.0]));
/// assert_eq!(velocities(&["bell-v1.wav", "bell-v2.wav"]), None);
/// ```
pub fn velocities(names: &[&str]) -> Option<Vec<f64>> {
    let found: Vec<f64> = names.iter().map(|name| number(name).or_else(|| mark(name))).collect::<Option<_>>()?;
    let loudest = found.iter().copied().fold(0.0, f64::max);
    (loudest >= LEAST_LOUDEST && found.iter().any(|velocity| *velocity != loudest)).then_some(found)
}

/// The name without folders and ending, in pieces of letters and of digits.
fn pieces(name: &str) -> Vec<&str> {
    let name = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let kind = |letter: char| (letter.is_alphabetic(), letter.is_ascii_digit());
    let mut pieces = Vec::new();
    let mut start = 0;
    for (at, letter) in stem.char_indices().skip(1) {
        let before = stem[..at].chars().next_back().unwrap_or(letter);
        if kind(before) != kind(letter) {
            pieces.push(&stem[start..at]);
            start = at;
        }
    }
    pieces.push(&stem[start..]);
    pieces
}

/// The velocity that is written as a number after a word, directly or after a separator.
fn number(name: &str) -> Option<f64> {
    let pieces = pieces(name);
    let mut found = (0..pieces.len()).filter(|at| WORDS.contains(&pieces[*at].to_lowercase().as_str()));
    found.find_map(|at| {
        let is_separator = |piece: &&&str| !piece.contains(|letter: char| letter.is_alphanumeric());
        let next = pieces.get(at + 1).filter(|next| !is_separator(next)).or_else(|| pieces.get(at + 2))?;
        let velocity: u8 = next.parse().ok()?;
        (1..=127).contains(&velocity).then_some(f64::from(velocity))
    })
}

/// The velocity of the last dynamic mark that stands by itself. Capitals are notes.
fn mark(name: &str) -> Option<f64> {
    let pieces = pieces(name);
    let of = |piece: &&str| MARKS.iter().find(|(mark, _)| mark == piece).map(|(_, velocity)| *velocity);
    pieces.iter().rev().find_map(of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_marks_are_found() {
        for (soft, loud, expected) in [
            ("bell-C5-v40.wav", "bell-C5-v120.wav", [40.0, 120.0]),
            ("Vibes vel 9.flac", "Vibes vel 99.flac", [9.0, 99.0]),
            ("A0v16.wav", "A0v127.wav", [16.0, 127.0]),
            ("a/b.v1/tom_Velocity_064.wav", "a/b.v1/tom_Velocity_100.wav", [64.0, 100.0]),
            ("marimba-F3-pp.wav", "marimba-F3-f.wav", [33.0, 96.0]),
            ("trumpet.mf.C4.wav", "trumpet.ff.C4.wav", [80.0, 112.0]),
        ] {
            assert_eq!(velocities(&[soft, loud]), Some(expected.to_vec()), "{soft} {loud}");
        }
    }

    #[test]
    fn what_is_no_velocity_is_not_taken_for_one() {
        for names in [
            ["bell-v40.wav", "bell.wav"],
            ["bell-v40.wav", "other-v40.wav"],
            ["kick-v1.wav", "kick-v2.wav"],
            ["tom F.wav", "tom P.wav"],
            ["bell-v200.wav", "bell-v300.wav"],
            ["sov40.wav", "sov50.wav"],
            ["", "ä"],
        ] {
            assert_eq!(velocities(&names), None, "{names:?}");
        }
        assert_eq!(velocities(&["bell-v40.wav"]), None, "one alone needs none");
        assert_eq!(velocities(&[]), None);
    }
}
