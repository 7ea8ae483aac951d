//! The routes of a preset file: `routes = [{ source = "lfo1", to = "tune", amount = 2 }]`.

use super::complaints::Complaints;
use super::value::{check_keys, param_value, unexpected};
use crate::params::Param;
use crate::patch::Patch;
use crate::patch::routes::{MAX_ROUTES, Response, Route, Routes, Source, amount_param, place_of_amount};
use std::fmt::Write;
use toml::{Table, Value};

const KEYS: [&str; 6] = ["source", "to", "amount", "response", "scale", "place"];

/// Reads the routes of a file with their amounts.
pub(super) fn read(file: &Table, patch: &mut Patch, complaints: &mut Complaints) {
    let routes = match file.get("routes") {
        None => return,
        Some(Value::Array(routes)) => routes,
        Some(other) => {
            return complaints.add(unexpected("routes", "a list of routes, [{ source = …, to = … }, …]", other));
        }
    };
    patch.routes = Routes::NONE;
    let mut place = 0;
    for (index, route) in routes.iter().enumerate() {
        let at = format!("routes[{index}]");
        let Value::Table(route) = route else {
            complaints.add(unexpected(&at, "a route, { source = …, to = … }", route));
            continue;
        };
        check_keys(route, &format!("{at}."), &KEYS, complaints);
        place = complaints.take("", read_place(route, &at)).flatten().unwrap_or(place);
        if place >= MAX_ROUTES {
            complaints.add(format!("{at}: there are places for {MAX_ROUTES} routes"));
            continue;
        }
        if patch.routes.get(place).is_some() {
            complaints.add(format!("{at}: place {} has a route already", place + 1));
            continue;
        }
        if let Some(read) = complaints.take("", read_route(route, &at)) {
            patch.routes.set(place, Some(read));
            read_amount(file, route, &at, place, patch, complaints);
        }
        place += 1;
    }
}

/// Reads the amount of the route with number `place`: from the route, or from the file's parameters; 0 if neither has
/// it.
fn read_amount(file: &Table, route: &Table, at: &str, place: usize, patch: &mut Patch, complaints: &mut Complaints) {
    let info = amount_param(place).info();
    let in_params = file.get("params").is_some_and(|params| params.get(info.id).is_some());
    match route.get("amount") {
        Some(_) if in_params => {
            complaints.add(format!("{at}.amount: it is given twice, here and as params.{}", info.id));
        }
        None if in_params => {}
        amount => {
            let read = amount.map(|amount| param_value(info, amount)).transpose();
            let value = complaints.take(&format!("{at}.amount: "), read).flatten();
            patch.set(info.param, value.unwrap_or(0.0));
        }
    }
}

/// Reads the `place` of a route. Files count places from 1, the result counts from 0.
fn read_place(route: &Table, at: &str) -> Result<Option<usize>, String> {
    let most = MAX_ROUTES as i64;
    match route.get("place") {
        None => Ok(None),
        Some(Value::Integer(place)) if (1..=most).contains(place) => Ok(Some(*place as usize - 1)),
        Some(other) => {
            Err(unexpected(&format!("{at}.place"), &format!("a whole number from 1 to {MAX_ROUTES}"), other))
        }
    }
}

fn read_route(route: &Table, at: &str) -> Result<Route, String> {
    let sources = || Source::ALL.iter().map(|source| source.id()).collect::<Vec<_>>().join(", ");
    let source = |key: &str| named(route, at, key, Source::from_id, sources);
    let responses = || Response::ALL.iter().map(|response| response.id()).collect::<Vec<_>>().join(", ");
    let movable = |id: &str| Param::from_id(id).filter(|param| param.info().is_modulatable());
    let all = || "a parameter that routes can move; ‘sprung params’ marks them".to_owned();
    let route = Route {
        source: source("source")?.ok_or_else(|| format!("{at}: there is no ‘source’: expected {}", sources()))?,
        destination: named(route, at, "to", movable, all)?
            .ok_or_else(|| format!("{at}: there is no ‘to’: expected {}", all()))?,
        response: named(route, at, "response", Response::from_id, responses)?.unwrap_or(Response::Linear),
        scale: source("scale")?,
    };
    if route.is_possible() {
        Ok(route)
    } else {
        let to = route.destination.info().id;
        Err(format!("{at}: all notes share ‘{to}’, so an oscillator, an envelope or a release cannot move it for one"))
    }
}

/// Looks up the text at `key` of a route with `find`; none if the key is missing.
fn named<T>(
    route: &Table,
    at: &str,
    key: &str,
    find: impl Fn(&str) -> Option<T>,
    all: impl Fn() -> String,
) -> Result<Option<T>, String> {
    let wrong = |found: &Value| unexpected(&format!("{at}.{key}"), &all(), found);
    match route.get(key) {
        None => Ok(None),
        Some(Value::String(id)) => {
            find(id).map(Some).ok_or_else(|| format!("{at}.{key}: ‘{id}’ is none: expected {}", all()))
        }
        Some(other) => Err(wrong(other)),
    }
}

