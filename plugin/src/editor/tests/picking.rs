//! Files chosen in the list of files, and sounds saved in any folder.

use super::dropped::asset;
use super::pictures::{Stage, stage};
use super::reaching::page;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use sprung::internals::library::Library;
use sprung::preset::Playable;
use std::path::Path;
use std::time::{Duration, Instant};

impl Stage {
    fn is_listed(&self, name: &str) -> bool {
        self.harness.query_by_role_and_label(Role::ListItem, name).is_some()
    }

    /// Goes to a path, and waits until an entry is listed.
    fn go(&mut self, path: &Path, entry: &str) {
        self.fill("Path of a folder or file", &path.display().to_string());
        self.harness.key_press(Key::Enter);
        self.until(|stage| stage.is_listed(entry));
    }

    fn fill(&mut self, field: &str, text: &str) {
        self.harness.get_by_role_and_label(Role::TextInput, field).focus();
        self.harness.run_steps(2);
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.run_steps(1);
        self.type_text(text);
    }

    /// Shows the window until something is so: folders are read in the background.
    fn until(&mut self, is_so: impl Fn(&Self) -> bool) {
        self.within(60, is_so);
    }

    /// The same for what takes so many seconds at most.
    pub(super) fn within(&mut self, seconds: u64, is_so: impl Fn(&Self) -> bool) {
        let end = Instant::now() + Duration::from_secs(seconds);
        while !is_so(self) {
            assert!(Instant::now() < end, "it happens");
            std::thread::sleep(Duration::from_millis(5));
            self.harness.run_steps(1);
        }
        self.harness.run_steps(2);
    }

    fn click_entry(&mut self, name: &str) {
        self.harness.get_by_role_and_label(Role::ListItem, name).click();
        self.harness.run_steps(3);
    }

    fn says(&self, text: &str) -> bool {
        self.harness.query_by_label_contains(text).is_some()
    }
}

/// A folder with one of each, and a file that cannot be opened.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("more")).unwrap();
    std::fs::copy(asset("scales/19-equal.scl"), folder.path().join("more/well.scl")).unwrap();
    std::fs::copy(asset("presets/mallet/marimba.toml"), folder.path().join("mine.toml")).unwrap();
    std::fs::write(folder.path().join("song.mid"), "x").unwrap();
    folder
}

#[test]
fn a_scale_is_chosen_in_a_folder_below() {
    let (mut stage, folder) = (stage("Marimba", SIZE, 1.0, Theme::Dark), folder());
    stage.harness.get_by_role_and_label(Role::Tab, "Tuning").click();
    stage.harness.run_steps(3);
    stage.button("Open a scale or mapping");
    let field =
        |stage: &Stage| stage.harness.get_by_role_and_label(Role::TextInput, "Path of a folder or file").is_focused();
    stage.until(field);
    stage.go(folder.path(), "Folder more");
    assert!(!stage.is_listed("mine.toml"), "it is no scale");
    stage.harness.check_accessibility();
    stage.click_entry("Folder more");
    stage.until(|stage| stage.is_listed("well.scl"));
    stage.button("Open the chosen files");
    assert!(stage.is_listed("well.scl"), "none is chosen");
    stage.click_entry("well.scl");
    stage.button("Open the chosen files");
    assert!(stage.says("tuned to") && !stage.is_listed("well.scl"));
    stage.button("Undo");
    // Once more, by a double click, in the folder that was shown last, and then by the keyboard.
    stage.button("Open a scale or mapping");
    stage.until(|stage| stage.is_listed("well.scl"));
    stage.harness.run_steps(40);
    let place = stage.harness.get_by_role_and_label(Role::ListItem, "well.scl").rect().center();
    stage.click(place);
    stage.click(place);
    assert!(!stage.is_listed("well.scl"));
    stage.button("Open a scale or mapping");
    stage.until(|stage| stage.is_listed("well.scl"));
    stage.harness.get_by_role_and_label(Role::ListItem, "well.scl").focus();
    stage.harness.run_steps(2);
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    assert!(!stage.is_listed("well.scl"));
}

