//! Converts presets of formats 1 and 2: routes replace retired parameters and effects that used to be built in.

use super::complaints::Complaints;
use super::value::param_value;
use crate::params::retired::RETIRED;
use crate::params::{Curve, Param, ParamInfo};
use crate::patch::Patch;
use crate::patch::routes::{MAX_ROUTES, Route, Routes, Source, amount_param};
use std::fmt;
use toml::Table;

/// The first format in which the parameters that routes replace are errors.
pub(super) const FIRST_WITH_ROUTES_INSTEAD: i64 = 3;

/// A retired parameter that was found in a preset, and its replacement.
#[derive(Clone, Debug, PartialEq)]
pub struct Replaced {
    /// Id of the retired parameter.
    pub id: &'static str,
    /// The parameter whose value was changed too, since the new route modulates it from another base value.
    pub rebased: Option<Param>,
    /// The replacement, or the reason why there is none.
    what: String,
}

impl fmt::Display for Replaced {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "‘{}’ is retired: {}", self.id, self.what)
    }
}

/// A route that replaces a retired parameter or a built-in effect.
struct Work {
    route: Route,
    /// Amount of the route: knob travel in per cent.
    amount: f64,
    /// New base value of the destination, if it has to change.
    base: Option<f64>,
    /// The place of this route in a new patch, if a new patch has it.
    place: Option<usize>,
}

/// Removes the retired parameters from a file's parameters, and the routes from the new patch, since old formats had
/// none. Returns for each retired parameter its value, and whether the file has it.
pub(super) fn take(params: &mut Table, patch: &mut Patch, complaints: &mut Complaints) -> Vec<(f32, bool)> {
    patch.routes = Routes::NONE;
    (0..MAX_ROUTES).for_each(|place| patch.set(amount_param(place), 0.0));
    let mut value = |row: &ParamInfo| {
        let given = params.remove(row.id);
        let read = given.and_then(|value| complaints.take(&format!("params.{}: ", row.id), param_value(row, &value)));
        (read.unwrap_or(row.default), read.is_some())
    };
    replaced_by_routes().map(|(row, _)| value(row)).collect()
}

/// The rows of the parameters that routes replace, and those routes in words.
fn replaced_by_routes() -> impl Iterator<Item = (&'static ParamInfo, &'static str)> {
    RETIRED.iter().filter_map(|retired| Some((retired.row.as_ref()?, retired.replacement)))
}

/// The parameter that a route moves in place of a retired one.
fn destination(row: &ParamInfo, patch: &Patch) -> Param {
    let is_plucked = patch.get(Param::PluckLevel) > Param::PluckLevel.info().min;
    if row.param == Param::MalletHardness && is_plucked { Param::PluckHardness } else { row.param }
}

/// Adds routes with the effect that the retired parameters and the built-in effects had. `params` are the file's other
/// parameters.
pub(super) fn migrate(retired: &[(f32, bool)], params: &Table, patch: &mut Patch, replaced: &mut dyn FnMut(Replaced)) {
    for ((row, replacement), (value, is_given)) in replaced_by_routes().zip(retired) {
        let work = work(row, f64::from(*value), patch);
        let param = work.route.destination;
        let rebased = work.base.filter(|base| *base as f32 != patch.get(param)).map(|_| param);
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
    // Amounts of unused routes get the values that they have in a new patch, unless the file sets them.
    for param in (0..MAX_ROUTES).filter(|place| patch.routes.get(*place).is_none()).map(amount_param) {
        if !params.contains_key(param.info().id) {
            patch.values.set(param, param.info().default);
        }
    }
}

/// The route that replaces a retired parameter with this value.
fn work(row: &ParamInfo, value: f64, patch: &Patch) -> Work {
    let param = destination(row, patch);
    let (destination, before) = (param.info(), f64::from(patch.get(param)));
    // Knob travel in per cent, for a distance in the parameter's unit, or in octaves if its knob is logarithmic.
    let (min, max) = (f64::from(destination.min), f64::from(destination.max));
    let range = match destination.curve {
        Curve::Linear => max - min,
        Curve::Logarithmic => libm::log2(max / min),
    };
    let share = value * 0.01;
    let (source, distance, base, place) = match row.id {
        // The base is the value at velocity 0; the rest grows with velocity.
        "hardness_velocity" | "sweep_velocity" => {
            (Source::Velocity, before * share, Some(before * (1.0 - share)), None)
        }
        // At 100 %, the decay halves with each octave of pitch. The source is ±1 at five octaves from the middle.
        "decay_key" => (Source::Key, -5.0 * share, None, None),
        // At 100 %, twice the time at velocity 0, and half the time at velocity 1.
        "release_velocity" => (Source::ReleaseVelocity, -2.0 * share, Some(before * libm::exp2(share)), None),
        "wheel_vibrato" => (Source::Wheel, value, None, Some(13)),
        _ => (Source::Pressure, value, None, None),
    };
    Work { route: Route::linear(source, param), amount: 100.0 * distance / range, base, place }
}

/// Adds a route, at its own place if that is free, else at the first free place. Returns false if there is none.
fn add(patch: &mut Patch, work: &Work) -> bool {
    let is_free = |place: &usize| patch.routes.get(*place).is_none();
    // Fill the lower places first, so that the places of a new patch's routes stay free for them as long as possible.
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
    use crate::preset::Preset;

    fn load(text: &str) -> (Patch, Vec<String>) {
        let mut told = vec![];
        let text = format!("name = \"a\"\n{text}");
        let preset = Preset::parse_old(&text, "x", &mut |replaced| told.push(replaced.to_string())).unwrap();
        let again = Preset::parse_old(&preset.to_toml(), "x", &mut |replaced| panic!("{replaced}")).unwrap();
        assert_eq!(again, preset, "{}", preset.to_toml());
        (preset.patch, told)
    }

    /// The modulated value of a parameter for these source values, computed as in `engine::modulation`.
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
            assert_near(moved(&patch, Param::MalletHardness, &velocity), 54.0 * (1.0 - 0.5 * (1.0 - x)));
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
        assert_eq!(told.len(), replaced_by_routes().count());
        assert_eq!(told[2], "‘decay_key’ is retired: a route from key to decay replaces it");
    }

    #[test]
    fn a_preset_that_names_none_has_the_routes_of_a_new_patch() {
        for format in [1, 2, 3, 4] {
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
    }
}
