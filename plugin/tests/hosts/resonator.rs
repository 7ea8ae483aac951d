//! Sprung Resonator, the effect: what the factory says of it, its bits, its state, its silence, and its real-time safety.

use crate::host::reference::{assert_clean, assert_same_bits, assert_sound};
use crate::host::{Address, Instance, Player, Sent, Timed, open};
use crate::patches::{own_part, patch_in, patches, state};
use crate::phrase::{self, Dialect, SAMPLE_RATE};
use crate::song::{divisions, rendered, some_divisions};
use clack_extensions::audio_ports::{AudioPortFlags, AudioPortInfoBuffer, AudioPortType, PluginAudioPorts};
use clack_extensions::audio_ports_config::{AudioPortsConfigBuffer, PluginAudioPortsConfig};
use clack_extensions::note_ports::PluginNotePorts;
use clack_host::factory::plugin::PluginFactory;
use clack_host::prelude::ClapId;
use sprung::internals::random::{key, uniform};
use sprung::io::Song;
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::patch::routes::amount_param;
use sprung::preset::Preset;
use sprung::render::{Job, Options, Tail};
use sprung::sound::Kit;

const RATE: f64 = SAMPLE_RATE as f64;
const FRAMES: usize = 24_000;

/// The effect's own parameters: what they are called, and a value of each.
const OWN: [(&str, f64); 3] = [("Chord", 5.0), ("Chord root", 50.0), ("Resonator mix", 0.3)];

fn id(instance: &mut Instance, name: &str) -> ClapId {
    instance.parameters().iter().find(|parameter| parameter.name == name).unwrap_or_else(|| panic!("no ‘{name}’")).id
}

/// Sets the effect's own parameters while it does not play.
fn set(instance: &mut Instance, chord: f64, root: f64, mix: f64) {
    for ((name, _), value) in OWN.into_iter().zip([chord, root, mix]) {
        let id = id(instance, name);
        instance.flush(&[Sent::Value(id, value).at(0)]);
    }
}

/// The effect with a state, a chord and a mix, playing.
fn player(state: &[u8], chord: f64, root: f64, mix: f64) -> Player {
    let mut instance = Instance::resonator(&open());
    assert!(instance.load(state), "it takes a state of Sprung");
    set(&mut instance, chord, root, mix);
    instance.play(RATE, 8192)
}

pub(crate) fn incoming(frames: usize) -> Vec<f32> {
    (0..frames as u64).map(|n| 0.2 * uniform(key(9, 0), n)).collect()
}

/// What `sprung render --input` makes of the same.
pub(crate) fn by_the_command(song: &Song, patch: &Patch, input: &[f32]) -> Vec<Vec<f32>> {
    let options = Options { sample_rate: SAMPLE_RATE, tail: Tail::None, ..Options::default() };
    rendered(&Job { input, ..Job::new(song, &Kit::of_patch(patch), options) })
}

/// A patch whose own exciters are off, also those that routes turn up.
pub(crate) fn without_exciters(patch: &Patch) -> Patch {
    use Param::{BowLevel, BreathLevel, MalletLevel, NoiseHeld, NoiseLevel, PluckLevel};
    let exciters = [MalletLevel, PluckLevel, NoiseLevel, NoiseHeld, BowLevel, BreathLevel];
    let off = exciters.into_iter().fold(patch.clone(), |patch, param| patch.with(param, -60.0));
    let routes = patch.routes.iter().filter(|(_, route)| exciters.contains(&route.destination));
    routes.fold(off, |patch, (place, _)| patch.with(amount_param(place), 0.0))
}

pub(crate) fn the_factory_has_it_beside_the_instrument() {
    let entry = open();
    let factory = entry.get_factory::<PluginFactory>().unwrap();
    let text = |string: Option<&std::ffi::CStr>| string.unwrap().to_str().unwrap().to_owned();
    let descriptors = [0, 2].map(|index| factory.plugin_descriptor(index).unwrap());
    let listed = descriptors.each_ref().map(|descriptor| (text(descriptor.id()), text(descriptor.name())));
    let both = [("org.sprung.sprung", "Sprung"), ("org.sprung.resonator", "Sprung Resonator")];
    assert_eq!(listed, both.map(|(id, name)| (id.to_owned(), name.to_owned())));
    let features: Vec<String> = descriptors[1].features().map(|feature| text(Some(feature))).collect();
    assert_eq!(features, ["audio-effect", "filter", "stereo", "mono"]);
    let mut instance = Instance::resonator(&entry);
    let names: Vec<String> = instance.parameters().into_iter().map(|parameter| parameter.name).collect();
    assert_eq!(names[..3], OWN.map(|(name, _)| name));
    let of_sprung: Vec<String> = Instance::new().parameters().into_iter().map(|parameter| parameter.name).collect();
    assert_eq!(names[3..], of_sprung, "the rest is the instrument's, which has none of the effect's");
    for (name, value, shown) in [("Chord", 6.0, "Sus4"), ("Chord root", 61.0, "C#4"), ("Resonator mix", 0.25, "25.0 %")]
    {
        let id = id(&mut instance, name);
        assert_eq!(instance.text(id, value).unwrap(), shown);
        assert!((instance.parse(id, shown).unwrap() - value).abs() < 1e-4, "{shown}");
        assert_eq!(instance.parse(id, "nothing of it"), None);
    }
}

