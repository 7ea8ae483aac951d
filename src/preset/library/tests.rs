//! Tests of the library, each in a temporary folder.

use super::*;

fn library() -> (tempfile::TempDir, Library) {
    let folder = tempfile::tempdir().unwrap();
    let library = Library::at(folder.path().join("sprung"));
    (folder, library)
}

fn named(name: &str) -> Playable {
    Playable::Preset(Preset { name: name.to_owned(), ..Preset::find("Church Bell").unwrap().clone() })
}

#[test]
fn presets_are_saved_under_their_names_and_replaced_only_when_told() {
    let (_folder, library) = library();
    assert!(library.entries().is_empty());
    let path = library.save(&named("My Bell"), false).unwrap();
    assert_eq!(path.file_name().unwrap(), "my-bell.toml");
    assert_eq!(library.save(&named("Ω"), false).unwrap().file_name().unwrap(), "ω.toml");
    assert!(matches!(library.save(&named("My Bell"), false), Err(Error::Exists { .. })));
    let names = |library: &Library| -> Vec<String> {
        library.entries().iter().map(|entry| entry.playable.as_ref().unwrap().name().to_owned()).collect()
    };
    assert_eq!(names(&library), ["My Bell", "Ω"]);
    assert_eq!(library.save(&named("My Bell"), true).unwrap(), path);
    assert_eq!(names(&library), ["My Bell", "Ω"]);
    for (name, message) in
        [("kick", "sound of the factory"), ("a/b", "taken for a file"), ("a.toml", "taken for a file")]
    {
        let error = library.save(&named(name), true).unwrap_err().to_string();
        assert!(error.contains(message), "{name}: {error}");
    }
    let error = library.save(&named(&"n".repeat(101)), false).unwrap_err().to_string();
    assert!(error.contains("at most 100 characters"), "{error}");
    assert_eq!(fs::read_dir(library.presets_folder()).unwrap().count(), 2, "nothing else is left");
}

#[test]
fn presets_are_renamed_with_their_files_and_imported_beside_others() {
    let (folder, library) = library();
    let path = library.save(&named("My Bell"), false).unwrap();
    library.save(&named("Other"), false).unwrap();
    assert!(matches!(library.rename(&path, "Other"), Err(Error::Exists { .. })) && path.exists());
    assert!(library.rename(&path, "Kick").unwrap_err().to_string().contains("sound of the factory"));
    let renamed = library.rename(&path, "Great Bell").unwrap();
    assert_eq!((renamed.file_name().unwrap().to_str(), path.exists()), (Some("great-bell.toml"), false));
    let renamed = library.rename(&renamed, "great bell").unwrap();
    let names = |library: &Library| -> Vec<String> {
        library.entries().iter().map(|entry| entry.playable.as_ref().unwrap().name().to_owned()).collect()
    };
    assert_eq!(names(&library), ["great bell", "Other"]);
    // A copy of a preset is renamed in its own file, and the other stays.
    let copy = library.presets_folder().join("copy.toml");
    fs::copy(&renamed, &copy).unwrap();
    assert_eq!(library.rename(&copy, "GREAT bell").unwrap(), copy);
    assert_eq!(names(&library), ["GREAT bell", "great bell", "Other"]);
    fs::remove_file(&copy).unwrap();
    let stranger = folder.path().join("x.toml");
    fs::write(&stranger, named("Great Bell").to_toml()).unwrap();
    for expected in ["Great Bell 2", "Great Bell 3"] {
        assert_eq!(library.import(read(&stranger).unwrap()).unwrap().0.name(), expected);
    }
    let long = "n".repeat(100);
    library.save(&named(&long), false).unwrap();
    let another = folder.path().join("long.toml");
    fs::write(&another, named(&long).to_toml()).unwrap();
    assert_eq!(library.import(read(&another).unwrap()).unwrap().0.name(), format!("{} 2", &long[2..]));
    assert!(stranger.exists() && renamed.exists());
    assert_eq!((library.entries().len(), library.rename(&stranger, "y").is_err()), (6, true));
}

