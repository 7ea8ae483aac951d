//! Trying sounds in the browser: by keys along its shelves, kept by Enter, and taken back by Escape.

use super::pictures::{Stage, stage};
use crate::editor::theme::{SIZE, Theme};
use crate::link::Touch;
use crate::state::State;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use sprung::internals::library::Library;
use sprung::params::Param;
use sprung::preset::{Playable, Preset};
use std::sync::atomic::Ordering::Relaxed;

impl Stage {
    fn press_key(&mut self, key: Key) {
        self.harness.key_press(key);
        self.harness.run_steps(3);
    }

    fn names(&self) -> Vec<String> {
        let nodes = self.harness.query_all_by_role(Role::ListItem);
        nodes.filter_map(|node| node.accesskit_node().label()).collect()
    }

    fn is_browsing(&self) -> bool {
        self.harness.query_by_label("Search").is_some()
    }
}

/// Counts the strikes since it was asked last.
fn strikes(stage: &Stage) -> impl FnMut() -> usize + use<> {
    let mut touches = stage.params.link().connect(48_000.0);
    move || std::iter::from_fn(|| touches.pop().ok()).filter(|touch| matches!(touch, Touch::Down { .. })).count()
}

/// The browser with the mallets, which stand on more than two shelves, their names, and how many stand on one.
fn mallets() -> (Stage, Vec<String>, usize) {
    let mut stage = stage("Kick", SIZE, 1.0, Theme::Dark);
    stage.host.is_alone.store(true, Relaxed);
    stage.button("Browse");
    stage.button("Show Mallet");
    let names = stage.names();
    let top = |name: &String| stage.harness.get_by_role_and_label(Role::ListItem, name).rect().top();
    let tops: Vec<f32> = names.iter().map(top).collect();
    let columns = tops.iter().take_while(|top| **top == tops[0]).count();
    assert!(columns > 2 && names.len() > 2 * columns, "{columns} of {}", names.len());
    (stage, names, columns)
}

#[test]
fn arrows_lead_along_the_shelves() {
    let (mut stage, names, columns) = mallets();
    let last = names.len() - 1;
    assert!(stage.paints("Esc brings back what you had"));
    for (key, place) in [
        (Key::ArrowRight, 0),
        (Key::ArrowRight, 1),
        (Key::ArrowDown, 1 + columns),
        (Key::ArrowLeft, columns),
        (Key::ArrowUp, 0),
        (Key::ArrowUp, 0),
        (Key::ArrowLeft, 0),
        (Key::End, last),
        (Key::ArrowRight, last),
        (Key::Home, 0),
        (Key::PageDown, (last / columns * columns).min(last)),
        (Key::PageUp, 0),
    ] {
        stage.press_key(key);
        assert_eq!(stage.params.name(), names[place], "{key:?}");
    }
    // With the focus on a sound it goes along, and Space and Enter press it.
    stage.harness.get_by_role_and_label(Role::ListItem, &names[1]).focus();
    stage.harness.run_steps(2);
    for (key, place) in [(Key::Space, 1), (Key::ArrowRight, 2), (Key::ArrowDown, 2 + columns)] {
        stage.press_key(key);
        assert_eq!(stage.params.name(), names[place], "{key:?}");
        assert!(stage.harness.get_by_role_and_label(Role::ListItem, &names[place]).is_focused(), "{key:?}");
    }
    stage.press_key(Key::Enter);
    assert!(!stage.is_browsing() && stage.params.name() == names[2 + columns]);
}

