//! Tests of the parameter table: ids, rows, and the conversion of values to texts and knob positions and back.

use super::*;
use proptest::prelude::*;

/// Saved presets contain these ids: they may be added to this list, but never removed.
#[test]
fn ids_are_pinned() {
    let ids: Vec<_> = PARAMS.iter().map(|info| info.id).collect();
    let pinned = "mallet_level mallet_pulse mallet_hardness mallet_mass mallet_speed mallet_key mallet_velocity \
        pluck_level pluck_hardness pluck_position pluck_width pluck_velocity \
        noise_level noise_reach noise_time noise_decay noise_attack noise_colour noise_hits noise_spacing noise_held noise_velocity \
        bow_level bow_force bow_position bow_slip bow_velocity \
        breath_level breath_pressure breath_valve breath_opening breath_lip breath_noise breath_steepening breath_attack breath_tongue \
        rattle rattle_gap rattle_mass rattle_rate rattle_hardness rattle_position \
        input_level \
        velocity vary_position vary_hardness vary_modes \
        decay release damper note_off decay_tilt tilt colour stretch width coefficients \
        tension bloom bloom_time drift_level drift_pitch drift_rate touch touch_position \
        tune fine tuning key_track sweep sweep_time sweep_curve \
        vibrato vibrato_rate vibrato_delay vibrato_sync glide glide_when glide_by \
        bend_range \
        lfo1_rate lfo1_sync lfo1_shape lfo1_phase lfo1_fade lfo1_scope \
        lfo2_rate lfo2_sync lfo2_shape lfo2_phase lfo2_fade lfo2_scope \
        lfo3_rate lfo3_sync lfo3_shape lfo3_phase lfo3_fade lfo3_scope \
        envelope1_delay envelope1_attack envelope1_hold envelope1_decay envelope1_sustain envelope1_release \
        envelope1_curve \
        envelope2_delay envelope2_attack envelope2_hold envelope2_decay envelope2_sustain envelope2_release \
        envelope2_curve \
        macro1 macro2 macro3 macro4 macro5 macro6 macro7 macro8 \
        route1 route2 route3 route4 route5 route6 route7 route8 \
        route9 route10 route11 route12 route13 route14 route15 route16 \
        voices mode priority unison unison_detune unison_spread unison_phase choke \
        soundbox soundbox_size soundbox_vowel soundbox_mix \
        strings_level strings_tuning strings_tune strings_low_decay strings_high_decay \
        tremolo_depth tremolo_rate tremolo_stereo drive tone_low tone_high \
        space space_size space_material space_low_decay space_high_decay space_pre_delay space_mix stereo_width \
        gain pan limiter";
    assert_eq!(ids, pinned.split_whitespace().collect::<Vec<_>>());
}

#[test]
fn the_table_is_consistent() {
    for (index, info) in PARAMS.iter().enumerate() {
        assert_eq!(info.param as usize, index, "{}", info.id);
        assert_eq!(Param::from_id(info.id), Some(info.param));
        assert!(info.min < info.max && (info.min..=info.max).contains(&info.default), "{}", info.id);
        assert!(info.curve == Curve::Linear || info.min > 0.0, "{}", info.id);
        assert_eq!(info.unit == Unit::Choice, !info.choices.is_empty(), "{}", info.id);
        if info.unit == Unit::Choice {
            assert_eq!((info.min, info.max as usize + 1), (0.0, info.choices.len()), "{}", info.id);
        }
    }
    assert_eq!(PARAMS.len(), PARAM_COUNT);
}

proptest! {
    #[test]
    fn text_and_knob_go_both_ways(index in 0..PARAM_COUNT, position in 0.0..=1.0f64) {
        let info = &PARAMS[index];
        let value = info.denormalise(position);
        prop_assert!(info.check(value).is_ok());
        let text = info.format(value);
        let read = info.parse(&text).map_err(TestCaseError::fail)?;
        prop_assert_eq!(info.format(read), text);
        let single = info.normalise(value) as f32;
        prop_assert_eq!(info.denormalise(single.into()), value, "{} through {}", info.id, single);
    }
}
