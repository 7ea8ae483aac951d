//! CLAP's preset discovery: hosts list the sounds of the factory and of the user's folder without making an instance.
//!
//! The sounds of the factory are in the plugin, and their load keys are their names. The user's are files, of one sound
//! each. The user's folder is declared if it exists; nothing is made for being asked.

use super::c::string;
use super::place::Place;
use crate::files;
use crate::multi::SprungMulti;
use crate::plugin::Sprung;
use crate::resonator::Resonator;
use clap_sys::factory::preset_discovery::*;
use clap_sys::universal_plugin_id::clap_universal_plugin_id;
use clap_sys::version::CLAP_VERSION;
use nice_plug::prelude::ClapPlugin;
use sprung::internals::library::{Library, Listed, tags_of};
use sprung::preset::{Family, KitPreset, Playable, Preset};
use std::collections::BTreeSet;
use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr;

pub(super) static DISCOVERY: clap_preset_discovery_factory =
    clap_preset_discovery_factory { count: Some(count), get_descriptor: Some(get_descriptor), create: Some(create) };

/// The one provider of sounds. Hosts keep what they have indexed under its id.
const ID: &CStr = c"org.sprung.sounds";

static DESCRIPTOR: clap_preset_discovery_provider_descriptor = clap_preset_discovery_provider_descriptor {
    clap_version: CLAP_VERSION,
    id: ID.as_ptr(),
    name: c"Sprung".as_ptr(),
    vendor: c"The Sprung authors".as_ptr(),
};

/// The plugins that load every sound.
const PLUGINS: [&str; 3] = [Sprung::CLAP_ID, SprungMulti::CLAP_ID, Resonator::CLAP_ID];

/// Families that are drums, which CLAP has a word for.
const DRUMS: [Family; 7] =
    [Family::Kick, Family::Snare, Family::Tom, Family::Hat, Family::Cymbal, Family::HandDrum, Family::Percussion];

unsafe extern "C" fn count(_: *const clap_preset_discovery_factory) -> u32 {
    1
}

unsafe extern "C" fn get_descriptor(
    _: *const clap_preset_discovery_factory,
    index: u32,
) -> *const clap_preset_discovery_provider_descriptor {
    if index == 0 { &raw const DESCRIPTOR } else { ptr::null() }
}

/// Makes a provider, with the indexer as its data. The host destroys it before the indexer.
unsafe extern "C" fn create(
    _: *const clap_preset_discovery_factory,
    indexer: *const clap_preset_discovery_indexer,
    id: *const c_char,
) -> *const clap_preset_discovery_provider {
    // SAFETY: ids end with a null.
    if indexer.is_null() || id.is_null() || unsafe { CStr::from_ptr(id) } != ID {
        return ptr::null();
    }
    Box::into_raw(Box::new(clap_preset_discovery_provider {
        desc: &raw const DESCRIPTOR,
        provider_data: indexer.cast_mut().cast(),
        init: Some(init),
        destroy: Some(destroy),
        get_metadata: Some(get_metadata),
        get_extension: Some(get_extension),
    }))
}

unsafe extern "C" fn destroy(provider: *const clap_preset_discovery_provider) {
    if !provider.is_null() {
        // SAFETY: `create` has made it, and a host destroys it once.
        drop(unsafe { Box::from_raw(provider.cast_mut()) });
    }
}

unsafe extern "C" fn get_extension(_: *const clap_preset_discovery_provider, _: *const c_char) -> *const c_void {
    ptr::null()
}

/// Declares where sounds are.
unsafe extern "C" fn init(provider: *const clap_preset_discovery_provider) -> bool {
    // SAFETY: hosts pass the provider that they got, whose indexer lives; null is refused.
    unsafe {
        let Some(provider) = provider.as_ref() else { return false };
        let indexer: *const clap_preset_discovery_indexer = provider.provider_data.cast();
        let (Some(declare_type), Some(declare)) = ((*indexer).declare_filetype, (*indexer).declare_location) else {
            return false;
        };
        let kind = clap_preset_discovery_filetype {
            name: c"Sprung preset or kit".as_ptr(),
            description: c"A sound, or sounds on keys".as_ptr(),
            file_extension: c"toml".as_ptr(),
        };
        let factory = clap_preset_discovery_location {
            flags: CLAP_PRESET_DISCOVERY_IS_FACTORY_CONTENT,
            name: c"Sprung".as_ptr(),
            kind: CLAP_PRESET_DISCOVERY_LOCATION_PLUGIN,
            location: ptr::null(),
        };
        let user = users_folder();
        let own = user.as_ref().map(|path| clap_preset_discovery_location {
            flags: CLAP_PRESET_DISCOVERY_IS_USER_CONTENT,
            name: c"My sounds".as_ptr(),
            kind: CLAP_PRESET_DISCOVERY_LOCATION_FILE,
            location: path.as_ptr(),
        });
        declare_type(indexer, &kind) && declare(indexer, &factory) && own.is_none_or(|own| declare(indexer, &own))
    }
}

