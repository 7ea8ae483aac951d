//! Changes of parameters through the host, which may record them as automation.

use crate::params::{Knob, SprungParams};
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use sprung::params::{PARAM_COUNT, Param, ParamInfo};
use std::array::from_fn;

/// A parameter's change in progress, which the host sees as one gesture.
#[derive(Default)]
pub(crate) struct Gestures {
    /// Index of the parameter whose gesture the host has seen begin.
    moving: Option<usize>,
}

impl Gestures {
    /// The parameter that is being changed.
    pub(crate) fn moving(&self) -> Option<usize> {
        self.moving
    }

    /// Moves a knob. The first call ends any other gesture and begins this one.
    pub(super) fn turn(&mut self, params: &SprungParams, host: &GuiContext, index: usize, position: f32) {
        if self.moving != Some(index) {
            self.end(params, host);
            self.moving = Some(index);
            let setter = host.param_setter();
            match &params.knobs()[index] {
                Knob::Continuous(knob) => setter.begin_set_parameter(knob),
                Knob::Stepped(knob) => setter.begin_set_parameter(knob),
            }
        }
        let knob = &params.knobs()[index];
        // In a VST3 host that does not process, the wrapper's own change would be lost.
        knob.turn(position);
        let setter = host.param_setter();
        match knob {
            Knob::Continuous(knob) => setter.set_parameter_normalized(knob, position),
            Knob::Stepped(knob) => setter.set_parameter_normalized(knob, position),
        }
    }

    /// Ends the gesture, if there is one.
    pub(crate) fn end(&mut self, params: &SprungParams, host: &GuiContext) {
        let Some(index) = self.moving.take() else { return };
        let setter = host.param_setter();
        match &params.knobs()[index] {
            Knob::Continuous(knob) => setter.end_set_parameter(knob),
            Knob::Stepped(knob) => setter.end_set_parameter(knob),
        }
    }

    /// Moves a knob, as one gesture.
    pub(crate) fn set(&mut self, params: &SprungParams, host: &GuiContext, index: usize, position: f32) {
        self.turn(params, host, index, position);
        self.end(params, host);
    }
}

/// The positions of all knobs.
fn positions(params: &SprungParams) -> [f32; PARAM_COUNT] {
    from_fn(|index| params.knobs()[index].position())
}

/// Loads a state, and tells the host which knobs have moved.
pub(crate) fn load(state: State, params: &SprungParams, host: &GuiContext) {
    let before = positions(params);
    params.load(state.into());
    announce(params, host, &before);
}

/// Changes the present state by `change`, and tells the host which knobs have moved. Does nothing if there is no other state.
pub(crate) fn change(params: &SprungParams, host: &GuiContext, change: impl FnOnce(State) -> Option<State>) {
    let before = positions(params);
    if params.change(change).is_some() {
        announce(params, host, &before);
    }
}

/// Asks the host for its own menu of a parameter, at a place in the window.
#[allow(unsafe_code, reason = "the wrapper's interface is unsafe")]
pub(crate) fn show_host_menu(params: &SprungParams, host: &GuiContext, info: &ParamInfo, [x, y]: [i32; 2]) {
    let param = params.knobs()[info.param as usize].as_ptr();
    // SAFETY: the parameters live as long as the window, and the wrapper ignores those it does not know.
    unsafe { host.raw_show_host_menu(param, x, y) };
}

/// Tells the host that something other than a knob has changed, so that it saves the project. The wrapper offers only
/// one way: a gesture that leaves a knob where it is.
pub(crate) fn touch(params: &SprungParams, host: &GuiContext) {
    let index = Param::Voices as usize;
    Gestures::default().set(params, host, index, params.knobs()[index].position());
}

/// Tells the host of the knobs that are no longer at the positions `before`, or that something else has changed.
fn announce(params: &SprungParams, host: &GuiContext, before: &[f32; PARAM_COUNT]) {
    let mut gestures = Gestures::default();
    if positions(params).iter().zip(before).all(|(now, before)| now.to_bits() == before.to_bits()) {
        return touch(params, host);
    }
    for (index, (now, before)) in positions(params).into_iter().zip(before).enumerate() {
        if now.to_bits() != before.to_bits() {
            gestures.set(params, host, index, now);
        }
    }
}
