//! A new route, whose source and knob are typed by the beginnings of their names, or chosen from menus.

use super::row::{About, Parts, chip, paint_chip, paint_target, short_name, verbs};
use super::{AMOUNT, add, can_move, destinations, source_name, sources};
use crate::editor::controls::{Controls, Hint, Said};
use crate::editor::theme::{Palette, SMALL, TEXT, font};
use crate::editor::widgets::outline;
use crate::editor::widgets::text::{fitting, is_entered, line, name_field};
use egui::{
    Align2, Frame, Id, Painter, Popup, Rect, Response, Role, Sense, Shape, Stroke, TextEdit, Ui, WidgetInfo, vec2,
};
use sprung::params::{PARAMS, Param};
use sprung::patch::routes::{MAX_ROUTES, Route, Source};
use sprung::preset::Guide;

/// Words between the two that say nothing more.
const BETWEEN: [&str; 8] = ["raises", "tilts", "sways", "moves", "by", "to", "with", "›"];
/// What a part costs that is not there, beside one that is named whole and one that is not: more than any name that matches badly.
const MISSING: [usize; 2] = [3, 100];

/// What typed words say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sentence {
    source: Option<Source>,
    target: Option<Param>,
    scale: Option<Source>,
    amount: Option<f32>,
}

impl Sentence {
    /// The whole route, and its amount.
    fn route(&self) -> Option<(Route, f32)> {
        let route = Route { scale: self.scale, ..Route::linear(self.source?, self.target?) };
        Some((route, self.amount.unwrap_or(AMOUNT)))
    }
}

/// Reads words such as `vel hard 30` or `lfo 1 decay times wheel`; none if they say nothing.
fn read(text: &str, guide: &Guide) -> Option<Sentence> {
    let text = text.to_lowercase();
    let mut words: Vec<&str> = text.split_whitespace().collect();
    let mut sign = 1.0;
    if let Some(lowers) = words.iter().position(|word| *word == "lowers") {
        words.remove(lowers);
        sign = -1.0;
    }
    words.retain(|word| *word != "%");
    let number = words.last().map(|word| word.trim_end_matches('%').replace(['−', '±'], "-"));
    let number = number.and_then(|word| word.parse::<f32>().ok()).filter(|number| number.is_finite());
    let amount = (sign < 0.0).then_some(-AMOUNT);
    let whole = skim(&words, guide).map(|(cost, found)| (cost, Sentence { amount, ..found }));
    // A number at the end may be an amount, or belong to a name.
    let with_amount = number.and_then(|number| {
        let (cost, found) = skim(&words[..words.len() - 1], guide)?;
        Some((cost, Sentence { amount: Some((sign * number).clamp(-100.0, 100.0)), ..found }))
    });
    whole.into_iter().chain(with_amount).min_by_key(|(cost, _)| *cost).map(|(_, found)| found)
}

/// As [`understand`], without words that say nothing more, unless they belong to a name.
fn skim(words: &[&str], guide: &Guide) -> Option<(usize, Sentence)> {
    let says = |word: &&str| !BETWEEN.contains(word);
    let words = &words[..=words.iter().rposition(says)?];
    let said: Vec<&str> = words.iter().copied().filter(says).collect();
    understand(words, guide).or_else(|| understand(&said, guide))
}

/// Finds the source and the knob whose names begin like these words, where the two meet best, and how badly they match.
fn understand(words: &[&str], guide: &Guide) -> Option<(usize, Sentence)> {
    let is_times = |word: &&str| matches!(*word, "times" | "×");
    let times = words.iter().position(is_times).unwrap_or(words.len());
    let (words, scale) = match words.split_at(times) {
        (words, [_, scale @ ..]) if !scale.is_empty() => (words, Some(find_source(scale, guide)?.0)),
        (words, _) => (words, None),
    };
    let splits = (0..=words.len()).rev().filter_map(|split| {
        let (first, second) = words.split_at(split);
        let source = if first.is_empty() { None } else { Some(find_source(first, guide)?) };
        let can = |param: Param| source.is_none_or(|(source, _)| can_move(source, param.info()));
        let target = if second.is_empty() { None } else { Some(find_target(second, can)?) };
        let [first, second] = [source.map(|(_, cost)| cost), target.map(|(_, cost)| cost)];
        let missing = |other: Option<usize>| MISSING[usize::from(other != Some(0))];
        let cost = first.unwrap_or_else(|| missing(second)) + second.unwrap_or_else(|| missing(first));
        let sentence =
            Sentence { source: source.map(|(own, _)| own), target: target.map(|(own, _)| own), scale, amount: None };
        Some((cost, sentence))
    });
    let found = splits.min_by_key(|(cost, _)| *cost);
    found.filter(|(_, sentence)| sentence.source.is_some() || sentence.target.is_some())
}