pub(crate) fn its_ports_are_as_wide_in_as_out() {
    let mut instance = Instance::resonator(&open());
    let ids = {
        let handle = instance.clack.plugin_handle();
        let layouts: PluginAudioPortsConfig = handle.get_extension().unwrap();
        let notes: PluginNotePorts = handle.get_extension().expect("it takes notes");
        assert_eq!((notes.count(&handle, true), notes.count(&handle, false)), (1, 0));
        assert_eq!(layouts.count(&handle), 2);
        [0, 1].map(|index| layouts.get(&handle, index, &mut AudioPortsConfigBuffer::new()).unwrap().id)
    };
    for (id, channels) in ids.into_iter().zip([2, 1]) {
        let handle = instance.clack.plugin_handle();
        let layouts: PluginAudioPortsConfig = handle.get_extension().unwrap();
        layouts.select(&handle, id).unwrap();
        let ports: PluginAudioPorts = handle.get_extension().unwrap();
        for is_input in [true, false] {
            assert_eq!(ports.count(&handle, is_input), 1);
            let mut buffer = AudioPortInfoBuffer::new();
            let port = ports.get(&handle, 0, is_input, &mut buffer).unwrap();
            assert!(port.flags.contains(AudioPortFlags::IS_MAIN));
            assert_eq!((port.channel_count, port.port_type), (channels, AudioPortType::from_channel_count(channels)));
        }
        let mut player = Player::new(instance, RATE, 480);
        player.audio.feed(incoming(FRAMES));
        let found = player.render(&[], FRAMES, || 480).channels;
        assert_eq!(found.len(), channels as usize);
        assert_sound("a layout", &found);
        instance = player.stop();
    }
}

/// A chord that is held has the bits of `sprung render --note … --input …`.
pub(crate) fn a_held_chord_has_the_bits_of_the_command() {
    let input = incoming(FRAMES / 2);
    let song = Song::chord(&[48.0, 55.0, 60.0], 100.0 / 127.0, FRAMES as f64 / RATE);
    for ((name, patch), case) in patches().into_iter().zip(0..) {
        // What its author drives stays as it is; what nothing drives is driven, and nothing else moves it.
        let driven = without_exciters(&patch).with(Param::InputLevel, 0.0);
        let as_made = patch.clone().with(Param::InputLevel, -6.0);
        for (loaded, played, case) in [(&patch, driven, case), (&as_made, as_made.clone(), case + 3)] {
            let expected = by_the_command(&song, &played, &input);
            assert_sound(name, &expected);
            for (division, block) in some_divisions(case) {
                let mut player = player(&state(loaded), 3.0, 48.0, 1.0);
                player.audio.feed(input.clone());
                let rendered = player.render(&[], FRAMES, block);
                assert_same_bits(&format!("{name}, {division}"), &rendered.channels, &expected);
                assert_eq!(rendered.ended, [], "the host knows of no notes");
            }
        }
    }
}

/// Notes have the bits of the same song in the command, if no chord is held.
pub(crate) fn notes_have_the_bits_of_the_command() {
    let song = phrase::song(&phrase::midi_file());
    let input = incoming(phrase::FRAMES / 2);
    let (name, patch) = patches().swap_remove(1);
    let patch = patch.with(Param::InputLevel, -6.0);
    let expected = by_the_command(&song, &patch, &input);
    for (division, block) in divisions() {
        let mut player = player(&state(&patch), 0.0, 48.0, 1.0);
        player.audio.feed(input.clone());
        let sent = phrase::sent(&phrase::messages(), Dialect::Midi);
        let found = player.render(&sent, phrase::FRAMES, block).channels;
        assert_same_bits(&format!("{name}, {division}"), &found, &expected);
    }
}

