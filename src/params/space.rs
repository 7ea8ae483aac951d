//! Parameter rows of the effects behind the voices, in the order of the signal path.

macro_rules! space {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Strings" {
        StringsLevel "strings_level" "Strings", Percent 0.0..100.0 = 0.0, Linear, AtOnce, [],
            "How loudly sympathetic strings ring along with what is played.";
        StringsTuning "strings_tuning" "Strings tuning", Choice 0.0..3.0 = 0.0, Linear, AtOnce, [StringsTuning],
            "What the strings are tuned to: all keys of two octaves, or a chord.";
        StringsTune "strings_tune" "Strings tune", Semitones -24.0..24.0 = 0.0, Linear, AtOnce, [],
            "Tunes all strings higher or lower; the lowest is C2 at 0 st.";
        StringsLowDecay "strings_low_decay" "Strings low decay", Seconds 0.05..30.0 = 6.0, Logarithmic, AtOnce, [],
            "T60 of the strings up to 200 Hz.";
        StringsHighDecay "strings_high_decay" "Strings high decay", Seconds 0.05..30.0 = 2.0, Logarithmic, AtOnce, [],
            "T60 of the strings from 6.4 kHz on.";
    }
    "Tremolo" {
        TremoloDepth "tremolo_depth" "Tremolo depth", Percent 0.0..100.0 = 0.0, Linear, AtOnce, [],
            "How far a motor takes the loudness down and up again; 100 % is down to silence.";
        TremoloRate "tremolo_rate" "Tremolo rate", Hertz 0.1..20.0 = 5.0, Logarithmic, AtOnce, [],
            "How often it does so in a second.";
        TremoloStereo "tremolo_stereo" "Tremolo stereo", Percent 0.0..100.0 = 0.0, Linear, AtOnce, [],
            "How far the right side is ahead; at 100 % the sides go up and down in turn.";
    }
    "Drive" {
        Drive "drive" "Drive", Decibels 0.0..36.0 = 0.0, Linear, AtOnce, [],
            "Lifts what is soft by so much and holds what is loud: full scale stays full scale.";
    }
    "Tone" {
        ToneLow "tone_low" "Tone low", Decibels -18.0..18.0 = 0.0, Linear, AtOnce, [],
            "Gain below 250 Hz.";
        ToneHigh "tone_high" "Tone high", Decibels -18.0..18.0 = 0.0, Linear, AtOnce, [],
            "Gain above 3.5 kHz.";
    }
    "Space" {
        Space "space" "Space", Choice 0.0..3.0 = 0.0, Linear, AtOnce, [Space],
            "The body that reverberates, every mode of it a mass: none, a sheet of metal, a spring tank, or a small room.";
        SpaceSize "space_size" "Space size", Percent 25.0..200.0 = 100.0, Logarithmic, AtOnce, [],
            "Size against a plate of 2 m × 1 m, a guitar amplifier’s tank, or a drum booth of 3 m.";
        SpaceMaterial "space_material" "Space material", Choice 0.0..4.0 = 0.0, Linear, AtOnce, [SpaceMaterial],
            "What the plate or the springs are made of: sets the speed of waves in it.";
        SpaceLowDecay "space_low_decay" "Space low decay", Seconds 0.05..30.0 = 3.0, Logarithmic, AtOnce, [],
            "T60 of the space up to 200 Hz.";
        SpaceHighDecay "space_high_decay" "Space high decay", Seconds 0.05..30.0 = 1.0, Logarithmic, AtOnce, [],
            "T60 of the space from 6.4 kHz on.";
        SpacePreDelay "space_pre_delay" "Space pre-delay", Seconds 0.0..0.25 = 0.0, Linear, AtOnce, [],
            "Time before the space hears what is played.";
        SpaceMix "space_mix" "Space mix", Percent 0.0..100.0 = 25.0, Linear, AtOnce, [],
            "From what is played (0 %) to what the space makes of it (100 %), at equal power.";
        StereoWidth "stereo_width" "Stereo width", Percent 0.0..200.0 = 100.0, Linear, AtOnce, [],
            "How wide the stereo image of it all is: 0 % is mono, 200 % the widest.";
    }
        } $($rest)* }
    };
}

pub(super) use space;
