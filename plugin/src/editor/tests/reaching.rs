//! The keyboard's focus, which Tab leads into what is not on screen.

use super::pictures::{Stage, facing, stage};
use crate::editor::theme::layout::Layout;
use crate::editor::theme::{LEAST_SIZE, Theme};
use crate::editor::window::Face;
use egui::{Key, Modifiers, Pos2, Rect, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// Where pages are in the smallest window.
pub(super) fn page() -> Rect {
    let [width, height] = LEAST_SIZE.map(|side| side as f32);
    Layout::of(Rect::from_min_size(Pos2::ZERO, vec2(width, height))).page()
}

impl Stage {
    /// The names of all of a role that are within a place; only that with the focus, if so wanted.
    fn seen(&self, role: Role, within: Rect, is_focused: bool) -> Vec<String> {
        let nodes = self.harness.query_all_by_role(role);
        let seen = nodes.filter(|node| within.contains_rect(node.rect()) && (!is_focused || node.is_focused()));
        seen.filter_map(|node| node.accesskit_node().label()).collect()
    }

    /// Presses Tab, with Shift or without, until something of a role has the focus that could not be seen before, and is seen now.
    pub(super) fn reach(&mut self, role: Role, within: Rect, modifiers: Modifiers) {
        let before = self.seen(role, within, false);
        let nearest = if modifiers.shift { before.first() } else { before.last() };
        self.harness.get_by_role_and_label(role, nearest.unwrap()).focus();
        self.harness.run_steps(2);
        for _ in 0..300 {
            self.harness.key_press_modifiers(modifiers, Key::Tab);
            self.harness.step();
            if self.seen(role, within, true).iter().any(|now| !before.contains(now)) {
                return;
            }
        }
        panic!("Tab leads to nothing but {before:?}");
    }
}

#[test]
fn tab_leads_on_into_rows_that_are_not_on_screen_and_back() {
    let mut stage = stage("Marimba", LEAST_SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    let first = stage.seen(Role::ListItem, page(), false)[0].clone();
    for _ in 0..3 {
        stage.reach(Role::ListItem, page(), Modifiers::NONE);
    }
    assert!(!stage.seen(Role::ListItem, page(), false).contains(&first));
    for _ in 0..3 {
        stage.reach(Role::ListItem, page(), Modifiers::SHIFT);
    }
    assert!(stage.seen(Role::ListItem, page(), false).contains(&first));
}

#[test]
fn tab_leads_into_all_that_is_scrolled() {
    let mut stage = facing(Face::Kit, "Acoustic Kit", LEAST_SIZE, 1.0, Theme::Dark);
    stage.reach(Role::ListItem, page(), Modifiers::NONE);
    stage.harness.get_by_role_and_label(Role::Tab, "Keys").click();
    stage.harness.run_steps(3);
    stage.reach(Role::Button, page(), Modifiers::NONE);
    let mut stage = facing(Face::Motion, "Church Bell", LEAST_SIZE, 1.0, Theme::Dark);
    let below = stage.harness.get_by_role_and_label(Role::Slider, "LFO 1 rate").rect().top();
    stage.reach(Role::Button, page().with_max_y(below).with_min_x(page().left() + 150.0), Modifiers::NONE);
    let mut stage = facing(Face::Sound, "Acoustic Kit", LEAST_SIZE, 1.0, Theme::Dark);
    stage.tab("Knobs");
    stage.reach(Role::Slider, page(), Modifiers::NONE);
}
