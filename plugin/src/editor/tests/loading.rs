//! States that the host loads while the window is open, and the window that stays as it is.

use super::pictures::{Stage, facing, stage};
use crate::editor::theme::{SIZE, Theme};
use crate::editor::window::Face;
use crate::params::SprungParams;
use crate::state::{FIELD, State};
use egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use nice_plug::prelude::Params as _;
use nice_plug_core::editor::dpi::PhysicalSize;
use nice_plug_egui::baseview::WindowSize;
use sprung::params::Param;
use sprung::preset::Playable;
use std::collections::BTreeMap;

/// Loads a sound as the host does it, with a view of its own.
fn host_loads(params: &SprungParams, sound: &str) {
    let State { seed, mut view, .. } = State::default();
    (view.size, view.zoom, view.theme) = ([800, 600], 150, Theme::Light);
    let state = State::new(Playable::find(sound).unwrap(), seed, view);
    params.deserialize_fields(&BTreeMap::from([(FIELD.to_owned(), state.to_json())]));
}

impl Stage {
    /// The host loads a sound while the window is open.
    fn host_loads(&mut self, sound: &str) {
        host_loads(&self.params, sound);
        self.harness.run_steps(3);
    }

    pub(super) fn can(&self, button: &str) -> bool {
        !self.harness.get_by_role_and_label(egui::Role::Button, button).accesskit_node().is_disabled()
    }

    fn pointer(&mut self, pos: Pos2, pressed: bool) {
        self.harness.event(Event::PointerMoved(pos));
        self.harness.event(Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        self.harness.run_steps(2);
    }
}

#[test]
fn what_can_be_undone_and_what_is_not_saved_outlives_the_window() {
    let mut stage = facing(Face::Play, "Marimba", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    stage.button("Next sound");
    let loaded = stage.params.state();
    stage.harness.get_by_label("Bow alone").click();
    stage.harness.run_steps(3);
    let is_marked = |stage: &Stage| stage.paints(&format!("{} *", stage.params.name()));
    assert!(is_marked(&stage) && stage.params.state() != loaded);
    stage.button("Kit");
    let mut stage = stage.reopened(|_| ());
    assert!(is_marked(&stage) && stage.paints("Make a kit"), "its page, too");
    stage.button("Undo");
    assert!(stage.params.state() == loaded && !is_marked(&stage));
    stage.button("Undo");
    assert!(stage.params.state() == before);
    stage.button("Redo");
    // A state that the host loads meanwhile is another project's.
    let stage = stage.reopened(|params| host_loads(params, "Church Bell"));
    assert!(!stage.can("Undo") && !stage.can("Redo"));
}

#[test]
fn undo_redo_and_the_other_version_do_not_cross_a_state_that_the_host_loads() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.button("Copy A to B");
    stage.button("Next sound");
    stage.button("Next sound");
    stage.button("Undo");
    assert!(stage.can("Undo") && stage.can("Redo"));
    stage.host_loads("Church Bell");
    assert!(!stage.can("Undo") && !stage.can("Redo"), "there is nothing to take back");
    for button in ["Undo", "Redo", "A or B"] {
        stage.button(button);
        assert_eq!(stage.params.name(), "Church Bell", "{button}");
    }
    stage.button("Next sound");
    stage.button("Undo");
    assert_eq!(stage.params.name(), "Church Bell", "from here on, steps are taken back");
}

#[test]
fn an_action_that_began_before_a_load_does_not_bring_the_former_sound_back() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.tab("Mallet");
    let knob = stage.harness.get_by_role_and_label(egui::Role::Slider, "Mallet level").rect().center();
    stage.pointer(knob, true);
    stage.harness.event(Event::PointerMoved(knob + vec2(20.0, 0.0)));
    stage.harness.run_steps(2);
    stage.host_loads("Church Bell");
    let loaded = stage.params.state();
    stage.pointer(knob + vec2(20.0, 0.0), false);
    assert_eq!(stage.params.name(), "Church Bell");
    if stage.can("Undo") {
        stage.button("Undo");
        assert_eq!(stage.params.name(), "Church Bell");
    }
    let level = |state: &State| state.values.get(Param::MalletLevel);
    assert_eq!(level(&stage.params.state()), level(&loaded));
}

#[test]
fn an_open_window_keeps_its_view_and_a_closed_one_has_that_of_the_state() {
    for is_open in [false, true] {
        let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
        let before = stage.params.view();
        if is_open {
            stage.params.extent().set(WindowSize::from_physical(PhysicalSize::new(1_100, 700), 1.0));
        }
        stage.host_loads("Church Bell");
        assert_eq!(stage.params.view() == before, is_open);
    }
}

#[test]
fn the_way_back_from_a_zoom_stays_within_reach_in_the_smallest_windows() {
    // At 300 % in a host that leaves the window as it is.
    for size in [[367, 233], [320, 320]] {
        let mut stage = stage("Marimba", size, 1.0, Theme::Dark);
        let view = stage.harness.get_by_label("Menu").rect();
        assert!(view.left() >= 0.0 && view.right() <= size[0] as f32, "{size:?}: {view:?}");
        stage.button("Menu");
        stage.button("100 %");
        assert_eq!(stage.params.view().zoom, 100);
    }
}
