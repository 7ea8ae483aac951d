//! Two bodies in a preset file: `[body]`, `[second]`, and how they are connected, `[joint]`.

use super::body_table::{named, number, read_body, text};
use super::complaints::Complaints;
use super::value::unexpected;
use crate::error::nearest;
use crate::patch::ModeTable;
use crate::sound::bodies::Body;
use crate::sound::pairs::{LINK_FIELDS, Link, LinkField, Pair};
use std::fmt::Write;
use toml::{Table, Value};

/// The kinds of links by their names in files, with their starting values.
pub const LINK_KINDS: [(&str, Link); 4] = [
    ("apart", Link::Apart),
    ("series", Link::Series),
    ("spring", Link::Spring { stiffness: 1000.0, damping: 0.0 }),
    ("rigid", Link::Rigid),
];

/// The modes of a pair. They keep the texts of both bodies and of the joint as their origin. Allocates.
///
/// # Errors
/// As [`Pair::table`].
pub fn modes_of_pair(pair: &Pair) -> crate::Result<ModeTable> {
    let origin = format!("{}\n[second]\n{}\n[joint]\n{}", text(&pair.first), text(&pair.second), link_text(pair));
    Ok(pair.table()?.with_origin(&origin))
}

/// The pair from which modes were made; none if they were not made from one. Allocates.
pub fn pair_of_modes(modes: &ModeTable) -> Option<Pair> {
    let mut complaints = Complaints::default();
    // The first body gets a table of its own, since its number `joint` would clash with the table `[joint]`.
    let mut file: Table = toml::from_str(&format!("[body]\n{}", modes.origin()?)).ok()?;
    let Some(Value::Table(first)) = file.remove("body").filter(|_| is_in(&file)) else { return None };
    let first = read_body(&first, "body", &mut complaints)?;
    let pair = read(&file, first, &mut complaints);
    pair.filter(|_| complaints.into_lines().is_empty())
}

/// Whether the file has `[second]` or `[joint]`.
pub(super) fn is_in(file: &Table) -> bool {
    file.contains_key("second") || file.contains_key("joint")
}

/// Reads the second body and the joint of a file, if both can be read.
pub(super) fn read(file: &Table, first: Body, complaints: &mut Complaints) -> Option<Pair> {
    let mut part = |key: &str, other: &str| match file.get(key) {
        Some(Value::Table(table)) => Some(table),
        Some(other) => {
            complaints.add(unexpected(key, &format!("a table [{key}]"), other));
            None
        }
        None => {
            complaints.add(format!("{other}: there is no [{key}]: expected one beside it"));
            None
        }
    };
    let (second, joint) = (part("second", "joint"), part("joint", "second"));
    let second = read_body(second?, "second", complaints)?;
    read_joint(joint?, first, second, complaints)
}

fn read_joint(table: &Table, first: Body, second: Body, complaints: &mut Complaints) -> Option<Pair> {
    let names = || ["kind"].into_iter().chain(LINK_FIELDS.iter().map(|field| field.name));
    for unknown in table.keys().filter(|key| !names().any(|name| name == *key)) {
        complaints.add(match nearest(unknown, names()) {
            Some(near) => format!("unknown key ‘joint.{unknown}’; the nearest is {near}"),
            None => {
                format!("unknown key ‘joint.{unknown}’: expected one of {}", names().collect::<Vec<_>>().join(", "))
            }
        });
    }
    let kinds = || LINK_KINDS.iter().map(|(kind, _)| *kind);
    let find = |id: &str| LINK_KINDS.iter().find(|(kind, _)| *kind == id);
    let expected = || kinds().collect::<Vec<_>>().join(", ");
    let kind = named(table, "joint", "kind", find, kinds)
        .and_then(|kind| kind.ok_or_else(|| format!("joint: there is no ‘kind’: expected one of {}", expected())));
    let (kind, link) = complaints.take("", kind)?;
    let mut pair = Pair::new(first, second, *link);
    for LinkField { name, unit, min, max, get, set } in LINK_FIELDS {
        let Some(value) = table.get(*name) else { continue };
        let Some(value) = complaints.take(&format!("joint.{name}: "), number(unit, [*min, *max], value)) else {
            continue;
        };
        set(&mut pair, value);
        if get(&pair).is_none() {
            complaints.add(format!("joint.{name}: a joint of the kind {kind} has no such number"));
        }
    }
    if pair.keys[0] > pair.keys[1] {
        let [lowest, highest] = pair.keys;
        complaints.add(format!("joint.highest: {highest} is below the lowest key: expected from {lowest} to 127"));
        return None;
    }
    Some(pair)
}

