//! The knobs as the host and the engine see them.

use super::*;
use nice_plug_core::params::InternalParamMut;
use sprung::params::{Change, Param as Row, Unit};

#[test]
fn the_host_sees_the_table() {
    let params = SprungParams::default();
    assert_eq!((params.knobs().len(), params.param_map().len()), (PARAM_COUNT, PARAM_COUNT));
    for ((info, knob), (id, _, section)) in PARAMS.iter().zip(params.knobs()).zip(params.param_map()) {
        assert_eq!((id.as_str(), section.as_str()), (info.id, info.section));
        let (name, steps, modulated) = match knob {
            Knob::Continuous(knob) => (knob.name(), knob.step_count(), knob.poly_modulation_id()),
            Knob::Stepped(knob) => (knob.name(), knob.step_count(), knob.poly_modulation_id()),
        };
        assert_eq!(name, info.name);
        let stepped = matches!(info.unit, Unit::Count | Unit::Choice);
        assert_eq!(steps, stepped.then_some((info.max - info.min) as usize), "{id}");
        let smoothed = matches!(info.change, Change::Smoothed(_));
        assert_eq!(modulated, smoothed.then_some(info.param as u32), "{id}");
        assert_eq!(knob.position(), info.normalise(info.default) as f32, "{id}");
    }
}

#[test]
fn a_knob_is_turned_whatever_modulates_it() {
    let params = SprungParams::default();
    for row in [Row::Gain, Row::VibratoSync] {
        let knob = &params.knobs()[row as usize];
        for (offset, position) in [(1.0, 1.0), (1.0, 0.0), (-1.0, 1.0), (0.5, 0.0), (0.0, 1.0)] {
            // SAFETY: as the wrapper does while a host modulates.
            unsafe {
                match knob {
                    Knob::Continuous(knob) => knob._internal_modulate_value(offset),
                    Knob::Stepped(knob) => knob._internal_modulate_value(offset),
                }
            };
            knob.turn(position);
            assert_eq!(knob.position(), position, "{row:?} modulated by {offset}");
        }
    }
}

#[test]
fn text_is_read_and_written_as_everywhere() {
    let params = SprungParams::default();
    for (row, text, shown) in [
        (Row::Decay, "250 ms", "250 ms"),
        (Row::Decay, "1.5", "1.5 s"),
        (Row::Tuning, "A4", "440 Hz"),
        (Row::Gain, "-12 dB", "-12 dB"),
        (Row::MalletPulse, "Contact", "contact"),
        (Row::Voices, "8", "8"),
    ] {
        let position = match &params.knobs()[row as usize] {
            Knob::Continuous(knob) => knob.string_to_normalized_value(text).unwrap(),
            Knob::Stepped(knob) => knob.string_to_normalized_value(text).unwrap(),
        };
        let written = match &params.knobs()[row as usize] {
            Knob::Continuous(knob) => knob.normalized_value_to_string(position, true),
            Knob::Stepped(knob) => knob.normalized_value_to_string(position, true),
        };
        assert_eq!(written, shown, "{text}");
        params.knobs()[row as usize].turn(position);
        assert_eq!(params.state().values.get(row), row.info().parse(text).unwrap(), "{text}");
    }
    let Knob::Continuous(gain) = &params.knobs()[Row::Gain as usize] else { panic!("gain is continuous") };
    assert_eq!(gain.string_to_normalized_value("loud"), None);
    assert_eq!(gain.string_to_normalized_value("99 dB"), None);
}
