//! Sounds in a host's own browser: listed without an instance, loaded into one, and what is told if they cannot be.

use crate::host::{Instance, PresetCall, open, text};
use crate::patches::{own_part, patch_in};
#[cfg(target_os = "linux")]
use crate::process::{command, succeeds};
use clack_extensions::preset_discovery::prelude::*;
use clack_host::prelude::*;
use sprung::preset::{KitPreset, Playable, Preset};
use std::collections::BTreeSet;
use std::ffi::{CStr, CString};
use std::path::Path;
#[cfg(target_os = "linux")]
use std::process::ExitCode;

/// A host's index of places.
#[derive(Default)]
struct Index {
    /// Endings of files.
    endings: Vec<String>,
    /// Names, flags and paths, of which the plugin itself has none.
    places: Vec<(String, Flags, Option<String>)>,
}

impl IndexerImpl for Index {
    fn declare_filetype(&mut self, kind: FileType) -> Result<(), HostError> {
        assert!(!kind.name.is_empty());
        self.endings.push(text(kind.file_extension.expect("there is one")));
        Ok(())
    }

    fn declare_location(&mut self, place: LocationInfo) -> Result<(), HostError> {
        self.places.push((text(place.name), place.flags, place.location.file_path().map(text)));
        Ok(())
    }

    fn declare_soundpack(&mut self, _: Soundpack) -> Result<(), HostError> {
        panic!("there are none")
    }
}

/// What a host is told of a sound.
#[derive(Debug, Default)]
struct Told {
    name: String,
    key: Option<String>,
    plugins: Vec<(String, String)>,
    flags: Option<Flags>,
    creators: Vec<String>,
    description: String,
    features: Vec<String>,
}

/// A host that takes some sounds.
struct Listener {
    most: usize,
    sounds: Vec<Told>,
    errors: Vec<(i32, String)>,
}

impl Listener {
    fn last(&mut self) -> &mut Told {
        self.sounds.last_mut().expect("a sound has begun")
    }
}

impl MetadataReceiverImpl for Listener {
    fn on_error(&mut self, number: i32, message: Option<&CStr>) {
        self.errors.push((number, text(message.expect("an error has a message"))));
    }

    fn begin_preset(&mut self, name: Option<&CStr>, key: Option<&CStr>) -> Result<(), HostError> {
        if self.sounds.len() == self.most {
            return Err(HostError::Message("enough"));
        }
        self.sounds.push(Told { name: text(name.unwrap()), key: key.map(text), ..Told::default() });
        Ok(())
    }

    fn add_plugin_id(&mut self, id: UniversalPluginId) {
        self.last().plugins.push((text(id.abi), text(id.id)));
    }

    fn set_soundpack_id(&mut self, _: &CStr) {
        panic!("there are none")
    }

    fn set_flags(&mut self, flags: Flags) {
        self.last().flags = Some(flags);
    }

    fn add_creator(&mut self, creator: &CStr) {
        self.last().creators.push(text(creator));
    }

    fn set_description(&mut self, description: &CStr) {
        self.last().description = text(description);
    }

    fn set_timestamps(&mut self, _: Option<Timestamp>, _: Option<Timestamp>) {}

    fn add_feature(&mut self, feature: &CStr) {
        self.last().features.push(text(feature));
    }

    fn add_extra_info(&mut self, _: &CStr, _: &CStr) {}
}

/// The provider of the library, with what it has declared.
fn provider(entry: &PluginEntry) -> Provider<Index> {
    let factory: PresetDiscoveryFactory = entry.get_factory().expect("sounds can be discovered");
    assert_eq!(factory.provider_count(), 1);
    let descriptor = factory.get_provider_descriptor(0).expect("it has a descriptor");
    let info = HostInfo::new("Sprung's tests", "Sprung", "", "1").unwrap();
    let provider = Provider::instantiate(Index::default(), entry, descriptor.id().unwrap(), &info);
    provider.unwrap_or_else(|error| panic!("{error:?}"))
}

/// What is told of the sounds at a place, up to a number of them.
fn listen(provider: &mut Provider<Index>, place: Location, most: usize) -> Listener {
    let mut listener = Listener { most, sounds: Vec::new(), errors: Vec::new() };
    provider.get_metadata(place, &mut listener);
    listener
}

/// Has a sound loaded. Returns whether the plugin says so, and what it tells.
fn load(instance: &mut Instance, place: Location, key: Option<&str>) -> (bool, PresetCall) {
    let handle = instance.clack.plugin_handle();
    let loads: PluginPresetLoad = handle.get_extension().expect("presets can be loaded");
    let key = key.map(|key| CString::new(key).unwrap());
    let is_loaded = loads.load_from_location(&handle, place, key.as_deref()).is_ok();
    instance.run_callbacks();
    let mut calls = instance.preset_calls();
    assert_eq!(calls.len(), 1, "the host is told once: {calls:?}");
    (is_loaded, calls.remove(0))
}

