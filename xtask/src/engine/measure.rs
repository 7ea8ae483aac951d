//! `cargo xtask measure`: measures every factory preset, and writes the page with the results.

use crate::shell::root;
use sprung::analysis::measures::preset::{Measure, SYNTHESIS, is_sustained, measure};
use sprung::preset::{Family, Preset};
use std::fmt::Write;
use std::fs;

/// The page, from the top of the project.
const PAGE: &str = "assets/measures/results.md";

/// Measures the bank and writes the page.
pub(crate) fn run() -> Result<(), String> {
    let mut page = String::from(
        "# How the factory's presets measure\n\n\
         Written by `cargo xtask measure`. `cargo test --release --test analysis bank` holds every preset to these figures, but for those\n\
         tagged *synthesis*, which are no instruments and need no noise, motion or partials. A figure that is not as it is to be is\n\
         bold. Recordings are those of `recordings.toml`, beside this page.\n",
    );
    for family in Family::ALL {
        let presets = || Preset::factory().iter().filter(|preset| preset.guide.family == Some(*family));
        let rows = presets().map(row).collect::<Result<Vec<_>, _>>()?;
        if rows.is_empty() {
            continue;
        }
        let _ = write!(
            page,
            "\n## {}\n\n| preset | attack flatness, dB | above 2 kHz, dB | motion, dB | partials | T60 ÷ recording | timbre by velocity, dB | \
             repeated strike, dB | loudness, LUFS | over keys, LU | chord’s peak, dBFS | limited, dB |\n\
             |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n{}",
            family.name().replace('_', " "),
            rows.concat()
        );
        let held = presets().filter(|preset| is_sustained(preset)).map(held_row).collect::<Result<Vec<_>, _>>()?;
        if !held.is_empty() {
            let _ = write!(
                page,
                "\n| held | valleys between partials, dB | entry of partials, ms | wobble at one rate | change of colour, octaves |\n\
                 |---|--:|--:|--:|--:|\n{}",
                held.concat()
            );
        }
    }
    let path = root().join(PAGE);
    fs::write(&path, page).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

/// A row of a table: these figures of a preset, in bold where one is not as it is to be.
fn cells(preset: &Preset, figures: &[&str]) -> Result<String, String> {
    let measures = measure(preset).map_err(|error| format!("{}: {error}", preset.name))?;
    let figure = |name: &&str| match measures.iter().find(|measure| measure.name == *name) {
        Some(measure @ Measure { value: Some(value), .. }) => {
            let is_share = ["times", "octaves"].contains(&measure.unit);
            let digits = usize::from(is_share) + usize::from(!measure.unit.is_empty());
            let text = format!("{value:.digits$}");
            if measure.is_kept() { text } else { format!("**{text}**") }
        }
        _ => "–".to_owned(),
    };
    let is_free = preset.tags.iter().any(|tag| tag == SYNTHESIS);
    let cells: Vec<String> = figures.iter().map(figure).collect();
    Ok(format!("| {}{} | {} |\n", preset.name, if is_free { " *(synthesis)*" } else { "" }, cells.join(" | ")))
}

/// A row of the table of all presets.
fn row(preset: &Preset) -> Result<String, String> {
    cells(
        preset,
        &[
            "attack flatness",
            "energy above 2 kHz",
            "motion",
            "partials",
            "T60 against a recording",
            "timbre by velocity",
            "repeated strike",
            "loudness",
            "loudness over keys",
            "chord’s true peak",
            "limiter on a chord",
        ],
    )
}

/// A row of the table of presets that last as long as a key is held.
fn held_row(preset: &Preset) -> Result<String, String> {
    cells(preset, &["valleys between partials", "entry of partials", "wobble at one rate", "change of colour"])
}
