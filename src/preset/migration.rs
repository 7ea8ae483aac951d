//! Presets of formats 1 and 2: what their retired parameters and built-in effects did, routes do.

use super::complaints::Complaints;
use super::value::param_value;
use crate::params::retired::{RETIRED, Retired};
use crate::params::{Curve, Param, ParamInfo};
use crate::patch::Patch;
use crate::patch::routes::{MAX_ROUTES, Route, Routes, Source, amount_param};
use std::fmt;
use toml::Table;

/// The first format in which retired parameters are errors.
pub(super) const FIRST_WITHOUT_RETIRED: i64 = 3;

/// A retired parameter that was found in a preset.
#[derive(Clone, Debug, PartialEq)]
pub struct Replaced {
    /// Its id.
    pub id: &'static str,
    /// The parameter whose value has changed because a route moves it from another one.
    pub rebased: Option<Param>,
    /// What replaces it, or why nothing does.
    what: String,
}

impl fmt::Display for Replaced {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "‘{}’ is retired: {}", self.id, self.what)
    }
}

/// What a route is to do in place of a retired parameter or of a built-in effect.
struct Work {
    route: Route,
    /// Knob travel in per cent.
    amount: f64,
    /// The value from which the destination is moved, if it is another.
    base: Option<f64>,
    /// Place that the route has in a new patch.
    place: Option<usize>,
}

/// Takes the retired parameters out of those of a file, and the routes out of a new patch: the format had none. Returns
/// the values, and whether the file has them.
pub(super) fn take(params: &mut Table, patch: &mut Patch, complaints: &mut Complaints) -> Vec<(f32, bool)> {
    patch.routes = Routes::NONE;
    (0..MAX_ROUTES).for_each(|place| patch.set(amount_param(place), 0.0));
    let value = |row: &ParamInfo| {
        let given = params.remove(row.id);
        let read = given.and_then(|value| complaints.take(&format!("params.{}: ", row.id), param_value(row, &value)));
        (read.unwrap_or(row.default), read.is_some())
    };
    RETIRED.iter().map(|retired| &retired.row).map(value).collect()
}

/// Gives a patch the routes that do what the values of retired parameters did, and what was built in. `params` are the
/// others in the file.
pub(super) fn migrate(retired: &[(f32, bool)], params: &Table, patch: &mut Patch, replaced: &mut dyn FnMut(Replaced)) {
    for (Retired { row, replacement }, (value, is_given)) in RETIRED.iter().zip(retired) {
        let work = work(row, f64::from(*value), patch);
        let rebased = work.base.filter(|base| *base as f32 != patch.get(row.param)).map(|_| row.param);
        let is_done = work.amount == 0.0 || add(patch, &work);
        let what = match is_done {
            true if work.amount == 0.0 => "it is 0, and needs nothing in its place".to_owned(),
            true => format!("{replacement} replaces it"),
            false => format!("{replacement} would replace it, but all {MAX_ROUTES} places for routes are taken"),
        };
        if *is_given || !is_done {
            replaced(Replaced { id: row.id, rebased: rebased.filter(|_| is_done), what });
        }
    }
    for (place, (destination, amount)) in [(14, (Param::Tilt, 25.0)), (15, (Param::DecayTilt, -50.0))] {
        let route = Route::linear(Source::Timbre, destination);
        if !add(patch, &Work { route, amount, base: None, place: Some(place) }) {
            let id = destination.info().id;
            let what = format!("brightness no longer moves it, since all {MAX_ROUTES} places for routes are taken");
            replaced(Replaced { id, rebased: None, what });
        }
    }
    // Amounts of places without a route are those of a new patch, unless the file says otherwise.
    for param in (0..MAX_ROUTES).filter(|place| patch.routes.get(*place).is_none()).map(amount_param) {
        if !params.contains_key(param.info().id) {
            patch.values.set(param, param.info().default);
        }
    }
}

/// What does what a value of a retired parameter did.
fn work(row: &ParamInfo, value: f64, patch: &Patch) -> Work {
    let destination = row.param.info();
    let before = f64::from(patch.get(row.param));
    // Knob travel in per cent of a distance: in the parameter's unit, or in octaves where steps are of equal ratio.
    let (min, max) = (f64::from(destination.min), f64::from(destination.max));
    let range = match destination.curve {
        Curve::Linear => max - min,
        Curve::Logarithmic => libm::log2(max / min),
    };
    let share = value * 0.01;
    let (source, distance, base, place) = match row.id {
        // The value at velocity 0 is the base, the rest grows with velocity.
        "hardness_velocity" | "sweep_velocity" => {
            (Source::Velocity, before * share, Some(before * (1.0 - share)), None)
        }
        // One octave of decay for an octave of pitch; the source is ±1 five octaves from the middle.
        "decay_key" => (Source::Key, -5.0 * share, None, None),
        // Twice as long for a velocity of 0, half as long for 1.
        "release_velocity" => (Source::ReleaseVelocity, -2.0 * share, Some(before * libm::exp2(share)), None),
        "wheel_vibrato" => (Source::Wheel, value, None, Some(13)),
        _ => (Source::Pressure, value, None, None),
    };
    Work { route: Route::linear(source, row.param), amount: 100.0 * distance / range, base, place }
}

