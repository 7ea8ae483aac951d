//! Parameter offsets that a host sets, for the whole instrument and for single notes.

use crate::dsp::ramp::Ramp;
use crate::params::{Change, PARAM_COUNT, PARAMS, Param, Values};

/// The value of a parameter, moved by an offset in knob travel.
pub(crate) fn modulated(values: &Values, param: Param, offset: f32) -> f32 {
    param.info().moved(values.get(param), offset)
}

/// Number of parameters that sounding notes follow.
const FOLLOWED: usize = {
    let (mut index, mut count) = (0, 0);
    while index < PARAM_COUNT {
        count += matches!(PARAMS[index].change, Change::Smoothed(_)) as usize;
        index += 1;
    }
    count
};

/// The parameter offsets of one note, and the smoothed values that result. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoteModulation {
    moved: [Option<Moved>; FOLLOWED],
}

#[derive(Clone, Copy, Debug)]
struct Moved {
    param: Param,
    /// False once the note follows the instrument's value again. This is a separate field because an `Option` of the offset
    /// would make the struct a fifth larger, and every voice has room for all parameters.
    has_offset: bool,
    offset: f32,
    value: Ramp,
}

impl NoteModulation {
    /// A note without offsets.
    pub(crate) const NONE: Self = Self { moved: [None; FOLLOWED] };

    /// Whether no offset was ever set for the note.
    pub(crate) fn is_none(&self) -> bool {
        self.moved[0].is_none()
    }

    /// Sets the offset of a parameter that sounding notes follow. `from` is its value now.
    pub(crate) fn set(&mut self, param: Param, offset: f32, from: f32) {
        let is_free = |moved: &Option<Moved>| moved.is_none_or(|moved| moved.param == param);
        if let Some(slot) = self.moved.iter_mut().find(|moved| is_free(moved)) {
            let value = slot.map_or(Ramp::at_rest(from), |moved| moved.value);
            *slot = Some(Moved { param, has_offset: true, offset, value });
        }
    }

    /// Drops all offsets: after the next [`NoteModulation::aim`] the note follows the instrument.
    pub(crate) fn let_go(&mut self) {
        self.moved.iter_mut().flatten().for_each(|moved| moved.has_offset = false);
    }

    /// Starts a ramp to the target of each parameter that has or had an offset: the instrument's `value` plus the offset,
    /// or, if the offset was dropped, the value in `played`, with the instrument's own modulation. With `at_once`, for a
    /// note that has not sounded yet, the value jumps.
    pub(crate) fn aim(
        &mut self,
        value: impl Fn(Param) -> f32,
        played: impl Fn(Param) -> f32,
        sample_rate: f64,
        at_once: bool,
    ) {
        for moved in self.moved.iter_mut().flatten() {
            let target = match moved.has_offset {
                true => moved.param.info().moved(value(moved.param), moved.offset),
                false => played(moved.param),
            };
            if at_once {
                moved.value = Ramp::at_rest(target);
            } else if moved.value.after(u32::MAX) != target {
                moved.value.set(target, moved.param.info().smoothing_frames(sample_rate).unwrap_or(0));
            }
        }
    }

    /// The value of a parameter `frames` frames from now; none if the note never had an offset for it.
    pub(crate) fn after(&self, param: Param, frames: u32) -> Option<f32> {
        self.moved.iter().flatten().find(|moved| moved.param == param).map(|moved| moved.value.after(frames))
    }

    /// Calls `tell` with each parameter that has an offset, and its value now.
    pub(crate) fn each_value(&self, mut tell: impl FnMut(Param, f32)) {
        let moved = self.moved.iter().map_while(Option::as_ref).filter(|moved| moved.has_offset);
        moved.for_each(|moved| tell(moved.param, moved.value.after(0)));
    }

    /// Advances the ramps by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.moved.iter_mut().map_while(Option::as_mut).for_each(|moved| moved.value.advance(frames));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;

    #[test]
    fn an_offset_is_knob_travel_from_the_value_and_ends_at_the_range() {
        let patch = Patch::default().with(Param::Gain, -24.0).with(Param::Decay, 0.6);
        for (param, offset, expected) in [
            (Param::Gain, 0.25, -6.0),
            (Param::Gain, 1.0, 12.0),
            (Param::Gain, 0.0, -24.0),
            (Param::Decay, -1.0, 0.005),
            (Param::Mode, 0.5, 1.0),
        ] {
            assert_eq!(modulated(&patch.values, param, offset), expected, "{param:?} {offset}");
        }
    }

    #[test]
    fn a_note_slides_to_its_own_value_and_follows_the_patch_from_there() {
        let mut patch = Patch::default().with(Param::Gain, -24.0);
        let mut note = NoteModulation::NONE;
        assert!(note.is_none());
        note.set(Param::Gain, 0.25, -24.0);
        note.aim(|param| patch.get(param), |param| patch.get(param), 48_000.0, false);
        assert_eq!((note.after(Param::Gain, 480), note.after(Param::Pan, 480)), (Some(-15.0), None));
        note.advance(960);
        assert_eq!(note.after(Param::Gain, 0), Some(-6.0));
        patch.set(Param::Gain, -42.0);
        note.aim(|param| patch.get(param), |param| patch.get(param), 48_000.0, true);
        assert_eq!(note.after(Param::Gain, 0), Some(-24.0));
        note.let_go();
        note.aim(|param| patch.get(param), |param| param.info().default, 48_000.0, true);
        assert_eq!(note.after(Param::Gain, 0), Some(Param::Gain.info().default));
    }

    #[test]
    fn there_is_room_for_every_parameter_that_notes_follow() {
        let mut note = NoteModulation::NONE;
        let followed = PARAMS.iter().filter(|info| matches!(info.change, Change::Smoothed(_)));
        for info in followed.clone() {
            note.set(info.param, 0.1, 0.0);
            note.set(info.param, 0.2, 0.0);
        }
        assert!(followed.clone().all(|info| note.after(info.param, 0) == Some(0.0)));
    }
}
