//! The pages below the modes, the manual over them, and files dropped on the window.

use super::dropped::{Dropped, asset};
use super::fake_host::Call;
use super::pictures::{Stage, compare, compare_part, finish, stage};
use super::sounding::Band;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use egui::{Key, Role, vec2};
use egui_kittest::kittest::Queryable as _;
use sprung::params::Param;
use sprung::preset::{Playable, Preset};
use std::path::Path;
use std::sync::Arc;

impl Band {
    fn open(&mut self, name: &str) {
        self.stage.harness.get_by_role_and_label(Role::Tab, name).click();
        self.passes(3);
    }

    fn drop_file(&mut self, path: &Path) {
        self.stage.harness.input_mut().dropped_files.push(Arc::new(Dropped(path.to_owned())));
        self.passes(3);
    }
}

#[test]
fn pictures_of_tuning_voices_and_manual_are_as_accepted() {
    for (sound, page, size, theme, name) in [
        ("Marimba", "Tuning", SIZE, Theme::Light, "tuning"),
        ("Marimba", "Tuning", LEAST_SIZE, Theme::HighContrast, "tuning-least"),
        ("Marimba", "Voices", SIZE, Theme::HighContrast, "voices"),
    ] {
        let mut band = Band::new(sound, size, theme);
        band.passes(2);
        band.open(page);
        band.strike(&[42, 60]);
        band.passes(4);
        compare_part(name, &mut band.stage.harness);
    }
    for (size, theme, name) in [(SIZE, Theme::Dark, "manual"), (LEAST_SIZE, Theme::Dark, "manual-least")] {
        let mut stage = stage("Marimba", size, 1.0, theme);
        stage.harness.get_by_label_contains("Manual: ").click();
        stage.harness.run_steps(3);
        compare(name, &mut stage.harness);
    }
    finish();
}

#[test]
fn the_chosen_part_is_shown_alone_and_its_lamp_brings_it_back_as_it_was() {
    let mut band = Band::new("Church Bell", SIZE, Theme::Dark);
    let is_shown = |band: &Band, name| band.stage.harness.query_by_role_and_label(Role::Slider, name).is_some();
    assert!(is_shown(&band, "Bloom") && band.stage.harness.query_by_label("Modes of the body").is_some());
    band.open("Noise");
    assert!(is_shown(&band, "Noise colour") && !is_shown(&band, "Mallet mass") && !is_shown(&band, "Bloom"));
    let before = band.value(Param::NoiseLevel);
    band.click(Role::CheckBox, "Noise");
    assert_eq!(band.value(Param::NoiseLevel), Param::NoiseLevel.info().min);
    assert!(is_shown(&band, "Noise colour"), "it is chosen");
    band.click(Role::CheckBox, "Noise");
    assert_eq!(band.value(Param::NoiseLevel), before);
    // What is turned down to nothing stays under the hand.
    band.open("Mallet");
    let knob = band.stage.harness.get_by_role_and_label(Role::Slider, "Mallet level").rect().center();
    band.press(knob, true);
    band.event(egui::Event::PointerMoved(knob + vec2(0.0, 400.0)));
    band.press(knob + vec2(0.0, 400.0), false);
    assert!(band.value(Param::MalletLevel) == Param::MalletLevel.info().min && is_shown(&band, "Mallet mass"));
    band.undo();
    // What was off before has a level that is heard.
    band.click(Role::CheckBox, "Drive");
    assert_eq!(band.value(Param::Drive), 6.0);
    for _ in 0..3 {
        band.undo();
    }
    assert!(band.value(Param::NoiseLevel) == before && band.value(Param::Drive) == 0.0);
    // A tone is off where it passes all unchanged, which is in the middle of its knobs.
    band.click(Role::CheckBox, "Tone");
    assert_eq!(band.value(Param::ToneLow), 3.0);
    band.click(Role::CheckBox, "Tone");
    assert_eq!([Param::ToneLow, Param::ToneHigh].map(|param| band.value(param)), [0.0; 2]);
}

#[test]
fn the_bodies_of_a_pair_and_their_joint_are_chosen_on_the_way() {
    let mut band = Band::new("Church Bell", SIZE, Theme::Dark);
    let has = |band: &Band, name| band.stage.harness.query_by_role_and_label(Role::SpinButton, name).is_some();
    band.open("Joint");
    assert!(has(&band, "Heard of second") && !has(&band, "Strike place"));
    band.open("Body 2");
    assert!(has(&band, "Strike place") && !has(&band, "Heard of second"));
    band.open("Body");
    assert!(band.stage.paints("Its modes, how they ring"), "the pointer is on it");
    assert!(!has(&band, "Strike place") && band.stage.harness.query_by_label("Modes of the body").is_some());
    let band = Band::new("Marimba", SIZE, Theme::Dark);
    assert!(band.stage.harness.query_by_role_and_label(Role::Tab, "Joint").is_none());
}