/// Adds a route, in its own place if that is free, else in the first that is. Returns whether there was one.
fn add(patch: &mut Patch, work: &Work) -> bool {
    let is_free = |place: &usize| patch.routes.get(*place).is_none();
    // The places of a new patch's routes are left to them as long as there are others.
    let Some(place) = work.place.filter(is_free).or_else(|| (0..MAX_ROUTES).find(is_free)) else { return false };
    patch.routes.set(place, Some(work.route));
    patch.set(amount_param(place), work.amount as f32);
    if let Some(base) = work.base {
        patch.set(work.route.destination, base as f32);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::PARAMS;
    use crate::preset::Preset;

    fn load(text: &str) -> (Patch, Vec<String>) {
        let mut told = vec![];
        let text = format!("name = \"a\"\n{text}");
        let preset = Preset::parse_old(&text, "x", &mut |replaced| told.push(replaced.to_string())).unwrap();
        let again = Preset::parse_old(&preset.to_toml(), "x", &mut |replaced| panic!("{replaced}")).unwrap();
        assert_eq!(again, preset, "{}", preset.to_toml());
        (preset.patch, told)
    }

    /// What the routes make of a parameter with these sources, by the law of `engine::modulation`.
    fn moved(patch: &Patch, param: Param, sources: &[(Source, f64)]) -> f64 {
        let info = param.info();
        let source = |wanted: Source| sources.iter().find(|(source, _)| *source == wanted).map_or(0.0, |found| found.1);
        let way: f64 = patch
            .routes
            .iter()
            .filter(|(_, route)| route.destination == param)
            .map(|(place, route)| f64::from(patch.get(amount_param(place))) * 0.01 * source(route.source))
            .sum();
        let (min, max, base) = (f64::from(info.min), f64::from(info.max), f64::from(patch.get(param)));
        match info.curve {
            Curve::Linear => base + way * (max - min),
            Curve::Logarithmic => base * libm::pow(max / min, way),
        }
    }

    #[track_caller]
    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 2e-6 * expected.abs(), "{found}, not {expected}");
    }

    #[test]
    fn retired_parameters_become_routes_that_do_the_same() {
        let (patch, told) = load(
            "format = 2\n[params]\nhardness = 54\nhardness_velocity = \"50 %\"\nsweep = -26\nsweep_velocity = 30\n\
             decay = 7.5\ndecay_key = 45\nrelease = 0.35\nrelease_velocity = 30\nwheel_vibrato = 20\n\
             pressure_vibrato = \"30 ct\"\npressure_damping = 80\n",
        );
        for x in [0.0, 0.25, 1.0] {
            let velocity = [(Source::Velocity, x)];
            assert_near(moved(&patch, Param::Hardness, &velocity), 54.0 * (1.0 - 0.5 * (1.0 - x)));
            assert_near(moved(&patch, Param::Sweep, &velocity), -26.0 * (1.0 - 0.3 * (1.0 - x)));
            let release = 0.35 * libm::exp2(0.3 * (1.0 - 2.0 * x));
            assert_near(moved(&patch, Param::Release, &[(Source::ReleaseVelocity, x)]), release);
            assert_near(moved(&patch, Param::Vibrato, &[(Source::Wheel, x), (Source::Pressure, 0.5)]), 20.0 * x + 15.0);
            assert_near(moved(&patch, Param::Damper, &[(Source::Pressure, x)]), 80.0 * x);
        }
        for key in [24.0, 60.0, 96.0] {
            let decay = 7.5 * libm::exp2(0.45 * (60.0 - key) / 12.0);
            assert_near(moved(&patch, Param::Decay, &[(Source::Key, (key - 60.0) / 60.0)]), decay);
        }
        assert_eq!(told.len(), RETIRED.len());
        assert_eq!(told[2], "‘decay_key’ is retired: a route from key to decay replaces it");
    }

    #[test]
    fn a_preset_that_names_none_has_the_routes_of_a_new_patch() {
        for format in [1, 2, 3] {
            let (patch, told) = load(&format!("format = {format}\n"));
            assert_eq!((patch, told), (Patch::default(), vec![]), "format {format}");
        }
        let (patch, told) = load("format = 1\n[params]\nwheel_vibrato = 0\n");
        assert_eq!(patch.routes.get(13), None);
        assert_eq!(told, ["‘wheel_vibrato’ is retired: it is 0, and needs nothing in its place"]);
    }

    #[test]
    fn what_finds_no_place_is_told() {
        let routes = "{ source = \"macro1\", to = \"tune\" }, ".repeat(15);
        let (patch, told) = load(&format!("format = 2\nroutes = [{routes}]\n[params]\nhardness_velocity = 20\n"));
        assert_eq!(patch.routes.iter().count(), MAX_ROUTES);
        assert_eq!(told.len(), 4, "{told:?}");
        assert!(told[1].starts_with("‘wheel_vibrato’ is retired: a route from wheel to vibrato would"), "{told:?}");
    }

    #[test]
    fn a_retired_parameter_is_an_error_in_the_present_format() {
        let error = Preset::parse("format = 3\nname = \"a\"\n[params]\ndecay_key = 3", "x").unwrap_err().to_string();
        assert_eq!(error, "x: params.decay_key: ‘decay_key’ is retired: a route from key to decay replaces it");
        assert!(PARAMS.iter().all(|info| Retired::from_id(info.id).is_none()));
    }
}
