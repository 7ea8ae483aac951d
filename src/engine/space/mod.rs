//! The effects after the voices of a synth: soundbox, strings, tremolo, drive, tone, space and width, in series.
//!
//! A section that is off does not change the signal. A section that is on becomes idle when its content is below −120 dBFS and
//! its input is silent. [`Space::skip`] then advances what has a clock, with the same result as silent input. So the output
//! does not depend on the block size, nor on the frame at which the silence is detected.
//!
//! Room for bodies is made outside the audio thread, 4 MB per synth, of which a plate at rest uses 1 MB (20 KB for a soundbox): by
//! `Synth::reserve_space`, or when a kit with a body is set. Without room, bodies stay off. An ensemble makes room for each channel that starts with a body, and for
//! all channels if one of its programs has a body. Each channel has its own effects, so sixteen channels with a plate
//! take the time of sixteen plates.
//!
//! While an effect sleeps and no voice sounds, the motor of the tremolo continues. Settings move in 20 ms; while nothing
//! sounds, they apply at once. Level and pan of the voices come before the effects, so the
//! drive depends on `gain`. Tails are computed from effect to effect: while voices sound, the magnitudes of what they
//! still send add up to at most their peak times the frames that they have left. The computed tail is an upper bound,
//! and can be some T60s too long. Tests: `tests/engine/space/` for each effect, `tests/engine/behind_voices.rs` for synths and
//! ensembles, with every parameter changed during sound and during silence.

mod bodies;
mod resonant;
mod tail;

use crate::dsp::space::{BoxBody, Overdrive, Soundbox, Tone, Tremolo, Width};
use crate::params::{self, Param, Values};
use crate::patch::routes::Route;
use crate::sound::Kit;
use resonant::Resonant;

/// The effects after the voices. Real-time safe once made, except for [`Space::reserve`].
pub(crate) struct Space {
    sample_rate: f64,
    /// None until room for it is reserved.
    soundbox: Option<Box<Soundbox>>,
    /// Strings and space; none until room for them is reserved.
    resonant: Option<Box<Resonant>>,
    tremolo: Tremolo,
    drive: Overdrive,
    tone: Tone,
    width: Width,
    /// Whether any section changes or may change the signal.
    is_on: bool,
    /// Whether any section still sounds or is still moving to another setting.
    is_awake: bool,
    /// The parameters that the sections have; none for sections that were made just now.
    values: Option<Values>,
}

/// The sections, in the order of the signal.
#[derive(Clone, Copy)]
enum Section {
    Soundbox,
    Strings,
    Tremolo,
    Drive,
    Tone,
    Reverb,
    Width,
}

/// The parameters of each section: what switches it on comes last, so that all else is already set.
const SECTIONS: [(Section, &[Param]); 7] = [
    (Section::Soundbox, &[Param::SoundboxSize, Param::SoundboxVowel, Param::Soundbox, Param::SoundboxMix]),
    (
        Section::Strings,
        &[
            Param::StringsTuning,
            Param::StringsTune,
            Param::StringsLowDecay,
            Param::StringsHighDecay,
            Param::StringsLevel,
        ],
    ),
    (Section::Tremolo, &[Param::TremoloRate, Param::TremoloStereo, Param::TremoloDepth]),
    (Section::Drive, &[Param::Drive]),
    (Section::Tone, &[Param::ToneLow, Param::ToneHigh]),
    (
        Section::Reverb,
        &[
            Param::SpaceLowDecay,
            Param::SpaceHighDecay,
            Param::SpacePreDelay,
            Param::Space,
            Param::SpaceSize,
            Param::SpaceMaterial,
            Param::SpaceMix,
        ],
    ),
    (Section::Width, &[Param::StereoWidth]),
];

/// Whether these values need room for bodies. Real-time safe.
pub(crate) fn needs_bodies(values: &Values) -> bool {
    values.choice::<params::Space>(Param::Space) != params::Space::None || values.get(Param::StringsLevel) > 0.0
}