#[test]
fn all_of_the_chosen_part_can_be_reached_at_every_size() {
    let parts = ["Pitch", "Voices", "Strike", "Mallet", "Noise", "Breath", "Rattle", "Strings", "Space", "Output"];
    for size in [SIZE, LEAST_SIZE, [900, 620], [900, 500], [1600, 1000]] {
        let mut stage = stage("Church Bell", size, 1.0, Theme::Dark);
        for part in parts {
            stage.tab(part);
            let rail = stage.harness.get_by_label("Source velocity").rect().top();
            let all = stage.harness.query_all_by_role(Role::Slider).map(|knob| knob.rect());
            let sliders: Vec<_> = all.filter(|knob| knob.top() < rail).collect();
            assert!(!sliders.is_empty(), "{part} {size:?}");
            for (place, knob) in sliders.iter().enumerate() {
                assert!(knob.bottom() < rail - 8.0, "{part} {size:?}: {knob}");
                for other in &sliders[place + 1..] {
                    assert!(!knob.shrink(0.1).intersects(*other), "{part} {size:?}: {knob} {other}");
                }
            }
        }
    }
}

#[test]
fn the_chosen_part_is_seen_at_every_size() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.tab("Output");
    let [width, height] = LEAST_SIZE.map(|side| side as f32);
    stage.harness.set_size(vec2(width, height));
    stage.harness.run_steps(30);
    let pan = stage.harness.get_by_role_and_label(Role::Slider, "Pan").rect();
    assert!(pan.left() > 0.0 && pan.right() < width, "{pan}");
}

#[test]
fn a_kit_has_no_lamps_and_all_knobs() {
    let mut band = Band::new("Acoustic Kit", SIZE, Theme::Dark);
    band.open("Pluck");
    let is_shown = |role, name| band.stage.harness.query_by_role_and_label(role, name).is_some();
    assert!(is_shown(Role::Slider, "Pluck width") && band.stage.paints("added to what each pad has"));
    assert!(!is_shown(Role::CheckBox, "Pluck"));
}

#[test]
fn held_noise_is_noise() {
    let mut band = Band::new("Whistle", SIZE, Theme::Dark);
    let levels = |band: &Band| [Param::NoiseLevel, Param::NoiseHeld].map(|param| band.value(param));
    let (before, least) = (levels(&band), [Param::NoiseLevel, Param::NoiseHeld].map(|param| param.info().min));
    assert!(before[1] > least[1]);
    band.click(Role::CheckBox, "Noise");
    assert_eq!(levels(&band), least);
    band.click(Role::CheckBox, "Noise");
    assert_eq!(levels(&band), before);
}

#[test]
fn the_manual_opens_at_the_page_that_matters_and_escape_closes_it() {
    for (tab, title) in [("Space", "Space"), ("Tuning", "Tuning, MIDI and MPE"), ("Bow", "Exciters")] {
        let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
        stage.harness.get_by_role_and_label(Role::Tab, tab).click();
        stage.harness.run_steps(3);
        stage.harness.get_by_label_contains("Manual: ").click();
        stage.harness.run_steps(3);
        assert!(stage.harness.query_by_role_and_label(Role::Label, title).is_some(), "{title}");
        stage.harness.get_by_label("Manual: recipes").click();
        stage.harness.run_steps(3);
        assert!(stage.harness.query_by_role_and_label(Role::Label, title).is_none());
        stage.harness.key_press(Key::Escape);
        stage.harness.run_steps(3);
        assert!(stage.harness.query_by_label("Close the manual").is_none());
        stage.harness.get_by_role_and_label(Role::Tab, tab);
    }
}

#[test]
fn every_page_of_the_manual_can_be_shown() {
    // High enough for the whole list of pages.
    for size in [[1100, 900], [640, 900]] {
        let mut stage = stage("Marimba", size, 1.0, Theme::Dark);
        stage.harness.get_by_label_contains("Manual: ").click();
        stage.harness.run_steps(3);
        // A letter that no font has would panic here.
        for (name, _) in sprung::internals::text::PAGES {
            stage.harness.get_by_label(&format!("Manual: {name}")).click();
            stage.harness.run_steps(2);
            let labels = stage.harness.query_all_by_role(Role::Label);
            let right = labels.map(|label| label.rect().right()).fold(0.0, f32::max);
            assert!(right <= size[0] as f32, "{name} wraps: {right}");
        }
    }
}

#[test]
fn the_manual_is_searched_and_opened_where_the_words_are() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    stage.harness.get_by_label_contains("Manual: ").click();
    stage.harness.run_steps(3);
    assert!(stage.paints("Begin here") && stage.paints("Playing"), "the contents have groups");
    stage.harness.get_by_label("Search the manual").focus();
    stage.harness.run_steps(2);
    stage.type_text("bohlen-pierce");
    stage.harness.run_steps(3);
    let is_listed = |stage: &Stage, page: &str| stage.harness.query_by_label(&format!("Manual: {page}")).is_some();
    assert!(is_listed(&stage, "window") && !is_listed(&stage, "exciters"));
    let visible = |stage: &Stage, words: &str| {
        let labels = stage.harness.query_all_by_label_contains(words);
        labels.map(|label| label.rect()).any(|rect| rect.top() > 40.0 && rect.top() < 560.0)
    };
    assert!(visible(&stage, "Bohlen-Pierce"), "the text is scrolled to it");
    stage.type_text(" xyzzy");
    assert!(stage.paints("No page has all of these words."));
    stage.button("Clear the search of the manual");
    assert!(is_listed(&stage, "exciters"));
}

