//! Malformed files are refused with the line, the fault and the remedy; unusual but valid files are read.

use super::tuning;
use sprung::sound::Tuning;
use sprung::sound::tuning::{Keymap, Scale};

const PITCH: &str = "expected a ratio of whole numbers from 1 (3/2, 2) or cents with a point (701.955, 100.)";
const ENTRY: &str = "expected a degree of the scale (0, 1, 2, …) or x for an unmapped key";
const KEY: &str = "expected a MIDI key from 0 to 127 (60)";

#[test]
fn malformed_scales() {
    for (text, line, message) in [
        ("", 1, "the file ends here: expected the number of notes".to_owned()),
        ("! only\n! comments", 2, "the file ends here: expected the number of notes".to_owned()),
        ("a scale\n\n", 2, "the file ends here: expected the number of notes".to_owned()),
        ("a\ntwelve\n2/1", 2, "‘twelve’ is not a number of notes: expected a whole number (12)".to_owned()),
        ("a\n-1\n2/1", 2, "‘-1’ is not a number of notes: expected a whole number (12)".to_owned()),
        ("a\n2.5\n2/1", 2, "‘2.5’ is not a number of notes: expected a whole number (12)".to_owned()),
        ("a\n2\n3/2\n! no more", 4, "the file ends here: expected pitch 2 of the 2 that line 2 says".to_owned()),
        ("a\n99999999999\n2/1", 3, "expected pitch 2 of the 99999999999 that line 2 says".to_owned()),
        ("a\n1\n3/2\n2/1", 4, "‘2/1’ is a pitch too many: expected the 1 that line 2 says, or more there".to_owned()),
        ("a\n1\nfifth", 3, format!("‘fifth’ is not a pitch: {PITCH}")),
        ("a\n1\n701,955", 3, format!("‘701,955’ is not a pitch: {PITCH}")),
        ("a\n1\n7\\12", 3, format!("‘7\\12’ is not a pitch: {PITCH}")),
        ("a\n1\n7.02e2", 3, format!("‘7.02e2’ is not a pitch: {PITCH}")),
        ("a\n1\n1.2.3", 3, format!("‘1.2.3’ is not a pitch: {PITCH}")),
        ("a\n1\n.", 3, format!("‘.’ is not a pitch: {PITCH}")),
        ("a\n1\nnan", 3, format!("‘nan’ is not a pitch: {PITCH}")),
        ("a\n1\n3/", 3, format!("‘3/’ is not a ratio: {PITCH}")),
        ("a\n1\n3/-2", 3, format!("‘3/-2’ is not a ratio: {PITCH}")),
        ("a\n1\n3/2/1", 3, format!("‘3/2/1’ is not a pitch: {PITCH}")),
        ("a\n1\n-3/2", 3, format!("‘-3/2’ is not a positive ratio: {PITCH}")),
        ("a\n1\n1/0", 3, format!("‘1/0’ is not a positive ratio: {PITCH}")),
        ("! name\n\n! count\n1\n!\n0/1", 6, format!("‘0/1’ is not a positive ratio: {PITCH}")),
    ] {
        let error = Scale::parse(text, "bad.scl").unwrap_err().to_string();
        assert_eq!(error.split(": ").next(), Some(&*format!("bad.scl:{line}")), "{text:?}: {error}");
        assert!(error.ends_with(&message), "{text:?}: {error}");
    }
}

