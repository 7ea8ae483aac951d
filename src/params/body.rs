//! Parameter rows of the body: tuning, levels and decay of its modes.

macro_rules! body {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Body" {
        Decay "decay" "Decay", Seconds 0.005..60.0 = 1.0, Logarithmic, Smoothed(20), [],
            "Time in which a held note falls by 60 dB (T60).";
        Release "release" "Release", Seconds 0.005..60.0 = 0.3, Logarithmic, Smoothed(20), [],
            "Longest T60 once the note is released; modes that decay faster do not change.";
        Damper "damper" "Damper", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the release damping acts while the note is held.";
        NoteOff "note_off" "Note off", Choice 0.0..1.0 = 0.0, Linear, NextNote, [NoteOff],
            "Whether a released note is damped or rings on as a drum does.";
        DecayTilt "decay_tilt" "Decay by mode", Number 0.0..2.0 = 0.0, Linear, Smoothed(20), [],
            "How higher modes decay faster: the T60 of a mode is divided by its ratio to this power.";
        Tilt "tilt" "Brightness", DecibelsPerOctave -24.0..24.0 = 0.0, Linear, NextNote, [],
            "Tilts the levels of the modes by their ratio.";
        Stretch "stretch" "Stretch", Number 0.5..2.0 = 1.0, Linear, NextNote, [],
            "Raises the ratios of the modes to this power: spreads or squeezes the spectrum.";
        Width "width" "Width", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How far apart the modes are panned.";
        Coefficients "coefficients" "Coefficients", Choice 0.0..1.0 = 0.0, Linear, NextNote, [Coefficients],
            "Exact tuning and decay, or the original formulas with their drift, clamped short of exploding.";
        Tension "tension" "Tension", Semitones 0.0..24.0 = 0.0, Linear, Smoothed(20), [],
            "How far a full strike stretches head or string: the pitch rises by this much, and falls as the sound decays.";
        Bloom "bloom" "Bloom", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How much of its energy a loud sound passes on from each half octave to the next, as gongs and cymbals do.";
        BloomTime "bloom_time" "Bloom time", Seconds 0.05..10.0 = 0.5, Logarithmic, Smoothed(20), [],
            "Time in which the energy of a full strike climbs to the high modes.";
        Touch "touch" "Touch", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How firmly a finger touches the sounding body: it damps each mode by how far that moves there.";
        TouchPosition "touch_position" "Touch position", Percent 0.0..100.0 = 50.0, Linear, Smoothed(20), [],
            "Where the finger touches, in per cent of the body's length.";
    }
        } $($rest)* }
    };
}

pub(super) use body;
