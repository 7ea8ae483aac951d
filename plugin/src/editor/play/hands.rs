//! What the player's wheel, pressure, breath and timbre move in the sound, in a line.

use crate::editor::controls::Controls;
use crate::editor::theme::SMALL;
use crate::editor::widgets::text::{line, width};
use egui::{Align2, Rect, Ui};
use sprung::patch::routes::{Route, Routes, Source, amount_param};

/// The controllers that hands and mouth have beside the keys, by the names that players have for them.
const CONTROLLERS: [(Source, &str); 4] =
    [(Source::Wheel, "Wheel"), (Source::Pressure, "Pressure"), (Source::Breath, "Breath"), (Source::Timbre, "Timbre")];

/// Said of a sound that they do not move.
const NOTHING: &str = "Wheel and pressure move nothing yet: drag them to knobs, on Motion.";

/// Shows as many controllers as fit, the first at the left, up to the right end of `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, routes: &Routes, controls: &Controls) {
    let is_on = |place| controls.value(amount_param(place).info()) != 0.0;
    let mut shown = String::new();
    for text in CONTROLLERS.into_iter().filter_map(|(source, name)| sentence(routes, source, name, is_on)) {
        let longer = if shown.is_empty() { text } else { format!("{shown}   ·   {text}") };
        if width(ui.painter(), &longer, SMALL) > rect.width() {
            break;
        }
        shown = longer;
    }
    let said = if shown.is_empty() { NOTHING } else { &shown };
    line(ui.painter(), rect, Align2::RIGHT_CENTER, said, SMALL, controls.palette.muted);
}

/// Such as `Pressure: bow force, vibrato`; none if no route whose amount is not 0 has the source.
fn sentence(routes: &Routes, source: Source, name: &str, is_on: impl Fn(usize) -> bool) -> Option<String> {
    let mut moved: Vec<&str> = Vec::new();
    let follows = |route: &Route| route.source == source || route.scale == Some(source);
    for (_, route) in routes.iter().filter(|(place, route)| follows(route) && is_on(*place)) {
        let destination = route.destination.info().name;
        if !moved.contains(&destination) {
            moved.push(destination);
        }
    }
    (!moved.is_empty()).then(|| format!("{name}: {}", moved.join(", ").to_lowercase()))
}

#[cfg(test)]
mod tests {
    use super::{CONTROLLERS, Route, Source, sentence};
    use sprung::params::Param;
    use sprung::patch::routes::Routes;
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
        let said = |source| sentence(routes, source, "Hand", |_| true);
        assert_eq!(said(Source::Pressure).as_deref(), Some("Hand: bow force, vibrato"));
        assert_eq!(said(Source::Wheel).as_deref(), Some("Hand: vibrato"));
        assert_eq!(said(Source::Breath), None);
        assert_eq!(sentence(routes, Source::Wheel, "Hand", |_| false), None);
        let mut scaled = Routes::NONE;
        scaled.set(3, Some(Route { scale: Some(Source::Wheel), ..Route::linear(Source::Lfo1, Param::Fine) }));
        assert_eq!(sentence(&scaled, Source::Wheel, "Hand", |_| true).as_deref(), Some("Hand: fine tune"));
    }
}