#[test]
fn a_kit_is_imported_with_the_presets_of_its_files() {
    let (folder, library) = library();
    let path = folder.path().join("kit.toml");
    let mut own = named("Mine");
    fs::write(folder.path().join("mine.toml"), own.to_toml()).unwrap();
    let text = "kit = 1\nname = \"Two\"\nkeys = [{ key = 36, sound = \"mine.toml\" }, { key = 38, sound = \"Kick\" }]";
    fs::write(&path, text).unwrap();
    let (imported, place) = library.import(read(&path).unwrap()).unwrap();
    fs::remove_file(folder.path().join("mine.toml")).unwrap();
    let saved = read(&place).unwrap();
    let (Playable::Kit(kit), Some(mine)) = (&saved, own.presets_mut().pop()) else { panic!("a kit") };
    assert_eq!((&saved, &kit.sounds[0].1), (&imported, &*mine));
    let renamed = library.rename(&place, "Three").unwrap();
    assert_eq!((renamed.file_name().unwrap().to_str(), place.exists()), (Some("three.toml"), false));
    assert!(matches!(library.save(&named("three"), false), Err(Error::Exists { .. })), "a kit has this name");
}

#[test]
fn sounds_of_other_names_are_not_replaced() {
    let (_folder, library) = library();
    let save = |name: &str, replace| {
        let path = library.save(&named(name), replace).unwrap();
        path.file_name().unwrap().to_string_lossy().into_owned()
    };
    assert_eq!(
        ["My Bell", "my-bell!", "♪", "★"].map(|name| save(name, true)),
        ["my-bell.toml", "my-bell-2.toml", "sound.toml", "sound-2.toml"]
    );
    library.discard(&library.presets_folder().join("my-bell.toml")).unwrap();
    assert!(matches!(library.save(&named("my-bell!"), false), Err(Error::Exists { .. })));
    assert_eq!(save("my-bell!", true), "my-bell-2.toml", "where it was");
    let own = library.presets_folder().join("a name of its own.toml");
    fs::rename(library.presets_folder().join("my-bell-2.toml"), &own).unwrap();
    assert!(matches!(library.save(&named("my-bell!"), false), Err(Error::Exists { .. })));
    assert_eq!(save("my-bell!", true), "a name of its own.toml");
    fs::rename(&own, library.presets_folder().join("my-bell-2.toml")).unwrap();
    fs::write(library.presets_folder().join("sound-3.toml"), "broken").unwrap();
    assert_eq!(save("♯", true), "sound-4.toml");
    assert_eq!(library.entries().len(), 5);
}

#[test]
fn what_is_no_preset_says_why() {
    let (_folder, library) = library();
    library.save(&named("Good"), false).unwrap();
    fs::write(library.presets_folder().join("bad.toml"), "format = \"x\"").unwrap();
    fs::write(library.presets_folder().join("notes.txt"), "not a sound").unwrap();
    let entries = library.entries();
    assert_eq!(entries.len(), 2);
    assert!(entries[0].playable.is_err() && entries[1].playable.is_ok());
}

#[test]
fn files_go_to_the_bin_and_nothing_there_is_replaced() {
    let (folder, library) = library();
    let bins: Vec<PathBuf> =
        (0..3).map(|_| library.discard(&library.save(&named("Bell"), false).unwrap()).unwrap()).collect();
    assert!(bins.iter().all(|path| path.is_file()) && library.entries().is_empty());
    let stranger = folder.path().join("stranger.toml");
    fs::write(&stranger, "").unwrap();
    assert!(library.discard(&stranger).is_err() && stranger.exists());
}

#[test]
fn favourites_are_kept() {
    let (_folder, library) = library();
    for name in ["Kick", "Church Bell", "Kick"] {
        library.set_favourite(name, true).unwrap();
    }
    let favourites = || library.favourites().unwrap().into_iter().collect::<Vec<_>>();
    assert_eq!(favourites(), ["Church Bell", "Kick"]);
    library.set_favourite("Kick", false).unwrap();
    assert_eq!(favourites(), ["Church Bell"]);
    // Not UTF-8.
    fs::write(library.favourites_file(), b"Kick\n\xff\n").unwrap();
    assert!(library.favourites().is_err() && library.set_favourite("Church Bell", true).is_err());
    assert_eq!(fs::read(library.favourites_file()).unwrap(), b"Kick\n\xff\n", "not written over");
}

