//! A parameter's row in the window: its name, and a slider or a choice, with a text field.

use crate::params::{Knob, SprungParams};
use egui::{ComboBox, Label, Sense, Slider, Ui};
use nice_plug_core::context::gui::GuiContext;
use sprung::params::{ParamInfo, Unit};

/// The rows of a window.
#[derive(Default)]
pub(super) struct Rows {
    /// Index of the parameter for which the host was told that a gesture has begun.
    moving: Option<usize>,
}

impl Rows {
    /// Shows a row in two columns of a grid.
    pub(super) fn show(&mut self, ui: &mut Ui, params: &SprungParams, host: &GuiContext, info: &'static ParamInfo) {
        let index = info.param as usize;
        let knob = &params.knobs()[index];
        let name = ui.add(Label::new(info.name).sense(Sense::click()));
        let help = format!("{}\nDouble-click for {}.", info.help, info.format(info.default));
        if name.on_hover_text(help).double_clicked() {
            self.turn(host, index, knob, info.normalise(info.default));
            self.let_go(host, index, knob);
        }
        let mut position = f64::from(knob.position());
        if info.unit == Unit::Choice {
            let mut chosen = info.denormalise(position) as usize;
            let choice = ComboBox::from_id_salt(info.id).width(120.0);
            if choice.show_index(ui, &mut chosen, info.choices.len(), |choice| info.choices[choice]).changed() {
                self.turn(host, index, knob, info.normalise(chosen as f32));
                self.let_go(host, index, knob);
            }
            return;
        }
        ui.spacing_mut().slider_width = 320.0;
        let slider = Slider::new(&mut position, 0.0..=1.0)
            .smart_aim(false)
            .update_while_editing(false)
            .custom_formatter(|position, _| info.format(info.denormalise(position)))
            .custom_parser(|text| Some(info.normalise(info.parse(text).ok()?)));
        let slider = ui.add(slider);
        if slider.changed() {
            self.turn(host, index, knob, position);
        }
        if !slider.dragged() {
            self.let_go(host, index, knob);
        }
    }

    /// Changes a parameter through the host, which may record it as automation.
    fn turn(&mut self, host: &GuiContext, index: usize, knob: &Knob, position: f64) {
        let setter = host.param_setter();
        if self.moving != Some(index) {
            self.moving = Some(index);
            match knob {
                Knob::Continuous(knob) => setter.begin_set_parameter(knob),
                Knob::Stepped(knob) => setter.begin_set_parameter(knob),
            }
        }
        match knob {
            Knob::Continuous(knob) => setter.set_parameter_normalized(knob, position as f32),
            Knob::Stepped(knob) => setter.set_parameter_normalized(knob, position as f32),
        }
    }

    fn let_go(&mut self, host: &GuiContext, index: usize, knob: &Knob) {
        if self.moving == Some(index) {
            self.moving = None;
            let setter = host.param_setter();
            match knob {
                Knob::Continuous(knob) => setter.end_set_parameter(knob),
                Knob::Stepped(knob) => setter.end_set_parameter(knob),
            }
        }
    }
}

/// Tells the host the positions of all knobs, after they have changed without it.
pub(super) fn announce(params: &SprungParams, host: &GuiContext) {
    let mut rows = Rows::default();
    for (index, knob) in params.knobs().iter().enumerate() {
        rows.turn(host, index, knob, f64::from(knob.position()));
        rows.let_go(host, index, knob);
    }
}