#[test]
fn malformed_keyboard_mappings() {
    let ends = |what: &str| format!("the file ends here: expected {what}");
    for (text, line, message) in [
        ("", 1, ends("the size of the map")),
        ("12\n0\n127", 3, ends("the middle key, which plays the first entry of the map")),
        ("0\n0\n127\n60\n69\n440.0", 6, ends("the degree that is the formal octave")),
        (
            "A map\n0",
            1,
            "‘A map’ is not the size of the map: expected 0 for a linear one, or the keys of its pattern (12)"
                .to_owned(),
        ),
        (
            "-2\n0",
            1,
            "‘-2’ is not the size of the map: expected 0 for a linear one, or the keys of its pattern (12)".to_owned(),
        ),
        ("0\n-1", 2, format!("‘-1’ is not the first key to tune: {KEY}")),
        ("0\n0\n128", 3, format!("‘128’ is not the last key to tune: {KEY}")),
        ("0\n64\n32", 3, "the last key to tune is 32: expected the first, 64, or above".to_owned()),
        ("0\n0\n127\nC4", 4, format!("‘C4’ is not the middle key, which plays the first entry of the map: {KEY}")),
        ("0\n0\n127\n60\n440.0", 5, format!("‘440.0’ is not the reference key, whose frequency is given: {KEY}")),
        ("0\n0\n127\n60\n69\n0.0", 6, "‘0.0’ is not a frequency: expected Hz above 0 (440.0)".to_owned()),
        ("0\n0\n127\n60\n69\n440,5", 6, "‘440,5’ is not a frequency: expected Hz above 0 (440.0)".to_owned()),
        ("0\n0\n127\n60\n69\ninf", 6, "‘inf’ is not a frequency: expected Hz above 0 (440.0)".to_owned()),
        (
            "0\n0\n127\n60\n69\n440\n2/1",
            7,
            "‘2/1’ is not the degree of the formal octave: expected 0 for the scale's last, or a degree (12)"
                .to_owned(),
        ),
        ("2\n0\n127\n60\n60\n440\n2\n0\n-1", 9, format!("‘-1’ is not an entry of the map: {ENTRY}")),
        ("2\n0\n127\n60\n60\n440\n2\n0\ny", 9, format!("‘y’ is not an entry of the map: {ENTRY}")),
        (
            "2\n0\n127\n60\n60\n440\n2\n0\nx\n1",
            10,
            "‘1’ is an entry too many: expected the 2 that line 1 says, or more there".to_owned(),
        ),
        (
            "2\n0\n127\n60\n69\n440\n2\n0\nx",
            5,
            "the map leaves the reference key 69 unmapped: expected a mapped key; the nearest is 68 (G#4)".to_owned(),
        ),
        (
            "2\n0\n127\n60\n69\n440\n2\nx\nx",
            5,
            "the map leaves the reference key 69 unmapped: expected at least one mapped key in the map".to_owned(),
        ),
    ] {
        let error = Keymap::parse(text, "bad.kbm").unwrap_err().to_string();
        assert_eq!(error, format!("bad.kbm:{line}: {message}"), "{text:?}");
    }
}

#[test]
fn from_scala_says_which_of_the_texts_is_wrong() {
    let error = |scl, kbm| Tuning::from_scala(scl, kbm).unwrap_err().to_string();
    assert!(error("a\n1\n", None).starts_with("scale:2: "));
    assert!(error("a\n1\n2/1", Some("0\n0\n")).starts_with("keymap:2: "));
}

#[test]
fn files_as_they_are_found_are_read() {
    let expected = tuning("slendro white-keys-five");
    let scale = super::file("slendro.scl");
    let (comments, pitches) = scale.split_once("\n 5\n").unwrap();
    let keymap = super::file("white-keys-five.kbm");
    for scale in [
        scale.replace('\n', "\r\n"),
        scale.replace('\n', "\r"),
        format!("\u{feff}{scale}"),
        format!("! name\n\n5\n{pitches}"),
        format!("{comments}\n\t5 notes\n{}", pitches.replace("228.", "! as measured\n\n  228.000 cents ! 2nd\t")),
        format!("{scale}\n\nWords may follow,\nas in a letter.\n"),
        scale.replace(" 5\n", "5\n").replace("2/1", "2"),
    ] {
        let found = Tuning::from_scala(&scale, Some(&keymap)).unwrap();
        assert!(found == expected, "{scale:?}");
    }
    for keymap in [
        keymap.replace('\n', "\r\n"),
        keymap.replace("440.0", "440.000000 Hz ! A4"),
        keymap.replace("\nx\n", "\nX unmapped\n\n"),
        format!("{keymap}x\nx\nThis was the map.\n"),
    ] {
        let found = Tuning::from_scala(&scale, Some(&keymap)).unwrap();
        assert!(found == expected, "{keymap:?}");
    }
    let latin = b"! G\xfcnter's\nSl\xe9ndro, 5 tons \xe9gaux\n1\n240. \xb0\n";
    assert_eq!(Scale::read(&latin[..], "a").unwrap(), Scale::parse("\n1\n240.", "a").unwrap());
}