#[test]
fn left_and_right_belong_to_the_words_and_space_plays_again_where_there_are_none() {
    let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
    let mut strikes = strikes(&stage);
    stage.button("Browse");
    stage.press_key(Key::ArrowRight);
    assert!(stage.params.name() != "Church Bell" && strikes() == 1, "the search is empty");
    let tried = stage.params.state();
    stage.harness.event(egui::Event::Text(" ".to_owned()));
    stage.press_key(Key::Space);
    assert_eq!((strikes(), stage.params.state() == tried), (1, true));
    let words = |stage: &Stage| stage.harness.get_by_role_and_label(Role::TextInput, "Search").accesskit_node().value();
    assert_eq!(words(&stage).unwrap_or_default(), "", "the space is no word");
    stage.type_text("xylophone");
    stage.press_key(Key::ArrowLeft);
    stage.press_key(Key::Space);
    assert!(stage.params.state() == tried && strikes() == 0);
    // Enter takes the first that is found, and keeps it the next time.
    stage.press_key(Key::Enter);
    assert!(stage.is_browsing() && strikes() == 1);
    assert_eq!(stage.params.name(), stage.names()[0]);
    stage.press_key(Key::Enter);
    assert!(!stage.is_browsing());
}

#[test]
fn after_a_click_the_keys_are_those_of_the_list_although_words_are_searched_for() {
    let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
    let mut strikes = strikes(&stage);
    stage.button("Browse");
    stage.type_text("marimba");
    let names = stage.names();
    let at = stage.harness.get_by_role_and_label(Role::ListItem, &names[1]).rect().center();
    stage.click(at);
    assert_eq!((stage.params.name(), strikes()), (names[1].clone(), 1));
    stage.harness.event(egui::Event::Text(" ".to_owned()));
    stage.press_key(Key::Space);
    assert_eq!((stage.names().len(), strikes()), (names.len(), 1), "Space plays it again, and is no word");
    stage.press_key(Key::ArrowRight);
    stage.press_key(Key::ArrowLeft);
    stage.press_key(Key::ArrowRight);
    assert_eq!(stage.params.name(), names[2]);
    stage.press_key(Key::Enter);
    assert!(!stage.is_browsing() && stage.params.name() == names[2]);
    // The cursor has stayed behind the words.
    stage.button("Browse");
    stage.type_text("marimba");
    stage.press_key(Key::ArrowDown);
    stage.press_key(Key::ArrowLeft);
    stage.type_text("x");
    let words = stage.harness.get_by_role_and_label(Role::TextInput, "Search").accesskit_node().value();
    assert!(words.is_some_and(|words| words.ends_with("marimbax")));
}

#[test]
fn a_click_on_a_family_or_a_tag_leaves_the_keys_to_the_search() {
    let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
    stage.host.is_alone.store(true, Relaxed);
    let mut strikes = strikes(&stage);
    stage.press_key(Key::Slash);
    let words = |stage: &Stage| stage.harness.get_by_role_and_label(Role::TextInput, "Search").accesskit_node().value();
    // The first family is chosen already.
    for (name, typed, all) in
        [("Show All", "m", "m"), ("Show Mallet", "glass", "glass"), ("Only glass", " m", "glass m")]
    {
        stage.button(name);
        // A key that would play.
        stage.harness.key_press(Key::M);
        stage.type_text(typed);
        assert_eq!((words(&stage).as_deref(), strikes()), (Some(all), 0), "{name}");
    }
    // The arrows walk on to what was found in other families.
    let names = stage.names();
    assert!(stage.paints("Elsewhere:") && names.len() > 1);
    for (key, name) in [(Key::ArrowDown, &names[0]), (Key::ArrowDown, &names[1]), (Key::End, &names[names.len() - 1])] {
        stage.press_key(key);
        assert_eq!(&stage.params.name(), name, "{key:?}");
    }
    stage.press_key(Key::Escape);
    assert!(!stage.is_browsing());
}

