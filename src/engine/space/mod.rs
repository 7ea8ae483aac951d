//! What is behind the voices of a synth: strings, tremolo, drive, tone, space and width, one after the other.
//!
//! Those that are off touch nothing. The rest sleep once what they hold is below −120 dBFS and silence comes in; then they
//! are told of frames that pass, and do with them what they would have done with silence. So it does not matter for the
//! bits when somebody finds that nothing sounds, and neither do blocks.

mod bodies;
mod resonant;
mod tail;

use crate::dsp::space::{Overdrive, Tone, Tremolo, Width};
use crate::params::{self, Param, Values};
use resonant::Resonant;

/// The sections behind the voices. Real-time safe once made, but for [`Space::reserve`].
pub(crate) struct Space {
    sample_rate: f64,
    /// The bodies, if there is room for them.
    resonant: Option<Box<Resonant>>,
    tremolo: Tremolo,
    drive: Overdrive,
    tone: Tone,
    width: Width,
    /// A section does or may do something to what passes.
    is_on: bool,
    /// A section holds something, or is on its way to another setting.
    is_awake: bool,
}

/// Parameters of the sections, each after those that it needs; [`Param::Space`] brings size, material and mix along.
const ALL: [Param; 16] = [
    Param::StringsTuning,
    Param::StringsTune,
    Param::StringsLowDecay,
    Param::StringsHighDecay,
    Param::StringsLevel,
    Param::TremoloRate,
    Param::TremoloStereo,
    Param::TremoloDepth,
    Param::Drive,
    Param::ToneLow,
    Param::ToneHigh,
    Param::SpaceLowDecay,
    Param::SpaceHighDecay,
    Param::SpacePreDelay,
    Param::Space,
    Param::StereoWidth,
];

/// Whether these values need room for bodies. Real-time safe.
pub(crate) fn needs_bodies(values: &Values) -> bool {
    values.choice::<params::Space>(Param::Space) != params::Space::None || values.get(Param::StringsLevel) > 0.0
}

impl Space {
    /// All off, without room for bodies.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            resonant: None,
            tremolo: Tremolo::new(sample_rate),
            drive: Overdrive::new(sample_rate),
            tone: Tone::new(sample_rate),
            width: Width::new(sample_rate),
            is_on: false,
            is_awake: false,
        }
    }

    /// Makes room for any body, if there is none. Follow with [`Space::set_all`]. Allocates.
    pub(crate) fn reserve(&mut self) {
        if self.resonant.is_none() {
            self.resonant = Some(Box::new(Resonant::new(self.sample_rate)));
        }
    }

    /// Whether there is room for bodies. Without it they stay off.
    pub(crate) fn has_room(&self) -> bool {
        self.resonant.is_some()
    }

    /// Takes over one parameter: in 20 ms, or `at_once`, which is for times when nothing sounds, here or before.
    pub(crate) fn set(&mut self, param: Param, values: &Values, at_once: bool) {
        self.follow(param, values);
        self.finish(at_once);
    }

    /// Takes over all parameters, likewise.
    pub(crate) fn set_all(&mut self, values: &Values, at_once: bool) {
        ALL.into_iter().for_each(|param| self.follow(param, values));
        self.finish(at_once);
    }

    fn follow(&mut self, param: Param, values: &Values) {
        let number = |param| values.get(param);
        let share = |param| 0.01 * values.get(param);
        match param {
            Param::TremoloDepth => self.tremolo.set_depth(share(param)),
            Param::TremoloRate => self.tremolo.set_rate(number(param).into()),
            Param::TremoloStereo => self.tremolo.set_stereo_phase(180.0 * share(param)),
            Param::Drive => self.drive.set(number(param)),
            Param::ToneLow | Param::ToneHigh => self.tone.set(number(Param::ToneLow), number(Param::ToneHigh)),
            Param::StereoWidth => self.width.set(share(param)),
            _ => {
                if let Some(resonant) = &mut self.resonant {
                    resonant.follow(param, values);
                }
            }
        }
    }

    fn finish(&mut self, at_once: bool) {
        if at_once { self.reset() } else { self.look() }
    }

    /// Silence, and everything where it is to be.
    pub(crate) fn reset(&mut self) {
        if let Some(resonant) = &mut self.resonant {
            resonant.strings.reset();
            resonant.reverb.reset();
        }
        self.tremolo.reset();
        self.drive.reset();
        self.tone.reset();
        self.width.reset();
        self.look();
    }

    /// Finds what there is to do from now on.
    fn look(&mut self) {
        let Self { tremolo, drive, tone, width, .. } = self;
        let (mut off, mut idle) = (true, true);
        if let Some(Resonant { strings, reverb, .. }) = self.resonant.as_deref() {
            off = strings.is_off() && reverb.is_off();
            idle = strings.is_idle() && reverb.is_idle();
        }
        self.is_on = !(off && tremolo.is_off() && drive.is_off() && tone.is_off() && width.is_off());
        self.is_awake =
            self.is_on && !(idle && tremolo.is_idle() && drive.is_idle() && tone.is_idle() && width.is_idle());
    }

    /// Whether something sounds, or is on its way to another setting.
    pub(crate) fn is_awake(&self) -> bool {
        self.is_awake
    }

    /// Sends what the voices play through all sections, in place. Returns whether any has touched it.
    pub(crate) fn process(&mut self, left: &mut [f32], right: &mut [f32]) -> bool {
        if !self.is_on {
            return false;
        }
        if let Some(resonant) = &mut self.resonant {
            resonant.strings.process(left, right);
        }
        self.tremolo.process(left, right);
        self.drive.process(left, right);
        self.tone.process(left, right);
        if let Some(resonant) = &mut self.resonant {
            resonant.reverb.process(left, right);
        }
        self.width.process(left, right);
        self.look();
        true
    }

    /// Lets frames of silence pass while it is not awake.
    pub(crate) fn skip(&mut self, frames: usize) {
        if !self.is_on {
            return;
        }
        if let Some(resonant) = &mut self.resonant {
            resonant.strings.skip(frames);
            resonant.reverb.skip(frames);
        }
        self.tremolo.skip(frames);
        self.tone.skip(frames);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::PARAMS;

    #[test]
    fn all_that_is_behind_voices_is_followed() {
        let rows: Vec<Param> = PARAMS.iter().map(|info| info.param).filter(|param| param.is_behind_voices()).collect();
        let with_space = [Param::SpaceSize, Param::SpaceMaterial, Param::SpaceMix];
        let followed: Vec<Param> = ALL.into_iter().chain(with_space).collect();
        assert!(rows.len() == followed.len() && rows.iter().all(|param| followed.contains(param)), "{rows:?}");
    }
}