fn file(path: &CStr) -> Location<'_> {
    Location::File { path }
}

fn c_path(path: &Path) -> CString {
    CString::new(path.to_str().unwrap()).unwrap()
}

pub(crate) fn every_sound_of_the_factory_is_listed_once() {
    let entry = open();
    let mut provider = provider(&entry);
    let index = provider.indexer();
    assert_eq!(index.endings, ["toml"]);
    let (name, flags, path) = &index.places[0];
    assert_eq!((name.as_str(), *flags, path.as_ref()), ("Sprung", Flags::IS_FACTORY_CONTENT, None));
    let heard = listen(&mut provider, Location::Plugin, usize::MAX);
    assert_eq!(heard.errors, []);
    let names: Vec<&str> = heard.sounds.iter().map(|told| told.name.as_str()).collect();
    let presets = Preset::factory().iter().map(|preset| preset.name.as_str());
    let expected: Vec<&str> = presets.chain(KitPreset::factory().iter().map(|kit| kit.name.as_str())).collect();
    assert_eq!(names, expected);
    let keys: BTreeSet<&Option<String>> = heard.sounds.iter().map(|told| &told.key).collect();
    assert_eq!(keys.len(), names.len(), "each has a key of its own");
    let ids = entry.get_factory::<clack_host::factory::plugin::PluginFactory>().unwrap();
    let ids: Vec<_> = ids.plugin_descriptors().map(|plugin| ("clap".to_owned(), text(plugin.id().unwrap()))).collect();
    assert_eq!(ids.len(), 3);
    for told in &heard.sounds {
        let playable = Playable::find(told.key.as_deref().unwrap()).unwrap();
        assert_eq!((playable.name(), playable.comment()), (told.name.as_str(), told.description.as_str()));
        assert_eq!(told.creators, [playable.author()]);
        assert_eq!(told.plugins, ids);
        assert!(told.flags.unwrap().contains(Flags::IS_FACTORY_CONTENT));
        for tag in playable.tags() {
            assert!(told.features.contains(&tag.replace(['_', ' '], "-")), "{tag} in {told:?}");
        }
        let different: BTreeSet<_> = told.features.iter().collect();
        assert_eq!(different.len(), told.features.len(), "{told:?}");
    }
    let features = |name: &str| &heard.sounds.iter().find(|told| told.name == name).unwrap().features;
    for (name, family) in [("Kick", "kick"), ("Kick", "drum"), ("Conga", "hand-drum"), ("Acoustic Kit", "kit")] {
        assert!(features(name).iter().any(|feature| feature == family), "{name}: {:?}", features(name));
    }
    assert!(!features("Marimba").contains(&"drum".to_owned()));
}

pub(crate) fn a_listing_ends_when_the_host_has_enough() {
    let entry = open();
    let heard = listen(&mut provider(&entry), Location::Plugin, 5);
    assert_eq!((heard.sounds.len(), heard.errors), (5, vec![]));
    assert!(!heard.sounds[4].plugins.is_empty(), "the last one is told as a whole");
}

pub(crate) fn sounds_of_the_factory_load_by_their_keys_in_every_plugin() {
    for (index, mut instance) in Instance::of_each(&open()).into_iter().enumerate() {
        for preset in Preset::factory().iter().skip(index).step_by(23) {
            instance.rescans();
            let (is_loaded, call) = load(&mut instance, Location::Plugin, Some(&preset.name));
            assert_eq!((is_loaded, call), (true, PresetCall::Loaded(None, Some(preset.name.clone()))));
            assert!(instance.rescans() > 0, "{}: the host is told to ask for the values", preset.name);
            let patch = patch_in(&instance.save());
            if index < 2 {
                assert!(patch == preset.patch, "{}", preset.name);
            } else {
                // The effect's sounds are moved by what comes in.
                assert_eq!(patch.modes, preset.patch.modes, "{}", preset.name);
                assert!(patch.get(sprung::params::Param::InputLevel) > -60.0, "{}", preset.name);
            }
        }
        assert!(load(&mut instance, Location::Plugin, Some("Acoustic Kit")).0);
        assert!(own_part(&instance.save())["kit"].is_string());
    }
}