#[test]
fn the_sixteen_sounds_that_were_chosen_last_are_kept_the_newest_first() {
    let (_folder, library) = library();
    assert!(library.recent().unwrap().is_empty());
    for number in 0..20 {
        library.note_recent(&format!("Sound {number}")).unwrap();
    }
    library.note_recent("Sound 10").unwrap();
    let recent = library.recent().unwrap();
    assert_eq!((recent.len(), &recent[..3]), (16, &["Sound 10", "Sound 19", "Sound 18"].map(str::to_owned)[..]));
    assert_eq!(recent.iter().filter(|name| *name == "Sound 10").count(), 1);
    // Not UTF-8.
    fs::write(library.recent_file(), b"Kick\n\xff\n").unwrap();
    assert!(library.recent().is_err() && library.note_recent("Kick").is_err());
    assert_eq!(fs::read(library.recent_file()).unwrap(), b"Kick\n\xff\n", "not written over");
}

#[test]
fn a_copy_in_the_library_s_folder_makes_no_second_sound_of_a_name() {
    let (folder, library) = library();
    let saved = library.save(&named("My Bell"), false).unwrap();
    let [other, elsewhere] = [library.presets_folder().join("other.toml"), folder.path().join("other.toml")];
    let export = |path: &Path, replace| export(&named("My Bell"), path, Some(&library), replace);
    assert!(matches!(export(&other, false), Err(Error::Exists { path }) if path == saved.display().to_string()));
    assert_eq!((export(&other, true).unwrap(), other.exists()), (saved, false));
    assert_eq!(export(&elsewhere, false).unwrap(), elsewhere);
    let new = super::export(&named("Second"), &other, Some(&library), false).unwrap();
    assert_eq!((new, library.entries().len()), (other, 2));
    assert!(check(&named("kick")).is_err() && check(&named("a/b")).is_err() && check(&named("My Bell")).is_ok());
}

#[test]
fn controllers_are_kept_and_what_is_not_understood_is_not_written_over() {
    let (_folder, library) = library();
    assert_eq!(library.controllers().unwrap(), Controllers::new());
    library.set_controller(Param::Decay, Some(21)).unwrap();
    library.set_controller(Param::Gain, Some(7)).unwrap();
    let all = library.set_controller(Param::Tilt, Some(21)).unwrap();
    assert_eq!(all, Controllers::from([(7, Param::Gain), (21, Param::Tilt)]));
    assert_eq!(library.set_controller(Param::Gain, None).unwrap(), library.controllers().unwrap());
    assert_eq!(fs::read_to_string(library.controllers_file()).unwrap(), "tilt = 21\n");
    let refused = library.set_controller(Param::Decay, Some(32)).unwrap_err().to_string();
    assert!(refused.starts_with("decay: controller 32 selects banks"), "{refused}");
    for (text, part) in [
        ("tilt 21", "expected"),
        ("tilt = 21\ntilt = 22", "duplicate"),
        ("tilt = 21\ndecay = 21", "both"),
        ("size = 21", "size = 21: expected a parameter's id"),
        ("tilt = \"x\"", "expected a parameter's id and a controller"),
        ("tilt = 1000", "tilt = 1000"),
        ("tilt = 123", "tilt: controller 123 ends notes"),
    ] {
        fs::write(library.controllers_file(), text).unwrap();
        let message = library.controllers().unwrap_err().to_string();
        assert!(message.contains("controllers.toml") && message.contains(part), "{text}: {message}");
        assert_eq!(library.set_controller(Param::Gain, Some(7)).unwrap_err().to_string(), message);
        assert_eq!(fs::read_to_string(library.controllers_file()).unwrap(), text, "not written over");
    }
}

#[test]
fn the_folder_is_where_the_system_keeps_data() {
    let find = |variables: &[(&str, &str)]| {
        data_folder(&|name| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| value.into()))
    };
    if cfg!(windows) {
        assert_eq!(find(&[("APPDATA", r"C:\h\Roaming")]), Some(r"C:\h\Roaming\Sprung".into()));
        assert_eq!(find(&[("APPDATA", "Roaming")]), None, "a relative path is ignored");
    } else if cfg!(target_os = "macos") {
        assert_eq!(find(&[("HOME", "/h")]), Some("/h/Library/Application Support/Sprung".into()));
    } else {
        assert_eq!(find(&[("XDG_DATA_HOME", "/d"), ("HOME", "/h")]), Some("/d/sprung".into()));
        assert_eq!(find(&[("XDG_DATA_HOME", "d"), ("HOME", "/h")]), Some("/h/.local/share/sprung".into()));
    }
    assert_eq!(find(&[]), None);
}
