//! Formats the tables of `benches/README.md`.

use super::measured::Measured;
use super::peers::Peer;
use super::songs::Song;
use sprung::internals::Level;
use std::fmt::Write as _;

const WORKS: [&str; 3] = ["ringing", "modulated", "driven"];
const RATE: f64 = 48_000.0;
/// Duration of a block of 64 frames, in seconds.
const BLOCK: f64 = 64.0 / RATE;

/// Converts frames per second to the unit of a table.
type Unit = fn(f64) -> f64;

/// All tables.
pub(super) fn all(measured: &Measured, peers: &[Peer], songs: &[Song], cpu: &str) -> String {
    let levels: Vec<Level> = Level::ALL.into_iter().rev().filter(|level| level.is_available()).collect();
    let mut text = machine(measured, cpu);
    text += &banks(measured, &levels);
    text += &instrument(measured, &levels);
    text += &whole_songs(songs);
    text += &beside(measured, peers, levels[0]);
    text += &sizes(measured, &levels);
    text
}

/// A number with three significant digits, or a dash.
fn figure(value: Option<f64>) -> String {
    match value {
        None => "–".to_owned(),
        Some(value) if value >= 100.0 => format!("{value:.0}"),
        Some(value) if value >= 10.0 => format!("{value:.1}"),
        Some(value) => format!("{value:.2}"),
    }
}

fn ratio(value: Option<f64>, to: Option<f64>) -> Option<f64> {
    Some(value? / to?)
}

fn head(first: &str, columns: impl Iterator<Item = String>) -> String {
    let columns: Vec<String> = columns.collect();
    format!("| {first} | {} |\n|---|{}\n", columns.join(" | "), "---|".repeat(columns.len()))
}

fn machine(measured: &Measured, cpu: &str) -> String {
    let clock = measured.rate("probe/clock");
    let per_cycle = |name: &str, lanes: f64| {
        let vectors = measured.rate(&format!("probe/{name}")).map(|rate| rate / lanes);
        figure(ratio(vectors, clock))
    };
    format!(
        "{cpu}, one core, {} GHz by the probe; vectors of `a·b + c` a cycle: {} of AVX2, {} of AVX-512.\n\
         The plain loop over 1,024 oscillators: {} G.\n\n",
        figure(clock.map(|clock| clock / 1e9)),
        per_cycle("avx2", 8.0),
        per_cycle("avx512", 16.0),
        figure(plain(measured).map(|rate| rate / 1e9)),
    )
}

fn plain(measured: &Measured) -> Option<f64> {
    measured.rate("plain loop/1024 modes")
}

fn bank(measured: &Measured, work: &str, level: Level, modes: usize, frames: usize) -> Option<f64> {
    measured.rate(&format!("{work}/{}/{modes} modes x {frames} frames", level.name()))
}

fn banks(measured: &Measured, levels: &[Level]) -> String {
    let mut text = "### 16 banks of 64 modes, blocks of 64 frames: G, and times the plain loop\n\n".to_owned();
    text += &head("", levels.iter().map(|level| level.name().to_owned()));
    for work in WORKS {
        let cell = |level: &Level| {
            let rate = bank(measured, work, *level, 1024, 64);
            format!("{} ({}×)", figure(rate.map(|rate| rate / 1e9)), figure(ratio(rate, plain(measured))))
        };
        let cells: Vec<String> = levels.iter().map(cell).collect();
        let _ = writeln!(text, "| {work} | {} |", cells.join(" | "));
    }
    text + "\n"
}

fn instrument(measured: &Measured, levels: &[Level]) -> String {
    let mut text = "### The instrument: 16 notes of 64 modes at 48 kHz, blocks of 64 frames\n\n".to_owned();
    text += &head("", levels.iter().map(|level| level.name().to_owned()));
    let share: Unit = |rate| 64.0 / rate / BLOCK * 100.0;
    let times: Unit = |rate| rate / RATE;
    let rows: [(&str, &str, Unit); 7] = [
        ("all struck in one block, % of its time", "note-on", share),
        ("as many of the Grand Piano", "Grand Piano", share),
        ("of the Crash, of 486 modes", "Crash", share),
        ("of the Clash Cymbals, of 500 modes", "Clash Cymbals", share),
        ("ringing, × real time", "ringing", times),
        ("bend, vibrato and sweep moving, × real time", "moving", times),
        ("and 16 routes, 3 oscillators and 2 envelopes a voice, × real time", "routed", times),
    ];
    for (title, name, unit) in rows {
        let cell = |level: &Level| figure(measured.rate(&format!("synth/{}/{name}", level.name())).map(unit));
        let cells: Vec<String> = levels.iter().map(cell).collect();
        let _ = writeln!(text, "| {title} | {} |", cells.join(" | "));
    }
    let voices = [1, 2, 4, 8, 16, 32, 64];
    text += "\n";
    text += &head("ringing voices", voices.iter().map(usize::to_string));
    let cell = |voices: &usize| {
        let block = measured.rate(&format!("voices/{voices}")).map(|rate| 64.0 / rate * 1e9);
        figure(block.map(|block| block / *voices as f64))
    };
    let cells: Vec<String> = voices.iter().map(cell).collect();
    let _ = writeln!(text, "| ns a voice and block | {} |", cells.join(" | "));
    let silent = |name: &str| figure(measured.rate(&format!("idle/{name}")).map(|rate| 64.0 / rate * 1e9));
    let song = |threads: usize| figure(measured.rate(&format!("suite.mid/{threads} threads")).map(times));
    let _ = writeln!(
        text,
        "\nA silent block takes {} ns of a synth and {} ns of an ensemble. The demo song: {} × real time on one thread,\n\
         {} × on two.\n",
        silent("synth"),
        silent("ensemble"),
        song(1),
        song(2),
    );
    text
}

