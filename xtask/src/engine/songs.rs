//! `cargo xtask songs`: the demo songs, composed in code and written to `assets/midi`.

mod drum;
mod groove;
mod kits;
mod score;
mod suite;

use crate::shell::root;
use std::fs;

/// Composes a song and returns the bytes of its file.
type Compose = fn() -> Result<Vec<u8>, String>;

/// Names of the files, with the functions that compose them.
const SONGS: [(&str, Compose); 3] =
    [("groove.mid", groove::compose), ("kits.mid", kits::compose), ("suite.mid", suite::compose)];

/// Writes the songs. With `check`, compares the existing files with what would be written instead.
pub(crate) fn run(check: bool) -> Result<(), String> {
    for (name, compose) in SONGS {
        let path = root().join("assets/midi").join(name);
        let bytes = compose()?;
        let at = |error| format!("{}: {error}", path.display());
        if !check {
            fs::write(&path, &bytes).map_err(at)?;
            println!("{} ({} bytes)", path.display(), bytes.len());
        } else if fs::read(&path).map_err(at)? == bytes {
            println!("{} is what the generator writes", path.display());
        } else {
            return Err(format!("{} is not what the generator writes: run `cargo xtask songs`", path.display()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn composing_twice_gives_the_same_bytes() {
        for (name, compose) in SONGS {
            assert_eq!(compose().unwrap(), compose().unwrap(), "{name}");
        }
    }

    #[test]
    fn the_files_are_what_the_generator_writes() {
        run(true).unwrap();
    }
}
