//! What a host reads from the plugin before it plays: the library, the descriptor, ports, layouts, voices.

use crate::host::{Instance, bundle, open};
use clack_extensions::audio_ports::{AudioPortFlags, AudioPortInfoBuffer, AudioPortType, PluginAudioPorts};
use clack_extensions::audio_ports_config::{AudioPortsConfigBuffer, PluginAudioPortsConfig};
use clack_extensions::latency::PluginLatency;
use clack_extensions::note_ports::{NoteDialect, NoteDialects, NotePortInfoBuffer, PluginNotePorts};
use clack_extensions::render::PluginRender;
use clack_extensions::voice_info::{PluginVoiceInfo, VoiceInfoFlags};
use clack_host::factory::plugin::PluginFactory;
use clack_host::prelude::*;
use std::collections::BTreeSet;
use std::ffi::CStr;

fn text(string: Option<&CStr>) -> &str {
    string.expect("it is given").to_str().expect("it is UTF-8")
}

pub(crate) fn the_descriptor_is_complete() {
    let entry = open();
    let factory = entry.get_factory::<PluginFactory>().unwrap();
    assert_eq!(factory.plugin_count(), 3);
    assert!(factory.plugin_descriptor(3).is_none());
    assert_eq!(text(factory.plugin_descriptor(1).unwrap().name()), "Sprung Multi");
    assert_eq!(text(factory.plugin_descriptor(2).unwrap().name()), "Sprung Resonator");
    let descriptor = factory.plugin_descriptor(0).unwrap();
    assert_eq!(text(descriptor.name()), "Sprung");
    assert_eq!(text(descriptor.version()), env!("CARGO_PKG_VERSION"));
    let id = text(descriptor.id());
    let is_reverse_domain = id.split('.').count() >= 2 && id.chars().all(|c| c.is_ascii_alphanumeric() || c == '.');
    assert!(is_reverse_domain, "{id}");
    assert!(!text(descriptor.vendor()).is_empty() && !text(descriptor.description()).is_empty());
    let features: Vec<&str> = descriptor.features().map(|feature| text(Some(feature))).collect();
    for wanted in ["instrument", "synthesizer", "stereo"] {
        assert!(features.contains(&wanted), "{wanted} is not among {features:?}");
    }
    let different: BTreeSet<_> = features.iter().collect();
    assert_eq!(different.len(), features.len(), "a feature is there twice: {features:?}");
    // The instance must report the same descriptor as the factory.
    let instance = Instance::of(&entry, true);
    let handle = instance.clack.plugin_shared_handle();
    assert_eq!(text(handle.descriptor().unwrap().id()), id);
    assert_eq!(text(handle.descriptor().unwrap().version()), env!("CARGO_PKG_VERSION"));
}

pub(crate) fn no_other_plugin_is_made() {
    let entry = open();
    let factory = entry.get_factory::<PluginFactory>().unwrap();
    let id = text(factory.plugin_descriptor(0).unwrap().id()).to_owned();
    let info = HostInfo::new("Sprung's tests", "Sprung", "", "1").unwrap();
    for wrong in [format!("{id}x"), id[..id.len() - 1].to_owned(), String::new(), id.to_uppercase()] {
        let wrong = std::ffi::CString::new(wrong).unwrap();
        let made = PluginInstance::<()>::new(|_| (), |_| (), &entry, &wrong, &info);
        assert!(made.is_err(), "{wrong:?}");
    }
}

/// Symbols that are missing on the system must be found here, not when a musician plays.
#[allow(unsafe_code)]
pub(crate) fn all_symbols_are_found_at_once() {
    #[cfg(unix)]
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    #[cfg(windows)]
    use libloading::os::windows::Library;
    let path = bundle::clap();
    // SAFETY: the library is our own, and loading it runs only its usual constructors.
    #[cfg(unix)]
    let library = unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) };
    // SAFETY: as above.
    #[cfg(windows)]
    let library = unsafe { Library::new(path) };
    let library = library.expect("the library loads");
    // SAFETY: the address is not used.
    assert!(unsafe { library.get::<*const ()>(b"clap_entry") }.is_ok(), "it has no clap_entry");
}

