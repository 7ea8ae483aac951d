//! A system to build for: this machine's, or another by the compiler's name for it.

use crate::files::make_folder_of;
use crate::shell::{cargo, root, run_to_end};
use crate::wine::Prefix;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The name for both of Apple's CPUs at once, as maturin has it, and the compiler's names for them.
const UNIVERSAL: (&str, [&str; 2]) = ("universal2-apple-darwin", ["aarch64-apple-darwin", "x86_64-apple-darwin"]);

/// What is built with: `release` is what users get.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Profile {
    Debug,
    Release,
}

/// A system and its CPU.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct System {
    /// The compiler's name for it, or [`UNIVERSAL`]; none for this machine.
    pub(crate) triple: Option<String>,
    /// As in `std::env::consts::ARCH`, or `universal`.
    pub(crate) architecture: String,
    /// As in `std::env::consts::OS`.
    pub(crate) name: &'static str,
}

impl System {
    /// This machine's.
    pub(crate) fn own() -> Self {
        Self { triple: None, architecture: std::env::consts::ARCH.to_owned(), name: std::env::consts::OS }
    }

    /// The system that the compiler calls so; this machine's without a name.
    pub(crate) fn of(triple: Option<&str>) -> Result<Self, String> {
        let Some(triple) = triple else { return Ok(Self::own()) };
        let (architecture, rest) = triple.split_once('-').unwrap_or((triple, ""));
        let names = [("windows", "windows"), ("apple-darwin", "macos"), ("linux", "linux")];
        let Some((_, name)) = names.iter().find(|(part, _)| rest.contains(part)) else {
            return Err(format!("--target {triple}: expected the compiler's name of a Windows, macOS or Linux"));
        };
        let architecture = if triple == UNIVERSAL.0 { "universal" } else { architecture };
        Ok(Self { triple: Some(triple.to_owned()), architecture: architecture.to_owned(), name })
    }

    /// The folder for what is made for it.
    pub(crate) fn folder(&self) -> PathBuf {
        root().join("target").join(self.triple.as_deref().unwrap_or_default())
    }

    /// The name of a program's file.
    pub(crate) fn program(&self, name: &str) -> String {
        format!("{name}{}", if self.name == "windows" { ".exe" } else { "" })
    }

    /// The name of a dynamic library's file.
    pub(crate) fn library(&self, name: &str) -> String {
        match self.name {
            "windows" => format!("{name}.dll"),
            "macos" => format!("lib{name}.dylib"),
            _ => format!("lib{name}.so"),
        }
    }

    /// Builds a program or library with cargo, without symbols for debuggers in a release. Returns its path.
    pub(crate) fn build(&self, arguments: &str, profile: Profile, file: &str) -> Result<PathBuf, String> {
        let triples: Vec<Option<&str>> = match self.triple.as_deref() {
            Some(triple) if triple == UNIVERSAL.0 => UNIVERSAL.1.map(Some).into(),
            triple => vec![triple],
        };
        let folder = if profile == Profile::Release { "release" } else { "debug" };
        let mut built = Vec::new();
        for triple in triples {
            let mut command = cargo(arguments);
            command.args(["--target-dir", "target"]).args(triple.iter().flat_map(|triple| ["--target", triple]));
            if profile == Profile::Release {
                // Symbols are most of the size.
                command.args(["--release", "--", "-C", "strip=symbols"]);
            }
            run_to_end(&mut command, &format!("{file} does not build"))?;
            built.push(root().join("target").join(triple.unwrap_or_default()).join(folder).join(file));
        }
        if let [one] = &built[..] {
            return Ok(one.clone());
        }
        let both = self.folder().join(folder).join(file);
        make_folder_of(&both)?;
        let mut join = Command::new("lipo");
        run_to_end(join.arg("-create").args(built).arg("-output").arg(&both), "lipo, which joins both CPUs' code")?;
        Ok(both)
    }

    /// A command that runs a program built for it, where this machine can.
    pub(crate) fn command(&self, program: &Path) -> Result<Command, String> {
        if self.name == "windows" && !cfg!(windows) {
            return Ok(Prefix::of_tests()?.command(program));
        }
        Ok(Command::new(program))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_the_compiler_are_understood() {
        let of = |triple| System::of(Some(triple)).map(|system| (system.architecture.clone(), system.name));
        for (triple, architecture, name) in [
            ("x86_64-pc-windows-gnu", "x86_64", "windows"),
            ("aarch64-pc-windows-msvc", "aarch64", "windows"),
            ("aarch64-apple-darwin", "aarch64", "macos"),
            ("universal2-apple-darwin", "universal", "macos"),
            ("aarch64-unknown-linux-gnu", "aarch64", "linux"),
        ] {
            assert_eq!(of(triple), Ok((architecture.to_owned(), name)));
        }
        assert!(of("wasm32-unknown-unknown").is_err_and(|message| message.contains("wasm32-unknown-unknown")));
        assert_eq!(System::of(None), Ok(System::own()));
        let own = System::own();
        assert_eq!(own.program("a"), format!("a{}", std::env::consts::EXE_SUFFIX));
        assert_eq!(own.library("a"), format!("{}a{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
    }
}
