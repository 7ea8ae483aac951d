//! Parameter rows of the exciters, which all act together, and of the variation between strikes.

macro_rules! exciter {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Mallet" {
        MalletLevel "mallet_level" "Mallet level", Decibels -60.0..24.0 = 0.0, Linear, NextNote, [],
            "Strength of the mallet's strike; at -60 dB there is none.";
        MalletPulse "mallet_pulse" "Mallet pulse", Choice 0.0..1.0 = 0.0, Linear, NextNote, [MalletPulse],
            "The mallet's force: all of it in one sample, or over the time of its contact.";
        MalletHardness "mallet_hardness" "Mallet hardness", Percent 0.0..100.0 = 70.0, Linear, NextNote, [],
            "Contact time from 10 ms (0 %) to 0.05 ms (100 %).";
        MalletMass "mallet_mass" "Mallet mass", Number 0.1..10.0 = 1.0, Logarithmic, NextNote, [],
            "Contact lasts longer with a heavier mallet: by its power of 2/5, as Hertz's law has it.";
        MalletSpeed "mallet_speed" "Mallet speed", Percent 0.0..100.0 = 0.0, Linear, NextNote, [],
            "How much harder strikes shorten contact: at 100 %, by their force to the power of -1/5 (Hertz).";
        MalletKey "mallet_key" "Mallet by key", Percent 0.0..100.0 = 0.0, Linear, NextNote, [],
            "Limits contact to one period of the note, so that high keys keep their loudness.";
        MalletVelocity "mallet_velocity" "Mallet velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote, [],
            "Added to how much velocity sets the force, for the mallet alone.";
    }
    "Pluck" {
        PluckLevel "pluck_level" "Pluck level", Decibels -60.0..24.0 = -60.0, Linear, NextNote, [],
            "Strength of the pluck, a displacement that is let go; at -60 dB there is none.";
        PluckHardness "pluck_hardness" "Pluck hardness", Percent 0.0..100.0 = 70.0, Linear, NextNote, [],
            "From a soft finger, which lets go within 10 ms (0 %), to a hard plectrum: 0.05 ms (100 %).";
        PluckPosition "pluck_position" "Pluck position", Percent 1.0..50.0 = 50.0, Linear, NextNote, [],
            "Where along the string it is plucked; 50 % is the middle and silences even harmonics.";
        PluckWidth "pluck_width" "Pluck width", Percent 0.0..20.0 = 0.0, Linear, NextNote, [],
            "How much of the string's length the finger covers: waves shorter than that are moved little.";
        PluckVelocity "pluck_velocity" "Pluck velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote, [],
            "Added to how much velocity sets the force, for the pluck alone.";
    }
    "Noise" {
        NoiseLevel "noise_level" "Noise level", Decibels -60.0..24.0 = 0.0, Linear, NextNote, [],
            "Strength of the noise burst against a strike of the same velocity; at -60 dB there is none.";
        NoiseReach "noise_reach" "Noise reach", Percent 0.0..100.0 = 0.0, Linear, NextNote, [],
            "Which modes noise moves: at 0 %, each by the share that the mallet does not have; at 100 %, all alike.";
        NoiseTime "noise_time" "Noise time", Seconds 0.001..1.0 = 0.02, Logarithmic, NextNote, [],
            "Time in which the noise burst falls.";
        NoiseDecay "noise_decay" "Noise decay", Choice 0.0..1.0 = 0.0, Linear, NextNote, [NoiseDecay],
            "Shape of the fall: quadratic is silent after the noise time, exponential has fallen by 60 dB then.";
        NoiseAttack "noise_attack" "Noise attack", Seconds 0.0..1.0 = 0.0, Linear, NextNote, [],
            "Time in which the noise burst rises before.";
        NoiseColour "noise_colour" "Noise colour", Percent -100.0..100.0 = 0.0, Linear, NextNote, [],
            "Filters the noise by an over-damped mass: a low-pass, down to 100 Hz at -100 %, or a high-pass, up to 16 kHz at 100 %.";
        NoiseHits "noise_hits" "Noise hits", Count 1.0..16.0 = 1.0, Linear, NextNote, [],
            "How many bursts follow each other, as in a clap or a flam; together they have the energy of one.";
        NoiseSpacing "noise_spacing" "Noise spacing", Seconds 0.002..0.5 = 0.012, Logarithmic, NextNote, [],
            "Time from each of these bursts to the next, which cuts it off.";
        NoiseVelocity "noise_velocity" "Noise velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote, [],
            "Added to how much velocity sets the force, for the noise alone.";
    }
    "Bow" {
        BowLevel "bow_level" "Bow level", Decibels -60.0..24.0 = -60.0, Linear, Smoothed(20), [],
            "Speed of a bow that moves the lowest 64 modes while the key is held; at -60 dB there is none.";
        BowForce "bow_force" "Bow force", Percent 0.0..100.0 = 50.0, Linear, Smoothed(20), [],
            "Pressure of the bow: little starts slowly and softly, much starts at once, louder and rougher.";
        BowPosition "bow_position" "Bow position", Percent 1.0..50.0 = 12.0, Linear, NextNote, [],
            "Where along the string it is bowed.";
        BowSlip "bow_slip" "Bow slip", Percent 1.0..100.0 = 20.0, Linear, NextNote, [],
            "How gradually friction falls as the bow slips: low is sharp, high is smooth.";
        BowVelocity "bow_velocity" "Bow velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote, [],
            "Added to how much velocity sets the speed, for the bow alone.";
    }
    "Input" {
        InputLevel "input_level" "Input level", Decibels -60.0..24.0 = -60.0, Linear, Smoothed(20), [],
            "Force of what comes in as sound on the modes of notes whose keys are held; at -60 dB there is none.";
    }
    "Strike" {
        Velocity "velocity" "Velocity to force", Percent 0.0..100.0 = 100.0, Linear, NextNote, [],
            "How much velocity sets the force of all exciters: 100 % is the square of velocity, 0 % is full force always.";
        VaryPosition "vary_position" "Vary position", Percent 0.0..10.0 = 0.0, Linear, NextNote, [],
            "How far from its place each strike and pluck falls at most, by chance, as a share of the length.";
        VaryHardness "vary_hardness" "Vary hardness", Percent 0.0..50.0 = 0.0, Linear, NextNote, [],
            "How much harder or softer each strike and pluck is at most, by chance.";
        VaryModes "vary_modes" "Vary modes", Decibels 0.0..12.0 = 0.0, Linear, NextNote, [],
            "How much louder or softer each strike leaves each mode at most, by chance.";
    }
        } $($rest)* }
    };
}

pub(super) use exciter;
