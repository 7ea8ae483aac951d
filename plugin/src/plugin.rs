//! The description of the instrument for hosts, and the calls that they make.
//!
//! One lock in the audio thread cannot be avoided: at the end of each call, the CLAP wrapper checks a channel for a
//! state from `GuiContext::set_state`, under a mutex. No other thread takes this mutex, because the window does not use
//! `set_state`, so the audio thread never waits for it. In a host without thread-check, the wrapper also asks for the
//! id of the current thread, for which Rust allocates once per thread.

use crate::editor::SprungEditor;
use crate::layer::published::publish;
use crate::live::{EVENT_CAPACITY, Live, MAX_VOICES};
use crate::params::{Knob, SprungParams};
use crate::state;
use nice_plug::prelude::*;
use sprung::params::{PARAMS, Param};
use sprung::units::mono_from_stereo;
use std::sync::Arc;

/// The instrument as the wrapper uses it.
pub struct Sprung {
    pub(crate) params: Arc<SprungParams>,
    /// Exists while the plugin is active.
    pub(crate) live: Option<Live>,
}

impl Default for Sprung {
    fn default() -> Self {
        let params = Arc::new(SprungParams::of_instrument().of_host());
        publish(&params);
        Self { params, live: None }
    }
}

/// A layout with this many output channels, with or without an input.
pub(crate) const fn layout(
    name: &'static str,
    channels: u32,
    inputs: &'static [std::num::NonZeroU32],
) -> AudioIOLayout {
    AudioIOLayout {
        main_input_channels: None,
        main_output_channels: Some(new_nonzero_u32(channels)),
        aux_input_ports: inputs,
        aux_output_ports: &[],
        names: PortNames { layout: Some(name), aux_inputs: &["Exciter in"], ..PortNames::const_default() },
    }
}

/// The first page of a hardware controller, in the order of its eight knobs. The macros come first, because every factory
/// sound has four, for what one would turn in it first; the others act in sounds without macros too.
const FIRST: [Param; 8] = [
    Param::Macro1,
    Param::Macro2,
    Param::Macro3,
    Param::Macro4,
    Param::Decay,
    Param::Tilt,
    Param::SpaceMix,
    Param::Gain,
];

pub(crate) const STEREO_IN: &[std::num::NonZeroU32] = &[new_nonzero_u32(2)];

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
    // Bend, pedals and the modulation wheel only arrive if all controllers are requested.
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

    fn activate(&mut self, _: &AudioIOLayout, config: &BufferConfig, _: &mut impl ActivateContext<Self>) -> bool {
        self.start(config);
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
        aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        match &mut self.live {
            Some(live) => live.process(&self.params, mono_input(aux.inputs), buffer.as_slice(), &mut None, context),
            None => ProcessStatus::Error("processing before activation"),
        }
    }

    fn deactivate(&mut self) {
        self.live = None;
    }
}

/// The signal at *Exciter in*, the mean of its channels; empty if the host has no such port. The wrapper's buffers are
/// copies, so the mean is written to the first channel.
pub(crate) fn mono_input<'a>(inputs: &'a mut [Buffer<'_>]) -> &'a [f32] {
    match inputs.first_mut().map(|input| input.as_slice()) {
        Some([left, right, ..]) => {
            for (left, right) in left.iter_mut().zip(right.iter()) {
                *left = mono_from_stereo(*left, *right);
            }
            left
        }
        Some([mono]) => mono,
        Some([]) | None => &[],
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
        add_pages(&self.params, context);
    }
}

impl Sprung {
    /// Makes what plays.
    pub(crate) fn start(&mut self, config: &BufferConfig) {
        let offline = config.process_mode == ProcessMode::Offline;
        self.live = Some(Live::new(f64::from(config.sample_rate), offline, &self.params));
    }
}

/// The pages of a hardware controller for the parameters of the table.
pub(crate) fn add_pages(params: &SprungParams, context: &mut impl RemoteControlsContext) {
    let mut add = |name: &str, rows: &mut dyn Iterator<Item = Param>| {
        context.add_section(name, |section| {
            section.add_page(name, |page| {
                for knob in rows.map(|param| &params.knobs()[param as usize]) {
                    match knob {
                        Knob::Continuous(knob) => page.add_param(knob),
                        Knob::Stepped(knob) => page.add_param(knob),
                    }
                }
            });
        });
    };
    add("Essentials", &mut FIRST.into_iter());
    // What a sound's author has put on macros comes before what the engine has.
    let mut sections: Vec<_> = PARAMS.chunk_by(|a, b| a.section == b.section).collect();
    sections.sort_by_key(|rows| rows[0].section != "Macros");
    for rows in sections {
        add(rows[0].section, &mut rows.iter().map(|info| info.param));
    }
}

impl Vst3Plugin for Sprung {
    // Stored in every project that uses the plugin, like CLAP_ID: neither may ever change.
    const VST3_CLASS_ID: [u8; 16] = *b"SprungMassSpring";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] =
        &[Vst3SubCategory::Instrument, Vst3SubCategory::Synth, Vst3SubCategory::Drum];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multi::SprungMulti;
    use crate::resonator::Resonator;
    use serde_json::{Value, json};

    fn class<P: Vst3Plugin>() -> Value {
        let categories: Vec<&str> = P::VST3_SUBCATEGORIES.iter().map(|category| category.as_str()).collect();
        json!({
            "CID": P::VST3_CLASS_ID.map(|byte| format!("{byte:02X}")).concat(),
            "Category": "Audio Module Class",
            "Name": P::NAME,
            "Vendor": P::VENDOR,
            "Version": P::VERSION,
            "SDKVersion": "VST 3.6.14",
            "Sub Categories": categories,
            "Class Flags": 2,
            "Cardinality": i32::MAX,
            "Snapshots": [],
        })
    }

    /// VST3 hosts may read this file instead of loading the library.
    #[test]
    fn moduleinfo_says_what_the_shell_is_made_with() {
        let info: Value = serde_json::from_str(include_str!("../moduleinfo.json")).unwrap();
        let factory = json!({
            "Vendor": Sprung::VENDOR,
            "URL": Sprung::URL,
            "E-Mail": Sprung::EMAIL,
            "Flags": { "Unicode": true, "Classes Discardable": false, "Component Non Discardable": false },
        });
        let classes = [class::<Sprung>(), class::<SprungMulti>(), class::<Resonator>()];
        let expected = json!({
            "Name": Sprung::NAME,
            "Version": Sprung::VERSION,
            "Factory Info": factory,
            "Compatibility": [],
            "Classes": classes,
        });
        assert_eq!(info, expected);
    }
}
