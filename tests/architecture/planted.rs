//! Violations in invented sources, which check that each rule finds them.

use crate::rules::{self, Row};
use crate::tree::Tree;
use std::path::Path;

const ROWS: &[Row] = &[("high", &["low"]), ("low", &[])];

/// A crate with these files, given as names and texts.
fn tree(files: &[(&str, &str)]) -> Tree {
    let source =
        |file: &Path| files.iter().find(|(name, _)| Path::new(name) == file).map(|(_, text)| (*text).to_owned());
    Tree::read(Path::new("lib.rs"), &source).unwrap()
}

/// A crate with the file `low.rs`, which has this text, and a module `high` with children.
fn with_low(low: &str) -> Tree {
    tree(&[
        ("lib.rs", "mod low; pub mod high; pub use high::Thing;"),
        ("high/mod.rs", "mod part; pub use part::Part; pub struct Thing;"),
        ("high/part.rs", "pub struct Part; pub fn work() {}"),
        ("low.rs", low),
    ])
}

#[test]
fn a_use_against_the_direction_is_found_wherever_it_is_written() {
    for low in [
        "use crate::high;",
        "use crate::high::Thing;",
        "use crate::Thing;",
        "use crate::{Thing as Other};",
        "use super::high::*;",
        "pub(crate) use crate::high::Part;",
        "fn f(x: crate::high::Thing) {}",
        "fn f() { crate::high::Part::new(); }",
        "fn f() -> Vec<Box<super::high::Part>> { vec![] }",
        "fn f() { println!(\"{}\", crate::high::work()); }",
        "mod inner { use super::super::high::Part; }",
        "#[cfg(test)] mod tests { use crate::low; } use crate::high::Thing;",
        "#[cfg(test)] use std::fs; impl crate::high::Trait for X {}",
        "struct S; impl S { #[cfg(test)] fn t() {} fn f() { super::high::Part; } }",
        "#[cfg(any(test, unix))] use crate::high::Thing;",
        "#[cfg(not(test))] use crate::high::Thing;",
        "use crate::high as other; fn f() { other::work(); }",
    ] {
        let breaches = rules::directions(&with_low(low), ROWS);
        assert!(!breaches.is_empty(), "{low}");
        assert!(breaches.iter().all(|breach| breach == "low.rs:1: `low` uses `high`"), "{low}: {breaches:?}");
    }
    let second_line = rules::directions(&with_low("//! Low.\nuse crate::high::Thing;"), ROWS);
    assert_eq!(second_line, ["low.rs:2: `low` uses `high`"]);
}

#[test]
fn what_only_tests_use_is_no_breach() {
    for low in [
        "#[cfg(test)] mod tests { use crate::high::Thing; }",
        "#[cfg(test)] mod tests;",
        "#[cfg(test)] use crate::high::Thing;",
        "#[cfg(all(test, unix))] fn f(x: crate::high::Thing) {}",
        "struct S; impl S { #[cfg(test)] fn f() { crate::high::work(); } }",
        "// use crate::high::Thing;\n/// [`crate::high::Thing`]\nfn f() { let high = 1; other::high(); }",
    ] {
        assert_eq!(rules::directions(&with_low(low), ROWS), [""; 0], "{low}");
    }
}

#[test]
fn a_module_without_a_row_is_found_and_rows_that_go_round() {
    let new = tree(&[("lib.rs", "mod low; mod new;"), ("low.rs", ""), ("new.rs", "")]);
    assert_eq!(rules::directions(&new, ROWS), ["`new` has no row that says what it may use"]);
    let round: &[Row] = &[("a", &["b"]), ("b", &["c"]), ("c", &["a"]), ("d", &["a"])];
    assert!(rules::reaches(round, "a", "a") && !rules::reaches(round, "d", "d"));
}

#[test]
fn an_outside_crate_is_found_under_any_name() {
    let rows: &[Row] = &[("std::fs", &["high"]), ("hound", &["high"])];
    for (low, found) in [
        ("use std::fs;", 1),
        ("use std::{io, fs::File};", 1),
        ("use std as system; fn f() { system::fs::read(\"\"); }", 1),
        ("fn f() { hound::open(); }", 1),
        ("use hound;", 1),
        ("use hound as h; fn f() { h::open(); h::close(); }", 3),
        ("use hounds::x; use std::fsx;", 0),
        ("#[cfg(test)] mod tests { use std::fs; }", 0),
    ] {
        assert_eq!(rules::outside(&with_low(low), rows).len(), found, "{low}");
    }
}

#[test]
fn files_that_import_each_other_are_found() {
    let of = |a: &str, b: &str| {
        let files = [("lib.rs", "mod a; mod b; pub use a::A; pub use b::B;"), ("a.rs", a), ("b.rs", b)];
        rules::circles(&tree(&files)).into_keys().collect::<Vec<_>>()
    };
    let circle = [("a.rs".into(), "b.rs".into())];
    assert_eq!(of("use crate::b::B; pub struct A;", "\nuse crate::a::A; pub struct B;"), circle);
    assert_eq!(of("use super::B; pub struct A;", "pub struct B; fn f() { crate::A::new() }"), circle);
    assert_eq!(of("use crate::b; pub struct A;", "pub struct B; mod inner { use super::super::a::A; }"), circle);
    assert_eq!(of("use crate::b::B; pub struct A;", "pub struct B; #[cfg(test)] mod tests { use crate::A; }"), []);
    assert_eq!(of("pub struct A;", "use crate::A; pub struct B;"), [], "a root that exports imports nothing");
    let child = tree(&[
        ("lib.rs", "mod a;"),
        ("a.rs", "mod part; use part::Part; pub struct A;"),
        ("a/part.rs", "use super::A; pub struct Part;"),
    ]);
    assert_eq!(rules::circles(&child).len(), 1, "a parent and its child");
}

#[test]
fn a_purpose_is_one_sentence_on_the_first_line() {
    for (text, is_one) in [
        ("//! What it is for.\n\nuse a;", true),
        ("//! What it is for.\n//!\n//! More.", true),
        ("//! What it is for, which\n//! takes two lines.", false),
        ("//! no sentence\n", false),
        ("//!\n//! Late.", false),
        ("use a;\n//! Late.", false),
        ("/// Of the item.", false),
        ("", false),
    ] {
        assert_eq!(rules::purpose(Path::new("a.rs"), text).is_none(), is_one, "{text:?}");
    }
}
