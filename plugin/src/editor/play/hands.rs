//! What the player's wheel, pressure, breath, pedals and pitch wheel do to the sound, in a line.

use crate::editor::controls::Controls;
use crate::editor::theme::SMALL;
use crate::editor::widgets::text::{line, width};
use egui::{Align2, Rect, Ui};
use sprung::params::{Param, ParamInfo};
use sprung::patch::routes::{Route, Routes, Source, amount_param};

/// The controllers that hands, feet and mouth have beside the keys, by the names that players have for them.
const CONTROLLERS: [(Source, &str); 6] = [
    (Source::Wheel, "Wheel"),
    (Source::Pressure, "Pressure"),
    (Source::Breath, "Breath"),
    (Source::Timbre, "Timbre"),
    (Source::Expression, "Expression"),
    (Source::Bend, "Bend"),
];

/// Said of a sound that they do not move.
const NOTHING: &str = "Wheel and pressure move nothing yet: drag them to knobs, on Motion.";
/// What the sustain pedal does to every sound.
const PEDAL: &str = "Pedal: holds notes";
const BETWEEN: &str = "   ·   ";

/// Shows what the controllers do, at one end of `rect`: how far they move things, if there is room for that, or else as many as fit, the
/// first at the left.
pub(super) fn show(ui: &Ui, rect: Rect, align: Align2, routes: &Routes, controls: &Controls) {
    let amount = |place| controls.value(amount_param(place).info());
    let range = controls.value(Param::BendRange.info());
    let said = |is_long: bool| {
        let bend = (range > 0.0).then(|| format!("pitch ±{}", Param::BendRange.info().format(range)));
        let own = |source| if source == Source::Bend { bend.clone() } else { None };
        CONTROLLERS.map(|(source, name)| sentence(routes, (source, name), own(source), is_long, amount))
    };
    let [long, short] = [true, false].map(said);
    // Bend and pedal do what they do in every sound.
    let moved = short[..CONTROLLERS.len() - 1].iter().flatten().count();
    let is_bent = routes.iter().any(|(place, route)| route.source == Source::Bend && amount(place) != 0.0);
    if moved == 0 && !is_bent {
        line(ui.painter(), rect, align, NOTHING, SMALL, controls.palette.muted);
        return;
    }
    let ways = |sentences: [Option<String>; CONTROLLERS.len()], least: usize| {
        let sentences: Vec<String> = sentences.into_iter().flatten().chain([PEDAL.to_owned()]).collect();
        let ways = (least..=sentences.len()).rev().map(|count| sentences[..count].join(BETWEEN));
        ways.collect::<Vec<_>>()
    };
    let mut ways = ways(long, moved).into_iter().chain(ways(short, 1));
    let said = ways.find(|way| width(ui.painter(), way, SMALL) <= rect.width()).unwrap_or_default();
    line(ui.painter(), rect, align, &said, SMALL, controls.palette.muted);
}

/// Such as `Pressure: bow force +25 %, vibrato +10 %`, or shorter without how far; none if there is nothing of its `own` that it does, and
/// no route has it whose amount is not 0.
fn sentence(
    routes: &Routes,
    (source, name): (Source, &str),
    own: Option<String>,
    is_long: bool,
    amount: impl Fn(usize) -> f32,
) -> Option<String> {
    let mut moved: Vec<(&ParamInfo, f32)> = Vec::new();
    let follows = |route: &Route| route.source == source || route.scale == Some(source);
    for (place, route) in routes.iter().filter(|(place, route)| follows(route) && amount(*place) != 0.0) {
        let destination = route.destination.info();
        // What only scales another source moves nothing by itself.
        let by = if route.source == source { amount(place) } else { 0.0 };
        match moved.iter_mut().find(|(other, _)| other.id == destination.id) {
            Some((_, sum)) => *sum += by,
            None => moved.push((destination, by)),
        }
    }
    let told = moved.into_iter().map(|(info, by)| {
        let name = info.name.to_lowercase();
        if is_long && by != 0.0 { format!("{name} {by:+.0} %") } else { name }
    });
    let told: Vec<String> = own.into_iter().chain(told).collect();
    (!told.is_empty()).then(|| format!("{name}: {}", told.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::preset::Preset;

    #[test]
    fn controllers_have_one_name_everywhere() {
        for (source, name) in CONTROLLERS {
            assert_eq!(name.to_lowercase(), source.id());
        }
    }

    #[test]
    fn a_violin_is_pressed_with_the_bow() {
        let routes = &Preset::find("Violin").unwrap().patch.routes;
        let said =
            |source, is_long| sentence(routes, (source, "Hand"), None, is_long, |place| 10.0 * (place as f32 + 1.0));
        assert_eq!(said(Source::Pressure, false).as_deref(), Some("Hand: bow force, vibrato"));
        assert_eq!(said(Source::Wheel, false).as_deref(), Some("Hand: vibrato"));
        assert_eq!(said(Source::Breath, true), None);
        assert_eq!(sentence(routes, (Source::Wheel, "Hand"), None, true, |_| 0.0), None);
        let own = sentence(routes, (Source::Wheel, "Hand"), Some("pitch ±2 st".to_owned()), true, |_| 0.0);
        assert_eq!(own.as_deref(), Some("Hand: pitch ±2 st"));
        let mut scaled = Routes::NONE;
        scaled.set(3, Some(Route { scale: Some(Source::Wheel), ..Route::linear(Source::Lfo1, Param::Fine) }));
        let said = |routes: &Routes, amount| sentence(routes, (Source::Wheel, "Hand"), None, true, |_| amount);
        assert_eq!(
            said(&scaled, 10.0).as_deref(),
            Some("Hand: fine tune"),
            "how far it moves depends on the oscillator"
        );
        scaled.set(5, Some(Route::linear(Source::Wheel, Param::Fine)));
        scaled.set(6, Some(Route::linear(Source::Wheel, Param::Tilt)));
        assert_eq!(said(&scaled, -25.0).as_deref(), Some("Hand: fine tune -25 %, brightness -25 %"));
    }
}