pub(crate) fn what_cannot_be_loaded_is_told_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (name, contents) in [
        ("broken.toml", "format = "),
        ("song.mid", "MThd"),
        ("other.toml", "[package]\nname = \"other\"\n"),
        ("bytes.toml", "\0\0\0"),
        ("kit.toml", "kit = 1\nname = \"Of nothing\"\nkeys = [{ key = 36, sound = \"../none.toml\" }]\n"),
        ("good.toml", &Preset::find("Marimba").unwrap().to_toml()),
    ] {
        std::fs::write(path(name), contents).unwrap();
    }
    std::fs::create_dir(path("folder.toml")).unwrap();
    let entry = open();
    let mut provider = provider(&entry);
    for mut instance in Instance::of_each(&entry) {
        let before = instance.save();
        let mut fails = |place: Location, key: Option<&str>, says: &str| {
            let (is_loaded, call) = load(&mut instance, place, key);
            let PresetCall::Failed(number, message) = call else { panic!("{place:?}, {key:?}: {call:?}") };
            assert!(!is_loaded && message.contains(says), "{place:?}, {key:?}: {message}");
            assert_eq!(instance.save(), before, "{place:?}, {key:?}");
            number
        };
        fails(Location::Plugin, None, "expected the name of a factory sound");
        fails(Location::Plugin, Some(""), "expected the name of a factory sound");
        fails(Location::Plugin, Some("Marimbas"), "Marimba");
        fails(Location::Plugin, Some("../../etc/passwd"), "../../etc/passwd");
        for (name, says) in [
            ("broken.toml", "broken.toml"),
            ("song.mid", "expected a whole path"),
            ("other.toml", "other.toml"),
            ("bytes.toml", "bytes.toml"),
            ("kit.toml", "it lies outside the kit"),
            ("folder.toml", "this is not a file"),
        ] {
            let number = fails(file(&c_path(&path(name))), None, says);
            assert_eq!(number, 0, "the system is not to blame for {name}");
            let heard = listen(&mut provider, file(&c_path(&path(name))), usize::MAX);
            let [(0, message)] = &heard.errors[..] else { panic!("{name}: {:?}", heard.errors) };
            assert!(message.contains(says) && heard.sounds.is_empty(), "{message}");
        }
        // ENOENT and ERROR_FILE_NOT_FOUND are both 2.
        assert_eq!(fails(file(&c_path(&path("none.toml"))), None, "none.toml"), 2);
        fails(file(c"bell.toml"), None, "expected a whole path");
        fails(file(c""), None, "expected the path");
        fails(file(c"/\xff.toml"), None, "not UTF-8");
        fails(file(&c_path(&path("good.toml"))), Some("2"), "there is no ‘2’ in it");
        let good = c_path(&path("good.toml"));
        let loaded = PresetCall::Loaded(Some(text(&good)), None);
        assert_eq!(load(&mut instance, file(&good), None), (true, loaded));
        assert_ne!(instance.save(), before);
    }
}

#[cfg(target_os = "linux")]
pub(crate) fn the_users_sounds_are_listed_and_load() {
    let home = tempfile::tempdir().unwrap();
    let sounds = home.path().join("sprung/presets");
    for has_folder in [false, true] {
        if has_folder {
            let own = Preset { name: "Mine".to_owned(), ..Preset::find("Marimba").unwrap().clone() };
            std::fs::create_dir_all(&sounds).unwrap();
            std::fs::write(sounds.join("mine.toml"), own.to_toml()).unwrap();
            std::fs::write(home.path().join("sprung/favourites.txt"), "Kick\nMine\n").unwrap();
        }
        let mut command = command("users-sounds");
        command.env("XDG_DATA_HOME", home.path());
        succeeds(command);
        assert_eq!(sounds.exists(), has_folder, "to be asked makes no folder");
    }
}

/// Runs in the process that this test starts, with a folder of the user's that exists or not.
#[cfg(target_os = "linux")]
pub(crate) fn work() -> ExitCode {
    let sounds = Path::new(&std::env::var("XDG_DATA_HOME").unwrap()).join("sprung/presets");
    let entry = open();
    let mut provider = provider(&entry);
    let own = provider.indexer().places.get(1).cloned();
    if !sounds.exists() {
        assert_eq!(own, None);
        return ExitCode::SUCCESS;
    }
    let (_, flags, path) = own.expect("the folder is declared");
    assert_eq!((flags, path.as_deref()), (Flags::IS_USER_CONTENT, sounds.to_str()));
    let favourites = |heard: &Listener| -> Vec<String> {
        let is_one = |told: &&Told| told.flags.unwrap().contains(Flags::IS_FAVORITE);
        heard.sounds.iter().filter(is_one).map(|told| told.name.clone()).collect()
    };
    assert_eq!(favourites(&listen(&mut provider, Location::Plugin, usize::MAX)), ["Kick"]);
    let mine = c_path(&sounds.join("mine.toml"));
    let heard = listen(&mut provider, file(&mine), usize::MAX);
    let [told] = &heard.sounds[..] else { panic!("{:?}", heard.sounds) };
    assert_eq!((told.name.as_str(), &told.key, told.plugins.len()), ("Mine", &None, 3));
    assert!(told.flags.unwrap().contains(Flags::IS_USER_CONTENT) && favourites(&heard) == ["Mine"]);
    let mut instance = Instance::of(&entry, true);
    assert_eq!(load(&mut instance, file(&mine), None), (true, PresetCall::Loaded(Some(text(&mine)), None)));
    assert!(patch_in(&instance.save()) == Preset::find("Marimba").unwrap().patch);
    ExitCode::SUCCESS
}
