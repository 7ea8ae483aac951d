//! Copies, replaces and removes files and folders as a whole.

use std::fs;
use std::path::Path;

/// Replaces the file or folder at `path` by what `fill` creates at the path that it receives. The replacement is never
/// half done, and if `fill` fails, the old one remains.
pub(crate) fn replace(path: &Path, fill: impl FnOnce(&Path) -> Result<(), String>) -> Result<(), String> {
    let beside = |suffix: &str| {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{suffix}-{}", std::process::id()));
        path.with_file_name(name)
    };
    let (new, old) = (beside("new"), beside("old"));
    let result = fill(&new).and_then(|()| {
        let existed = path.symlink_metadata().is_ok();
        if existed {
            fs::rename(path, &old).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        fs::rename(&new, path).map_err(|error| {
            if existed {
                let _ = fs::rename(&old, path);
            }
            format!("{}: {error}", path.display())
        })
    });
    // Leftover temporary files do no harm, and the result below is more important.
    let _ = remove(&new);
    let _ = remove(&old);
    result
}

/// Removes a file, or a folder with everything in it. Returns whether there was one.
pub(crate) fn remove(path: &Path) -> Result<bool, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    match path.symlink_metadata() {
        Ok(about) if about.is_dir() => fs::remove_dir_all(path).map(|()| true).map_err(failed),
        Ok(_) => fs::remove_file(path).map(|()| true).map_err(failed),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(failed(error)),
    }
}

/// Copies a file, or a folder with everything in it, and creates the folders above it.
pub(crate) fn copy(from: &Path, to: &Path) -> Result<(), String> {
    if !from.is_dir() {
        make_folder_of(to)?;
        return fs::copy(from, to)
            .map(drop)
            .map_err(|error| format!("{} to {}: {error}", from.display(), to.display()));
    }
    for entry in fs::read_dir(from).map_err(|error| format!("{}: {error}", from.display()))? {
        let entry = entry.map_err(|error| format!("{}: {error}", from.display()))?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

pub(crate) fn write(path: &Path, text: &str) -> Result<(), String> {
    make_folder_of(path)?;
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

pub(crate) fn make_folder_of(path: &Path) -> Result<(), String> {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell::root;

    #[test]
    fn a_bundle_is_replaced_whole_or_not_at_all() {
        let folder = root().join("target/tmp").join(format!("bundle-{}", std::process::id()));
        let bundle = folder.join("Sprung.vst3");
        for text in ["first", "second"] {
            replace(&bundle, |aside| write(&aside.join("Contents/a"), text)).unwrap();
            assert_eq!(fs::read_to_string(bundle.join("Contents/a")).unwrap(), text);
        }
        let failed = replace(&bundle, |aside| write(&aside.join("Contents/a"), "half").and(Err("no".to_owned())));
        assert_eq!(failed, Err("no".to_owned()));
        assert_eq!(fs::read_to_string(bundle.join("Contents/a")).unwrap(), "second");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing is left beside it");
        assert_eq!(remove(&folder), Ok(true));
        assert_eq!(remove(&folder), Ok(false));
    }
}
