//! The chores that use the engine: compiling it takes minutes, so the other chores are a program without it.

#[cfg(feature = "engine")]
mod bench_table;
#[cfg(feature = "engine")]
mod beside;
#[cfg(feature = "engine")]
mod callgrind;
#[cfg(feature = "engine")]
mod cross;
#[cfg(feature = "engine")]
mod figures;
#[cfg(feature = "engine")]
mod level;
#[cfg(feature = "engine")]
mod measure;
#[cfg(feature = "engine")]
mod web;

use clap::Subcommand;
use std::path::PathBuf;

#[derive(Subcommand)]
#[cfg_attr(not(feature = "engine"), allow(dead_code, reason = "read by the program with the engine"))]
pub(crate) enum Chore {
    /// Draw the README's picture of the demo song to assets/demo.png.
    Figures,
    /// Run the benches and the peers, and write their tables into benches/README.md.
    BenchTable {
        /// Run nothing: write what was measured the last time.
        #[arg(long)]
        again: bool,
    },
    /// Count the instructions of the kernels and of silence; fail if they have grown by more than 5 %.
    Callgrind {
        /// Keep what is counted.
        #[arg(long)]
        accept: bool,
    },
    /// What `callgrind` counts.
    #[command(hide = true)]
    CallgrindWork { name: String, rounds: usize },
    /// Render the golden cases on each CPU that this machine has or can imitate, and print a table of what is the same.
    Cross {
        /// The compiler for other CPUs, where the present toolchain lacks their standard libraries.
        #[arg(long, env = "SPRUNG_CROSS_RUSTC", value_name = "PATH")]
        rustc: Option<PathBuf>,
        /// Seconds of each song; 0 for none.
        #[arg(long, default_value_t = 10, value_name = "N")]
        song_seconds: usize,
        /// Only one case of N, where all take too long: QEMU needs seconds for each.
        #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        every: u16,
        /// Only CPUs and instructions whose name contains this, such as wasm32.
        only: Option<String>,
    },
    /// Build the page that plays Sprung in a browser into target/web.
    Web {
        /// The compiler for WebAssembly, where the present toolchain lacks its standard library.
        #[arg(long, env = "SPRUNG_CROSS_RUSTC", value_name = "PATH")]
        rustc: Option<PathBuf>,
        /// Serve the page to this machine.
        #[arg(long)]
        serve: bool,
        /// Port to serve at; 0 takes any free one.
        #[arg(long, value_name = "N", default_value_t = 8017, requires = "serve")]
        port: u16,
        /// Play it in headless Chromium: compare its samples with the renderer's, and measure.
        #[arg(long)]
        check: bool,
        /// Take the README's picture of it.
        #[arg(long, value_name = "OUT.png")]
        picture: Option<PathBuf>,
    },
    /// Measure how loud the factory's presets are, and propose gains that bring them to one loudness.
    Level {
        /// Write the gains into the presets' files.
        #[arg(long)]
        write: bool,
    },
    /// Measure the factory's presets and write the results to assets/measures/results.md; or beside two soundfonts.
    Measure {
        /// Play General MIDI's programs on two soundfonts too, by FluidSynth, and print where a preset stands beside both.
        #[arg(long, num_args = 2, value_names = ["FONT.sf2", "FONT.sf2"])]
        beside: Vec<PathBuf>,
    },
}

/// Does a chore.
#[cfg(feature = "engine")]
pub(crate) fn run(chore: &Chore) -> Result<(), String> {
    match chore {
        Chore::Figures => figures::run(),
        Chore::BenchTable { again } => bench_table::run(*again),
        Chore::Callgrind { accept } => callgrind::run(*accept),
        Chore::CallgrindWork { name, rounds } => callgrind::work(name, *rounds),
        Chore::Cross { rustc, song_seconds, every, only } => cross::run(&cross::Options {
            rustc: rustc.as_deref(),
            song_seconds: *song_seconds,
            every: usize::from(*every),
            only: only.as_deref(),
        }),
        Chore::Web { rustc, serve, port, check, picture } => {
            let (serve, check, picture) = (serve.then_some(*port), *check, picture.as_deref());
            web::run(&web::Options { rustc: rustc.as_deref(), serve, check, picture })
        }
        Chore::Level { write } => level::run(*write),
        Chore::Measure { beside } => match &beside[..] {
            [one, other] => beside::run([one, other]),
            [] => measure::run(),
            _ => Err("--beside: expected two soundfonts, once".to_owned()),
        },
    }
}

/// Runs the same chore in the optimised program with the engine, and ends with its exit code.
#[cfg(not(feature = "engine"))]
pub(crate) fn run(chore: &Chore) -> Result<(), String> {
    let profile = if matches!(chore, Chore::Callgrind { .. }) { "counted" } else { "release" };
    let mut command = crate::shell::cargo(WITH_ENGINE);
    command
        .args(["--profile", profile, "--manifest-path"])
        .arg(crate::shell::root().join("Cargo.toml"))
        .arg("--")
        .args(std::env::args_os().skip(1));
    // Paths on the command line are relative to the caller’s folder.
    command.current_dir(std::env::current_dir().map_err(|error| format!("the present folder: {error}"))?);
    eprintln!("building the chores that use the engine; the first time takes minutes");
    replace_by(command)
}

/// Replaces this process by the command (`exec`), as `cargo run` does too: a signal to this process reaches the chore.
#[cfg(all(unix, not(feature = "engine")))]
fn replace_by(mut command: std::process::Command) -> Result<(), String> {
    use std::os::unix::process::CommandExt as _;
    Err(format!("cargo: {}", command.exec()))
}

/// Runs the command and ends with its exit code.
#[cfg(all(not(unix), not(feature = "engine")))]
fn replace_by(mut command: std::process::Command) -> Result<(), String> {
    let status = command.status().map_err(|error| format!("cargo: {error}"))?;
    std::process::exit(status.code().unwrap_or(1));
}

/// Arguments with which cargo runs the program with the engine; the profile and the manifest’s path follow.
#[cfg(not(feature = "engine"))]
const WITH_ENGINE: &str = "run --quiet --package xtask --features engine";
