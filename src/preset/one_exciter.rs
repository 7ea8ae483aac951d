//! Converts presets of formats 1 to 3, which chose one exciter, to the present ones, in which each exciter has a level.

use super::complaints::Complaints;
use toml::{Table, Value};

/// The first format in which every exciter has a level.
pub(super) const FIRST_WITH_LEVELS: i64 = 4;

/// The parameters and values that replace each choice of exciter.
const CHOICES: [(&str, &[(&str, Setting)]); 4] = [
    ("impulse", &[]),
    ("strike", &[("mallet_pulse", Setting::Text("contact"))]),
    ("pluck", &[("mallet_level", Setting::Number(-60.0)), ("pluck_level", Setting::Number(0.0))]),
    ("noise", &[("mallet_level", Setting::Number(-60.0)), ("noise_reach", Setting::Number(100.0))]),
];

#[derive(Clone, Copy)]
enum Setting {
    Number(f64),
    Text(&'static str),
}

impl From<Setting> for Value {
    fn from(setting: Setting) -> Self {
        match setting {
            Setting::Number(number) => Value::Float(number),
            Setting::Text(text) => Value::String(text.to_owned()),
        }
    }
}

/// The file with present parameters in place of retired ones; the sound is the same.
pub(super) fn with_levels(file: &Table, complaints: &mut Complaints) -> Table {
    let mut file = file.clone();
    let exciter = match file.get_mut("params") {
        Some(Value::Table(params)) => choose(params, complaints),
        _ => "impulse",
    };
    let today = |id: &str| match id {
        "hardness" if exciter == "pluck" => Some("pluck_hardness"),
        "hardness" => Some("mallet_hardness"),
        "position" => Some("pluck_position"),
        _ => None,
    };
    if let Some(Value::Table(params)) = file.get_mut("params") {
        let renamed = params.iter().map(|(id, value)| (today(id).unwrap_or(id).to_owned(), value.clone()));
        *params = renamed.collect();
    }
    if let Some(Value::Array(routes)) = file.get_mut("routes") {
        for to in routes.iter_mut().filter_map(|route| route.get_mut("to")) {
            if let Some(id) = to.as_str().and_then(today) {
                *to = Value::String(id.to_owned());
            }
        }
    }
    file
}

/// Replaces the choice of exciter by levels. Returns the choice.
fn choose(params: &mut Table, complaints: &mut Complaints) -> &'static str {
    let Some(chosen) = params.remove("exciter") else { return "impulse" };
    let name = chosen.as_str().map_or_else(|| chosen.to_string(), str::to_owned);
    let found = CHOICES.iter().find(|(choice, _)| choice.eq_ignore_ascii_case(name.trim()));
    let Some((choice, settings)) = found else {
        let expected = CHOICES.map(|(choice, _)| choice).join(", ");
        complaints.add(format!("params.exciter: ‘{}’ is not one of {expected}", name.trim()));
        return "impulse";
    };
    params.extend(settings.iter().map(|(id, setting)| ((*id).to_owned(), Value::from(*setting))));
    choice
}

#[cfg(test)]
mod tests {
    use crate::params::Param;
    use crate::patch::Patch;
    use crate::patch::routes::Source;
    use crate::preset::Preset;

    fn parse(format: u8, body: &str) -> crate::Result<Patch> {
        Preset::parse(&format!("format = {format}\nname = \"a\"\n{body}"), "x").map(|preset| preset.patch)
    }

    #[test]
    fn a_chosen_exciter_is_the_one_with_a_level() {
        let routes = "routes = [{ source = \"velocity\", to = \"hardness\", amount = 9 }]\n";
        for (exciter, now, hardness) in [
            ("impulse", "", "mallet"),
            ("strike", "mallet_pulse = \"contact\"", "mallet"),
            ("Pluck", "mallet_level = -60\npluck_level = 0", "pluck"),
            ("noise", "mallet_level = -60\nnoise_reach = 100", "mallet"),
        ] {
            let old = format!("{routes}[params]\nexciter = \"{exciter}\"\nhardness = 30\nposition = 12");
            let new = format!("{routes}[params]\n{now}\nhardness = 30\npluck_position = 12");
            let new = new.replace("hardness", &format!("{hardness}_hardness"));
            assert_eq!(parse(3, &old).unwrap(), parse(4, &new).unwrap(), "{exciter}");
        }
    }

    #[test]
    fn what_velocity_did_to_hardness_it_does_to_that_of_the_exciter() {
        for (exciter, hardness) in [("strike", Param::MalletHardness), ("pluck", Param::PluckHardness)] {
            let body = format!("[params]\nexciter = \"{exciter}\"\nhardness = 50\nhardness_velocity = 40");
            let patch = parse(2, &body).unwrap();
            let route = patch.routes.iter().find(|(_, route)| route.source == Source::Velocity).unwrap().1;
            assert_eq!((route.destination, patch.get(hardness)), (hardness, 30.0));
        }
    }

    #[test]
    fn an_exciter_that_there_never_was_is_an_error() {
        let error = parse(3, "[params]\nexciter = \"hammer\"").unwrap_err().to_string();
        assert_eq!(error, "x: params.exciter: ‘hammer’ is not one of impulse, strike, pluck, noise");
        let error = parse(4, "[params]\nexciter = \"strike\"").unwrap_err().to_string();
        assert_eq!(error, "x: params.exciter: ‘exciter’ is retired: a level for each exciter replaces it");
    }
}