#[test]
fn tried_sounds_are_one_step_which_escape_takes_back() {
    for is_kept in [true, false] {
        let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
        stage.button("Next sound");
        stage.params.knobs()[Param::Decay as usize].turn(0.9);
        let before = stage.params.state();
        stage.button("Browse");
        stage.button("Show Mallet");
        for name in ["Marimba", "Xylophone", "Vibraphone"] {
            stage.harness.get_by_role_and_label(Role::TextInput, "Search").focus();
            stage.harness.run_steps(2);
            stage.harness.get_by_role_and_label(Role::ListItem, name).click();
            stage.harness.run_steps(3);
            let search = stage.harness.get_by_role_and_label(Role::TextInput, "Search");
            assert!(search.is_focused(), "so that keys go on being the window's in a host");
        }
        stage.press_key(Key::ArrowLeft);
        let last = stage.params.name();
        assert_eq!(last, "Steel Tongue");
        stage.press_key(if is_kept { Key::Enter } else { Key::Escape });
        assert!(!stage.is_browsing());
        if is_kept {
            assert_eq!(stage.params.name(), last);
            stage.button("Undo");
            stage.harness.get_by_label_contains(&format!("taken back: {} → {last}", before.playable.name()));
        } else {
            stage.harness.get_by_label_contains(&format!("‘{}’ is back as it was", before.playable.name()));
        }
        assert!(stage.params.state() == before, "with what had been changed");
        stage.button("Redo");
        assert_eq!(stage.params.name(), last);
        // A step of its own comes after it, and what is tried in another visit is another.
        stage.button("Browse");
        stage.button("Show Bell");
        stage.press_key(Key::ArrowRight);
        stage.button("Undo");
        assert_eq!(stage.params.name(), last);
        stage.press_key(Key::Escape);
        assert_eq!(stage.params.name(), last, "what there was when the browser was opened");
    }
}

#[test]
fn a_sound_that_is_left_and_come_back_to_is_no_step_and_saving_keeps_what_was_tried() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let disabled = |stage: &Stage| stage.harness.get_by_label("Undo").accesskit_node().is_disabled();
    stage.button("Browse");
    stage.button("Show Mallet");
    for key in [Key::ArrowRight, Key::ArrowRight, Key::ArrowLeft, Key::ArrowLeft] {
        assert_eq!(disabled(&stage), stage.params.name() == "Marimba");
        stage.press_key(key);
    }
    assert!(stage.params.name() == "Marimba" && disabled(&stage));
    stage.press_key(Key::ArrowRight);
    stage.button("Save");
    stage.type_text("Kept");
    stage.button("Save under this name");
    stage.press_key(Key::Escape);
    assert_eq!(stage.params.name(), "Kept");
    // A name that one was typing is left first.
    stage.button("Browse");
    stage.press_key(Key::ArrowRight);
    let tried = stage.params.name();
    stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under").click();
    stage.harness.run_steps(2);
    stage.press_key(Key::Escape);
    assert!(stage.is_browsing() && stage.params.name() == tried);
    stage.press_key(Key::Escape);
    assert!(!stage.is_browsing() && stage.params.name() == "Kept");
}

#[test]
fn the_sound_of_a_pad_comes_back_to_its_pad() {
    let mut stage = stage("Kick", SIZE, 1.0, Theme::Dark);
    let kit = State::new(Playable::find("Acoustic Kit").unwrap(), 0, stage.params.view());
    stage.params.load(kit.of_pad(38).unwrap().into());
    stage.harness.run_steps(3);
    let before = stage.params.state();
    assert!(before.pad.is_some());
    stage.button("Browse");
    stage.button("Show Kits");
    stage.press_key(Key::Home);
    assert!(stage.params.pad().is_none(), "a kit has taken its place");
    stage.button("Show Bell");
    stage.press_key(Key::ArrowRight);
    stage.press_key(Key::Escape);
    assert!(stage.params.state() == before);
    stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    stage.harness.run_steps(2);
    assert!(stage.params.state() == before, "that was all");
}