/// The lines of `[joint]`: the kind, and the values that differ from the starting values of the kind.
fn link_text(pair: &Pair) -> String {
    let same = |link: &Link| std::mem::discriminant(link) == std::mem::discriminant(&pair.link);
    let (kind, link) = LINK_KINDS.iter().find(|(_, link)| same(link)).unwrap_or(&LINK_KINDS[0]);
    let first = Pair::new(pair.first.clone(), pair.second.clone(), *link);
    let mut out = format!("kind = \"{kind}\"\n");
    for LinkField { name, get, .. } in LINK_FIELDS {
        if let Some(value) = get(pair).filter(|value| get(&first) != Some(*value)) {
            let _ = writeln!(out, "{name} = {value:?}");
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;
    use crate::patch::Patch;
    use crate::preset::Preset;
    use crate::sound::bodies::Point;

    fn parse(bodies: &str) -> crate::Result<Preset> {
        Preset::parse(&format!("format = 1\nname = \"a\"\n{bodies}"), "x")
    }

    const GUITAR: &str = "[body]\nmodel = \"string\"\ncount = 8\n[second]\nmodel = \"plate\"\ncount = 6\n\
        frequency = \"90 Hz\"\nfollows_key = false\n[joint]\nkind = \"spring\"\nstiffness = \"2 kHz\"\nheard = \"80 %\"\n\
        lowest = 50\nhighest = 52";

    #[test]
    fn a_pair_is_read_and_saved_as_it_was() {
        let preset = parse(GUITAR).unwrap();
        let pair = pair_of_modes(&preset.patch.modes).unwrap();
        assert_eq!(pair.link, Link::Spring { stiffness: 2000.0, damping: 0.0 });
        assert_eq!((pair.heard, pair.keys, pair.second.follows_key), (0.8, [50, 52], false));
        assert_eq!(f64::from(preset.patch.get(Param::Decay)), f64::from(pair.t60() as f32));
        assert_eq!(parse(preset.to_toml().split_once("name = \"a\"\n").unwrap().1).unwrap(), preset);
        preset.patch.modes.make_tables();
        assert_eq!(preset.patch.modes.keys(), Some(50..=52));
    }

    #[test]
    fn every_kind_of_joint_is_saved_and_read_as_it_was() {
        let [first, second] = ["marimba", "stopped_tube"].map(|model| {
            let model = crate::sound::bodies::Model::find(model).unwrap().clone();
            let joint = Point { x: 0.25, y: 0.5 };
            Body { modes: 4, joint, ..Body::new(model) }
        });
        for (_, link) in LINK_KINDS {
            let mut pair = Pair::new(first.clone(), second.clone(), link);
            for (n, field) in LINK_FIELDS.iter().enumerate() {
                (field.set)(
                    &mut pair,
                    (field.min + (field.max - field.min) * (n + 1) as f64 / 20.0).floor().max(field.min),
                );
            }
            let modes = modes_of_pair(&pair).unwrap();
            assert_eq!(pair_of_modes(&modes), Some(pair));
            let preset = Preset { patch: Patch { modes, ..Patch::default() }, ..parse("").unwrap() };
            let text = preset.to_toml();
            assert_eq!(Preset::parse(&text, "x").unwrap_or_else(|error| panic!("{error}\n{text}")), preset);
        }
    }

    #[test]
    fn errors_say_what_would_be_right() {
        let both = "[body]\nmodel = \"mass\"\n[second]\nmodel = \"mass\"\n";
        for (text, why) in [
            ("[second]\nmodel = \"mass\"", "x: second: there is no [body]: expected both"),
            ("[body]\nmodel = \"mass\"\nfollows_key = false", "x: body.follows_key: expected a [second] body"),
            ("[body]\nmodel = \"mass\"\nfollows_key = 1", "x: body.follows_key: expected true or false, found integer"),
            (both, "x: second: there is no [joint]: expected one beside it"),
            ("[body]\nmodel = \"mass\"\n[joint]\nkind = \"rigid\"", "x: joint: there is no [second]"),
            ("second = 1\n[body]\nmodel = \"mass\"", "x: second: expected a table [second], found integer ‘1’"),
            (&format!("{both}[joint]"), "x: joint: there is no ‘kind’: expected one of apart, series, spring, rigid"),
            (&format!("{both}[joint]\nkind = \"sprung\""), "x: joint.kind: there is no ‘sprung’; the nearest is"),
            (&format!("{both}[joint]\nkind = \"rigid\"\nmas = 1"), "x: unknown key ‘joint.mas’; the nearest is"),
            (
                &format!("{both}[joint]\nkind = \"rigid\"\nmass = 0"),
                "x: joint.mass: 0 is out of range: expected from 0.001",
            ),
            (
                &format!("{both}[joint]\nkind = \"series\"\nmass = 2"),
                "x: joint.mass: a joint of the kind series has no",
            ),
            (
                &format!("{both}[joint]\nkind = \"spring\"\nstiffness = \"1 N\""),
                "x: joint.stiffness: ‘1 N’ is no number in Hz",
            ),
            (
                &format!("{both}[joint]\nkind = \"rigid\"\nlowest = 9\nhighest = 8"),
                "x: joint.highest: 8 is below the lowest key",
            ),
            (&format!("{both}strike = 2\n[joint]\nkind = \"rigid\""), "x: second.strike: 2 is out of range"),
            (
                "[body]\nmodel = \"string\"\ncount = 500\n[second]\nmodel = \"plate\"\n[joint]\nkind = \"rigid\"",
                "x: count: both bodies have 564 modes",
            ),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with(why), "{text}: {error}");
        }
    }
}
