//! `sprung lab converge`.

use super::deliver::{Files, drawn};
use super::system::{MethodArgs, SystemArgs};
use super::table::{aligned, row};
use sprung::Result;
use sprung::internals::lab::convergence::csv;
use sprung::internals::text::measured;
use sprung::lab::Order;
use sprung::lab::convergence::{Convergence, converge, halving};
use sprung::lab::figure::ConvergenceFigure;

#[derive(clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    methods: MethodArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// How long to integrate, in s
    #[arg(long, default_value_t = 1.0, value_name = "S", allow_negative_numbers = true)]
    end: f64,
    /// Steps in s, at least three, separated by commas [default: ten, each half the one before, from 0.01]
    #[arg(long, value_delimiter = ',', value_name = "S,…", allow_negative_numbers = true)]
    steps: Vec<f64>,
    #[command(flatten)]
    files: Files,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let (system, start) = args.system.build()?;
    let steps = if args.steps.is_empty() { halving(0.01, 10) } else { args.steps.clone() };
    let methods = args.methods.for_system(&system, &steps)?;
    let deliveries = args.files.open(&["svg", "png"])?;
    let found = converge(&methods, &system, start, &steps, args.end)?;
    deliveries.finish(
        |format| drawn(&ConvergenceFigure(&found), format),
        |out| out.write_all(csv(&found).as_bytes()),
        &table(&found),
    )
}

fn table(found: &[Convergence]) -> String {
    let mut rows = vec![row(["method", "order", "fitted", "error at the longest step / m", "at the shortest"])];
    for convergence in found {
        let known = match convergence.method.order() {
            Order::Power(power) => power.to_string(),
            Order::Exact => "exact".to_owned(),
        };
        let fitted = convergence.order.map_or("rounding".to_owned(), |order| format!("{order:.2}"));
        let error = |longest: bool| {
            let points = convergence.points.iter();
            let by_step = |a: &&_, b: &&_| step(a).total_cmp(&step(b));
            let point = if longest { points.max_by(by_step) } else { points.min_by(by_step) };
            measured(point.map_or(f64::NAN, |point| point.error))
        };
        rows.push(vec![convergence.method.key().to_owned(), known, fitted, error(true), error(false)]);
    }
    aligned(&rows)
}

fn step(point: &sprung::lab::convergence::Point) -> f64 {
    point.h
}
