//! Controllers that turn knobs: learnt from the next one that moves, forgotten, and kept for the user.

use crate::editor::controls::{Binding, Controls, Said};
use crate::params::SprungParams;
use egui::{Key, Ui};
use nice_plug_core::context::PluginApi;
use sprung::internals::learned::check_controller;
use sprung::internals::library::Library;
use sprung::params::ParamInfo;
use std::time::Duration;

/// Time between two checks for a movement.
const PAUSE: Duration = Duration::from_millis(50);

/// The part of a parameter's menu that learns and forgets its controller. In VST3, where controllers come as parameters of their
/// own, hosts do it.
pub(super) fn menu(ui: &mut Ui, info: &'static ParamInfo, controls: &mut Controls) {
    if controls.host.plugin_api() == PluginApi::Vst3 {
        return;
    }
    if let Some(bound) = controls.controller(info) {
        ui.label(bound);
        if ui.button("Forget the controller").clicked() {
            stop(controls.params, &mut controls.interaction.binding);
            controls.interaction.binding = Some(Binding::Forget(info));
            ui.close();
        }
    }
    if ui.button("Learn a controller").clicked() {
        controls.interaction.learning = None;
        controls.interaction.binding = Some(Binding::Learn { info, is_prompted: false });
        controls.params.learned().listen();
        ui.close();
    }
}

/// Carries out what the menu began. Returns a message.
pub(super) fn follow(ui: &Ui, library: Option<&Library>, controls: &mut Controls) -> Option<Said> {
    let learned = controls.params.learned();
    let (info, controller) = match controls.interaction.binding.as_mut()? {
        Binding::Forget(info) => (*info, None),
        Binding::Learn { .. } if ui.input(|input| input.key_pressed(Key::Escape)) => {
            stop(controls.params, &mut controls.interaction.binding);
            return Some(Ok("nothing was learnt".to_owned()));
        }
        Binding::Learn { info, is_prompted } => {
            ui.ctx().request_repaint_after(PAUSE);
            let waits = learned.is_listening();
            let Some(controller) = learned.heard() else {
                if !waits {
                    controls.interaction.binding = None;
                    return Some(Err("nothing was learnt: another window has ended it".to_owned()));
                }
                let asks = !std::mem::replace(is_prompted, true);
                return asks.then(|| {
                    Ok(format!("{}: move the knob, fader or pedal that is to turn it; Escape gives up", info.name))
                });
            };
            if let Err(reason) = check_controller(controller) {
                learned.listen();
                return Some(Err(reason));
            }
            (*info, Some(controller))
        }
    };
    stop(controls.params, &mut controls.interaction.binding);
    let Some(library) = library else {
        return Some(Err("the system names no folder in which a controller could be kept".to_owned()));
    };
    let before =
        controller.and_then(|controller| learned.param(controller)).filter(|before| before.param != info.param);
    let kept = library.set_controller(info.param, controller).map_err(|error| error.to_string());
    Some(kept.map(|controllers| {
        learned.publish(&controllers);
        let instead = before.map_or(String::new(), |before| format!(" in place of {}", before.name));
        match controller {
            None => format!("no controller turns {}", info.name),
            Some(controller) => {
                format!("CC {controller} turns {}{instead}, once it has reached its position", info.name)
            }
        }
    }))
}

/// Waits no longer for a controller, if the window does.
pub(super) fn stop(params: &SprungParams, binding: &mut Option<Binding>) {
    if let Some(Binding::Learn { .. }) = binding.take() {
        params.learned().stop();
    }
}
