//! What hosts are told of the instrument, and their calls.

use crate::editor::SprungEditor;
use crate::live::{EVENT_CAPACITY, Live, MAX_VOICES};
use crate::params::{Knob, SprungParams};
use crate::state;
use nice_plug::prelude::*;
use sprung::params::PARAMS;
use std::sync::Arc;

/// The instrument as the wrapper sees it.
#[derive(Default)]
pub struct Sprung {
    params: Arc<SprungParams>,
    /// There while the plugin is active.
    live: Option<Live>,
}

/// The layout of so many output channels, with or without an input.
const fn layout(name: &'static str, channels: u32, inputs: &'static [std::num::NonZeroU32]) -> AudioIOLayout {
    AudioIOLayout {
        main_input_channels: None,
        main_output_channels: Some(new_nonzero_u32(channels)),
        aux_input_ports: inputs,
        aux_output_ports: &[],
        names: PortNames { layout: Some(name), aux_inputs: &["Exciter in"], ..PortNames::const_default() },
    }
}

const STEREO_IN: &[std::num::NonZeroU32] = &[new_nonzero_u32(2)];

impl Plugin for Sprung {
    const NAME: &'static str = "Sprung";
    const VENDOR: &'static str = "The Sprung authors";
    const URL: &'static str = "";
    const EMAIL: &'static str = "";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] = &[
        layout("Stereo", 2, &[]),
        layout("Mono", 1, &[]),
        layout("Stereo with exciter input", 2, STEREO_IN),
        layout("Mono with exciter input", 1, STEREO_IN),
    ];
    // Bend, pedals and the wheel come only with all controllers.
    const MIDI_INPUT: MidiConfig = MidiConfig::MidiCCs;
    const SAMPLE_ACCURATE_AUTOMATION: bool = true;
    const INPUT_EVENT_CAPACITY: usize = EVENT_CAPACITY;

    type Editor = SprungEditor;
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.params.clone()
    }

    fn editor(&mut self, _: AsyncExecutor<Self>) -> Option<SprungEditor> {
        Some(SprungEditor::new(self.params.clone()))
    }

    fn filter_state(state: &mut PluginState) {
        state::filter(state);
    }

    fn activate(
        &mut self,
        _layout: &AudioIOLayout,
        config: &BufferConfig,
        _context: &mut impl ActivateContext<Self>,
    ) -> bool {
        let offline = config.process_mode == ProcessMode::Offline;
        self.live = Some(Live::new(f64::from(config.sample_rate), offline, &self.params));
        true
    }

    fn reset(&mut self) {
        if let Some(live) = &mut self.live {
            live.reset(&self.params);
        }
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        _aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        match &mut self.live {
            Some(live) => live.process(&self.params, buffer.as_slice(), context),
            None => ProcessStatus::Error("processing before activation"),
        }
    }

    fn deactivate(&mut self) {
        self.live = None;
    }
}

impl ClapPlugin for Sprung {
    const CLAP_ID: &'static str = "org.sprung.sprung";
    const CLAP_DESCRIPTION: Option<&'static str> = Some("A synthesizer whose only sound source is a mass on a spring");
    const CLAP_MANUAL_URL: Option<&'static str> = None;
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::Instrument, ClapFeature::Synthesizer, ClapFeature::Drum, ClapFeature::Stereo, ClapFeature::Mono];
    const CLAP_POLY_MODULATION_CONFIG: Option<PolyModulationConfig> =
        Some(PolyModulationConfig { max_voice_capacity: MAX_VOICES, supports_overlapping_voices: true });

    fn remote_controls(&self, context: &mut impl RemoteControlsContext) {
        for rows in PARAMS.chunk_by(|a, b| a.section == b.section) {
            context.add_section(rows[0].section, |section| {
                section.add_page(rows[0].section, |page| {
                    for knob in rows.iter().map(|info| &self.params.knobs()[info.param as usize]) {
                        match knob {
                            Knob::Continuous(knob) => page.add_param(knob),
                            Knob::Stepped(knob) => page.add_param(knob),
                        }
                    }
                });
            });
        }
    }
}

impl Vst3Plugin for Sprung {
    // In every project that uses the plugin: never to be changed, and CLAP_ID no more.
    const VST3_CLASS_ID: [u8; 16] = *b"SprungMassSpring";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] =
        &[Vst3SubCategory::Instrument, Vst3SubCategory::Synth, Vst3SubCategory::Drum];
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    /// VST3 hosts may read the file in place of loading the library.
    #[test]
    fn moduleinfo_says_what_the_shell_is_made_with() {
        let info: Value = serde_json::from_str(include_str!("../moduleinfo.json")).unwrap();
        let factory = json!({
            "Vendor": Sprung::VENDOR,
            "URL": Sprung::URL,
            "E-Mail": Sprung::EMAIL,
            "Flags": { "Unicode": true, "Classes Discardable": false, "Component Non Discardable": false },
        });
        let categories: Vec<&str> = Sprung::VST3_SUBCATEGORIES.iter().map(|category| category.as_str()).collect();
        let class = json!({
            "CID": Sprung::VST3_CLASS_ID.map(|byte| format!("{byte:02X}")).concat(),
            "Category": "Audio Module Class",
            "Name": Sprung::NAME,
            "Vendor": Sprung::VENDOR,
            "Version": Sprung::VERSION,
            "SDKVersion": "VST 3.6.14",
            "Sub Categories": categories,
            "Class Flags": 2,
            "Cardinality": i32::MAX,
            "Snapshots": [],
        });
        let expected = json!({
            "Name": Sprung::NAME,
            "Version": Sprung::VERSION,
            "Factory Info": factory,
            "Compatibility": [],
            "Classes": [class],
        });
        assert_eq!(info, expected);
    }
}
