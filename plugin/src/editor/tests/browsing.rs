//! Finding, trying, saving and removing sounds in the browser.

use super::fake_host::FakeHost;
use super::pictures::{Stage, compare, finish, stage};
use crate::editor::controls::files::load;
use crate::editor::controls::history::History;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::link::Touch;
use crate::params::SprungParams;
use crate::state::State;
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use sprung::internals::library::Library;
use sprung::params::Param;
use sprung::preset::{Playable, Preset};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

impl Stage {
    pub(super) fn type_text(&mut self, text: &str) {
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.run_steps(3);
    }
}

#[test]
fn pictures_of_the_browser_are_as_accepted() {
    for (size, theme, name) in [(SIZE, Theme::Dark, "browser"), (LEAST_SIZE, Theme::Dark, "browser-least")] {
        let mut stage = stage("Marimba", size, 1.0, theme);
        stage.button("Browse");
        stage.button("Show Mallet");
        stage.button("Favourite Marimba");
        compare(name, &mut stage.harness);
    }
    let mut stage = stage("Marimba", LEAST_SIZE, 1.0, Theme::HighContrast);
    stage.button("Save");
    compare("save-least", &mut stage.harness);
    finish();
}

#[test]
fn sounds_are_found_by_words_tried_by_arrows_and_undone_by_name() {
    let mut stage = stage("Kick", SIZE, 1.0, Theme::Dark);
    let mut touches = stage.params.link().connect(48_000.0);
    let before = stage.params.state();
    stage.button("Browse");
    // The search field has the focus.
    stage.type_text("church bell");
    stage.harness.key_press(Key::ArrowDown);
    stage.harness.run_steps(2);
    assert_eq!(stage.params.name(), "Church Bell");
    assert!(matches!(touches.pop(), Ok(Touch::Down { .. })), "it is heard");
    stage.harness.run_steps(60);
    assert!(matches!(touches.pop(), Ok(Touch::Up { .. })), "and let go");
    let to_save = |stage: &Stage| {
        let field = stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under");
        field.accesskit_node().value().unwrap()
    };
    assert_eq!(to_save(&stage), "Church Bell");
    stage.button("Undo");
    assert_eq!(to_save(&stage), "Kick", "that of the sound that has come back");
    stage.harness.get_by_label_contains("taken back: Kick → Church Bell");
    stage.button("Redo");
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(2);
    assert!(stage.harness.query_by_label("Search").is_none());
    assert_eq!(stage.params.name(), "Church Bell");
    stage.button("Undo");
    assert_eq!(stage.params.state(), before);
}

#[test]
fn a_slash_searches_in_the_program_alone_since_a_hosts_keys_are_its_own() {
    for is_alone in [false, true] {
        let mut stage = stage("Kick", SIZE, 1.0, Theme::Dark);
        stage.host.is_alone.store(is_alone, Relaxed);
        stage.harness.key_press(Key::Slash);
        stage.harness.run_steps(3);
        assert_eq!(stage.harness.query_by_label("Search").is_some(), is_alone);
        if is_alone {
            stage.type_text("church bell");
            stage.harness.key_press(Key::Slash);
            stage.harness.run_steps(2);
            assert!(stage.harness.query_by_label("Search").is_some(), "it is typed, and closes nothing");
            stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::Plus);
            stage.harness.run_steps(3);
            assert_eq!(stage.params.view().zoom, 125, "no text has such keys");
            stage.harness.key_press(Key::F1);
            stage.harness.run_steps(3);
            assert!(stage.harness.query_by_label("Search").is_none(), "the manual is shown");
        }
    }
}

