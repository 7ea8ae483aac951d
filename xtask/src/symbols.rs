//! Checks that a file for users has nothing that only debuggers read: symbols and line tables are more than half of it.

use std::path::Path;

/// The type of a section with the symbols that the loader does not need (ELF: `SHT_SYMTAB`).
const SYMBOLS: u32 = 2;

/// Checks a program or library. Only 64-bit ELF files, little-endian, are looked into.
///
/// # Errors
/// If it cannot be read, or was not stripped; the message has the sections.
pub(crate) fn check(path: &Path) -> Result<(), String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    if !bytes.starts_with(b"\x7fELF\x02\x01") {
        return Ok(());
    }
    let found = for_debuggers(&bytes).ok_or_else(|| format!("{}: its sections cannot be read", path.display()))?;
    if found.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{}: it was not stripped: it has the sections {}. It is linked with ‘-C strip=symbols’, which RUSTFLAGS may undo",
        path.display(),
        found.join(", ")
    ))
}

/// The sections of a 64-bit ELF file, little-endian, that only debuggers read; `None` if it is damaged.
fn for_debuggers(bytes: &[u8]) -> Option<Vec<String>> {
    let number = |at: usize, size: usize| -> Option<usize> {
        let digits = bytes.get(at..at.checked_add(size)?)?;
        Some(digits.iter().rev().fold(0, |number, digit| number << 8 | usize::from(*digit)))
    };
    let (table, entry, count) = (number(0x28, 8)?, number(0x3a, 2)?, number(0x3c, 2)?);
    let section = |index: usize| table.checked_add(index * entry);
    let names = number(section(number(0x3e, 2)?)?.checked_add(0x18)?, 8)?;
    let mut found = Vec::new();
    for index in 0..count {
        let section = section(index)?;
        let name = bytes.get(names.checked_add(number(section, 4)?)?..)?.split(|byte| *byte == 0).next()?;
        let name = String::from_utf8_lossy(name).into_owned();
        if number(section.checked_add(4)?, 4)? == SYMBOLS as usize || name.starts_with(".debug_") {
            found.push(name);
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell::root;
    use std::process::Command;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_library_that_was_not_stripped_is_refused() {
        let folder = root().join("target/tmp").join(format!("symbols-{}", std::process::id()));
        let source = folder.join("library.rs");
        crate::files::write(&source, "#[unsafe(no_mangle)]\npub extern \"C\" fn three() -> i32 {\n    3\n}\n").unwrap();
        let compiled = |options: &[&str]| {
            let library = folder.join("library.so");
            let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
            command.args(["--edition=2024", "--crate-type=cdylib"]).args(options).arg("-o").arg(&library).arg(&source);
            assert!(command.status().unwrap().success(), "{options:?}");
            check(&library)
        };
        for options in [&["-C", "strip=none"][..], &["-C", "strip=none", "-C", "debuginfo=line-tables-only"]] {
            let message = compiled(options).unwrap_err();
            assert!(message.contains(".symtab") && message.contains("library.so"), "{message}");
        }
        assert!(compiled(&["-C", "strip=debuginfo"]).unwrap_err().contains("sections .symtab."));
        assert_eq!(compiled(&["-C", "debuginfo=line-tables-only", "-C", "strip=symbols"]), Ok(()));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_cut_off_or_no_elf_file_is_not_looked_into() {
        assert_eq!(for_debuggers(b"MZ"), None);
        let own = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        assert_eq!(for_debuggers(&own[..100.min(own.len())]), None);
    }
}
