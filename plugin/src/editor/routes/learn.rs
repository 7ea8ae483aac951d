//! Routes that are learnt: what the user moves next modulates a parameter.

use crate::editor::binding;
use crate::editor::controls::{Controls, Learning, Said};
use crate::editor::routes::add;
use egui::{Key, Ui};
use sprung::params::ParamInfo;
use sprung::patch::routes::Source;
use std::time::Duration;

/// Time between two checks for a movement.
const PAUSE: Duration = Duration::from_millis(50);
/// If less than this share of the travel is left above a knob's position, a new route moves it downwards.
const LEAST: f32 = 0.05;

/// Waits for the next movement of a controller.
pub(crate) fn begin(info: &'static ParamInfo, controls: &mut Controls) {
    // A controller that is to be bound is not seen here.
    binding::stop(controls.params, &mut controls.interaction.binding);
    let (seen, _) = controls.params.link().telemetry.moved();
    controls.interaction.learning = Some(Learning { info, seen, is_prompted: false });
}

/// Checks whether a controller was moved, and makes a route from it. Returns a message.
pub(crate) fn follow(ui: &Ui, controls: &mut Controls) -> Option<Said> {
    let learning = controls.interaction.learning.as_mut()?;
    let info = learning.info;
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        controls.interaction.learning = None;
        return Some(Ok("nothing was learnt".to_owned()));
    }
    ui.ctx().request_repaint_after(PAUSE);
    let (count, moved) = controls.params.link().telemetry.moved();
    if count == std::mem::replace(&mut learning.seen, count) {
        let is_prompted = std::mem::replace(&mut learning.is_prompted, true);
        return (!is_prompted).then(|| {
            let sources = "wheel, pitch wheel, pressure, breath, expression or controller 74";
            Ok(format!("{}: move what is to modulate it ({sources}); Escape gives up", info.name))
        });
    }
    let moved = moved?;
    let Some(source) = moved.source() else {
        return Some(Err(format!(
            "{moved} is no source of routes: expected controller 1 (wheel), 2 (breath), 11 (expression), 74 (timbre), the \
             pitch wheel or pressure"
        )));
    };
    controls.interaction.learning = None;
    Some(learn(source, info, controls))
}

/// Adds a route from a source. Its amount moves the knob to the end of its travel. Returns a message.
fn learn(source: Source, info: &'static ParamInfo, controls: &mut Controls) -> Said {
    let position = controls.position(info);
    let travel = if 1.0 - position >= LEAST { 1.0 - position } else { -position };
    add(source, info, (100.0 * travel).round(), controls)
}