#[test]
fn the_arrows_in_the_header_walk_the_list_of_the_browser_and_play() {
    let mut stage = stage("Kick", SIZE, 1.0, Theme::Dark);
    let mut strikes = strikes(&stage);
    stage.button("Browse");
    stage.button("Show Mallet");
    stage.button("Only wood");
    let names = stage.names();
    stage.button("Browse");
    assert!(!stage.is_browsing() && (2..14).contains(&names.len()));
    for name in names.iter().chain(&names[..1]) {
        stage.button("Next sound");
        assert_eq!((stage.params.name(), strikes()), (name.clone(), 1), "from its first, and round");
    }
    stage.button("Previous sound");
    assert_eq!(Some(&stage.params.name()), names.last());
    stage.button("Undo");
    assert_eq!(stage.params.name(), names[0], "each of them is a step");
    // While the list is open, they are tried.
    stage.button("Browse");
    stage.button("Next sound");
    stage.button("Next sound");
    stage.press_key(Key::Escape);
    assert_eq!(stage.params.name(), names[0]);
}

#[test]
fn the_star_of_the_loaded_sound_is_one_in_header_list_and_details() {
    let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    let is_on = |stage: &Stage, name: &str| {
        let star = stage.harness.get_by_role_and_label(Role::CheckBox, name).accesskit_node();
        star.toggled() == Some(egui::accesskit::Toggled::True) || star.is_selected() == Some(true)
    };
    let stars = ["Favourite the loaded sound", "Favourite Church Bell", "Favourite this sound"];
    stage.button(stars[0]);
    assert!(library.favourites().unwrap().contains("Church Bell"));
    stage.button("Browse");
    stage.button("Show Bell");
    assert!(stars.iter().all(|star| is_on(&stage, star)));
    for star in stars {
        stage.button(star);
        let now = library.favourites().unwrap().contains("Church Bell");
        assert!(stars.iter().all(|star| is_on(&stage, star) == now), "{star}");
    }
    assert!(!library.favourites().unwrap().contains("Church Bell"));
}

#[test]
fn what_moves_a_sound_is_shown_its_macros_turn_and_its_details_open() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    let before = stage.params.state();
    let preset = Preset::find("Marimba").unwrap();
    let comment: Vec<&str> = preset.comment.split(' ').take(2).collect();
    for words in ["Moved by", "Mallet", "Noise", "Knock", &comment.join(" "), "by Sprung · C2 to C7, best at C4"] {
        assert!(stage.paints(words), "{words}");
    }
    assert!(!stage.paints("undercut"));
    stage.button("Details of this sound");
    assert!(stage.paints("undercut"));
    stage.harness.get_by_role_and_label(Role::Slider, "Macro 1").focus();
    stage.harness.run_steps(2);
    for _ in 0..5 {
        stage.press_key(Key::ArrowUp);
    }
    let macro1 = |stage: &Stage| stage.params.knobs()[Param::Macro1 as usize].position();
    assert!(macro1(&stage) > 0.04 && stage.params.name() == "Marimba", "the arrows are the knob's");
    // Escape leaves what is typed for it, and then the browser.
    stage.press_key(Key::Enter);
    stage.type_text("50");
    stage.press_key(Key::Escape);
    assert!(stage.is_browsing() && macro1(&stage) < 0.2);
    stage.harness.get_by_role_and_label(Role::Slider, "Macro 1").click_secondary();
    stage.harness.run_steps(3);
    stage.button("Name Macro 1");
    stage.press_key(Key::Escape);
    assert!(stage.is_browsing(), "nor does a name that is given up close it");
    stage.press_key(Key::Escape);
    assert!(!stage.is_browsing() && stage.params.state() == before);
    stage.button("Browse");
    assert!(stage.paints("undercut"), "it stays open");
    stage.button("Use this sound");
    assert!(!stage.is_browsing());
}

#[test]
fn the_dice_roll_another_sound_but_for_what_is_locked() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    stage.harness.get_by_label("Roll the dice").click_secondary();
    stage.harness.run_steps(3);
    stage.button("Lock Body");
    stage.press_key(Key::Escape);
    stage.button("Roll the dice");
    let after = stage.params.state();
    assert!(after != before);
    let modes = |state: &State| match &state.playable {
        Playable::Preset(preset) => preset.patch.modes.clone(),
        Playable::Kit(_) => unreachable!(),
    };
    assert!(modes(&after) == modes(&before));
    stage.button("Undo");
    assert!(stage.params.state() == before);
}