/// The chord gives way to notes and comes back after them, at their frames.
pub(crate) fn notes_replace_the_chord_at_their_frames() {
    let (_, patch) = patches().swap_remove(1);
    let patch = patch.with(Param::InputLevel, 0.0).with(Param::MalletLevel, -60.0);
    let note = Address::note(0, 65, 1);
    let sent: Vec<Timed> = vec![Sent::On(note, 0.8).at(5_003), Sent::Off(note, 0.5).at(11_111)];
    let render = |sent: &[Timed], block: &mut dyn FnMut() -> usize| {
        let mut player = player(&state(&patch), 4.0, 48.0, 1.0);
        player.audio.feed(incoming(FRAMES));
        player.render(sent, FRAMES, block)
    };
    let expected = render(&sent, &mut || 8192);
    assert!(expected.ended.iter().all(|ended| ended.note.id == 1), "{:?}", expected.ended);
    let held = render(&[], &mut || 8192).channels;
    let first = (0..FRAMES).find(|&frame| held[0][frame] != expected.channels[0][frame]).expect("the note is heard");
    assert!((5_003..5_100).contains(&first), "{first}");
    let power = |channels: &[Vec<f32>]| channels[0][16_000..].iter().map(|sample| sample * sample).sum::<f32>();
    let (with, without) = (power(&expected.channels), power(&held));
    assert!(with > 0.2 * without, "the chord is back: {with} against {without}");
    for (division, mut block) in divisions() {
        assert_same_bits(division, &render(&sent, &mut block).channels, &expected.channels);
    }
}

pub(crate) fn its_state_comes_back_and_is_that_of_the_instrument() {
    let mut instance = Instance::resonator(&open());
    let (_, patch) = patches().swap_remove(2);
    assert!(instance.load(&state(&patch)));
    for (name, value) in OWN {
        let id = id(&mut instance, name);
        instance.flush(&[Sent::Value(id, value).at(0)]);
    }
    // Even a sound that nothing drives comes back as it was left.
    let level = instance.id(Param::InputLevel);
    assert!(patch_in(&instance.save()).get(Param::InputLevel) == 0.0, "driven as it was loaded");
    instance.flush(&[Sent::Value(level, 0.0).at(0)]);
    let saved = instance.save();
    assert_eq!(patch_in(&saved).get(Param::InputLevel), -60.0);
    let mut other = Instance::resonator(&open());
    assert!(other.load(&saved));
    assert_eq!(other.save(), saved, "to the byte");
    for (name, value) in OWN {
        let id = id(&mut other, name);
        assert!((other.value(id).unwrap() - value).abs() < 1e-4, "{name}");
    }
    // The instrument reads the same state, and has nothing of the effect in its own.
    let mut instrument = Instance::new();
    assert!(instrument.load(&saved));
    assert_eq!(own_part(&instrument.save()), own_part(&saved));
    assert!(!String::from_utf8_lossy(&instrument.save()).contains("resonator"));
    let garbage = crate::patches::enclosed("{}");
    other.load(&garbage);
    assert_eq!(other.save(), saved, "what is no state changes nothing");
}

pub(crate) fn silence_gives_silence_after_the_tail() {
    let patch = Preset::find("Marimba").unwrap().patch.clone().with(Param::Decay, 0.2);
    for (chord, mix) in [(3.0, 1.0), (3.0, 0.5), (0.0, 1.0)] {
        let mut player = player(&state(&patch), chord, 48.0, mix);
        let untouched = player.render(&[], 4_800, || 480).channels;
        assert!(untouched.iter().flatten().all(|sample| *sample == 0.0), "nothing has come in");
        player.audio.feed([vec![0.0; 4_800], incoming(4_800)].concat());
        let found = player.render(&[], 5 * SAMPLE_RATE as usize, || 480).channels;
        assert_clean("what comes out", &found);
        let last = found[0].iter().rposition(|sample| *sample != 0.0);
        assert_eq!(last.is_some(), chord != 0.0 || mix != 1.0, "it is heard");
        assert!(last.is_none_or(|last| last < 3 * SAMPLE_RATE as usize), "silent before, not at {last:?}");
    }
}

pub(crate) fn at_a_mix_of_0_the_sound_is_as_it_was() {
    for in_place in [false, true] {
        let mut player = player(&state(&Patch::default()), 4.0, 48.0, 0.0);
        player.audio.feed_noise();
        if in_place {
            player.audio.work_in_place();
        }
        for block in [1, 480, 8_192] {
            let found = player.render(&[], block, || block).channels;
            let expected = match in_place {
                true => vec![vec![0.9; block]; 2],
                false => (1..=2).map(|seed| (0..block as u64).map(|n| uniform(seed, n)).collect()).collect(),
            };
            assert_same_bits("dry", &found, &expected);
        }
    }
}
