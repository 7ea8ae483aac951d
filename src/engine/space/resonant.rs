//! The effects that are bodies of many masses: sympathetic strings and the space.

use super::bodies::{self, Bodies};
use crate::dsp::space::{Decay, ModalReverb, Resonator};
use crate::params::{Param, Space, Values};
use crate::units::ratio_from_semitones;

/// Level of strings at 100 %. Set with noise as their input; input at the strings' own frequencies excites them far more.
const FULL_STRINGS: f32 = 0.3;

/// Sections that are bodies of many masses.
pub(super) struct Resonant {
    bodies: &'static Bodies,
    pub(super) strings: ModalReverb,
    pub(super) reverb: ModalReverb,
    space: Space,
}

impl Resonant {
    /// Room for all bodies. Allocates.
    pub(super) fn new(sample_rate: f64) -> Self {
        let bodies = Bodies::shared();
        let [reverb, strings] = bodies.most().map(|masses| {
            let decay = Decay { low: 1.0, high: 1.0 };
            ModalReverb::new(Resonator::with_room(masses, decay, sample_rate))
        });
        Self { bodies, strings, reverb, space: Space::None }
    }

    /// Applies a parameter that has changed.
    pub(super) fn follow(&mut self, param: Param, values: &Values) {
        let Self { bodies, strings, reverb, space } = self;
        let decay = |low, high| Decay { low: f64::from(values.get(low)), high: f64::from(values.get(high)) };
        match param {
            Param::StringsLevel => strings.set_levels(1.0, FULL_STRINGS * 0.01 * values.get(param)),
            Param::StringsTuning => strings.set_body(bodies.of_strings(values.choice(param))),
            Param::StringsTune => strings.set_pitch(ratio_from_semitones(values.get(param).into()) as f32),
            Param::StringsLowDecay | Param::StringsHighDecay => {
                strings.set_decay(decay(Param::StringsLowDecay, Param::StringsHighDecay));
            }
            Param::Space => {
                let wanted = values.choice(param);
                if let Some(modes) = bodies.of_space(wanted).filter(|_| *space != wanted) {
                    *space = wanted;
                    reverb.set_body(modes);
                }
                self.follow_size(values);
                self.follow_mix(values);
            }
            Param::SpaceSize | Param::SpaceMaterial => self.follow_size(values),
            Param::SpaceLowDecay | Param::SpaceHighDecay => {
                reverb.set_decay(decay(Param::SpaceLowDecay, Param::SpaceHighDecay));
            }
            Param::SpacePreDelay => reverb.set_pre_delay(values.get(param).into()),
            Param::SpaceMix => self.follow_mix(values),
            _ => {}
        }
    }

    fn follow_size(&mut self, values: &Values) {
        let (size, material) = (0.01 * f64::from(values.get(Param::SpaceSize)), values.choice(Param::SpaceMaterial));
        self.reverb.set_pitch(bodies::pitch(self.space, size, material) as f32);
    }

    fn follow_mix(&mut self, values: &Values) {
        match values.choice(Param::Space) {
            Space::None => self.reverb.set_levels(1.0, 0.0),
            _ => self.reverb.set_mix(0.01 * values.get(Param::SpaceMix)),
        }
    }
}
