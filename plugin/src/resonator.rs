//! Sprung Resonator: the same engine as an effect, in which the sound that comes in moves the body of any preset.
//!
//! Its own parameters (chord, root, mix) are not in the engine's table, since they act around the engine: the notes that it gets, and the
//! balance of its output. Everything else is the instrument's: the state, the parameters, the window. A sound that no input drives is
//! loaded with its input at 0 dB and its other exciters off (`State::driven`), where the window shows it and one can turn it; a state
//! of the effect itself is loaded as it is.

#![allow(unsafe_code, reason = "the wrapper takes parameters as pointers")]

use crate::editor::SprungEditor;
use crate::layer::published::publish;
use crate::live::Live;
use crate::params::SprungParams;
use crate::plugin::{Sprung, add_pages};
use crate::state;
use nice_plug::prelude::*;
use nice_plug_core::params::internals::ParamPtr;
use sprung::internals::space::Blend;
use sprung::units::{mono_from_stereo, note_name, parse_key};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The chords that are held while nobody plays, in semitones above the root. Projects store their numbers, so that new ones come last.
const CHORDS: [(&str, &[u8]); 7] = [
    ("Off", &[]),
    ("One note", &[0]),
    ("Octaves", &[0, 12, 24]),
    ("Fifth", &[0, 7, 12]),
    ("Major", &[0, 4, 7, 12]),
    ("Minor", &[0, 3, 7, 12]),
    ("Sus4", &[0, 5, 7, 12]),
];

/// The ids of the effect's own parameters. Stored in every project: they may never change.
const IDS: [&str; 3] = ["resonator_chord", "resonator_root", "resonator_mix"];

/// The effect's own parameters, and those of the instrument.
struct ResonatorParams {
    sprung: Arc<SprungParams>,
    chord: IntParam,
    root: IntParam,
    mix: FloatParam,
}

impl Default for ResonatorParams {
    fn default() -> Self {
        let chords = IntRange::Linear { min: 0, max: CHORDS.len() as i32 - 1 };
        let chord = |text: &str| CHORDS.iter().position(|(name, _)| name.eq_ignore_ascii_case(text.trim()));
        let sprung = Arc::new(SprungParams::of_effect().of_host());
        publish(&sprung);
        let percent = |text: &str| text.trim().trim_end_matches('%').trim_end().parse::<f32>().ok();
        Self {
            sprung,
            chord: IntParam::new("Chord", 3, chords)
                .with_value_to_string(Arc::new(|index| {
                    CHORDS[index.clamp(0, CHORDS.len() as i32 - 1) as usize].0.to_owned()
                }))
                .with_string_to_value(Arc::new(move |text| chord(text).map(|index| index as i32))),
            root: IntParam::new("Chord root", 48, IntRange::Linear { min: 0, max: 127 })
                .with_value_to_string(Arc::new(|key| note_name(key.clamp(0, 127) as u8)))
                .with_string_to_value(Arc::new(|text| {
                    let key = parse_key(text.trim(), 440.0).ok()?.round();
                    (0.0..=127.0).contains(&key).then_some(key as i32)
                })),
            mix: FloatParam::new("Resonator mix", 0.5, FloatRange::Linear { min: 0.0, max: 1.0 })
                .with_value_to_string(Arc::new(|share| format!("{:.1} %", 100.0 * share)))
                .with_string_to_value(Arc::new(move |text| {
                    Some(percent(text)? / 100.0).filter(|share| (0.0..=1.0).contains(share))
                })),
        }
    }
}

impl ResonatorParams {
    /// The keys of the chord, a bit for each; those above the keyboard are left out. Real-time safe.
    fn keys(&self) -> u128 {
        let (_, intervals) = CHORDS[(self.chord.value() as usize).min(CHORDS.len() - 1)];
        let root = self.root.value().clamp(0, 127) as u32;
        intervals.iter().fold(0, |keys, interval| keys | 1_u128.checked_shl(root + u32::from(*interval)).unwrap_or(0))
    }
}

// SAFETY: the pointers refer to fields of `self`, and to those of `sprung`, which lives as long.
unsafe impl Params for ResonatorParams {
    fn param_map(&self) -> Vec<(String, ParamPtr, String)> {
        let own = IDS.into_iter().zip([self.chord.as_ptr(), self.root.as_ptr(), self.mix.as_ptr()]);
        let own = own.map(|(id, pointer)| (id.to_owned(), pointer, "Resonator".to_owned()));
        own.chain(self.sprung.param_map()).collect()
    }

    fn serialize_fields(&self) -> BTreeMap<String, String> {
        let mut fields = self.sprung.serialize_fields();
        fields.insert(state::EFFECT_FIELD.to_owned(), "1".to_owned());
        fields
    }

    fn deserialize_fields(&self, fields: &BTreeMap<String, String>) {
        self.sprung.deserialize_fields(fields);
    }
}

/// What exists while the effect is active.
struct Running {
    live: Live,
    blend: Blend,
    /// The sound as it came in.
    dry: [Vec<f32>; 2],
    /// The same as the engine gets it.
    mono: Vec<f32>,
}

/// The effect as the wrapper uses it.
#[derive(Default)]
pub struct Resonator {
    params: Arc<ResonatorParams>,
    running: Option<Running>,
}

