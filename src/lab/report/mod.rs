//! Writes a comparison as one HTML file that works offline: interactive charts, an animated mass per method, tables.

use super::comparison::Comparison;
use super::energy::Energy;
use super::method::{Method, Order};
use super::system::{Spring, State, System};
use super::trajectory::Trajectory;
use crate::figure::page;
use crate::text::number::{measured, short};
use serde_json::{Value, json};

const PAGE: &str = include_str!("report.html");
const SCRIPT: &str = include_str!("report.js");

/// Maximum number of states of one run in the page; longer runs are thinned out.
const MOST_POINTS: usize = 2000;
/// Methods shown at first: one each that explodes, shrinks, drifts, is accurate enough, and is exact.
const SHOWN: [Method; 5] =
    [Method::ExplicitEuler, Method::ImplicitEuler, Method::SymplecticEuler, Method::RungeKutta4, Method::SynthExact];

/// Makes the page.
pub fn html(comparison: &Comparison) -> String {
    page::fill(PAGE, |name| match name {
        "style" => page::STYLE.to_owned(),
        "script" => SCRIPT.to_owned(),
        // A "</script>" in the data would end the script.
        "data" => data(comparison).to_string().replace('<', "\\u003c"),
        "summary" => summary(comparison),
        "methods" => checkboxes(comparison),
        "steps" => radios(comparison),
        "tables" => tables(comparison),
        _ => sources(comparison),
    })
}

fn summary(comparison: &Comparison) -> String {
    let setup = &comparison.setup;
    let System { mass, stiffness, damping, target, spring, force } = setup.system;
    let law = match spring {
        Spring::Linear => "a spring of".to_owned(),
        Spring::Duffing { cubic } => format!("a Duffing spring of {} N/m³ and", short(cubic)),
        Spring::Pendulum => "a pendulum's restoring force of".to_owned(),
    };
    let mut text = format!(
        "A mass of {} kg on {law} {} N/m with a damper of {} kg/s, let go at {} m with {} m/s and followed for {} s.",
        short(mass),
        short(stiffness),
        short(damping),
        short(setup.start.x),
        short(setup.start.v),
        short(setup.end)
    );
    if target != 0.0 {
        text += &format!(" The spring pulls to {} m.", short(target));
    }
    if force.amplitude != 0.0 {
        text += &format!(" A force of {} N at {} Hz drives it.", short(force.amplitude), short(force.frequency));
    }
    if comparison.runs.iter().flatten().any(|run| stride(run) > 1) {
        text += &format!(" Runs of more than {MOST_POINTS} steps are drawn with every few of them.");
    }
    text
}

/// Only every n-th state of a run is in the page: returns this n.
fn stride(run: &Trajectory) -> usize {
    run.states.len().div_ceil(MOST_POINTS).max(1)
}

fn checkboxes(comparison: &Comparison) -> String {
    let methods = &comparison.setup.methods;
    let known = methods.iter().any(|method| SHOWN.contains(method));
    let label = |(n, method): (usize, &Method)| {
        let dashed = if (n / 6) % 2 == 1 { " dashed" } else { "" };
        let checked = if !known || SHOWN.contains(method) { " checked" } else { "" };
        format!(
            "<label><input type=\"checkbox\" value=\"{}\"{checked}><svg class=\"swatch\" viewBox=\"0 0 38 12\" \
             aria-hidden=\"true\"><line class=\"series s{}{dashed}\" x1=\"0\" x2=\"38\" y1=\"6\" y2=\"6\"/></svg>{}</label>\n",
            method.key(),
            n % 6,
            method.title()
        )
    };
    methods.iter().enumerate().map(label).collect()
}

fn radios(comparison: &Comparison) -> String {
    let steps = &comparison.setup.steps;
    let label = |(n, h): (usize, &f64)| {
        let checked = if n == steps.len() / 2 { " checked" } else { "" };
        format!("<label><input type=\"radio\" name=\"step\" value=\"{n}\"{checked}>{} s</label>\n", short(*h))
    };
    steps.iter().enumerate().map(label).collect()
}

fn tables(comparison: &Comparison) -> String {
    let mut html = String::new();
    for (n, h) in comparison.setup.steps.iter().enumerate() {
        html += &format!("<div class=\"scroll\"><table><caption>Steps of {} s</caption>\n<thead><tr>", short(*h));
        for head in ["method", "greatest error / m", "error at the end / m", "energy at the end / true"] {
            html += &format!("<th scope=\"col\">{head}</th>");
        }
        html += "</tr></thead>\n<tbody>\n";
        for run in comparison.runs.iter().filter_map(|runs| runs.get(n)) {
            html += &format!(
                "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                run.method.title(),
                measured(run.worst_error),
                measured(run.end_error),
                measured(comparison.energy_ratio(run))
            );
        }
        html += "</tbody></table></div>\n";
    }
    html
}

