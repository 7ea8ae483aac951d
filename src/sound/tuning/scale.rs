//! Scala's scale files (`.scl`): the intervals of a scale, which repeats after the last one.
//!
//! Format: <http://www.huygens-fokker.org/scala/scl_format.html>.

use super::lines::{self, Line, Lines, ends_number};
use crate::error::Result;
use crate::units::semitones_from_ratio;
use std::io::Read;

/// A scale: the interval from degree 0 to each of its degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Intervals of degrees 1 and up, in semitones. The last is the period, such as an octave.
    intervals: Vec<f64>,
}

impl Scale {
    /// Reads a scale file. `origin` names it in errors.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if it cannot be read; [`crate::Error::Format`] if it is larger than 1 MiB, and as
    /// [`Scale::parse`].
    pub fn read(reader: impl Read, origin: &str) -> Result<Self> {
        Self::parse(&lines::read(reader, origin)?, origin)
    }

    /// Reads the text of a scale file: a description, the number of notes, and that many pitches, as ratios or in
    /// cents.
    ///
    /// # Errors
    /// [`crate::Error::Format`] that names `origin`, the line, what is wrong with it, and what would be right.
    pub fn parse(text: &str, origin: &str) -> Result<Self> {
        let mut lines = Lines::new(text, origin);
        // The first line is the description, which may be empty.
        lines.next();
        let count_line = lines.demand("the number of notes")?;
        let count: usize = count_line.word().parse().map_err(|_| {
            count_line.error(format!("{} is not a number of notes: expected a whole number (12)", count_line.quote()))
        })?;
        let mut intervals = Vec::new();
        while intervals.len() < count {
            let number = intervals.len() + 1;
            let line = lines.demand(&format!("pitch {number} of the {count} that line {} says", count_line.number))?;
            intervals.push(interval(&line)?);
        }
        // Text may follow the scale. Another pitch would mean that the number of notes, and so the period, is wrong.
        match lines.find(|line| interval(line).is_ok()) {
            Some(line) => Err(line.error(format!(
                "{} is a pitch too many: expected the {count} that line {} says, or more there",
                line.quote(),
                count_line.number
            ))),
            None => Ok(Self { intervals }),
        }
    }

    /// The last degree, after which the scale repeats; 0 if degree 0 is the only one.
    pub(super) fn last_degree(&self) -> i32 {
        self.intervals.len() as i32
    }

    /// Interval from degree 0 to a degree, in semitones. Degrees below 0 and above the last continue the scale.
    pub(super) fn interval(&self, degree: i32) -> f64 {
        let Some(period) = self.intervals.last() else { return 0.0 };
        let (times, rest) = (degree.div_euclid(self.last_degree()), degree.rem_euclid(self.last_degree()));
        let above = if rest == 0 { 0.0 } else { self.intervals[rest as usize - 1] };
        f64::from(times) * period + above
    }
}

/// The interval of a line in semitones: cents if its number has a point, else a ratio.
fn interval(line: &Line) -> Result<f64> {
    let wrong = |what: &str| {
        let expected = "expected a ratio of whole numbers from 1 (3/2, 2) or cents with a point (701.955, 100.)";
        line.error(format!("{} {what}: {expected}", line.quote()))
    };
    let text = line.text;
    let end = text.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-'))).unwrap_or(text.len());
    let (number, rest) = text.split_at(end);
    let value = number.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| wrong("is not a pitch"))?;
    let (semitones, rest) = if number.contains('.') {
        (value / 100.0, rest)
    } else {
        let (denominator, rest) = match rest.trim_start().strip_prefix('/') {
            Some(divisor) => {
                let divisor = divisor.trim_start();
                let end = divisor.find(|c: char| !c.is_ascii_digit()).unwrap_or(divisor.len());
                let (number, rest) = divisor.split_at(end);
                (number.parse().map_err(|_| wrong("is not a ratio"))?, rest)
            }
            None => (1.0, rest),
        };
        if !(value > 0.0 && denominator > 0.0 && f64::is_finite(denominator)) {
            return Err(wrong("is not a positive ratio"));
        }
        (semitones_from_ratio(value / denominator), rest)
    };
    if ends_number(rest) { Ok(semitones) } else { Err(wrong("is not a pitch")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cents(pitch: &str) -> Result<f64> {
        Ok(100.0 * Scale::parse(&format!("\n1\n{pitch}"), "a")?.interval(1))
    }

    #[test]
    fn pitches_are_read_as_scala_says() {
        for (pitch, expected) in [
            ("81/64", 407.820_003),
            ("408.0", 408.0),
            ("408.", 408.0),
            (".5", 0.5),
            ("5", 2_786.313_714),
            ("-5.0", -5.0),
            ("10/20", -1200.0),
            ("100.0 cents", 100.0),
            ("100.0 C#", 100.0),
            ("100.0cents", 100.0),
            ("5/4   E\\", 386.313_714),
            ("\t3 / 2 fifth of 7", 701.955_001),
            ("2/1! octave", 1200.0),
            ("2!8ve", 1200.0),
            ("2147483647/2147483646", 0.000_000_8),
            ("36472996377170786403/18446744073709551616", 1_180.155_035),
        ] {
            let found = cents(pitch).unwrap();
            assert!((found - expected).abs() < 1e-6, "{pitch}: {found}");
        }
    }

    #[test]
    fn a_scale_goes_on_in_both_directions_at_its_period() {
        let scale = Scale::parse("Not in order, beyond the period\n3\n500.\n1300.\n1100.", "a").unwrap();
        let found: Vec<f64> = (-4..=6).map(|degree| scale.interval(degree)).collect();
        assert_eq!(found, [-9.0, -11.0, -6.0, 2.0, 0.0, 5.0, 13.0, 11.0, 16.0, 24.0, 22.0]);
        let single = Scale::parse("Degree 0 alone\n0", "a").unwrap();
        assert_eq!((single.interval(-7), single.interval(5)), (0.0, 0.0));
    }
}