fn find_source(words: &[&str], guide: &Guide) -> Option<(Source, usize)> {
    let cost = |source: Source| {
        let own = guide.macro_name(source.id()).unwrap_or_default();
        [&*source_name(source, guide), own, source.id()].into_iter().filter_map(|name| matched(words, name)).min()
    };
    let found = Source::ALL.iter().filter_map(|source| Some((*source, cost(*source)?)));
    found.min_by_key(|(_, cost)| *cost)
}

fn find_target(words: &[&str], can: impl Fn(Param) -> bool) -> Option<(Param, usize)> {
    let cost = |name, id| [name, id].into_iter().filter_map(|name| matched(words, name)).min();
    let possible = PARAMS.iter().filter(|info| info.is_modulatable() && can(info.param));
    let found = possible.filter_map(|info| Some((info.param, cost(info.name, info.id)?)));
    found.min_by_key(|(_, cost)| *cost)
}

/// How badly words match a name of which each begins one, in their order: 0 for the whole name.
fn matched(words: &[&str], name: &str) -> Option<usize> {
    let name = name.to_lowercase().replace('_', " ");
    let (mut rest, mut cost) = (name.split_whitespace(), 0);
    let mut is_first = true;
    for word in words {
        loop {
            let next = rest.next()?;
            if let Some(end) = next.strip_prefix(word) {
                cost += usize::from(!end.is_empty());
                break;
            }
            // A word in the middle of a name counts less than its beginning.
            cost += if is_first { 4 } else { 2 };
        }
        is_first = false;
    }
    Some(cost + 2 * rest.count())
}

/// Shows the row in which a route is typed into `text`, or chosen.
pub(super) fn show(ui: &mut Ui, parts: &Parts, text: &mut String, (patch, guide, _): About, controls: &mut Controls) {
    let palette = controls.palette;
    let sentence = read(text, guide);
    let Sentence { source, target, .. } = sentence.unwrap_or_default();
    let mut done = None;
    let touch = part(ui, chip(parts.source), "Source of a new route", controls);
    match source {
        Some(source) => paint_chip(ui.painter(), parts.source, &short_name(source, guide), palette),
        None => paint_empty(ui.painter(), chip(parts.source), "a source", palette),
    }
    Popup::menu(&touch).show(|ui| {
        let can = |source| target.is_none_or(|target: Param| can_move(source, target.info()));
        if let Some(source) = sources(ui, guide, |_| false, can) {
            *text = format!("{} ", source_name(source, guide));
            done = target.map(|target| (Route::linear(source, target), AMOUNT));
            ui.close();
        }
    });
    let route = sentence.and_then(|sentence| sentence.route());
    let verb = route.map_or("moves", |(route, amount)| verbs(&route, amount)[0]);
    line(ui.painter(), parts.verb, Align2::LEFT_CENTER, verb, TEXT, palette.muted);
    let touch = part(ui, chip(parts.target), "Target of a new route", controls);
    match target {
        Some(target) => paint_target(ui.painter(), parts, target, false, controls),
        None => paint_empty(ui.painter(), chip(parts.target), "a knob", palette),
    }
    Popup::menu(&touch).show(|ui| {
        let can = |target: Param| match source {
            Some(source) => can_move(source, target.info()),
            None => target.info().is_modulatable(),
        };
        if let Some(target) = destinations(ui, can) {
            target.info().name.clone_into(text);
            done = source.map(|source| (Route::linear(source, target), AMOUNT));
            ui.close();
        }
    });
    let place = parts.bar.with_max_x(parts.remove.right());
    let (touch, is_open) = show_field(ui, chip(place), text, MAX_ROUTES - patch.routes.iter().count(), palette);
    let adds = match route {
        Some((route, amount)) => {
            let scale = route.scale.map_or(String::new(), |scale| format!(" times {}", source_name(scale, guide)));
            let [source, target] = [source_name(route.source, guide), route.destination.info().name.to_owned()];
            let verb = verbs(&route, amount)[0];
            // To lower by less than nothing would be to raise.
            let by = if verb == "lowers" { amount.abs() } else { amount };
            Ok(format!("{source}{scale} {verb} {target} by {by} %"))
        }
        None if sentence.is_some() => Err("which knob, or which source?".to_owned()),
        None => Err(format!("no source and no knob begin like ‘{}’", text.trim())),
    };
    if is_open && !text.trim().is_empty() {
        *controls.hint = match &adds {
            Ok(adds) => {
                Hint::new(format!("Enter: {adds}"), "A number is how far, in per cent; times is a second source.")
            }
            Err(why) => Hint::new("New route", why),
        };
    } else if touch.hovered() {
        *controls.hint =
            Hint::new("New route", "Type the beginnings of a source and of a knob, and how far: vel hard 30.");
    }
    if is_entered(&touch) && !text.trim().is_empty() {
        match (route, adds) {
            (Some(route), _) => done = Some(route),
            (None, why) => controls.interaction.said = why.err().map(Said::Err),
        }
        touch.request_focus();
    }
    if let Some((route, amount)) = done {
        controls.interaction.said = Some(add(route, amount, controls));
        text.clear();
    }
}

