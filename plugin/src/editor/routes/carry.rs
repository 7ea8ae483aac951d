//! Sources that are dragged to knobs, of any face, which they then modulate. egui keeps what is dragged.

use super::{AMOUNT, add, can_move, free_place, place_of, put, source_name};
use crate::editor::controls::{Controls, Held, Hint, Said};
use crate::editor::widgets::carried;
use egui::{DragAndDrop, Pos2, Rect, Ui, vec2};
use sprung::params::ParamInfo;
use sprung::patch::routes::{Route, Source, amount_param};
use sprung::preset::{Guide, Playable};

/// How long a source is held over a tab until that is opened, or at one place of a knob until that takes it, in seconds.
const DWELL: f64 = 0.3;
/// How far a pointer strays that rests, to both sides.
const REST: f32 = 6.0;
/// How far to the side a knob is left that has taken a source.
const ASIDE: f32 = 60.0;
/// Per cent of an amount for each pixel up or down, and while Shift is held.
const STEP: [f64; 2] = [0.5, 0.1];

/// What a knob says while a source is dragged.
#[derive(Clone, Copy, PartialEq)]
pub(in crate::editor) enum Halo {
    /// Nothing is dragged.
    None,
    /// It cannot take the source.
    Closed,
    Open,
    /// It takes it, if it is let go.
    Aimed,
}

/// Whether a source is held over this place long enough to see what is behind it.
pub(in crate::editor) fn dwells(ui: &Ui, rect: Rect, controls: &mut Controls) -> bool {
    if controls.interaction.held.is_some() || !is_over(ui, rect) {
        return false;
    }
    let now = ui.input(|input| input.time);
    let here = controls.interaction.dwell.filter(|(place, _)| *place == rect);
    let (_, since) = *controls.interaction.dwell.insert(here.unwrap_or((rect, now)));
    now - since >= DWELL
}

/// Takes a source that is held over the place of a parameter. Returns what its knob is to say.
pub(in crate::editor) fn aim(ui: &Ui, rect: Rect, info: &'static ParamInfo, controls: &mut Controls) -> Halo {
    let Some(source) = DragAndDrop::payload::<Source>(ui.ctx()) else { return Halo::None };
    let is_held = controls.interaction.held.as_ref().map(|held| held.info.param == info.param);
    match is_held {
        _ if !can_move(*source, info) => Halo::Closed,
        Some(true) => Halo::Aimed,
        None if is_over(ui, rect) => {
            controls.interaction.aim = Some(info);
            Halo::Aimed
        }
        _ => Halo::Open,
    }
}

/// Whether a knob cannot take the source that is being dragged.
pub(in crate::editor) fn is_closed(ui: &Ui, info: &ParamInfo) -> bool {
    DragAndDrop::payload::<Source>(ui.ctx()).is_some_and(|source| !can_move(*source, info))
}

/// Whether a source is held over a place.
fn is_over(ui: &Ui, rect: Rect) -> bool {
    DragAndDrop::has_payload_of_type::<Source>(ui.ctx())
        && ui.input(|input| input.pointer.latest_pos()).is_some_and(|at| rect.intersect(ui.clip_rect()).contains(at))
}

