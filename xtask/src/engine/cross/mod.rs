//! `cargo xtask cross`: renders the golden cases on each CPU that this machine has or can imitate, and compares their digests.

mod cases;
mod stopped;
mod target;

use crate::shell::root;
use crate::wine;
use cases::{Accepted, Asked, Outcome};
use sprung::internals::Level;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stopped::Stopped::{self, Failed, Missing};

pub(crate) use target::Target;

/// How to build and what to play.
pub(crate) struct Options<'a> {
    /// The compiler for other targets, in place of the present toolchain's.
    pub(crate) rustc: Option<&'a Path>,
    /// Seconds of each song; 0 leaves the songs out.
    pub(crate) song_seconds: usize,
    /// Only one case of this many; 1 for all.
    pub(crate) every: usize,
    /// Only rows whose name contains this.
    pub(crate) only: Option<&'a str>,
}

/// A row of the table: a CPU, and the name of its instructions there.
struct Row {
    cpu: &'static str,
    level: String,
    target: Target,
    /// The value of `SPRUNG_SIMD`; for WebAssembly, the level for which the program was compiled.
    forced: Level,
}

impl Row {
    /// All rows, this machine's own levels first and QEMU, which takes longest, last.
    fn all() -> Vec<Row> {
        let own = if cfg!(target_arch = "x86_64") { "x86-64" } else { std::env::consts::ARCH };
        let is_own = |level: &Level| match level {
            Level::Scalar => true,
            Level::Sse2 | Level::Avx2 | Level::Avx512 => cfg!(target_arch = "x86_64"),
            Level::Neon => cfg!(target_arch = "aarch64"),
            Level::Simd128 => false,
        };
        let mut rows: Vec<Row> = Level::ALL
            .into_iter()
            .filter(is_own)
            .map(|level| Row { cpu: own, level: level.name().to_owned(), target: Target::Own, forced: level })
            .collect();
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            let level =
                Level::ALL.into_iter().filter(is_own).rfind(|level| level.is_available()).unwrap_or(Level::Scalar);
            let name = format!("{}, by Wine", level.name());
            rows.push(Row { cpu: wine::TARGET, level: name, target: Target::Windows, forced: level });
        }
        for (level, target) in [(Level::Scalar, Target::Wasm), (Level::Simd128, Target::WasmSimd)] {
            let name = format!("{}, in Node", level.name());
            rows.push(Row { cpu: "wasm32", level: name, target, forced: level });
        }
        if !cfg!(target_arch = "aarch64") {
            for level in [Level::Neon, Level::Scalar] {
                let name = format!("{}, by QEMU", level.name());
                rows.push(Row { cpu: "aarch64", level: name, target: Target::Aarch64, forced: level });
            }
        }
        rows
    }

    fn name(&self) -> String {
        format!("{} {}", self.cpu, self.level)
    }

    /// Builds and runs the program.
    fn run(&self, options: &Options) -> Result<(Outcome, Duration), Stopped> {
        if self.target == Target::Own && !self.forced.is_available() {
            return Err(Missing("this CPU does not have it".to_owned()));
        }
        let program = self.target.build(options.rustc)?;
        let start = Instant::now();
        // One process for each core, since WebAssembly has no threads. Of n processes, process k plays the cases k, k + n, k + 2n
        // and so on of those that are requested.
        let processes = std::thread::available_parallelism().map_or(1, usize::from);
        let mut running = Vec::new();
        for first in 0..processes {
            let mut command = self.target.command(&program).map_err(Missing)?;
            let [first, step] = [first, processes].map(|number| number * options.every);
            command.args([first, step, options.song_seconds].map(|number| number.to_string()));
            command.env("SPRUNG_SIMD", self.forced.name());
            let child = command.stdout(Stdio::piped()).spawn();
            running.push(child.map_err(|error| Failed(format!("{}: {error}", program_of(&command))))?);
        }
        let mut lines = Vec::new();
        for child in running {
            let output = child.wait_with_output().map_err(|error| Failed(error.to_string()))?;
            if !output.status.success() {
                return Err(Failed(format!("the program failed: {}", output.status)));
            }
            lines.extend(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned));
        }
        let level = lines.iter().find_map(|line| line.strip_prefix("level ")).unwrap_or("none").to_owned();
        if self.forced.name() != level {
            return Err(Failed(format!("it ran with {level}, not with {}", self.forced.name())));
        }
        let accepted = Accepted::read(&root().join("tests/golden")).map_err(Failed)?;
        let expected = |name: &str| options.song_seconds > 0 || !name.starts_with("song-");
        let asked = if options.every > 1 { Asked::Printed } else { Asked::Named(&expected) };
        let outcome = accepted.compare(&lines, asked).map_err(Failed)?;
        Ok((outcome, start.elapsed()))
    }
}

fn program_of(command: &Command) -> String {
    command.get_program().to_string_lossy().into_owned()
}

/// Prints a table with a row for each CPU, and a line for each CPU that could not run. Differing bits and failed runs are an
/// error.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let (mut ran, mut missing, mut failures) = (0, Vec::new(), Vec::new());
    // Each row appears when its CPU is done: QEMU takes long.
    println!("| CPU | instructions | cases with the accepted bits | SHA-256 of all | time |\n|---|---|---|---|---|");
    for row in Row::all().iter().filter(|row| options.only.is_none_or(|only| row.name().contains(only))) {
        eprintln!("── {}", row.name());
        match row.run(options) {
            Ok((outcome, time)) => {
                ran += 1;
                println!(
                    "| {} | {} | {} of {} | `{}…` | {} |",
                    row.cpu,
                    row.level,
                    outcome.same,
                    outcome.same + outcome.differing.len(),
                    outcome.digest,
                    duration(time)
                );
                failures.extend(outcome.differing.iter().map(|case| format!("{}: {case}", row.name())));
            }
            Err(Missing(message)) => missing.push(format!("{}: {message}", row.name())),
            Err(Failed(message)) => failures.push(format!("{}: {message}", row.name())),
        }
    }
    let songs = match options.song_seconds {
        0 => "without songs".to_owned(),
        seconds => format!("of each song, at most the first {seconds} s"),
    };
    match options.every {
        1 => println!("\nEvery case, {songs}."),
        every => println!("\nOne case of {every}, {songs}."),
    }
    missing.iter().for_each(|line| println!("not run: {line}"));
    if !failures.is_empty() {
        return Err(failures.join("\n"));
    }
    if ran == 0 { Err("nothing was run".to_owned()) } else { Ok(()) }
}

fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    if seconds < 120 { format!("{seconds} s") } else { format!("{} min", (seconds + 30) / 60) }
}