impl Space {
    /// All sections off, without room for bodies.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            soundbox: None,
            resonant: None,
            tremolo: Tremolo::new(sample_rate),
            drive: Overdrive::new(sample_rate),
            tone: Tone::new(sample_rate),
            width: Width::new(sample_rate),
            is_on: false,
            is_awake: false,
            values: None,
        }
    }

    /// Another with the same room, at another sample rate. Allocates.
    pub(crate) fn at_rate(&self, sample_rate: f64) -> Self {
        let mut other = Self::new(sample_rate);
        if self.soundbox.is_some() {
            other.reserve_soundbox();
        }
        if self.resonant.is_some() {
            other.reserve();
        }
        other
    }

    /// Makes room for what a kit has: a soundbox, strings and a space, from the start or when a route brings in the strings. Follow
    /// with [`Space::set`]. Allocates if it makes room.
    pub(crate) fn reserve_for(&mut self, kit: &Kit) {
        let is_to_strings = |(_, route): (usize, Route)| route.destination == Param::StringsLevel;
        let routes = kit.sounds().iter().map(|sound| &sound.patch().routes);
        if needs_bodies(kit.values()) || routes.into_iter().any(|routes| routes.iter().any(is_to_strings)) {
            self.reserve();
        } else if kit.values().choice::<params::Soundbox>(Param::Soundbox) != params::Soundbox::None {
            self.reserve_soundbox();
        }
    }

    fn reserve_soundbox(&mut self) {
        if self.soundbox.is_none() {
            (self.soundbox, self.values) = (Some(Box::new(Soundbox::new(self.sample_rate))), None);
        }
    }

    /// Makes room for any body, if there is none. Follow with [`Space::set`]. Allocates.
    pub(crate) fn reserve(&mut self) {
        self.reserve_soundbox();
        if self.resonant.is_none() {
            (self.resonant, self.values) = (Some(Box::new(Resonant::new(self.sample_rate))), None);
        }
    }

    /// Applies the parameters that have changed: within 20 ms, or `at_once`, which is meant for when neither the voices nor the
    /// effects sound.
    pub(crate) fn set(&mut self, values: &Values, at_once: bool) {
        let known = self.values.replace(*values);
        let has_changed = |param: &&Param| known.is_none_or(|known| known.get(**param) != values.get(**param));
        for (section, params) in SECTIONS {
            let mut changed = params.iter().filter(has_changed).peekable();
            if changed.peek().is_some() {
                changed.for_each(|param| self.follow(*param, values));
                if at_once {
                    self.reset_section(section);
                }
            }
        }
        self.look();
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
            Param::Soundbox | Param::SoundboxSize | Param::SoundboxVowel | Param::SoundboxMix => {
                if let Some(soundbox) = &mut self.soundbox {
                    follow_soundbox(soundbox, param, values);
                }
            }
            _ => {
                if let Some(resonant) = &mut self.resonant {
                    resonant.follow(param, values);
                }
            }
        }
    }

    /// Silences all sections and sets all smoothed values to their targets.
    pub(crate) fn reset(&mut self) {
        SECTIONS.into_iter().for_each(|(section, _)| self.reset_section(section));
        self.look();
    }

    fn reset_section(&mut self, section: Section) {
        let (soundbox, resonant) = (self.soundbox.as_mut(), self.resonant.as_mut());
        match section {
            Section::Soundbox => soundbox.into_iter().for_each(|soundbox| soundbox.reset()),
            Section::Strings => resonant.into_iter().for_each(|resonant| resonant.strings.reset()),
            Section::Tremolo => self.tremolo.reset(),
            Section::Drive => self.drive.reset(),
            Section::Tone => self.tone.reset(),
            Section::Reverb => resonant.into_iter().for_each(|resonant| resonant.reverb.reset()),
            Section::Width => self.width.reset(),
        }
    }

    /// Updates `is_on` and `is_awake`.
    fn look(&mut self) {
        let Self { tremolo, drive, tone, width, .. } = self;
        let (mut off, mut idle) = (true, true);
        if let Some(soundbox) = &self.soundbox {
            (off, idle) = (soundbox.is_off(), soundbox.is_idle());
        }
        if let Some(Resonant { strings, reverb, .. }) = self.resonant.as_deref() {
            off &= strings.is_off() && reverb.is_off();
            idle &= strings.is_idle() && reverb.is_idle();
        }
        self.is_on = !(off && tremolo.is_off() && drive.is_off() && tone.is_off() && width.is_off());
        self.is_awake =
            self.is_on && !(idle && tremolo.is_idle() && drive.is_idle() && tone.is_idle() && width.is_idle());
    }

    /// Whether any section changes or may change the signal.
    pub(crate) fn is_on(&self) -> bool {
        self.is_on
    }

    /// Whether any section still sounds or is still moving to another setting.
    pub(crate) fn is_awake(&self) -> bool {
        self.is_awake
    }

    /// Processes the voices' output through all sections, in place. Returns whether any section is on.
    pub(crate) fn process(&mut self, left: &mut [f32], right: &mut [f32]) -> bool {
        if !self.is_on {
            return false;
        }
        if let Some(soundbox) = &mut self.soundbox {
            soundbox.process(left, right);
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

    /// Advances by silent frames, while the effects are not awake.
    pub(crate) fn skip(&mut self, frames: usize) {
        if !self.is_on {
            return;
        }
        self.tremolo.skip(frames);
        self.tone.skip(frames);
        if let Some(Resonant { strings, reverb, .. }) = self.resonant.as_deref_mut() {
            strings.skip(frames);
            reverb.skip(frames);
        }
    }
}

fn follow_soundbox(soundbox: &mut Soundbox, param: Param, values: &Values) {
    let share = |param| 0.01 * values.get(param);
    match param {
        Param::SoundboxSize => soundbox.set_size(share(param).into()),
        Param::SoundboxVowel => soundbox.set_vowel(share(param)),
        _ => {
            let body = body(values.choice(Param::Soundbox));
            body.into_iter().for_each(|body| soundbox.set_body(body));
            soundbox.set_mix(body.map_or(0.0, |_| share(Param::SoundboxMix)));
        }
    }
}

/// The body of a soundbox.
pub(super) fn body(soundbox: params::Soundbox) -> Option<&'static BoxBody> {
    match soundbox {
        params::Soundbox::None => None,
        params::Soundbox::Violin => Some(BoxBody::violin()),
        params::Soundbox::Guitar => Some(BoxBody::guitar()),
        params::Soundbox::Soundboard => Some(BoxBody::soundboard()),
        params::Soundbox::Voice => Some(BoxBody::voice()),
        params::Soundbox::Horn => Some(BoxBody::horn()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::PARAMS;

    #[test]
    fn all_that_is_behind_voices_is_followed() {
        let mut rows: Vec<Param> =
            PARAMS.iter().map(|info| info.param).filter(|param| param.is_behind_voices()).collect();
        let mut followed = SECTIONS.map(|(_, params)| params).concat();
        rows.sort_by_key(|param| *param as usize);
        followed.sort_by_key(|param| *param as usize);
        assert_eq!(rows, followed);
    }
}