/// A layout with this many channels in and out.
const fn layout(name: &'static str, channels: u32) -> AudioIOLayout {
    AudioIOLayout {
        main_input_channels: Some(new_nonzero_u32(channels)),
        main_output_channels: Some(new_nonzero_u32(channels)),
        aux_input_ports: &[],
        aux_output_ports: &[],
        names: PortNames { layout: Some(name), ..PortNames::const_default() },
    }
}

impl Plugin for Resonator {
    const NAME: &'static str = "Sprung Resonator";
    const VENDOR: &'static str = Sprung::VENDOR;
    const URL: &'static str = Sprung::URL;
    const EMAIL: &'static str = Sprung::EMAIL;
    const VERSION: &'static str = Sprung::VERSION;
    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] = &[layout("Stereo", 2), layout("Mono", 1)];
    const MIDI_INPUT: MidiConfig = Sprung::MIDI_INPUT;
    const SAMPLE_ACCURATE_AUTOMATION: bool = Sprung::SAMPLE_ACCURATE_AUTOMATION;
    const INPUT_EVENT_CAPACITY: usize = Sprung::INPUT_EVENT_CAPACITY;

    type Editor = SprungEditor;
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.params.clone()
    }

    fn editor(&mut self, _: AsyncExecutor<Self>) -> Option<SprungEditor> {
        Some(SprungEditor::new(self.params.sprung.clone()))
    }

    fn filter_state(state: &mut PluginState) {
        let mut own = std::mem::take(&mut state.params);
        own.retain(|id, _| IDS.contains(&id.as_str()));
        let mark = state.fields.remove_entry(state::EFFECT_FIELD);
        state::filter(state);
        // What is no state of Sprung changes nothing, not even these.
        if state.fields.contains_key(state::FIELD) {
            state.params = own;
            state.fields.extend(mark);
        }
    }

    fn activate(
        &mut self,
        _layout: &AudioIOLayout,
        config: &BufferConfig,
        _context: &mut impl ActivateContext<Self>,
    ) -> bool {
        let rate = f64::from(config.sample_rate);
        let mut live = Live::new(rate, config.process_mode == ProcessMode::Offline, &self.params.sprung);
        live.hold(self.params.keys());
        let room = || vec![0.0; config.max_buffer_size as usize];
        let blend = Blend::new(rate, self.params.mix.value());
        self.running = Some(Running { live, blend, dry: [room(), room()], mono: room() });
        true
    }

    fn reset(&mut self) {
        if let Some(running) = &mut self.running {
            running.live.reset(&self.params.sprung);
        }
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        _aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        match &mut self.running {
            Some(running) => running.process(&self.params, buffer.as_slice(), context),
            None => ProcessStatus::Error("processing before activation"),
        }
    }

    fn deactivate(&mut self) {
        self.running = None;
    }
}

impl Running {
    /// Processes a block in place, one channel or two. Real-time safe.
    fn process(
        &mut self,
        params: &ResonatorParams,
        channels: &mut [&mut [f32]],
        context: &mut impl ProcessContext<Resonator>,
    ) -> ProcessStatus {
        let frames = channels.first().map_or(0, |channel| channel.len());
        let Some(mono) = self.mono.get_mut(..frames) else {
            return ProcessStatus::Error("a block is longer than the host has said");
        };
        for (dry, channel) in self.dry.iter_mut().zip(channels.iter()) {
            dry[..frames].copy_from_slice(channel);
        }
        match channels {
            [left, right, ..] => {
                for ((mono, left), right) in mono.iter_mut().zip(left.iter()).zip(right.iter()) {
                    *mono = mono_from_stereo(*left, *right);
                }
            }
            [one] => mono.copy_from_slice(one),
            [] => {}
        }
        self.live.hold(params.keys());
        let status = self.live.process(&params.sprung, mono, channels, &mut None, context);
        self.blend.aim(params.mix.value());
        self.blend.mix(self.dry.iter().map(|dry| &dry[..frames]), channels);
        status
    }
}

impl ClapPlugin for Resonator {
    const CLAP_ID: &'static str = "org.sprung.resonator";
    const CLAP_DESCRIPTION: Option<&'static str> = Some("Masses on springs that resonate with the sound that comes in");
    const CLAP_MANUAL_URL: Option<&'static str> = None;
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::AudioEffect, ClapFeature::Filter, ClapFeature::Stereo, ClapFeature::Mono];
    const CLAP_POLY_MODULATION_CONFIG: Option<PolyModulationConfig> = Sprung::CLAP_POLY_MODULATION_CONFIG;

    fn remote_controls(&self, context: &mut impl RemoteControlsContext) {
        context.add_section("Resonator", |section| {
            section.add_page("Resonator", |page| {
                page.add_param(&self.params.chord);
                page.add_param(&self.params.root);
                page.add_param(&self.params.mix);
            });
        });
        add_pages(&self.params.sprung, context);
    }
}

impl Vst3Plugin for Resonator {
    // Stored in every project that uses the effect, like CLAP_ID: neither may ever change.
    const VST3_CLASS_ID: [u8; 16] = *b"SprungResonator1";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] = &[Vst3SubCategory::Fx, Vst3SubCategory::Filter];
}
