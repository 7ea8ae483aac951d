//! Digests, which show whether a source is the one for which, and with which, the corrections were made.

use crate::sha256::hex;
use sha2::{Digest as _, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// The digest of all files in a package's folder with their paths, except the files that cargo adds when unpacking.
pub(super) fn of_folder(folder: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    list(folder, &mut files)?;
    let mut paths: Vec<(String, PathBuf)> = files
        .into_iter()
        .map(|path| {
            let inside = path.strip_prefix(folder).expect("it was found in the folder");
            let parts: Vec<_> = inside.iter().map(|part| part.to_string_lossy()).collect();
            (parts.join("/"), path)
        })
        .filter(|(name, _)| name != ".cargo-ok")
        .collect();
    paths.sort();
    let mut sum = Sha256::new();
    for (name, path) in paths {
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        sum.update(format!("{name}\n{}\n", bytes.len()));
        sum.update(bytes);
    }
    Ok(hex(sum))
}

/// The digest of several texts in order.
pub(super) fn of_texts(texts: impl Iterator<Item = String>) -> String {
    let mut sum = Sha256::new();
    texts.for_each(|text| sum.update(text));
    hex(sum)
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() { list(&path, files)? } else { files.push(path) }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::write;
    use crate::shell::root;

    #[test]
    fn the_digest_knows_every_byte_and_path() {
        let folder = root().join("target/tmp").join(format!("digest-{}", std::process::id()));
        let digest = |files: &[(&str, &str)]| {
            for (name, text) in files {
                write(&folder.join(name), text).unwrap();
            }
            let digest = of_folder(&folder).unwrap();
            fs::remove_dir_all(&folder).unwrap();
            digest
        };
        let first = digest(&[("a", "1"), ("b/c", "2")]);
        assert_eq!(first, digest(&[("b/c", "2"), ("a", "1"), (".cargo-ok", "unpacked")]));
        assert_ne!(first, digest(&[("a", "1"), ("b/c", "3")]));
        assert_ne!(first, digest(&[("a", "1"), ("b/d", "2")]));
        assert_ne!(first, digest(&[("a", "1"), ("b/c", "2"), ("e", "")]));
    }
}
