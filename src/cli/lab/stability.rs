//! `sprung lab stability`.

use super::deliver::{Files, drawn};
use super::system::MethodArgs;
use super::table::{aligned, row};
use sprung::internals::lab::stability::csv;
use sprung::internals::text::measured;
use sprung::lab::Method;
use sprung::lab::figure::{Region, StabilityFigure};
use sprung::lab::stability::{cell, limit, spaced, theory};
use sprung::{Error, Result};

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct Args {
    #[command(flatten)]
    methods: MethodArgs,
    /// Longest ω·h of the figure, in rad, 0.1-100
    #[arg(long, default_value_t = 4.0, value_name = "RAD")]
    longest: f64,
    /// Greatest damping ratio ζ of the figure, 0.01-2
    #[arg(long, default_value_t = 1.5, value_name = "RATIO")]
    zeta: f64,
    /// Cells of the figure in each direction, 4-400
    #[arg(long, default_value_t = 80, value_name = "N", value_parser = clap::value_parser!(u16).range(4..=400))]
    grid: u16,
    #[command(flatten)]
    files: Files,
}

/// Damping ratios of the table.
const ZETAS: [f64; 4] = [0.0, 0.1, 0.5, 1.0];

pub(super) fn run(args: &Args) -> Result<()> {
    for (name, value, low, high) in [("--longest", args.longest, 0.1, 100.0), ("--zeta", args.zeta, 0.01, 2.0)] {
        if !(low..=high).contains(&value) {
            return Err(Error::value(name, format!("{value} is out of range: expected {low} to {high}")));
        }
    }
    let methods = args.methods.named()?;
    let deliveries = args.files.open(&["svg", "png"])?;
    let table = table(&methods)?;
    let drawing = deliveries.format().is_some() || deliveries.wants_csv();
    let regions = if drawing { regions(args, &methods)? } else { Vec::new() };
    deliveries.finish(
        |format| drawn(&StabilityFigure(&regions), format),
        |out| out.write_all(csv(&regions).as_bytes()),
        &table,
    )
}

fn regions(args: &Args, methods: &[Method]) -> Result<Vec<Region>> {
    let count = usize::from(args.grid);
    let steps = spaced(args.longest / count as f64, args.longest, count);
    let zetas = spaced(0.0, args.zeta, count);
    let region = |method: &Method| {
        let row = |zeta: &f64| steps.iter().map(|omega_h| cell(*method, *omega_h, *zeta)).collect();
        Ok(Region { method: *method, rows: zetas.iter().map(row).collect::<Result<_>>()? })
    };
    methods.iter().map(region).collect()
}

fn table(methods: &[Method]) -> Result<String> {
    let mut rows = vec![row(["longest ω·h / rad at", "ζ = 0", "(theory)", "ζ = 0.1", "ζ = 0.5", "ζ = 1"])];
    for method in methods {
        let mut cells = vec![method.key().to_owned()];
        for zeta in ZETAS {
            cells.push(word(limit(*method, zeta)?));
            if zeta == 0.0 {
                cells.push(word(theory(*method, zeta)));
            }
        }
        rows.push(cells);
    }
    Ok(aligned(&rows))
}

fn word(limit: f64) -> String {
    if limit == 0.0 {
        "never".to_owned()
    } else if limit.is_finite() {
        measured(limit)
    } else {
        "any".to_owned()
    }
}
