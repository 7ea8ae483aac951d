//! `cargo xtask callgrind`: instructions per mode and frame of the kernels, counted by valgrind, against those kept.
//!
//! Counts do not depend on how busy the machine is. Valgrind has no AVX-512.

use crate::shell::{cargo, root};
use sprung::dsp::CONTROL_FRAMES;
use sprung::dsp::exciter::Drive;
use sprung::dsp::mode_bank::{Coupling, Law, Level, MAX_MODES, ModeBank, ModeSetup};
use std::fmt::Write as _;
use std::process::Command;

/// The counts as last accepted: level, work, instructions per mode and frame.
const KEPT: &str = "benches/instructions.txt";

/// A count may grow by this share.
const ALLOWANCE: f64 = 0.05;

const LEVELS: [Level; 3] = [Level::Scalar, Level::Sse2, Level::Avx2];
const WORKS: [&str; 3] = ["ringing", "modulated", "driven"];

/// Counts, and compares with what is kept; or keeps what is counted.
pub(crate) fn run(accept: bool) -> Result<(), String> {
    let built = cargo("build --release --quiet --package xtask").status().map_err(|error| error.to_string())?;
    if !built.success() {
        return Err("the release build of xtask fails".to_owned());
    }
    let mut counts = String::new();
    for level in LEVELS.into_iter().filter(|level| level.is_available()) {
        for work in WORKS {
            // The difference of two runs is free of starting up.
            let (few, many) = (count(level, work, 100)?, count(level, work, 1100)?);
            let each = (many - few) / (1000 * MAX_MODES * CONTROL_FRAMES) as f64;
            let _ = writeln!(counts, "{} {work} {each:.3}", level.name());
        }
    }
    print!("{counts}");
    let path = root().join(KEPT);
    if accept {
        return std::fs::write(&path, counts).map_err(|error| format!("{}: {error}", path.display()));
    }
    let kept = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let (kept, found) = (parse(&kept), parse(&counts));
    if found.is_empty() {
        return Err("nothing was counted".to_owned());
    }
    let grown: Vec<String> = found
        .iter()
        .filter_map(|(name, now)| {
            let before = kept.iter().find(|(kept, _)| kept == name).map(|(_, count)| *count);
            let fine = before.is_some_and(|before| *now <= before * (1.0 + ALLOWANCE));
            let before = before.map_or("none".to_owned(), |before| before.to_string());
            (!fine).then(|| format!("{name}: {now} instructions, {before} kept"))
        })
        .collect();
    if grown.is_empty() {
        return Ok(());
    }
    Err(format!("{}\naccept with: cargo xtask callgrind --accept", grown.join("\n")))
}

fn parse(counts: &str) -> Vec<(String, f64)> {
    let line = |line: &str| {
        let (name, count) = line.rsplit_once(' ')?;
        Some((name.to_owned(), count.parse().ok()?))
    };
    counts.lines().filter_map(line).collect()
}

/// Instructions of a whole run of [`work`].
fn count(level: Level, work: &str, ticks: usize) -> Result<f64, String> {
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(root().join("target/release/xtask"));
    command.args(["callgrind-work", level.name(), work, &ticks.to_string()]);
    let output = command.output().map_err(|error| format!("valgrind: {error}; is it installed?"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    let collected = text.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    collected.filter(|_| output.status.success()).ok_or_else(|| format!("valgrind counted nothing:\n{text}"))
}

/// What is counted: a bank of 64 modes for some control ticks.
pub(crate) fn work(level: &str, work: &str, ticks: usize) -> Result<(), String> {
    let named = LEVELS.into_iter().find(|named| named.name() == level);
    if !named.is_some_and(Level::force) {
        return Err(format!("this CPU has no level {level}"));
    }
    let mut bank = ModeBank::new(48_000.0);
    let mode = |m: usize| ModeSetup { frequency: 100.0 + 310.0 * m as f64, t60: 10_000.0, left: 1.0, right: 1.0 };
    bank.load(Law::Exact, (0..MAX_MODES).map(mode));
    (0..MAX_MODES).for_each(|m| bank.set_coupling(m, Coupling { push: 1.0, pull: 0.0, noise: 0.0 }));
    let mut drive = Drive::NONE;
    drive.pulse[0] = 1.0;
    for tick in 0..ticks {
        let ratio = if work == "modulated" { 1.0 + 0.01 * (tick % 7) as f64 } else { 1.0 };
        bank.sweep_to(ratio, CONTROL_FRAMES);
        let driven = tick == 0 || work == "driven";
        std::hint::black_box(bank.render(driven.then_some(&drive), CONTROL_FRAMES));
    }
    Ok(())
}
