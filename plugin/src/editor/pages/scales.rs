//! Scales to choose from: those of the project, as files of Scala.

/// The names that the list has for them, and their files.
pub(super) const SCALES: [(&str, &str); 11] = [
    ("Pythagorean", include_str!("../../../../assets/scales/pythagorean.scl")),
    ("Quarter-comma meantone", include_str!("../../../../assets/scales/quarter-comma-meantone.scl")),
    ("Just intonation", include_str!("../../../../assets/scales/just.scl")),
    ("Werckmeister III", include_str!("../../../../assets/scales/werckmeister-3.scl")),
    ("Kirnberger III", include_str!("../../../../assets/scales/kirnberger-3.scl")),
    ("Young II", include_str!("../../../../assets/scales/young-2.scl")),
    ("Slendro", include_str!("../../../../assets/scales/slendro.scl")),
    ("Pelog", include_str!("../../../../assets/scales/pelog.scl")),
    ("19 equal steps", include_str!("../../../../assets/scales/19-equal.scl")),
    ("24 equal steps", include_str!("../../../../assets/scales/24-equal.scl")),
    ("Bohlen-Pierce", include_str!("../../../../assets/scales/bohlen-pierce.scl")),
];

#[cfg(test)]
mod tests {
    use super::SCALES;
    use sprung::preset::OwnTuning;

    /// Cents from C4 to a key.
    fn cents(name: &str, key: u8) -> f64 {
        let (_, text) = SCALES.into_iter().find(|(known, _)| *known == name).unwrap();
        let own = OwnTuning::from_scala(text.to_owned(), None).unwrap();
        let semitones = |key| own.tuning().pitch(key).unwrap().semitones(440.0);
        100.0 * (semitones(key) - semitones(60))
    }

    #[test]
    fn scales_rise_and_close_with_an_octave_or_a_twelfth() {
        let tables =
            [("Slendro", 5), ("Pelog", 7), ("19 equal steps", 19), ("24 equal steps", 24), ("Bohlen-Pierce", 13)];
        for (name, _) in SCALES {
            let steps = tables.into_iter().find(|(known, _)| *known == name).map_or(12, |(_, steps)| steps);
            let whole = if name == "Bohlen-Pierce" { 1901.955 } else { 1200.0 };
            assert!((cents(name, 60 + steps) - whole).abs() < 0.001, "{name}");
            assert!((60..100).all(|key| cents(name, key) < cents(name, key + 1)), "{name}");
        }
    }

    #[test]
    fn fifths_and_thirds_are_those_of_the_temperaments() {
        let (pure, comma) = (701.955, 23.460);
        for (name, fifth, third) in [
            ("Pythagorean", pure, 407.820),
            ("Quarter-comma meantone", 696.578, 386.314),
            ("Just intonation", pure, 386.314),
            ("Werckmeister III", pure - comma / 4.0, 390.225),
            ("Kirnberger III", 696.578, 386.314),
            ("Young II", pure - comma / 6.0, 392.180),
        ] {
            let found = [67, 64].map(|key| cents(name, key));
            assert!((found[0] - fifth).abs() < 0.002 && (found[1] - third).abs() < 0.002, "{name}: {found:?}");
        }
    }
}
