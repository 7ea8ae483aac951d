//! The modules of a crate, found through its `mod` items, and the file to which each path leads.

use crate::module::{self, Import, Module};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Maximum number of aliases on a path: more would be a cycle of `use` items.
const DEPTH: usize = 16;

/// A crate's modules by their paths, without modules for tests only.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    modules: BTreeMap<Vec<String>, (PathBuf, Module)>,
    /// All uses of other files and other crates.
    pub(crate) dependencies: Vec<Dependency>,
}

/// A use of another file, or of another crate, by a file.
#[derive(Clone, Debug)]
pub(crate) struct Dependency {
    /// Path of the module with the use.
    pub(crate) module: Vec<String>,
    pub(crate) file: PathBuf,
    pub(crate) line: usize,
    pub(crate) on: On,
    /// Whether it only makes something visible to others, as `pub use` does.
    pub(crate) is_export: bool,
}

/// The target of a dependency.
#[derive(Clone, Debug)]
pub(crate) enum On {
    Inside {
        /// The module named by the path, which may have imported the item itself.
        named: Vec<String>,
        /// The file that defines the item.
        file: PathBuf,
    },
    /// A path into another crate, with all aliases resolved.
    Outside(String),
}

/// Where a path ends: at a module of the crate, or outside the crate.
enum End {
    Module(Vec<String>),
    Outside(Vec<String>),
}

/// Whether a path is followed through modules that only re-export an item.
#[derive(Clone, Copy, PartialEq)]
enum Exports {
    Follow,
    /// Only through the crate's root, which may re-export everything.
    Stop,
}

impl Tree {
    /// Reads the crate with the root file `root`; `source` returns the text of a file.
    ///
    /// # Errors
    /// File, line and message of a file that cannot be read or parsed.
    pub(crate) fn read(root: &Path, source: &dyn Fn(&Path) -> Option<String>) -> Result<Self, String> {
        let mut tree = Self::default();
        tree.read_file(&[], root, root.parent().unwrap_or(Path::new("")), source)?;
        tree.dependencies = tree.found_dependencies();
        Ok(tree)
    }

    /// Reads the file of a module whose children's files are in `folder`.
    fn read_file(
        &mut self,
        path: &[String],
        file: &Path,
        folder: &Path,
        source: &dyn Fn(&Path) -> Option<String>,
    ) -> Result<(), String> {
        let text = source(file).ok_or_else(|| format!("{}: it cannot be read", file.display()))?;
        for module in module::read(path, &text).map_err(|error| format!("{}:{error}", file.display()))? {
            let inner = folder.join(module.path[path.len()..].iter().collect::<PathBuf>());
            for child in &module.children {
                let path = [&module.path[..], std::slice::from_ref(&child.name)].concat();
                let beside = file.parent().unwrap_or(Path::new(""));
                let given = child.file.as_ref().map(|given| tidy(&beside.join(given)));
                let candidates = [inner.join(format!("{}.rs", child.name)), inner.join(&child.name).join("mod.rs")];
                let found = given.or_else(|| candidates.into_iter().find(|file| source(file).is_some()));
                let found = found.ok_or_else(|| format!("{}: no file of `mod {}`", file.display(), child.name))?;
                let is_folder_root = child.file.is_some() || found.ends_with("mod.rs");
                let beneath = if is_folder_root { found.with_file_name("") } else { found.with_extension("") };
                self.read_file(&path, &found, &beneath, source)?;
            }
            self.modules.insert(module.path.clone(), (file.to_owned(), module));
        }
        Ok(())
    }

    /// Number of modules.
    pub(crate) fn len(&self) -> usize {
        self.modules.len()
    }

    /// The paths of all modules.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &[String]> {
        self.modules.keys().map(Vec::as_slice)
    }

    fn found_dependencies(&self) -> Vec<Dependency> {
        let mut all = Vec::new();
        for (file, module) in self.modules.values() {
            let imports = module.imports.iter().map(|import| (&import.named, import.is_export));
            for (named, is_export) in module.named.iter().map(|named| (named, false)).chain(imports) {
                let on = match self.resolve(&module.path, &named.path, Exports::Follow, 0) {
                    End::Outside(path) => On::Outside(path.join("::")),
                    End::Module(defining) => {
                        let Some((other, _)) = self.modules.get(&defining).filter(|(other, _)| other != file) else {
                            continue;
                        };
                        let named = match self.resolve(&module.path, &named.path, Exports::Stop, 0) {
                            End::Module(named) => named,
                            End::Outside(_) => defining,
                        };
                        On::Inside { named, file: other.clone() }
                    }
                };
                let (module, file) = (module.path.clone(), file.clone());
                all.push(Dependency { module, file, line: named.line, on, is_export });
            }
        }
        all
    }

    /// Resolves a path in a module.
    fn resolve(&self, from: &[String], path: &[String], exports: Exports, depth: usize) -> End {
        let outside = || End::Outside(path.to_vec());
        let (Some(first), Some((_, module))) = (path.first(), self.modules.get(from)) else { return outside() };
        if first == "crate" {
            return self.walk(&[], &path[1..], exports, depth);
        }
        let is_here = matches!(first.as_str(), "self" | "super")
            || self.child(from, first).is_some()
            || module.defined.contains(first);
        if is_here {
            return self.walk(from, path, exports, depth);
        }
        let Some(import) = module.imports.iter().find(|import| import.name == *first) else { return outside() };
        let meant = [&import.named.path[..], &path[1..]].concat();
        // `use rayon;` means the crate, not this import itself.
        if import.named.path[0] == *first || depth > DEPTH {
            return End::Outside(meant);
        }
        self.resolve(from, &meant, exports, depth + 1)
    }

    /// Resolves a path that continues from a module.
    fn walk(&self, at: &[String], path: &[String], exports: Exports, depth: usize) -> End {
        let here = || End::Module(at.to_vec());
        let (Some((first, rest)), Some((_, module))) = (path.split_first(), self.modules.get(at)) else {
            return here();
        };
        if first == "self" {
            return self.walk(at, rest, exports, depth);
        }
        if first == "super" {
            return self.walk(&at[..at.len().saturating_sub(1)], rest, exports, depth);
        }
        if let Some(child) = self.child(at, first) {
            return self.walk(&child, rest, exports, depth);
        }
        let may_follow = exports == Exports::Follow || at.is_empty();
        if module.defined.contains(first) || !may_follow || depth > DEPTH {
            return here();
        }
        if let Some(import) = module.imports.iter().find(|import| import.name == *first) {
            return self.resolve(at, &[&import.named.path[..], rest].concat(), exports, depth + 1);
        }
        let globs = module.imports.iter().filter(|import| import.name == "*");
        let source = |glob: &Import| match self.resolve(at, &glob.named.path, exports, depth + 1) {
            End::Module(found) if self.modules.get(&found).is_some_and(|(_, of)| of.defined.contains(first)) => {
                Some(found)
            }
            _ => None,
        };
        globs.filter_map(source).next().map_or_else(here, End::Module)
    }

    /// The path of a child of a module.
    fn child(&self, of: &[String], name: &str) -> Option<Vec<String>> {
        let path = [of, &[name.to_owned()]].concat();
        self.modules.contains_key(&path).then_some(path)
    }
}

/// A path with its `..` resolved.
fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                tidy.pop();
            }
            other => tidy.push(other),
        }
    }
    tidy
}