#[test]
fn keys_undo_and_redo_in_the_program_alone_and_search_no_sound_where_a_path_is_typed() {
    for is_alone in [false, true] {
        let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
        stage.host.is_alone.store(is_alone, Relaxed);
        let before = stage.params.state();
        stage.button("Next sound");
        let after = stage.params.state();
        let mut press = |modifiers, key| {
            stage.harness.key_press_modifiers(modifiers, key);
            stage.harness.run_steps(3);
            stage.params.state()
        };
        let shifted = Modifiers::COMMAND | Modifiers::SHIFT;
        for (modifiers, key, then) in [
            (Modifiers::COMMAND, Key::Z, &before),
            (shifted, Key::Z, &after),
            (Modifiers::COMMAND, Key::Z, &before),
            (Modifiers::COMMAND, Key::Y, &after),
        ] {
            assert_eq!(&press(modifiers, key), if is_alone { then } else { &after }, "{modifiers:?} {key:?}");
        }
        stage.button("Browse");
        stage.button("Import files");
        stage.harness.key_press(Key::Slash);
        stage.harness.run_steps(3);
        assert!(stage.harness.query_by_label("Path of a folder or file").is_some());
    }
}

#[test]
fn keys_zoom_and_open_the_manual_and_a_sound_that_was_not_saved_is_told_for_a_while() {
    let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
    stage.host.is_alone.store(true, Relaxed);
    stage.tab("Mallet");
    for (key, zoom) in [(Key::Plus, 125), (Key::Plus, 150), (Key::Minus, 125), (Key::Num0, 100)] {
        stage.harness.key_press_modifiers(Modifiers::COMMAND, key);
        stage.harness.run_steps(3);
        assert_eq!((stage.params.view().zoom, stage.harness.ctx.zoom_factor()), (zoom, zoom as f32 / 100.0), "{key:?}");
    }
    for is_shown in [true, false] {
        stage.harness.key_press(Key::F1);
        stage.harness.run_steps(3);
        assert_eq!(stage.harness.query_by_role_and_label(Role::Label, "Exciters").is_some(), is_shown);
    }
    // While a knob is dragged, nothing is undone under it.
    let knob = stage.at("Mallet hardness");
    let press = |pressed| Event::PointerButton {
        pos: knob,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    stage.button("Next sound");
    let name = stage.params.name();
    for event in [Event::PointerMoved(knob), press(true), Event::PointerMoved(knob - egui::vec2(0.0, 30.0))] {
        stage.harness.event(event);
        stage.harness.step();
    }
    stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    stage.harness.run_steps(2);
    stage.harness.event(press(false));
    stage.harness.run_steps(2);
    assert_eq!(stage.params.name(), name);
    let changed = stage.params.state();
    let says = |stage: &Stage| stage.harness.query_by_label_contains("was not saved: Undo brings it back").is_some();
    stage.button("Next sound");
    assert!(says(&stage));
    stage.button("Undo");
    assert!(stage.params.state() == changed && !says(&stage));
    stage.button("Next sound");
    stage.harness.run_steps(440);
    assert!(says(&stage));
    let mut paints = (0..60).map(|_| {
        stage.harness.step();
        (says(&stage), stage.harness.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay)
    });
    // Nothing else would repaint an idle window.
    let last = paints.by_ref().take_while(|(says, _)| *says).last().unwrap();
    assert_eq!(last.1, std::time::Duration::ZERO, "a pass without it is asked for");
    assert!(paints.all(|(says, _)| !says), "after some seconds it goes");
    stage.button("Next sound");
    assert!(!says(&stage), "this one was not changed");
}

#[test]
fn a_sound_is_saved_under_a_name_found_again_and_thrown_away() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    stage.button("Save");
    stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under").click();
    stage.harness.run_steps(2);
    stage.type_text(" of Glass");
    let before = stage.params.state();
    for key in [Key::ArrowDown, Key::ArrowUp] {
        stage.harness.key_press(key);
        stage.harness.run_steps(2);
        assert_eq!(stage.params.state(), before, "the arrows are the field's");
    }
    stage.button("Save under this name");
    assert_eq!(stage.params.name(), "Marimba of Glass");
    assert_eq!(library.entries().len(), 1);
    stage.button("Save under this name");
    stage.button("Show Your own");
    stage.harness.get_by_role_and_label(Role::ListItem, "Marimba of Glass").click();
    stage.harness.run_steps(3);
    stage.button("Move your sound to the bin");
    assert!(library.entries().is_empty());
    assert!(stage.harness.query_by_role_and_label(Role::ListItem, "Marimba of Glass").is_none());
}