fn whole_songs(songs: &[Song]) -> String {
    let mut text =
        "### Whole songs on one thread: user seconds, with what each program reads and writes\n\n".to_owned();
    text += &head("song", ["Sprung", "FluidSynth", "times FluidSynth's"].into_iter().map(str::to_owned));
    let mut ratios: Vec<f64> = songs.iter().map(Song::ratio).collect();
    for (song, ratio) in songs.iter().zip(&ratios) {
        let [sprung, fluidsynth, ratio] = [song.sprung, song.fluidsynth, *ratio].map(|value| figure(Some(value)));
        let _ = writeln!(text, "| {} | {sprung} | {fluidsynth} | {ratio} |", song.name);
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios.get(ratios.len() / 2).copied();
    let _ = writeln!(
        text,
        "\nThe median is {} times; the dearest song {} times.\n",
        figure(median),
        figure(ratios.last().copied())
    );
    text
}

fn beside(measured: &Measured, peers: &[Peer], best: Level) -> String {
    let ours = |work: &str, level: &str| measured.rate(&format!("peers/sprung {work} {level}"));
    let mut text = "### Peers, 16 × 64 modes: G, and how many times that Sprung does\n\n".to_owned();
    let columns = ["version", "instructions", "G", "Sprung, ringing", "Sprung, driven", "× real time"];
    text += &head("", columns.into_iter().map(str::to_owned));
    let mut row = |name: &str, version: &str, instructions: &str, giga: Option<f64>, remark: &str| {
        let level = if instructions == "avx2" { "avx2" } else { best.name() };
        let times = |work| {
            let times = ratio(ours(work, level).map(|rate| rate / 1e9), giga);
            if times.is_some() { format!("{}× ({level})", figure(times)) } else { figure(None) }
        };
        let (ringing, driven) = (times("ringing"), times("driven"));
        let _ = writeln!(
            text,
            "| {name} | {version} | {instructions} | {} | {ringing} | {driven} | {remark} |",
            figure(giga)
        );
    };
    for name in ["BiquadBank tick", "BiquadBank process", "resonator"] {
        let giga = measured.rate(&format!("peers/fundsp {name}")).map(|rate| rate / 1e9);
        let times = figure(giga.map(|giga| giga * 1e9 / 1024.0 / RATE));
        row(&format!("fundsp {name}"), "0.23", "avx2", giga, &times);
    }
    for Peer { name, version, instructions, giga, remark } in peers {
        row(name, version, instructions, *giga, remark);
    }
    text + "\n"
}

fn sizes(measured: &Measured, levels: &[Level]) -> String {
    let mut text = "### All sizes: G\n\n".to_owned();
    text += &head("work, modes, frames a block", levels.iter().map(|level| level.name().to_owned()));
    for work in WORKS {
        for modes in [1, 8, 64, 1024, 4096] {
            for frames in [32, 64, 512] {
                let cell = |level: &Level| figure(bank(measured, work, *level, modes, frames).map(|rate| rate / 1e9));
                let cells: Vec<String> = levels.iter().map(cell).collect();
                let _ = writeln!(text, "| {work}, {modes}, {frames} | {} |", cells.join(" | "));
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_three_digits() {
        for (value, text) in [(1.234, "1.23"), (12.34, "12.3"), (123.4, "123")] {
            assert_eq!(figure(Some(value)), text);
        }
        assert_eq!(figure(ratio(Some(3.0), Some(2.0))), "1.50");
        assert_eq!(figure(ratio(None, Some(2.0))), "–");
    }

    #[test]
    fn a_head_has_a_rule_as_wide() {
        assert_eq!(head("a", ["b".to_owned(), "c".to_owned()].into_iter()), "| a | b | c |\n|---|---|---|\n");
    }
}