#[test]
fn scales_and_mappings_are_dropped_undone_and_complained_about() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let before = band.stage.params.state();
    band.drop_file(&asset("scales/19-equal.scl"));
    let pitch = |band: &Band, key| band.stage.params.loaded().kit.sounds()[0].tuning().and_then(|own| own.pitch(key));
    let semitones = |band: &Band, key| pitch(band, key).unwrap().semitones(440.0);
    // From C to D, in steps of the scale.
    let steps = |band: &Band| (semitones(band, 62) - semitones(band, 60)) * 19.0 / 12.0;
    assert!((steps(&band) - 2.0).abs() < 1e-3, "{}", steps(&band));
    assert!(matches!(band.stage.host.calls()[..], [Call::Begin(_), Call::Set(..), Call::End(_)]), "the host saves it");
    band.open("Tuning");
    band.stage.harness.get_by_label_contains("Key C4 316.9");
    band.drop_file(&asset("scales/19-equal-on-white-keys.kbm"));
    assert!((steps(&band) - 3.0).abs() < 1e-3, "mapped: {}", steps(&band));
    let mapped = band.stage.params.state();
    // A file that is not a scale changes nothing.
    let wrong = band.stage.folder.path().join("wrong.scl");
    std::fs::write(&wrong, "a\n2\nx\n").unwrap();
    band.drop_file(&wrong);
    // Neither does a file that begins with a scale but is too large.
    let large = band.stage.folder.path().join("large.scl");
    std::fs::write(&large, "a\n1\n2/1\n".to_owned() + &" ".repeat(1 << 20)).unwrap();
    band.drop_file(&large);
    band.drop_file(Path::new("/nowhere/a.kbm"));
    band.drop_file(Path::new("/nowhere/a.txt"));
    assert!(band.stage.params.state() == mapped);
    // Scales of the project bring no mapping along.
    band.click(Role::ComboBox, "Scale");
    band.click(Role::Button, "Pythagorean");
    assert!((semitones(&band, 67) - semitones(&band, 60) - 7.01955).abs() < 1e-4);
    band.stage.button("Tune to equal temperament");
    assert_eq!(pitch(&band, 60), None, "no tuning of its own");
    for _ in 0..4 {
        band.stage.button("Undo");
    }
    assert!(band.stage.params.state() == before);
}

#[test]
fn a_preset_that_is_dropped_joins_the_users_sounds_and_is_renamed() {
    let mut band = Band::new("Marimba", SIZE, Theme::Dark);
    let before = band.stage.params.state();
    let file = band.stage.folder.path().join("from a friend.toml");
    let preset = Preset { name: "Friend’s Bell".to_owned(), ..Preset::find("Church Bell").unwrap().clone() };
    std::fs::write(&file, preset.to_toml()).unwrap();
    band.drop_file(&file);
    assert_eq!(band.stage.params.name(), "Friend’s Bell");
    let Playable::Preset(loaded) = band.stage.params.state().playable else { panic!("a preset") };
    assert_eq!(loaded.patch.modes, preset.patch.modes);
    band.stage.button("Undo");
    assert!(band.stage.params.state() == before);
    band.stage.button("Redo");
    band.stage.button("Browse");
    band.stage.button("Show Your own");
    band.stage.harness.get_by_role_and_label(Role::TextInput, "Name to save under").click();
    band.passes(2);
    band.stage.harness.event(egui::Event::Text(" 2".to_owned()));
    band.passes(3);
    band.stage.button("Give your sound this name");
    assert_eq!(band.stage.params.name(), "Friend’s Bell 2");
    assert!(band.stage.harness.query_by_role_and_label(Role::ListItem, "Friend’s Bell 2").is_some());
    assert!(band.stage.harness.query_by_role_and_label(Role::ListItem, "Friend’s Bell").is_none());
    let files =
        || std::fs::read_dir(band.stage.folder.path().join("presets")).unwrap().map(|file| file.unwrap().path());
    let own = files().next().unwrap();
    assert_eq!(files().count(), 1);
    // A file that is already in the user's folder is loaded, not copied.
    band.stage.button("Undo");
    band.drop_file(&own);
    assert_eq!(band.stage.params.name(), "Friend’s Bell 2");
    assert_eq!(std::fs::read_dir(own.parent().unwrap()).unwrap().count(), 1);
    // A favourite that is renamed to its own name stays a favourite.
    band.stage.button("Favourite Friend’s Bell 2");
    band.stage.button("Give your sound this name");
    let favourites = std::fs::read_to_string(band.stage.folder.path().join("favourites.txt")).unwrap();
    assert_eq!(favourites, "Friend’s Bell 2\n");
    // A broken file says what is wrong, and changes nothing.
    let state = band.stage.params.state();
    std::fs::write(&file, "format = 99").unwrap();
    band.drop_file(&file);
    assert!(band.stage.params.state() == state);
}
