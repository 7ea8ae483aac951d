//! The targets of the program: how it is built and run for each, and what must be installed for that.

use super::stopped::Stopped::{self, Failed, Missing};
use crate::shell::{cargo, has_standard_library, root, run_to_end, succeeds};
use crate::wine::{self, Prefix};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where Debian puts the libraries of aarch64.
const AARCH64_LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// Runs the program in Node.
const NODE_RUNNER: &str = "xtask/src/engine/cross/run.mjs";

/// A target of the compiler, with its options.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Target {
    /// This machine.
    Own,
    Aarch64,
    /// Windows on this CPU, under Wine.
    Windows,
    Wasm,
    /// WebAssembly whose scalar code the compiler may turn into vector instructions.
    WasmSimd,
}

impl Target {
    /// Its name for the compiler; none for this machine.
    pub(crate) fn triple(self) -> Option<&'static str> {
        match self {
            Target::Own => None,
            Target::Aarch64 => Some("aarch64-unknown-linux-gnu"),
            Target::Windows => Some(wine::TARGET),
            Target::Wasm | Target::WasmSimd => Some("wasm32-unknown-unknown"),
        }
    }

    /// Builds `tests/cross` and returns the program's path.
    pub(super) fn build(self, rustc: Option<&Path>) -> Result<PathBuf, Stopped> {
        let mut build = self.cargo("build --release --manifest-path tests/cross/Cargo.toml", rustc).map_err(Missing)?;
        run_to_end(&mut build, "tests/cross does not build").map_err(Failed)?;
        let name = match self {
            Target::Own | Target::Aarch64 => format!("sprung-cross{}", std::env::consts::EXE_SUFFIX),
            Target::Windows => "sprung-cross.exe".to_owned(),
            Target::Wasm | Target::WasmSimd => "sprung-cross.wasm".to_owned(),
        };
        Ok(self.folder().join(name))
    }

    /// Where release builds for it go.
    pub(crate) fn folder(self) -> PathBuf {
        let target = root().join(if self == Target::WasmSimd { "target/simd128" } else { "target" });
        target.join(self.triple().unwrap_or("")).join("release")
    }

    /// A cargo command that builds for it. The error says what is missing and how to install it.
    pub(crate) fn cargo(self, arguments: &str, rustc: Option<&Path>) -> Result<Command, String> {
        let mut command = cargo(arguments);
        command.envs([("CARGO_PROFILE_RELEASE_PANIC", "abort"), ("CARGO_PROFILE_RELEASE_STRIP", "true")]);
        let Some(triple) = self.triple() else { return Ok(command) };
        if !has_standard_library(triple, rustc) {
            return Err(format!(
                "Rust’s standard library for it is missing; install it with: rustup target add {triple} \
                 (or name another compiler that has it: --rustc PATH)"
            ));
        }
        command.args(["--target", triple]);
        if let Some(rustc) = rustc {
            // Cargo runs in another folder than the caller. A bare name is looked up as other programs are.
            let is_bare = rustc.components().count() == 1;
            let place = if is_bare { Ok(rustc.to_owned()) } else { std::path::absolute(rustc) };
            command.env("RUSTC", place.map_err(|error| format!("{}: {error}", rustc.display()))?);
        }
        const LINKER: &str = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER";
        if self == Target::Aarch64 && std::env::var_os(LINKER).is_none() {
            if !succeeds("aarch64-linux-gnu-gcc", &["--version"]) {
                return Err(
                    "there is no linker; install it with: sudo apt-get install gcc-aarch64-linux-gnu".to_owned()
                );
            }
            command.env(LINKER, "aarch64-linux-gnu-gcc");
        }
        if self == Target::WasmSimd {
            command.args(["--target-dir", "target/simd128"]).env("RUSTFLAGS", "-C target-feature=+simd128");
        }
        Ok(command)
    }

    /// A command that runs a program built for it. The error says what is missing and how to install it.
    pub(crate) fn command(self, program: &Path) -> Result<Command, String> {
        let (runner, package) = match self {
            Target::Own => return Ok(Command::new(program)),
            Target::Windows => return Ok(Prefix::of_tests()?.command(program)),
            Target::Aarch64 => ("qemu-aarch64", "qemu-user libc6-arm64-cross"),
            Target::Wasm | Target::WasmSimd => ("node", "nodejs"),
        };
        if !succeeds(runner, &["--version"]) {
            return Err(format!("there is no {runner}; install it with: sudo apt-get install {package}"));
        }
        let mut command = Command::new(runner);
        match self {
            Target::Aarch64 => command.args(["-L", AARCH64_LIBRARIES]),
            _ => command.arg(root().join(NODE_RUNNER)),
        };
        command.arg(program);
        Ok(command)
    }
}