/// The path of the user's folder of sounds, if it exists and has a name that hosts can be told.
fn users_folder() -> Option<CString> {
    let folder = Library::of_user()?.presets_folder();
    folder.to_str().filter(|_| folder.is_dir()).map(string)
}

/// Tells the host about the sounds at a place.
unsafe extern "C" fn get_metadata(
    _: *const clap_preset_discovery_provider,
    kind: u32,
    location: *const c_char,
    receiver: *const clap_preset_discovery_metadata_receiver,
) -> bool {
    // SAFETY: hosts pass strings that end with a null, and a receiver that lives during the call; null is refused.
    let Some(receiver) = (unsafe { receiver.as_ref() }) else { return false };
    let favourites = || Library::of_user().and_then(|library| library.favourites().ok()).unwrap_or_default();
    // SAFETY: as above.
    match unsafe { Place::of(kind, location) } {
        Ok(Place::Factory) => {
            let favourites = favourites();
            let presets = Preset::factory().iter().map(|preset| Playable::Preset(preset.clone()));
            let mut all = presets.chain(KitPreset::factory().iter().map(|kit| Playable::Kit(kit.clone())));
            // A host that wants no more says so, which is no fault.
            let _ = all.all(|playable| tell(receiver, &playable, true, &favourites));
            true
        }
        Ok(Place::File(path)) => match files::read(path) {
            Ok(playable) => {
                tell(receiver, &playable, false, &favourites());
                true
            }
            Err(error) => complain(receiver, files::number(&error), &error.to_string()),
        },
        Err(message) => complain(receiver, 0, &message),
    }
}

/// Tells the host what is wrong. Returns false.
fn complain(receiver: &clap_preset_discovery_metadata_receiver, number: i32, message: &str) -> bool {
    let message = string(message);
    if let Some(on_error) = receiver.on_error {
        // SAFETY: the receiver and the message live.
        unsafe { on_error(receiver, number, message.as_ptr()) };
    }
    false
}

/// Tells the host about a sound. Returns whether it wants to hear more.
fn tell(
    receiver: &clap_preset_discovery_metadata_receiver,
    playable: &Playable,
    is_of_factory: bool,
    favourites: &BTreeSet<String>,
) -> bool {
    let Some(begin) = receiver.begin_preset else { return false };
    let name = string(playable.name());
    let key = if is_of_factory { name.as_ptr() } else { ptr::null() };
    // SAFETY: the receiver lives, and so do the texts until each call returns.
    unsafe {
        if !begin(receiver, name.as_ptr(), key) {
            return false;
        }
        let say = |function: Option<unsafe extern "C" fn(*const _, *const c_char)>, text: &str| {
            if let Some(function) = function.filter(|_| !text.is_empty()) {
                function(receiver, string(text).as_ptr());
            }
        };
        if let Some(add) = receiver.add_plugin_id {
            for id in PLUGINS.map(string) {
                add(receiver, &clap_universal_plugin_id { abi: c"clap".as_ptr(), id: id.as_ptr() });
            }
        }
        if let Some(set_flags) = receiver.set_flags {
            let origin = match is_of_factory {
                true => CLAP_PRESET_DISCOVERY_IS_FACTORY_CONTENT,
                false => CLAP_PRESET_DISCOVERY_IS_USER_CONTENT,
            };
            let is_favourite = favourites.contains(playable.name());
            set_flags(receiver, if is_favourite { origin | CLAP_PRESET_DISCOVERY_IS_FAVORITE } else { origin });
        }
        say(receiver.add_creator, playable.author());
        say(receiver.set_description, playable.comment());
        features(playable).iter().for_each(|feature| say(receiver.add_feature, feature));
    }
    true
}

/// Family and tags of a sound, as hosts write features.
fn features(playable: &Playable) -> Vec<String> {
    let family = match playable {
        Playable::Preset(preset) => preset.guide.family,
        Playable::Kit(_) => None,
    };
    let own = match playable {
        Playable::Preset(_) => family.map_or("", Family::name),
        Playable::Kit(_) => Listed::KIT,
    };
    let drum = if family.is_some_and(|family| DRUMS.contains(&family)) { "drum" } else { "" };
    let mut features: Vec<String> = Vec::new();
    let tags = tags_of(playable);
    for word in [own, drum].into_iter().chain(tags.iter().map(String::as_str)) {
        let feature = word.replace(['_', ' '], "-");
        if !feature.is_empty() && !features.contains(&feature) {
            features.push(feature);
        }
    }
    features
}
