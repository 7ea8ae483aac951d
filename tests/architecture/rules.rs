//! The rules for sources: each is a function that returns a line for every violation.

use crate::tree::{Dependency, On, Tree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module at the crate's root, and the parts of the crate that it may use.
pub(crate) type Row = (&'static str, &'static [&'static str]);

fn place(dependency: &Dependency) -> String {
    format!("{}:{}", dependency.file.display(), dependency.line)
}

/// The module at the crate's root that contains a path.
fn top(path: &[String]) -> &str {
    path.first().map_or("the root", String::as_str)
}

/// Uses between root modules that no row allows, and root modules without a row.
pub(crate) fn directions(tree: &Tree, rows: &[Row]) -> Vec<String> {
    let row = |name: &str| rows.iter().find(|(module, _)| *module == name).map(|(_, allowed)| *allowed);
    let tops: BTreeSet<&str> = tree.paths().filter(|path| !path.is_empty()).map(top).collect();
    let mut breaches: Vec<String> = tops
        .into_iter()
        .filter(|name| row(name).is_none())
        .map(|name| format!("`{name}` has no row that says what it may use"))
        .collect();
    for dependency in &tree.dependencies {
        let On::Inside { named, .. } = &dependency.on else { continue };
        let (user, used) = (top(&dependency.module), top(named));
        let allowed = user == used || row(user).is_some_and(|allowed| allowed.contains(&used));
        // The crate's root declares all modules and uses nothing of them.
        let declares = dependency.module.is_empty() && dependency.is_export;
        if !allowed && !declares {
            breaches.push(format!("{}: `{user}` uses `{used}`", place(dependency)));
        }
    }
    breaches
}

/// Whether a module may use another one, directly or through others.
pub(crate) fn reaches(rows: &[Row], from: &str, to: &str) -> bool {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(name) = open.pop() {
        let allowed = rows.iter().find(|(module, _)| *module == name).map_or(&[][..], |(_, allowed)| *allowed);
        if allowed.contains(&to) {
            return true;
        }
        open.extend(allowed.iter().filter(|next| seen.insert(**next)));
    }
    false
}

/// Uses of other crates, or of parts of them, by root modules that no row names.
pub(crate) fn outside(tree: &Tree, rows: &[Row]) -> Vec<String> {
    let breach = |dependency: &Dependency| {
        let On::Outside(path) = &dependency.on else { return None };
        let is_of = |name: &str| path.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"));
        let (name, _) =
            rows.iter().find(|(name, allowed)| is_of(name) && !allowed.contains(&top(&dependency.module)))?;
        Some(format!("{}: `{}` uses `{name}`", place(dependency), top(&dependency.module)))
    };
    tree.dependencies.iter().filter_map(breach).collect()
}

/// Pairs of files that import each other, in alphabetical order, with a line number of each.
pub(crate) fn circles(tree: &Tree) -> BTreeMap<(PathBuf, PathBuf), [usize; 2]> {
    let mut uses = BTreeMap::new();
    for dependency in tree.dependencies.iter().filter(|dependency| !dependency.is_export) {
        if let On::Inside { file, .. } = &dependency.on {
            uses.entry((dependency.file.clone(), file.clone())).or_insert(dependency.line);
        }
    }
    let pairs = uses.iter().filter(|((from, to), _)| from < to);
    pairs
        .filter_map(|((from, to), line)| {
            let back = uses.get(&(to.clone(), from.clone()))?;
            Some(((from.clone(), to.clone()), [*line, *back]))
        })
        .collect()
}

/// Describes the fault of a file's first line, which must state the file's purpose; `None` if there is no fault.
pub(crate) fn purpose(file: &Path, text: &str) -> Option<String> {
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default();
    let Some(purpose) = first.strip_prefix("//! ").filter(|purpose| !purpose.trim().is_empty()) else {
        return Some(format!("{}: its first line is not `//! ` and its purpose", file.display()));
    };
    let goes_on = lines.next().is_some_and(|line| line.strip_prefix("//!").is_some_and(|rest| !rest.trim().is_empty()));
    let ends = purpose.ends_with(['.', ':', ';']);
    (goes_on || !ends).then(|| format!("{}: its purpose is not one sentence on the first line", file.display()))
}