/// Whether a parameter is written as part of a route: the amount of a route that exists.
pub(super) fn writes(patch: &Patch, param: Param) -> bool {
    let is_listed = |place| patch.routes != Routes::INITIAL && patch.routes.get(place).is_some();
    place_of_amount(param).is_some_and(is_listed)
}

/// Writes the routes, unless they are those of a new patch.
pub(super) fn to_toml(patch: &Patch) -> String {
    if patch.routes == Routes::INITIAL {
        return String::new();
    }
    let (mut out, mut expected) = (String::new(), 0);
    for (place, route) in patch.routes.iter() {
        let _ = write!(out, "    {{ source = \"{}\", to = \"{}\"", route.source.id(), route.destination.info().id);
        let amount = patch.get(amount_param(place));
        let _ = write!(out, ", amount = {amount:?}");
        if route.response != Response::Linear {
            let _ = write!(out, ", response = \"{}\"", route.response.id());
        }
        if let Some(scale) = route.scale {
            let _ = write!(out, ", scale = \"{}\"", scale.id());
        }
        if place != expected {
            let _ = write!(out, ", place = {}", place + 1);
        }
        out.push_str(" },\n");
        expected = place + 1;
    }
    if out.is_empty() { "routes = []\n".to_owned() } else { format!("routes = [\n{out}]\n") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::PARAMS;

    fn parse(routes: &str) -> Result<Patch, String> {
        let mut patch = Patch::default();
        let table = toml::from_str(routes).unwrap();
        let mut complaints = Complaints::default();
        read(&table, &mut patch, &mut complaints);
        match complaints.into_lines().into_iter().next() {
            None => Ok(patch),
            Some(first) => Err(first),
        }
    }

    #[test]
    fn routes_are_read_back_as_they_were() {
        let mut patch = Patch::default();
        for (place, source, to, response, scale, amount) in [
            (0, Source::Lfo1, Param::Tune, Response::Linear, Some(Source::Wheel), 12.5),
            (1, Source::Velocity, Param::MalletHardness, Response::Squared, None, -100.0),
            (7, Source::Macro8, Param::Route1, Response::Smooth, None, 0.0),
            (8, Source::Envelope2, Param::Lfo3Rate, Response::Root, Some(Source::Random), 0.1),
        ] {
            patch.routes.set(place, Some(Route { source, destination: to, response, scale }));
            patch.set(amount_param(place), amount);
        }
        let text = to_toml(&patch);
        assert_eq!(parse(&text).as_ref(), Ok(&patch), "{text}");
        assert!(PARAMS.iter().filter(|info| writes(&patch, info.param)).count() == 4 + 3, "and those of a new patch");
        assert_eq!(to_toml(&Patch::default()), "");
        patch.routes = Routes::NONE;
        assert_eq!(to_toml(&patch), "routes = []\n");
    }

    #[test]
    fn errors_name_the_place_and_what_would_be_right() {
        for (routes, why) in [
            ("routes = 1", "routes: expected a list of routes, [{ source = …, to = … }, …], found integer ‘1’"),
            ("routes = [1]", "routes[0]: expected a route, { source = …, to = … }, found integer ‘1’"),
            ("routes = [{}]", "routes[0]: there is no ‘source’: expected velocity, release_velocity, key"),
            (
                "routes = [{ source = \"lfo4\" }]",
                "routes[0].source: ‘lfo4’ is none: expected velocity, release_velocity, key",
            ),
            ("routes = [{ source = \"lfo1\" }]", "routes[0]: there is no ‘to’: expected a parameter"),
            (
                "routes = [{ source = \"lfo1\", to = \"voices\" }]",
                "routes[0].to: ‘voices’ is none: expected a parameter that routes can move",
            ),
            ("routes = [{ from = \"lfo1\" }]", "unknown key ‘routes[0].from’"),
            ("routes = [{ source = \"lfo1\", to = \"tune\", amount = 101 }]", "routes[0].amount: 101 is out of range"),
            (
                "routes = [{ source = \"lfo1\", to = \"tune\", place = 17 }]",
                "routes[0].place: expected a whole number from 1 to 16",
            ),
            (
                "routes = [{ source = \"lfo1\", to = \"tune\", amount = 1 }]\n[params]\nroute1 = 2",
                "routes[0].amount: it is given twice, here and as params.route1",
            ),
            (
                "routes = [{ source = \"lfo1\", to = \"tune\" }, { source = \"lfo2\", to = \"tune\", place = 1 }]",
                "routes[1]: place 1 has a route already",
            ),
            (
                "routes = [{ source = \"lfo1\", to = \"tune\", place = 16 }, { source = \"lfo2\", to = \"tune\" }]",
                "routes[1]: there are places for 16 routes",
            ),
        ] {
            let error = parse(routes).unwrap_err();
            assert!(error.starts_with(why), "{routes}: {error}");
        }
    }
}