#[test]
fn save_is_a_name_and_enter() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    let names = |library: &Library| -> Vec<String> {
        library.entries().iter().map(|entry| entry.path.file_name().unwrap().to_string_lossy().into_owned()).collect()
    };
    for from_the_browser in [false, true] {
        if from_the_browser {
            stage.button("Browse");
        }
        stage.button("Save");
        // What is there is selected: typed text replaces it.
        let name = if from_the_browser { "Hall" } else { "Glass" };
        stage.type_text(name);
        stage.harness.key_press(Key::Enter);
        stage.harness.run_steps(3);
        assert_eq!(stage.params.name(), name);
        assert!(stage.harness.query_by_label("Search").is_none(), "that was all");
        stage.harness.get_by_label_contains(&format!("saved {}", library.presets_folder().display()));
    }
    assert_eq!(names(&library), ["glass.toml", "hall.toml"]);
    // A name that is taken is only written over by a second Enter.
    stage.button("Save");
    stage.type_text("Glass");
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    stage.harness.get_by_label_contains("glass.toml exists; Enter again");
    assert_eq!(stage.params.name(), "Hall");
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    stage.harness.get_by_label_contains("saved ");
    assert_eq!((stage.params.name().as_str(), names(&library).len()), ("Glass", 2));
    // Escape saves nothing, and a name that is none is refused where it can be corrected.
    stage.button("Save");
    stage.type_text("Other");
    stage.harness.key_press(Key::Escape);
    stage.harness.run_steps(3);
    assert!(stage.harness.query_by_label("Search").is_none() && names(&library).len() == 2);
    stage.button("Save");
    stage.type_text(" ");
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    assert!(stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under").is_focused());
    assert_eq!((stage.params.name().as_str(), names(&library).len()), ("Glass", 2));
}

#[test]
fn what_is_made_of_a_factory_sound_is_ones_own_with_ones_own_tags() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    let fill = |stage: &mut Stage, field: &str, text: &str| {
        stage.harness.get_by_role_and_label(Role::TextInput, field).focus();
        stage.harness.run_steps(2);
        stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        stage.harness.run_steps(1);
        stage.type_text(text);
    };
    for (name, author) in [("Mine", "Ada"), ("Other", "")] {
        stage.button("Save");
        stage.type_text(name);
        if !author.is_empty() {
            fill(&mut stage, "Author of the saved sound", author);
            fill(&mut stage, "Tags of the saved sound", "mallet, soft , ");
        }
        stage.harness.key_press(Key::Enter);
        stage.harness.run_steps(3);
        assert!(stage.harness.query_by_label("Search").is_none(), "it is saved");
        let entry = library.entries().into_iter().map(|entry| entry.playable.unwrap()).find(|own| own.name() == name);
        let own = entry.unwrap();
        assert_eq!(own.author(), author);
        assert_eq!(own.tags().contains(&"soft".to_owned()), !author.is_empty(), "{:?}", own.tags());
        stage.button("Next sound");
        assert_eq!(stage.params.state().playable.author(), "Sprung");
    }
    stage.harness.get_by_label("Browse");
}

