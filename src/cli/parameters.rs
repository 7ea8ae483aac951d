//! `sprung params`: the parameter table as text, Markdown or JSON.

use super::terminal::print;
use serde_json::json;
use sprung::Result;
use sprung::internals::request::quantity::decimal;
use sprung::params::{Change, Curve, PARAMS, ParamInfo, Unit};
use std::fmt::Write;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung params
  sprung params --json | jq '.[] | select(.section == \"Pitch\").id'";

#[derive(clap::Args)]
pub(super) struct Args {
    /// Print JSON
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print a Markdown table
    #[arg(long)]
    markdown: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    print(&match args {
        Args { json: true, .. } => format!("{:#}\n", PARAMS.iter().map(to_json).collect::<serde_json::Value>()),
        Args { markdown: true, .. } => markdown(),
        _ => text(),
    })
}

fn range(info: &ParamInfo) -> String {
    match info.unit {
        Unit::Choice => info.choices.join(", "),
        _ => format!("{} to {}", info.format(info.min), info.format(info.max)),
    }
}

fn text() -> String {
    let width =
        |cell: &dyn Fn(&ParamInfo) -> String| PARAMS.iter().map(|info| cell(info).chars().count()).max().unwrap_or(0);
    let default = |info: &ParamInfo| info.format(info.default);
    let (id, ranges, defaults) = (width(&|info| info.id.to_owned()), width(&range), width(&default));
    let mut out = format!("{:id$}    {:ranges$}  {:defaults$}  * can be moved by routes\n", "id", "range", "default");
    for info in PARAMS {
        let (mark, help) = (if info.is_modulatable() { '*' } else { ' ' }, info.help);
        let _ = writeln!(out, "{:id$} {mark}  {:ranges$}  {:defaults$}  {help}", info.id, range(info), default(info));
    }
    out
}

fn markdown() -> String {
    let mut out = "| id | name | unit | range | default | meaning |\n|---|---|---|---|---|---|\n".to_owned();
    for info in PARAMS {
        let (unit, default) = (info.unit.symbol(), info.format(info.default));
        let _ =
            writeln!(out, "| `{}` | {} | {unit} | {} | {default} | {} |", info.id, info.name, range(info), info.help);
    }
    out
}

fn to_json(info: &ParamInfo) -> serde_json::Value {
    json!({
        "id": info.id,
        "name": info.name,
        "section": info.section,
        "unit": info.unit.symbol(),
        "min": decimal(info.min),
        "max": decimal(info.max),
        "default": decimal(info.default),
        "choices": info.choices,
        "curve": match info.curve {
            Curve::Linear => "linear",
            Curve::Logarithmic => "logarithmic",
        },
        "change": match info.change {
            Change::NextNote => json!("next note"),
            Change::AtOnce => json!("at once"),
            Change::Smoothed(ms) => json!({ "smoothed_ms": ms }),
        },
        "modulatable": info.is_modulatable(),
        "help": info.help,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_has_every_parameter() {
        assert_eq!(text().lines().count(), PARAMS.len() + 1);
        let markdown = markdown();
        assert!(markdown.lines().all(|line| line.matches('|').count() == 7), "{markdown}");
        assert!(markdown.contains("| `decay` | Decay | s | 5 ms to 60 s | 1 s | Time in which"), "{markdown}");
        let decay = PARAMS.iter().map(to_json).find(|row| row["id"] == "decay").unwrap();
        assert_eq!((decay["min"].as_f64(), decay["max"].as_f64()), (Some(0.005), Some(60.0)));
    }
}
