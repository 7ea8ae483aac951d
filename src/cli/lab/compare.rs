//! `sprung lab compare`.

use super::deliver::{Files, drawn};
use super::system::{MethodArgs, SystemArgs};
use super::table::{aligned, row};
use sprung::Result;
use sprung::internals::lab::report;
use sprung::internals::text::{measured, short};
use sprung::lab::comparison::{Comparison, Setup};
use sprung::lab::figure::ComparisonFigure;
use sprung::lab::trajectory::Trajectory;

#[derive(clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    methods: MethodArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// How long to integrate, in s
    #[arg(long, default_value_t = 5.0, value_name = "S", allow_negative_numbers = true)]
    end: f64,
    /// Steps in s, separated by commas
    #[arg(
        long,
        default_value = "0.01,0.05,0.15",
        value_delimiter = ',',
        value_name = "S,…",
        allow_negative_numbers = true
    )]
    steps: Vec<f64>,
    #[command(flatten)]
    files: Files,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let (system, start) = args.system.build()?;
    let methods = args.methods.for_system(&system, &args.steps)?;
    let deliveries = args.files.open(&["html", "svg", "png"])?;
    let comparison = Comparison::new(Setup { system, start, end: args.end, steps: args.steps.clone(), methods })?;
    let figure = |format: &str| match format {
        "html" => Ok(report::html(&comparison).into_bytes()),
        _ => drawn(&ComparisonFigure(&comparison), format),
    };
    deliveries.finish(figure, |out| comparison.write_csv(out), &table(&comparison))
}

fn table(comparison: &Comparison) -> String {
    let heads = ["method", "step / s", "greatest error / m", "error at the end / m", "energy / true", ""];
    let mut rows = vec![row(heads)];
    for run in comparison.runs.iter().flatten() {
        rows.push(vec![
            run.method.key().to_owned(),
            short(run.h),
            measured(run.worst_error),
            measured(run.end_error),
            measured(comparison.energy_ratio(run)),
            verdict(comparison, run).to_owned(),
        ]);
    }
    aligned(&rows)
}

/// The behaviour of a run in one word.
fn verdict(comparison: &Comparison, run: &Trajectory) -> &'static str {
    let (size, swell) = (comparison.size(), comparison.swell(run));
    if run.worst_error <= 1e-9 * size {
        "exact"
    } else if run.worst_error > 10.0 * size {
        "explodes"
    } else if swell > 1.1 {
        "grows"
    } else if swell < 0.9 {
        "shrinks"
    } else if run.worst_error < 0.01 * size {
        "close"
    } else {
        "drifts"
    }
}
