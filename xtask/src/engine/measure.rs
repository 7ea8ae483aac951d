//! `cargo xtask measure`: measures every factory preset, and writes the page with the results.

use crate::shell::root;
use sprung::internals::measures::preset::{Measure, SYNTHESIS, is_sustained, measure};
use sprung::preset::{Family, Preset};
use std::fmt::Write;
use std::fs;

/// The page, from the top of the project.
const PAGE: &str = "assets/measures/results.md";

/// The figures of all presets, and the head of their table.
const FIGURES: [&str; 11] = [
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
];
const HEAD: &str = "| preset | attack flatness, dB | above 2 kHz, dB | motion, dB | partials | T60 ÷ recording | timbre by velocity, dB | \
     repeated strike, dB | loudness, LUFS | over keys, LU | chord’s peak, dBFS | limited, dB |\n\
     |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";

/// Those of presets that last as long as a key is held.
const HELD: [&str; 4] = ["valleys between partials", "entry of partials", "wobble at one rate", "change of colour"];
const HELD_HEAD: &str = "| held | valleys between partials, dB | entry of partials, ms | wobble at one rate | change of colour, octaves |\n\
     |---|--:|--:|--:|--:|\n";

/// Measures the bank and writes the page.
pub(crate) fn run() -> Result<(), String> {
    let mut page = String::from(
        "# How the factory's presets measure\n\n\
         Written by `cargo xtask measure`. `cargo test --release --test analysis bank` holds every preset to these figures, but for those\n\
         tagged *synthesis*, which are no instruments and need no noise, motion or partials. A figure that is not as it is to be is\n\
         bold. Recordings are those of `recordings.toml`, beside this page. What is measured of held sounds beside that is shown, and holds\n\
         nothing to any figure.\n",
    );
    for family in Family::ALL {
        let presets = Preset::factory().iter().filter(|preset| preset.guide.family == Some(*family));
        let of = |preset: &'static Preset| match measure(preset) {
            Ok(measures) => Ok((preset, measures)),
            Err(error) => Err(format!("{}: {error}", preset.name)),
        };
        let measured = presets.map(of).collect::<Result<Vec<_>, _>>()?;
        let held: Vec<_> = measured.iter().filter(|(preset, _)| is_sustained(preset)).collect();
        if !measured.is_empty() {
            let rows: String = measured.iter().map(|(preset, measures)| row(preset, measures, &FIGURES)).collect();
            let _ = write!(page, "\n## {}\n\n{HEAD}{rows}", family.name().replace('_', " "));
        }
        if !held.is_empty() {
            let rows: String = held.iter().map(|(preset, measures)| row(preset, measures, &HELD)).collect();
            let _ = write!(page, "\n{HELD_HEAD}{rows}");
        }
    }
    let path = root().join(PAGE);
    fs::write(&path, page).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

/// A row of a table: these figures of a preset, in bold where one is not as it is to be.
fn row(preset: &Preset, measures: &[Measure], figures: &[&str]) -> String {
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
    format!("| {}{} | {} |\n", preset.name, if is_free { " *(synthesis)*" } else { "" }, cells.join(" | "))
}