#[test]
fn sounds_are_imported_by_a_button_or_by_a_typed_path() {
    let (mut stage, folder) = (stage("Kick", SIZE, 1.0, Theme::Dark), folder());
    stage.button("Browse");
    stage.button("Import files");
    stage.go(folder.path(), "mine.toml");
    assert!(stage.is_listed("Folder more") && !stage.is_listed("song.mid"));
    stage.button("Choose no file");
    assert!(stage.harness.query_by_label("Search").is_some(), "back in the browser");
    stage.button("Import files");
    stage.until(|stage| stage.is_listed("mine.toml"));
    stage.fill("Path of a folder or file", &folder.path().join("nowhere").display().to_string());
    stage.harness.key_press(Key::Enter);
    stage.until(|stage| stage.is_listed("mine.toml") && stage.params.name() == "Kick");
    stage.fill("Path of a folder or file", &folder.path().join("mine.toml").display().to_string());
    stage.harness.key_press(Key::Enter);
    stage.until(|stage| stage.params.name() != "Kick");
    assert!(stage.says("imported as"));
}

#[test]
fn a_copy_is_saved_in_any_folder_and_written_over_only_if_asked_again() {
    let (mut stage, folder) = (stage("Marimba", SIZE, 1.0, Theme::Dark), folder());
    for round in 0..2 {
        stage.button("Save");
        stage.type_text("Night Wood");
        stage.button("Save in another folder");
        stage.go(folder.path(), "mine.toml");
        assert!(!stage.is_listed("song.mid"));
        // Only in a folder that has been read.
        stage.until(|stage| stage.can("Save in this folder"));
        stage.button("Save in this folder");
        if round > 0 {
            assert!(stage.harness.query_by_label("Name of the file").is_some(), "it exists");
            stage.button("Save in this folder");
        }
        assert!(stage.says("saved "));
    }
    let saved = std::fs::read_to_string(folder.path().join("night-wood.toml")).unwrap();
    assert!(saved.contains("Night Wood") && !saved.contains("author = \"Sprung\""));
    assert_eq!(stage.params.name(), "Marimba", "the sound itself is not saved");
    assert!(matches!(stage.params.state().playable, Playable::Preset(_)));
}

#[test]
fn a_copy_among_ones_own_sounds_takes_the_place_of_the_one_of_its_name() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let library = Library::at(stage.folder.path());
    let save = |stage: &mut Stage| {
        stage.button("Save");
        stage.type_text("Night Wood");
    };
    save(&mut stage);
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    for is_again in [false, true] {
        save(&mut stage);
        stage.button("Save in another folder");
        stage.go(&library.presets_folder(), "night-wood.toml");
        stage.until(|stage| stage.can("Save in this folder"));
        stage.fill("Name of the file", "other");
        stage.button("Save in this folder");
        assert!(stage.says("Name of the file"), "it exists");
        if is_again {
            stage.button("Save in this folder");
            assert!(stage.says("saved "));
        } else {
            stage.harness.key_press(Key::Escape);
            stage.harness.run_steps(3);
        }
        assert_eq!(library.entries().len(), 1, "a name is that of one sound");
    }
}

#[test]
fn a_name_that_cannot_be_saved_is_refused_before_a_folder_is_looked_for() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.button("Save");
    stage.button("Save in another folder");
    assert!(stage.says("‘Marimba’ is a sound of the factory"));
    let name = stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under");
    assert!(name.is_focused(), "it can be corrected");
    stage.type_text("Гонг");
    stage.button("Save in another folder");
    let name = stage.harness.get_by_role_and_label(Role::TextInput, "Name of the file");
    assert_eq!(name.value().as_deref(), Some("гонг.toml"));
}

#[test]
fn tab_leads_to_files_that_are_not_on_screen() {
    let (mut stage, folder) = (stage("Marimba", LEAST_SIZE, 1.0, Theme::Dark), tempfile::tempdir().unwrap());
    for number in 100..300 {
        std::fs::write(folder.path().join(format!("{number}.scl")), "x").unwrap();
    }
    stage.button("Browse");
    stage.button("Import files");
    stage.go(folder.path(), "100.scl");
    stage.reach(Role::ListItem, page(), Modifiers::NONE);
}

#[test]
fn places_are_looked_for_once_when_the_list_is_opened() {
    let (mut stage, folder) = (stage("Marimba", SIZE, 1.0, Theme::Dark), folder());
    stage.button("Browse");
    stage.button("Import files");
    stage.until(|stage| stage.says("Go to Home"));
    std::fs::create_dir_all(stage.folder.path().join("presets")).unwrap();
    stage.go(folder.path(), "mine.toml");
    stage.harness.run_steps(20);
    assert!(!stage.says("Go to Your sounds"), "they are not looked for again");
    stage.button("Choose no file");
    stage.button("Import files");
    stage.until(|stage| stage.says("Go to Your sounds"));
}
