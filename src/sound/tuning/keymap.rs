//! Scala's keyboard mappings (`.kbm`): which key plays which degree of a scale, and the frequency of one key.
//!
//! Format: <http://www.huygens-fokker.org/scala/help.htm#mappings>.

use super::lines::{self, Line, Lines, ends_number};
use super::scale::Scale;
use crate::error::Result;
use crate::units::{note_name, split_quantity};
use std::io::Read;
use std::ops::RangeInclusive;

/// Which keys play which degrees of a scale, and the reference pitch.
#[derive(Clone, Debug, PartialEq)]
pub struct Keymap {
    /// Number of keys after which the pattern repeats; 0 if each key plays the next degree of the scale.
    size: i32,
    /// The keys that are mapped. Others are silent.
    keys: RangeInclusive<u8>,
    /// The key of the pattern's first entry.
    middle: u8,
    /// The key that has the reference frequency.
    reference: u8,
    /// Reference frequency in Hz; none if it follows from the frequency that the patch gives A4.
    frequency: Option<f64>,
    /// The degree whose interval lies between two repetitions of the pattern; 0 stands for the last degree of the
    /// scale.
    octave: i32,
    /// Degrees of the pattern's keys, none for an unmapped key. Keys at the end of the pattern may be missing:
    /// unmapped.
    degrees: Vec<Option<i32>>,
}

impl Keymap {
    /// The mapping without a file: degree 0 on key 60 (C4), each key plays the next degree, and key 69 (A4) has the
    /// frequency that the patch gives A4. Scala's own default is the same with A4 fixed at 440 Hz.
    pub(crate) const LINEAR: Self =
        Self { size: 0, keys: 0..=127, middle: 60, reference: 69, frequency: None, octave: 0, degrees: Vec::new() };

    /// Reads a keyboard mapping file. `origin` names it in errors.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if it cannot be read; [`crate::Error::Format`] if it is larger than 1 MiB, and as
    /// [`Keymap::parse`].
    pub(crate) fn read(reader: impl Read, origin: &str) -> Result<Self> {
        Self::parse(&lines::read(reader, origin)?, origin)
    }

    /// Reads the text of a keyboard mapping file: seven numbers, and a degree or `x` for each key of the pattern.
    ///
    /// # Errors
    /// [`crate::Error::Format`] that names `origin`, the line, what is wrong with it, and what would be right. The
    /// pattern must map the reference key: the pitches of all other keys depend on it.
    pub fn parse(text: &str, origin: &str) -> Result<Self> {
        let mut lines = Lines::new(text, origin);
        let size_line = lines.demand("the size of the map")?;
        let size = whole(&size_line, "the size of the map", "0 for a linear one, or the keys of its pattern (12)")?;
        let first = key(&mut lines, "the first key to tune")?.0;
        let (last, last_line) = key(&mut lines, "the last key to tune")?;
        if last < first {
            return Err(
                last_line.error(format!("the last key to tune is {last}: expected the first, {first}, or above"))
            );
        }
        let middle = key(&mut lines, "the middle key, which plays the first entry of the map")?.0;
        let (reference, reference_line) = key(&mut lines, "the reference key, whose frequency is given")?;
        let frequency = Some(frequency(&lines.demand("the frequency of the reference key in Hz")?)?);
        let octave_line = lines.demand("the degree that is the formal octave")?;
        let octave =
            whole(&octave_line, "the degree of the formal octave", "0 for the scale's last, or a degree (12)")?;
        let mut degrees = Vec::new();
        let mut entries = lines.filter(|line| !line.text.is_empty());
        for line in entries.by_ref().take(size as usize) {
            degrees.push(degree(&line)?);
        }
        // Text may follow the map. Another entry would mean that the map's size is wrong.
        if let Some(line) = entries.find(|line| degree(line).is_ok()) {
            return Err(line.error(format!(
                "{} is an entry too many: expected the {size} that line {} says, or more there",
                line.quote(),
                size_line.number
            )));
        }
        let keymap = Self { size, keys: first..=last, middle, reference, frequency, octave, degrees };
        if keymap.place(reference).is_none() {
            let mapped = (0..128).filter(|key| keymap.place(*key).is_some());
            let hint = match mapped.min_by_key(|key| key.abs_diff(reference)) {
                Some(near) => format!("expected a mapped key; the nearest is {near} ({})", note_name(near)),
                None => "expected at least one mapped key in the map".to_owned(),
            };
            return Err(reference_line.error(format!("the map leaves the reference key {reference} unmapped: {hint}")));
        }
        Ok(keymap)
    }

    /// The reference key, and its frequency in Hz; none if that follows from the patch's A4.
    pub(super) fn reference(&self) -> (u8, Option<f64>) {
        (self.reference, self.frequency)
    }

