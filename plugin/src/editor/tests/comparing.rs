//! The search for sounds like one, in the background.

use super::pictures::{Stage, stage};
use crate::editor::theme::{SIZE, Theme};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// Seconds within which a comparison ends, however busy the machine is.
const LONGEST: u64 = 300;

/// The window while sounds are compared with the marimba.
fn comparing() -> Stage {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    stage.type_text("marimba");
    stage.button("Find sounds like this one");
    stage
}

#[test]
fn the_search_for_sounds_like_one_is_cancelled() {
    let mut stage = comparing();
    stage.button("Cancel the comparison");
    stage.within(LONGEST, |stage| stage.harness.query_by_label("Cancel the comparison").is_none());
    assert!(stage.harness.query_by_label("Show Like Marimba").is_none(), "nothing was found");
}

#[test]
#[ignore = "takes several seconds"]
fn sounds_like_one_are_found_in_the_background() {
    let mut stage = comparing();
    stage.within(LONGEST, |stage| stage.harness.query_by_label("Show Like Marimba").is_some());
    let listed: Vec<_> =
        stage.harness.query_all_by_role(Role::ListItem).filter_map(|node| node.accesskit_node().label()).collect();
    assert_eq!(listed[0], "Marimba", "nothing is nearer to it than itself: {listed:?}");
    assert!(listed.iter().any(|name| name == "Resonator Marimba"), "{listed:?}");
}