/// Shows the source at the pointer, and makes a route when it is let go over a knob. A knob over which the pointer rests takes the
/// source at once, and the amount then follows the pointer up and down: with the button down, hosts send all movements, also those
/// outside the window, and a release ends it for sure. To be called after all knobs. Returns a message.
pub(in crate::editor) fn follow(ui: &Ui, guide: &Guide, controls: &mut Controls) -> Option<Said> {
    let aim = controls.interaction.aim.take();
    let held = controls.interaction.held.take();
    // Beyond the edge of the window the pointer goes on from where it was seen last.
    let (pointer, is_released) = ui.input(|input| (input.pointer.interact_pos(), input.pointer.any_released()));
    let (Some(source), Some(at)) = (DragAndDrop::payload::<Source>(ui.ctx()), pointer) else {
        controls.interaction.dwell = None;
        return held.map(|held| give_up(&held, controls));
    };
    let mut said = None;
    match held {
        Some(held) if is_released => return Some(let_go(&held, guide, controls)),
        Some(held) if !held.is_there(controls) || (at.x - held.from.x).abs() > ASIDE => {
            said = Some(give_up(&held, controls));
        }
        Some(mut held) => {
            pull(ui, &mut held, at, controls);
            let name = source_name(*source, guide);
            let amount = controls.text(amount_param(held.place).info());
            let title = format!("{name} moves {} by {amount}", held.info.name);
            let help = "Up and down: how much. Shift: fine. Let it go: done. To the side, or Escape: not.";
            *controls.hint = Hint::new(title, help);
            carried::paint(ui, &format!("{name} {amount}"), controls.palette.modulation, controls.palette);
            controls.interaction.held = Some(held);
            return None;
        }
        None if is_released => {
            return aim.map(|info| add(Route::linear(*source, info.param), AMOUNT, controls));
        }
        None => {}
    }
    controls.interaction.dwell = controls.interaction.dwell.filter(|(place, _)| place.contains(at));
    if let Some(info) = aim {
        let here = Rect::from_center_size(at, vec2(2.0 * REST, 2.0 * REST));
        let now = ui.input(|input| input.time);
        let (_, since) = *controls.interaction.dwell.get_or_insert((here, now));
        let title = format!("{} › {}", source_name(*source, guide), info.name);
        *controls.hint = Hint::new(title, "Let it go: moved by 25 %. Rest here, then up and down: as far as you like.");
        if now - since >= DWELL {
            controls.interaction.dwell = None;
            controls.interaction.held = take(*source, info, at, controls);
        }
    }
    carried::paint(ui, &source_name(*source, guide), controls.palette.modulation, controls.palette);
    // A tab is opened by holding it there, without a movement.
    ui.ctx().request_repaint();
    said
}

impl Held {
    /// Whether its route is there: another sound may have been loaded meanwhile.
    fn is_there(&self, controls: &Controls) -> bool {
        let loaded = controls.params.loaded();
        let route = loaded.kit.sounds().first().and_then(|sound| sound.patch().routes.get(self.place));
        route.is_some_and(|route| (route.source, route.destination) == (self.source, self.info.param))
    }
}

/// A knob takes a source: the route is made, or found, but is no step yet. None if there is no place for it.
fn take(source: Source, info: &'static ParamInfo, at: Pos2, controls: &mut Controls) -> Option<Held> {
    let Playable::Preset(preset) = controls.params.state().playable else { return None };
    let route = Route::linear(source, info.param);
    let old = place_of(&route, &preset.patch.routes);
    let place = old.or(free_place(&preset.patch.routes))?;
    let amount = amount_param(place).info();
    let before = (controls.value(amount), controls.position(amount));
    controls.release();
    controls.history.begin(controls.params);
    if old.is_none() {
        put(place, Some(route), Some((AMOUNT, amount.normalise(AMOUNT) as f32)), controls);
    }
    let now = if old.is_none() { AMOUNT } else { before.0 };
    let (from, is_new) = (at, old.is_none());
    Some(Held { source, info, place, is_new, before, from, last: at, amount: f64::from(now), is_moved: false })
}

/// The amount follows the pointer.
fn pull(ui: &Ui, held: &mut Held, at: Pos2, controls: &mut Controls) {
    let up = f64::from(held.last.y - at.y);
    held.last = at;
    held.is_moved |= (at.y - held.from.y).abs() > REST;
    if !held.is_moved || up == 0.0 {
        return;
    }
    let is_fine = ui.input(|input| input.modifiers.shift);
    held.amount = (held.amount + up * STEP[usize::from(is_fine)]).clamp(-100.0, 100.0);
    let amount = if is_fine { (10.0 * held.amount).round() / 10.0 } else { held.amount.round() };
    let info = amount_param(held.place).info();
    if amount as f32 != controls.value(info) {
        controls.turn(info, info.normalise(amount as f32));
    }
}

/// The route is as it is to be: one step.
fn let_go(held: &Held, guide: &Guide, controls: &mut Controls) -> Said {
    let amount = amount_param(held.place);
    controls.interaction.gestures.end(controls.params, controls.host);
    let by = controls.text(amount.info());
    let name = format!("{} moves {} by {by}", source_name(held.source, guide), held.info.name);
    controls.history.end_of(&[amount as usize], name.clone(), controls.params);
    Ok(name)
}

/// All is as it was before the knob took the source.
fn give_up(held: &Held, controls: &mut Controls) -> Said {
    let amount = amount_param(held.place);
    controls.interaction.gestures.end(controls.params, controls.host);
    match held.is_there(controls) {
        true if held.is_new => put(held.place, None, Some(held.before), controls),
        true => controls.interaction.gestures.set(controls.params, controls.host, amount as usize, held.before.1),
        false => {}
    }
    controls.history.cancel();
    Ok(String::new())
}