    /// Interval from the reference key to a key, in semitones; none if the key is unmapped.
    pub(super) fn interval_from_reference(&self, scale: &Scale, key: u8) -> Option<f64> {
        let above_middle = |key: u8| {
            let (patterns, degree) = self.place(key)?;
            let octave = if self.octave == 0 { scale.last_degree() } else { self.octave };
            Some(f64::from(patterns) * scale.interval(octave) + scale.interval(degree))
        };
        if self.keys.contains(&key) { Some(above_middle(key)? - above_middle(self.reference)?) } else { None }
    }

    /// How many patterns a key is above the middle key, and its degree; none if the pattern does not map it.
    fn place(&self, key: u8) -> Option<(i32, i32)> {
        let steps = i32::from(key) - i32::from(self.middle);
        if self.size == 0 {
            return Some((0, steps));
        }
        let degree = self.degrees.get(steps.rem_euclid(self.size) as usize).copied().flatten()?;
        Some((steps.div_euclid(self.size), degree))
    }
}

/// Reads a whole number that is at least 0.
fn whole(line: &Line, what: &str, expected: &str) -> Result<i32> {
    let number = line.word().parse().ok().filter(|number: &i32| *number >= 0);
    number.ok_or_else(|| line.error(format!("{} is not {what}: expected {expected}", line.quote())))
}

/// Reads the MIDI key in the next line.
fn key<'a>(lines: &mut Lines<'a>, what: &str) -> Result<(u8, Line<'a>)> {
    let line = lines.demand(what)?;
    match line.word().parse() {
        Ok(key @ 0..=127) => Ok((key, line)),
        _ => Err(line.error(format!("{} is not {what}: expected a MIDI key from 0 to 127 (60)", line.quote()))),
    }
}

/// Reads a frequency in Hz.
fn frequency(line: &Line) -> Result<f64> {
    let frequency = split_quantity(line.text).filter(|(hz, rest)| *hz > 0.0 && ends_number(rest));
    let wrong = || line.error(format!("{} is not a frequency: expected Hz above 0 (440.0)", line.quote()));
    frequency.map(|(hz, _)| hz).ok_or_else(wrong)
}

/// Reads an entry of the map: a degree, or none for `x`.
fn degree(line: &Line) -> Result<Option<i32>> {
    if line.word().eq_ignore_ascii_case("x") {
        return Ok(None);
    }
    whole(line, "an entry of the map", "a degree of the scale (0, 1, 2, …) or x for an unmapped key").map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keymap(size: u32, octave: u32, entries: &str) -> Keymap {
        Keymap::parse(&format!("{size}\n50\n70\n60\n60\n256.0 Hz\n{octave}\n{entries}"), "a").unwrap()
    }

    /// Intervals from key 60 in semitones, for the keys from 58 on, in a scale of 200, 400, 700 and 1200 cents.
    fn intervals(keymap: &Keymap) -> Vec<Option<f64>> {
        let scale = Scale::parse("\n4\n200.\n400.\n700.\n2/1", "a").unwrap();
        (58..=65).map(|key| keymap.interval_from_reference(&scale, key)).collect()
    }

    #[test]
    fn a_linear_map_plays_the_scale_key_by_key() {
        let expected = [-8.0, -5.0, 0.0, 2.0, 4.0, 7.0, 12.0, 14.0].map(Some);
        assert_eq!(intervals(&keymap(0, 0, "")), expected);
        assert_eq!(intervals(&keymap(4, 4, "0\n1\n2\n3")), expected);
        assert_eq!(intervals(&keymap(4, 0, "0\n1\n2\n3")), expected, "0 is the highest degree");
    }

    #[test]
    fn unmapped_keys_and_keys_left_out_are_silent() {
        let expected = [None, None, Some(0.0), None, Some(7.0), None, None, Some(12.0)];
        assert_eq!(intervals(&keymap(5, 4, "0\nx\n3 fifth\nX unmapped")), expected);
        let narrow = Keymap { keys: 60..=61, ..keymap(0, 0, "") };
        assert_eq!(intervals(&narrow), [None, None, Some(0.0), Some(2.0), None, None, None, None]);
    }

    #[test]
    fn patterns_are_as_far_apart_as_the_formal_octave() {
        let fifths = [-7.0, -3.0, 0.0, 4.0, 7.0, 11.0, 14.0, 18.0].map(Some);
        assert_eq!(intervals(&keymap(2, 3, "0\n2")), fifths);
        let beyond = [-12.0, 0.0, 0.0, 12.0, 12.0, 24.0, 24.0, 36.0].map(Some);
        assert_eq!(intervals(&keymap(2, 4, "0\n4")), beyond);
    }
}
