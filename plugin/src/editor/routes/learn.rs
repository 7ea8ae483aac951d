//! Routes that are learnt: what the user moves next modulates a parameter.

use crate::editor::binding;
use crate::editor::controls::{Controls, Learning, Said};
use crate::editor::routes::add;
use egui::{Key, Ui};
use sprung::params::ParamInfo;
use sprung::patch::routes::{Route, Source};
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
    let down = down(controls);
    controls.interaction.learning = Some(Learning { info, seen, down, is_struck: false, is_prompted: false });
}

/// The keys that are down on any channel.
fn down(controls: &Controls) -> u128 {
    (0..16).fold(0, |down, channel| down | controls.params.link().telemetry.keys(channel))
}

/// Checks whether a controller was moved, and makes a route from it. Returns a message.
pub(crate) fn follow(ui: &Ui, controls: &mut Controls) -> Option<Said> {
    let down = down(controls);
    let learning = controls.interaction.learning.as_mut()?;
    let info = learning.info;
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        controls.interaction.learning = None;
        return Some(Ok("nothing was learnt".to_owned()));
    }
    ui.ctx().request_repaint_after(PAUSE);
    let (count, moved) = controls.params.link().telemetry.moved();
    if count == std::mem::replace(&mut learning.seen, count) {
        learning.is_struck |= down & !std::mem::replace(&mut learning.down, down) != 0;
        // A key is held to press it, or to move something else meanwhile; what is struck and let go has its velocity alone.
        if learning.is_struck && down == 0 {
            controls.interaction.learning = None;
            return Some(learn(Source::Velocity, info, controls));
        }
        let is_prompted = std::mem::replace(&mut learning.is_prompted, true);
        return (!is_prompted).then(|| {
            let sources =
                "wheel, pitch wheel, pressure, breath, expression, controller 74; or strike a key and let it go";
            Ok(format!("{}: move what is to move it ({sources}); Escape gives up", info.name))
        });
    }
    let moved = moved?;
    let Some(source) = moved.source() else {
        return Some(Err(format!(
            "{moved} is no source of routes: expected controller 1 (wheel), 2 (breath), 11 (expression), 74 (timbre), the \
             pitch wheel, pressure, or a key that is struck and let go"
        )));
    };
    controls.interaction.learning = None;
    Some(learn(source, info, controls))
}

/// Adds a route from a source. Its amount moves the knob to the end of its travel. Returns a message.
fn learn(source: Source, info: &'static ParamInfo, controls: &mut Controls) -> Said {
    let position = controls.position(info);
    let travel = if 1.0 - position >= LEAST { 1.0 - position } else { -position };
    add(Route::linear(source, info.param), (100.0 * travel).round(), controls)
}