/// Shows the field. Returns it, and whether it is being typed into.
fn show_field(ui: &mut Ui, rect: Rect, text: &mut String, free: usize, palette: &Palette) -> (Response, bool) {
    let id = Id::unique("new route");
    let is_open = ui.memory(|memory| memory.has_focus(id));
    let says = [
        &*format!("Type here, or drop a source on a knob. {free} of {MAX_ROUTES} are free."),
        &*format!("Type here: {free} of {MAX_ROUTES} are free"),
        &*format!("{free} are free"),
    ];
    let says = fitting(ui.painter(), &says, SMALL, rect.width() - 12.0).to_owned();
    if is_open || !text.is_empty() {
        ui.painter().rect_filled(rect, 4.0, palette.raised);
    }
    let edit = TextEdit::singleline(text).id(id).font(font(SMALL)).margin(vec2(4.0, 0.0)).hint_text(says);
    let response = ui.put(rect, edit.frame(Frame::NONE).align(Align2::LEFT_CENTER));
    name_field(&response, "New route", text);
    outline(ui, &response, rect, 4, palette);
    (response, is_open)
}

fn part(ui: &Ui, rect: Rect, label: &str, controls: &mut Controls) -> Response {
    let touch = ui.interact(rect, Id::unique(label), Sense::click());
    touch.widget_info(|| WidgetInfo::labeled(Role::Button, true, label));
    if touch.hovered() {
        *controls.hint = Hint::new("New route", "Click: choose from a list. Or type at the right.");
    }
    outline(ui, &touch, rect.expand(1.0), 10, controls.palette);
    touch
}

/// Paints what is still to be named.
fn paint_empty(painter: &Painter, rect: Rect, words: &str, palette: &Palette) {
    let rect = rect.shrink(0.5);
    let corners = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom(), rect.left_top()];
    painter.extend(Shape::dashed_line(&corners, Stroke::new(1.0, palette.muted), 3.0, 3.0));
    line(painter, rect.shrink2(vec2(4.0, 0.0)), Align2::CENTER_CENTER, words, SMALL, palette.muted);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guide() -> Guide {
        Guide { macros: vec!["Soft".to_owned(), "Wide Room".to_owned()], ..Guide::default() }
    }

    #[test]
    fn beginnings_of_names_are_enough() {
        for (text, source, target, amount) in [
            ("wheel decay", Source::Wheel, Param::Decay, None),
            ("velocity hardness 30", Source::Velocity, Param::MalletHardness, Some(30.0)),
            ("vel mal hard -30%", Source::Velocity, Param::MalletHardness, Some(-30.0)),
            ("rel vel decay 200", Source::ReleaseVelocity, Param::Decay, Some(100.0)),
            ("lfo1 lfo 2 rate", Source::Lfo1, Param::Lfo2Rate, None),
            ("LFO 3 Decay 7.5", Source::Lfo3, Param::Decay, Some(7.5)),
            ("soft lowers decay", Source::Macro1, Param::Decay, Some(-AMOUNT)),
            ("macro wide room decay", Source::Macro2, Param::Decay, None),
            ("macro 8 raises decay by 12 %", Source::Macro8, Param::Decay, Some(12.0)),
        ] {
            let found = read(text, &guide());
            assert_eq!(
                found,
                Some(Sentence { source: Some(source), target: Some(target), scale: None, amount }),
                "{text}"
            );
        }
        let found = read("lfo 2 decay times wheel 10", &guide()).and_then(|sentence| sentence.route());
        let route = Route { scale: Some(Source::Wheel), ..Route::linear(Source::Lfo2, Param::Decay) };
        assert_eq!(found, Some((route, 10.0)));
    }

    #[test]
    fn every_name_is_found_by_itself() {
        for source in Source::ALL {
            let text = source_name(*source, &guide());
            assert_eq!(read(&text, &guide()).and_then(|found| found.source), Some(*source), "{text}");
        }
        for info in PARAMS.iter().filter(|info| info.is_modulatable()) {
            let text = format!("velocity {}", info.name);
            let found = read(&text, &guide());
            assert_eq!(found.and_then(|found| found.target).map(|target| target.info().name), Some(info.name));
        }
    }

    #[test]
    fn what_says_nothing_or_cannot_be_is_no_route() {
        assert_eq!(read("", &guide()), None);
        assert_eq!(read("qqq decay", &guide()), None);
        assert_eq!(read("lfo 1 space mix", &guide()), None, "it is of all notes");
        assert_eq!(read("decay", &guide()).and_then(|found| found.route()), None);
        assert_eq!(read("velocity", &guide()).and_then(|found| found.route()), None);
    }
}