#[test]
fn a_changed_sound_is_not_described_as_the_one_that_it_was_made_of() {
    let mut stage = stage("Glass Marimba", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    let saved = |name: &str| -> Playable {
        let entries = library.entries().into_iter().map(|entry| entry.playable.unwrap());
        entries.into_iter().find(|own| own.name() == name).unwrap()
    };
    let factory = stage.params.state().playable;
    let save = |stage: &mut Stage, name: &str| {
        stage.button("Save");
        stage.type_text(name);
        stage.harness.key_press(Key::Enter);
        stage.harness.run_steps(3);
    };
    save(&mut stage, "As It Is");
    assert_eq!(saved("As It Is").comment(), factory.comment());
    stage.button("Undo");
    stage.tab("Play");
    stage.harness.get_by_role_and_label(Role::RadioButton, "material: steel").click();
    stage.harness.run_steps(3);
    save(&mut stage, "Of Steel");
    let own = saved("Of Steel");
    assert_eq!((own.comment(), own.details()), ("Made from Glass Marimba.", ""));
    assert!(own.tags().contains(&"metal".to_owned()) && !own.tags().contains(&"glass".to_owned()), "{:?}", own.tags());
    assert_eq!(stage.params.state().playable.comment(), own.comment());
    // What one has written oneself stays.
    stage.button("Save");
    stage.harness.get_by_role_and_label(Role::TextInput, "Description of the saved sound").focus();
    stage.harness.run_steps(2);
    stage.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    stage.harness.run_steps(1);
    stage.type_text("Bars of steel.");
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(2);
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    stage.harness.get_by_role_and_label(Role::RadioButton, "material: brass").click();
    stage.harness.run_steps(3);
    save(&mut stage, "Of Brass");
    assert_eq!(saved("Of Brass").comment(), "Bars of steel.");
}

#[test]
fn a_family_is_shown_whole_and_a_search_can_be_cleared() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let is_listed = |stage: &Stage, name: &str| stage.harness.query_by_role_and_label(Role::ListItem, name).is_some();
    stage.button("Browse");
    assert!(stage.harness.query_by_label("Clear the search").is_none(), "there is nothing to clear");
    stage.type_text("church bell");
    assert!(is_listed(&stage, "Church Bell"));
    stage.button("Show Mallet");
    assert!(is_listed(&stage, "Marimba"), "the words of the other search are gone");
    stage.harness.get_by_role_and_label(Role::TextInput, "Search").click();
    stage.harness.run_steps(2);
    stage.type_text("glass");
    assert!(is_listed(&stage, "Glass Marimba") && !is_listed(&stage, "Marimba"), "words search in the family");
    assert!(is_listed(&stage, "Wine Glass") && stage.paints("Elsewhere:"), "and below that in the others");
    assert!(!stage.paints("None in Mallet."));
    stage.button("Show Mallet");
    assert!(!is_listed(&stage, "Marimba"), "it is shown already");
    stage.button("Clear the search");
    assert!(is_listed(&stage, "Marimba"));
    stage.type_text("vibraphone");
    assert!(is_listed(&stage, "Vibraphone") && !is_listed(&stage, "Marimba"), "and what is typed then is searched");
    stage.button("Clear the search");
    stage.type_text("church bell");
    assert!(is_listed(&stage, "Church Bell") && stage.paints("None in Mallet. Elsewhere:"), "it is no mallet's");
    stage.button("Clear the search");
    stage.type_text("qwertz");
    assert!(!stage.paints("None in Mallet. Elsewhere:"));
}

#[test]
fn a_sound_is_marked_while_it_differs_from_what_was_loaded_or_saved() {
    let (params, context) = (SprungParams::default(), FakeHost::default());
    let context = Arc::new(context).context();
    let mut history = History::default();
    let marimba = |gain: f32| {
        let mut preset = Preset::find("Marimba").unwrap().clone();
        preset.patch.set(Param::Gain, gain);
        Playable::Preset(preset)
    };
    let step = |history: &mut History, gain: f32| {
        history.begin(&params);
        load(marimba(gain), &params, &context);
    };
    history.load(marimba(0.0), &params, &context);
    assert!(!history.is_changed(), "loaded");
    step(&mut history, -6.0);
    history.end("Gain", &params);
    assert!(history.is_changed(), "changed");
    history.undo(&params, &context);
    assert!(!history.is_changed(), "undone");
    history.redo(&params, &context);
    assert!(history.is_changed(), "redone");
    history.saved(&params);
    assert!(!history.is_changed(), "saved");
    history.undo(&params, &context);
    assert!(history.is_changed(), "no longer what was saved");
    history.redo(&params, &context);
    assert!(!history.is_changed(), "saved, and back again");
    step(&mut history, -12.0);
    history.end_swap("version B", false, &params);
    assert!(!history.is_changed(), "the other version is as it was loaded");
}

