//! Velocities in the names of recordings, as libraries of samples write them.

use super::take::Take;

/// The dynamic marks of scores, with the velocities at which MuseScore plays them.
const MARKS: [(&str, f64); 8] =
    [("ppp", 16.0), ("pp", 33.0), ("p", 49.0), ("mp", 64.0), ("mf", 80.0), ("f", 96.0), ("ff", 112.0), ("fff", 126.0)];

/// Words before a velocity in a name.
const WORDS: [&str; 3] = ["velocity", "vel", "v"];

/// The least number of the loudest recording. Where all numbers are smaller, they count versions or layers: sample libraries
/// have up to some twenty of these.
const LEAST_LOUDEST: f64 = 32.0;

/// Gives several takes of one instrument the velocities that are in the names of their files, and returns them as a list to
/// read, if there are any: numbers as in `bell-C5-v40.wav`, `bell vel 100.wav` or `A0v127.wav`, or else dynamic marks as in `bell-pp.wav`. Every
/// name must have one, two must differ, and numbers that only count versions are left alone.
pub fn take_velocities_from_names(takes: &mut [Take]) -> Option<String> {
    let names: Vec<&str> = takes.iter().map(|take| take.name.as_str()).collect();
    let velocities = velocities(&names)?;
    takes.iter_mut().zip(&velocities).for_each(|(take, velocity)| take.velocity = *velocity);
    Some(velocities.iter().map(f64::to_string).collect::<Vec<_>>().join(", "))
}

fn velocities(names: &[&str]) -> Option<Vec<f64>> {
    let all = |of: fn(&str) -> Option<f64>| {
        let found: Vec<f64> = names.iter().map(|name| of(name)).collect::<Option<_>>()?;
        found.iter().any(|velocity| *velocity != found[0]).then_some(found)
    };
    let numbers = all(number).filter(|found| found.iter().any(|velocity| *velocity >= LEAST_LOUDEST));
    numbers.or_else(|| all(mark))
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

/// The velocity of the last dynamic mark that stands by itself. A letter before a digit, a sharp or a flat is a key.
fn mark(name: &str) -> Option<f64> {
    let pieces = pieces(name);
    let is_key = |at: usize| {
        pieces.get(at + 1).is_some_and(|next| next.starts_with(|letter: char| letter.is_ascii_digit() || letter == '#'))
    };
    let of =
        |at: usize| MARKS.iter().find(|(mark, _)| *mark == pieces[at] && !is_key(at)).map(|(_, velocity)| *velocity);
    (0..pieces.len()).rev().find_map(of)
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
            ("bell-pp-f3.wav", "bell-ff-f#3.wav", [33.0, 112.0]),
            ("bell_v2-pp.wav", "bell_v2-ff.wav", [33.0, 112.0]),
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
            ["bell-pp-c3.wav", "bell-pp-f3.wav"],
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