fn sources(comparison: &Comparison) -> String {
    let row = |method: &Method| {
        let order = match method.order() {
            Order::Power(power) => power.to_string(),
            Order::Exact => "exact".to_owned(),
        };
        let source = method.source().replace('&', "&amp;");
        format!("<tr><th scope=\"row\">{}</th><td>{order}</td><td class=\"text\">{source}</td></tr>\n", method.title())
    };
    comparison.setup.methods.iter().map(row).collect()
}

/// The data that the script draws.
fn data(comparison: &Comparison) -> Value {
    let system = &comparison.setup.system;
    let energy = |state: &State| Energy::of(system, *state).total();
    let truth = &comparison.truth;
    let extent = |value: fn(&State) -> f64| {
        let (low, high) = truth.iter().map(value).fold((0.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        if high > low { [low, high] } else { [-1.0, 1.0] }
    };
    let greatest = truth.iter().map(energy).fold(0.0, f64::max);
    let methods: Vec<Value> = comparison.runs.iter().map(|runs| method(runs, &energy)).collect();
    json!({
        "end": comparison.setup.end,
        "x": extent(|state| state.x),
        "v": extent(|state| state.v),
        "energy": if greatest > 0.0 { greatest } else { 1.0 },
        "truth": states(truth, comparison.truth_step, truth.len().div_ceil(2 * MOST_POINTS).max(1), &energy),
        "methods": methods,
    })
}

fn method(runs: &[Trajectory], energy: &impl Fn(&State) -> f64) -> Value {
    let runs_of: Vec<Value> = runs
        .iter()
        .map(|run| {
            let stride = stride(run);
            let mut value = states(&run.states, run.h, stride, energy);
            value["error"] = run.errors().step_by(stride).map(rounded).collect();
            value["worst"] = rounded(run.worst_error);
            value
        })
        .collect();
    json!({ "title": runs.first().map_or("", |run| run.method.title()), "runs": runs_of })
}

fn states(states: &[State], h: f64, stride: usize, energy: &impl Fn(&State) -> f64) -> Value {
    let series = |value: &dyn Fn(&State) -> f64| -> Value {
        states.iter().step_by(stride).map(|state| rounded(value(state))).collect()
    };
    json!({
        "step": h * stride as f64,
        "x": series(&|state| state.x),
        "v": series(&|state| state.v),
        "energy": series(energy),
    })
}

/// Rounded to six significant digits, more than a chart shows. Null if the value is not finite.
fn rounded(value: f64) -> Value {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { json!(0) } else { Value::Null };
    }
    format!("{value:.5e}").parse::<f64>().map_or(Value::Null, |value| json!(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::comparison::Setup;

    fn page(steps: Vec<f64>, end: f64) -> String {
        let setup = Setup {
            system: System::linear(1.0, 50.0, 0.0).unwrap(),
            start: State { x: 0.5, v: 0.0 },
            end,
            steps,
            methods: Method::ALL.to_vec(),
        };
        html(&Comparison::new(setup).unwrap())
    }

    #[test]
    fn the_page_is_whole_and_needs_nothing_from_elsewhere() {
        let page = page(vec![0.01, 0.05, 0.15], 5.0);
        assert!(!page.contains("{{") && !page.contains("}}\n<"));
        for link in ["http://", "https://", "src=", "@import", "url(//"] {
            let places: Vec<_> = page.match_indices(link).map(|(at, _)| &page[at..at + 40]).collect();
            assert!(places.iter().all(|place| place.starts_with("http://www.w3.org/2000/svg")), "{link}: {places:?}");
        }
        assert_eq!(page.matches("type=\"checkbox\"").count(), 12);
        assert_eq!(page.matches("type=\"radio\"").count(), 3);
        assert_eq!(page.matches("<caption>").count(), 3);
    }

    #[test]
    fn the_data_is_what_was_computed() {
        let page = page(vec![0.05], 1.0);
        let (_, data) = page.split_once("id=\"data\">").unwrap();
        let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
        let run = &data["methods"][0]["runs"][0];
        assert_eq!((run["x"][2].as_f64(), run["energy"][0].as_f64()), (Some(0.4375), Some(6.25)));
        assert_eq!(run["x"].as_array().map(Vec::len), Some(21));
        assert_eq!(data["end"], json!(1.0));
    }

    #[test]
    fn long_runs_are_thinned_and_said_to_be() {
        let page = page(vec![0.001], 10.0);
        assert!(page.contains("every few of them") && page.len() < 3_000_000, "{}", page.len());
    }

    #[test]
    fn numbers_keep_six_digits() {
        assert_eq!(rounded(1.234_567_89e-17), json!(1.23457e-17));
        assert_eq!(rounded(-0.1), json!(-0.1));
        assert_eq!((rounded(0.0), rounded(f64::INFINITY)), (json!(0), Value::Null));
    }
}