#[test]
fn a_changed_kit_stays_so_when_the_sound_of_its_pad_is_saved() {
    let (params, mut history) = (SprungParams::default(), History::default());
    let kit = State::new(Playable::find("Acoustic Kit").unwrap(), 0, params.view());
    params.load(kit.clone().into());
    history.begin(&params);
    params.load(kit.of_pad(38).unwrap().into());
    history.end_of_pad("edit".to_owned(), true, &params);
    history.saved(&params);
    assert!(history.is_changed());
}

#[test]
fn tags_narrow_the_list_together_and_go_with_another_family() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.button("Browse");
    let count = |stage: &Stage| stage.harness.query_all_by_role(Role::ListItem).count();
    let all = count(&stage);
    stage.button("Only metal");
    let metal = count(&stage);
    stage.button("Only long");
    let long = count(&stage);
    assert!(all > metal && metal > long && long > 0, "{all} {metal} {long}");
    assert!(stage.harness.query_by_label("Marimba").is_none(), "it is of wood");
    stage.button("Only metal");
    assert!(count(&stage) > long, "a click lets go of a tag");
    // Moods are found by the knobs, and named beside materials and instruments.
    stage.button("Only long");
    stage.button("Only bright");
    let bright = count(&stage);
    assert!(stage.harness.query_by_role_and_label(Role::ListItem, "Triangle").is_some() && bright < all);
    assert!(stage.harness.query_by_role_and_label(Role::ListItem, "Kick").is_none());
    for row in ["Material", "Character", "Instrument"] {
        assert!(stage.paints(row), "{row}");
    }
    // What there is no room for is led to.
    let at = |stage: &Stage| stage.harness.get_by_label("Only effect").rect().left();
    stage.button("Only bright");
    let before = at(&stage);
    while stage.harness.query_by_label("More tags: instrument").is_some() {
        stage.button("More tags: instrument");
    }
    assert!(at(&stage) < before - 100.0);
    stage.button("First tags: instrument");
    assert!(at(&stage) >= before, "{} {before}", at(&stage));
    stage.harness.get_by_label("More tags: instrument");
    stage.button("Show Mallet");
    assert!(stage.harness.query_by_role_and_label(Role::ListItem, "Marimba").is_some());
    assert!(stage.paints("14 mallets"));
}

#[test]
fn the_sounds_that_were_chosen_last_are_listed_the_newest_first() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    let listed = |stage: &Stage| -> Vec<String> {
        let nodes = stage.harness.query_all_by_role(Role::ListItem);
        nodes.filter_map(|node| node.accesskit_node().label()).collect()
    };
    stage.button("Next sound");
    let next = stage.params.name();
    stage.button("Browse");
    stage.button("Show Recent");
    assert_eq!(listed(&stage), [next.as_str()], "chosen in the header");
    stage.button("Show Bell");
    for name in ["Church Bell", "Wine Glass"] {
        stage.harness.get_by_role_and_label(Role::ListItem, name).click();
        stage.harness.run_steps(3);
        assert_ne!(library.recent().unwrap()[0], name, "it is only tried");
        stage.button("Browse");
        stage.button("Browse");
    }
    stage.button("Undo");
    stage.button("Undo");
    stage.button("Show Recent");
    assert_eq!(listed(&stage), ["Wine Glass", "Church Bell", &next]);
    // The order stays while arrows go through it.
    stage.harness.key_press(Key::ArrowLeft);
    stage.harness.run_steps(3);
    assert_eq!((stage.params.name().as_str(), listed(&stage)[0].as_str()), ("Church Bell", "Wine Glass"));
    stage.button("Browse");
    assert_eq!(library.recent().unwrap()[0], "Church Bell");
    stage.button("Browse");
    assert_eq!(listed(&stage)[0], "Church Bell");
    stage.button("Browse");
    // A list that is not understood is said, and stays.
    std::fs::write(stage.folder.path().join("recent.txt"), b"\xff\n").unwrap();
    stage.button("Next sound");
    stage.harness.get_by_label_contains("recent.txt: ");
    assert_eq!(std::fs::read(stage.folder.path().join("recent.txt")).unwrap(), b"\xff\n");
}
