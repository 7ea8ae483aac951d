//! Sprung Multi: the same instrument with sixteen stereo outputs beside the main one, for a kit's pads and for MIDI channels.

use crate::editor::SprungEditor;
use crate::plugin::{STEREO_IN, Sprung, add_pages, layout, mono_input};
use nice_plug::prelude::*;
use sprung::engine::Outputs;
use sprung::sound::OUTPUTS;
use std::num::NonZeroU32;
use std::sync::Arc;

/// [`Sprung`] with more outputs. Both read the same states.
#[derive(Default)]
pub struct SprungMulti(Sprung);

const OTHERS: &[NonZeroU32] = &[new_nonzero_u32(2); OUTPUTS];

const NAMES: &[&str; OUTPUTS] = &[
    "Output 1",
    "Output 2",
    "Output 3",
    "Output 4",
    "Output 5",
    "Output 6",
    "Output 7",
    "Output 8",
    "Output 9",
    "Output 10",
    "Output 11",
    "Output 12",
    "Output 13",
    "Output 14",
    "Output 15",
    "Output 16",
];

/// A stereo layout with all outputs.
const fn with_outputs(name: &'static str, inputs: &'static [NonZeroU32]) -> AudioIOLayout {
    let plain = layout(name, 2, inputs);
    AudioIOLayout { aux_output_ports: OTHERS, names: PortNames { aux_outputs: NAMES, ..plain.names }, ..plain }
}

impl Plugin for SprungMulti {
    const NAME: &'static str = "Sprung Multi";
    const VENDOR: &'static str = Sprung::VENDOR;
    const URL: &'static str = Sprung::URL;
    const EMAIL: &'static str = Sprung::EMAIL;
    const VERSION: &'static str = Sprung::VERSION;
    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] =
        &[with_outputs("Outputs", &[]), with_outputs("Outputs with exciter input", STEREO_IN)];
    const MIDI_INPUT: MidiConfig = Sprung::MIDI_INPUT;
    const SAMPLE_ACCURATE_AUTOMATION: bool = Sprung::SAMPLE_ACCURATE_AUTOMATION;
    const INPUT_EVENT_CAPACITY: usize = Sprung::INPUT_EVENT_CAPACITY;

    type Editor = SprungEditor;
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.0.params()
    }

    fn editor(&mut self, _: AsyncExecutor<Self>) -> Option<SprungEditor> {
        Some(SprungEditor::new(self.0.params.clone()))
    }

    fn filter_state(state: &mut PluginState) {
        Sprung::filter_state(state);
    }

    fn activate(&mut self, _: &AudioIOLayout, config: &BufferConfig, _: &mut impl ActivateContext<Self>) -> bool {
        self.0.start(config);
        true
    }

    fn reset(&mut self) {
        self.0.reset();
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        let Some(live) = &mut self.0.live else { return ProcessStatus::Error("processing before activation") };
        let others = aux.outputs.iter_mut().map(|output| match output.as_slice() {
            [left, right] => [&mut **left, &mut **right],
            _ => Default::default(),
        });
        let mut others = Some(Outputs::new(others));
        live.process(&self.0.params, mono_input(aux.inputs), buffer.as_slice(), &mut others, context)
    }

    fn deactivate(&mut self) {
        self.0.deactivate();
    }
}

impl ClapPlugin for SprungMulti {
    const CLAP_ID: &'static str = "org.sprung.sprung-multi";
    const CLAP_DESCRIPTION: Option<&'static str> = Some("Sprung with an output for each pad or MIDI channel");
    const CLAP_MANUAL_URL: Option<&'static str> = None;
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::Instrument, ClapFeature::Synthesizer, ClapFeature::Drum, ClapFeature::Stereo];
    const CLAP_POLY_MODULATION_CONFIG: Option<PolyModulationConfig> = Sprung::CLAP_POLY_MODULATION_CONFIG;

    fn remote_controls(&self, context: &mut impl RemoteControlsContext) {
        add_pages(&self.0.params, context);
    }
}

impl Vst3Plugin for SprungMulti {
    // Stored in every project that uses the plugin, like CLAP_ID: neither may ever change.
    const VST3_CLASS_ID: [u8; 16] = *b"SprungMassMultiO";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] = Sprung::VST3_SUBCATEGORIES;
}