/// They are 3 MB. A constant's texts may be stored several times.
pub(crate) fn factory_presets_are_in_the_library_once() {
    let library = std::fs::read(bundle::clap()).unwrap();
    for name in ["hat/pedal-hat", "bass/fingered-bass", "wind/piccolo"] {
        let path = format!("{}/../assets/presets/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert_eq!(library.windows(text.len()).filter(|bytes| *bytes == text).count(), 1, "{name}");
    }
}

pub(crate) fn one_stereo_output_comes_first_and_every_layout_is_valid() {
    let mut instance = Instance::new();
    let (configs, names) = {
        let handle = instance.clack.plugin_handle();
        let extension: PluginAudioPortsConfig = handle.get_extension().expect("layouts can be chosen");
        let mut buffer = AudioPortsConfigBuffer::new();
        let mut names = Vec::new();
        let configs: Vec<_> = (0..extension.count(&handle))
            .map(|index| {
                let config = extension.get(&handle, index, &mut buffer).expect("a known layout");
                names.push(String::from_utf8_lossy(config.name).into_owned());
                let output = config.main_output.as_ref().expect("every layout has an output").channel_count;
                (config.id, config.input_port_count, config.output_port_count, output)
            })
            .collect();
        (configs, names)
    };
    assert_eq!(configs.first().map(|&(_, inputs, outputs, channels)| (inputs, outputs, channels)), Some((0, 1, 2)));
    let different: BTreeSet<_> = names.iter().collect();
    assert_eq!(different.len(), names.len(), "two layouts have the same name: {names:?}");
    let widths: BTreeSet<u32> = configs.iter().map(|config| config.3).collect();
    assert_eq!(widths, BTreeSet::from([1, 2]), "mono and stereo");
    assert!(configs.iter().any(|config| config.1 == 1), "an input bus for exciting the body");
    for (id, inputs, outputs, channels) in configs {
        let handle = instance.clack.plugin_handle();
        let extension: PluginAudioPortsConfig = handle.get_extension().unwrap();
        extension.select(&handle, id).expect("every layout can be chosen");
        let ports: PluginAudioPorts = handle.get_extension().unwrap();
        assert_eq!((ports.count(&handle, true), ports.count(&handle, false)), (inputs, outputs));
        let mut buffer = AudioPortInfoBuffer::new();
        let port = ports.get(&handle, 0, false, &mut buffer).unwrap();
        assert!(port.flags.contains(AudioPortFlags::IS_MAIN) && !port.name.is_empty());
        assert_eq!((port.channel_count, port.port_type), (channels, AudioPortType::from_channel_count(channels)));
        assert!(ports.get(&handle, outputs, false, &mut buffer).is_none());
        assert!(ports.get(&handle, inputs, true, &mut buffer).is_none());
    }
}

pub(crate) fn notes_come_in_by_clap_and_midi() {
    let mut instance = Instance::new();
    let handle = instance.clack.plugin_handle();
    let ports: PluginNotePorts = handle.get_extension().expect("there are note ports");
    assert_eq!((ports.count(&handle, true), ports.count(&handle, false)), (1, 0));
    let mut buffer = NotePortInfoBuffer::new();
    let port = ports.get(&handle, 0, true, &mut buffer).unwrap();
    assert!(port.supported_dialects.contains(NoteDialects::CLAP | NoteDialects::MIDI));
    assert_eq!(port.preferred_dialect, Some(NoteDialect::Clap));
}

pub(crate) fn latency_voices_and_rendering_are_told() {
    let mut instance = Instance::new();
    let handle = instance.clack.plugin_handle();
    let latency: PluginLatency = handle.get_extension().expect("there is a latency");
    assert_eq!(latency.get(&handle), 0);
    let voices: PluginVoiceInfo = handle.get_extension().expect("there is voice info");
    let info = voices.get(&handle).unwrap();
    assert_eq!(info.voice_capacity, 64);
    assert!((1..=64).contains(&info.voice_count), "{}", info.voice_count);
    assert!(info.flags.contains(VoiceInfoFlags::SUPPORTS_OVERLAPPING_NOTES));
    let render: PluginRender = handle.get_extension().expect("hosts can render offline");
    assert!(!render.has_realtime_requirement(&handle));
}
