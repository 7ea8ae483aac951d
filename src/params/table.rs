//! The parameter table: one row for each parameter, in the order of the signal.

use super::{Change::*, *};

/// Makes [`Param`] and [`PARAMS`] of the table below. A row reads: variant, id, name; unit, with its list of choices,
/// range, default; curve; when a change takes effect; `fixed` if routes cannot modulate it although it is a quantity;
/// help.
macro_rules! table {
    ($($section:literal {
        $($param:ident $id:literal $name:literal,
          $unit:ident$([$choices:ident])? $min:literal..$max:literal = $default:literal,
          $curve:ident, $change:expr, $($fixed:ident,)? $help:literal;)*
    })*) => {
        /// A parameter, in table order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Param {
            $($(#[doc = $help] $param,)*)*
        }

        /// The parameter table, indexed by `Param as usize`.
        pub static PARAMS: &[ParamInfo] = &[
            $($(ParamInfo {
                param: Param::$param, id: $id, name: $name, section: $section, unit: Unit::$unit,
                min: $min, max: $max, default: $default, curve: Curve::$curve, change: $change,
                is_fixed: !stringify!($($fixed)?).is_empty(), choices: [$($choices::NAMES,)? &[]][0], help: $help,
            },)*)*
        ];

        /// Number of parameters.
        pub const PARAM_COUNT: usize = [$($(Param::$param,)*)*].len();
    };
}

table! {
    "Mallet" {
        MalletLevel "mallet_level" "Mallet level", Decibels -60.0..24.0 = 0.0, Linear, NextNote,
            "Strength of the mallet's strike; at -60 dB there is none.";
        MalletPulse "mallet_pulse" "Mallet pulse", Choice[MalletPulse] 0.0..2.0 = 0.0, Linear, NextNote,
            "The mallet's force: all of it in one sample, over the time of its contact, or as the body pushes it back.";
        MalletHardness "mallet_hardness" "Mallet hardness", Percent 0.0..100.0 = 70.0, Linear, NextNote,
            "Contact time from 10 ms (0 %) to 0.05 ms (100 %).";
        MalletMass "mallet_mass" "Mallet mass", Number 0.1..10.0 = 1.0, Logarithmic, NextNote,
            "Contact lasts longer with a heavier mallet: by its power of 2/5, as Hertz's law has it.";
        MalletSpeed "mallet_speed" "Mallet speed", Percent 0.0..100.0 = 0.0, Linear, NextNote,
            "How much harder strikes shorten contact: at 100 %, by their force to the power of -1/5 (Hertz).";
        MalletKey "mallet_key" "Mallet by key", Percent 0.0..100.0 = 0.0, Linear, NextNote,
            "Limits contact to one period of the note, so that high keys keep their loudness.";
        MalletVelocity "mallet_velocity" "Mallet velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote,
            "Added to how much velocity sets the force, for the mallet alone.";
    }
    "Pluck" {
        PluckLevel "pluck_level" "Pluck level", Decibels -60.0..24.0 = -60.0, Linear, NextNote,
            "Strength of the pluck, a displacement that is let go; at -60 dB there is none.";
        PluckHardness "pluck_hardness" "Pluck hardness", Percent 0.0..100.0 = 70.0, Linear, NextNote,
            "From a soft finger, which lets go within 10 ms (0 %), to a hard plectrum: 0.05 ms (100 %).";
        PluckPosition "pluck_position" "Pluck position", Percent 1.0..50.0 = 50.0, Linear, NextNote,
            "Where along the string it is plucked; 50 % is the middle and silences even harmonics.";
        PluckWidth "pluck_width" "Pluck width", Percent 0.0..20.0 = 0.0, Linear, NextNote,
            "How much of the string's length the finger covers: waves shorter than that are moved little.";
        PluckVelocity "pluck_velocity" "Pluck velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote,
            "Added to how much velocity sets the force, for the pluck alone.";
    }
    "Noise" {
        NoiseLevel "noise_level" "Noise level", Decibels -60.0..24.0 = 0.0, Linear, NextNote,
            "Strength of the noise burst against a strike of the same velocity; at -60 dB there is none.";
        NoiseReach "noise_reach" "Noise reach", Percent 0.0..100.0 = 0.0, Linear, NextNote,
            "Which modes noise moves: at 0 %, each by the share that the mallet does not have; at 100 %, all alike.";
        NoiseTime "noise_time" "Noise time", Seconds 0.001..1.0 = 0.02, Logarithmic, NextNote,
            "Time in which the noise burst falls.";
        NoiseDecay "noise_decay" "Noise decay", Choice[NoiseDecay] 0.0..1.0 = 0.0, Linear, NextNote,
            "Shape of the fall: quadratic is silent after the noise time, exponential has fallen by 60 dB then.";
        NoiseAttack "noise_attack" "Noise attack", Seconds 0.0..1.0 = 0.0, Linear, NextNote,
            "Time in which the noise burst rises before.";
        NoiseColour "noise_colour" "Noise colour", Percent -100.0..100.0 = 0.0, Linear, NextNote,
            "Filters the noise by an over-damped mass: a low-pass, down to 100 Hz at -100 %, or a high-pass, up to 16 kHz at 100 %.";
        NoiseHits "noise_hits" "Noise hits", Count 1.0..16.0 = 1.0, Linear, NextNote,
            "How many bursts follow each other, as in a clap or a flam; together they have the energy of one.";
        NoiseSpacing "noise_spacing" "Noise spacing", Seconds 0.002..0.5 = 0.012, Logarithmic, NextNote,
            "Time from each of these bursts to the next, which cuts it off.";
        NoiseHeld "noise_held" "Noise held", Decibels -60.0..24.0 = -60.0, Linear, Smoothed(20),
            "Noise that goes on while the key is held, such as breath or bow hair, of the same colour; at -60 dB there is none.";
        NoiseVelocity "noise_velocity" "Noise velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote,
            "Added to how much velocity sets the force, for the noise alone.";
    }
    "Bow" {
        BowLevel "bow_level" "Bow level", Decibels -60.0..24.0 = -60.0, Linear, Smoothed(20),
            "Speed of a bow that moves the lowest 64 modes while the key is held; at -60 dB there is none.";
        BowForce "bow_force" "Bow force", Percent 0.0..100.0 = 50.0, Linear, Smoothed(20),
            "Pressure of the bow: little starts slowly and softly, much starts at once, louder and rougher.";
        BowPosition "bow_position" "Bow position", Percent 1.0..50.0 = 12.0, Linear, NextNote,
            "Where along the string it is bowed.";
        BowSlip "bow_slip" "Bow slip", Percent 1.0..100.0 = 20.0, Linear, NextNote,
            "How gradually friction falls as the bow slips: low is sharp, high is smooth.";
        BowVelocity "bow_velocity" "Bow velocity", Percent -100.0..100.0 = 0.0, Linear, NextNote,
            "Added to how much velocity sets the speed, for the bow alone.";
    }
    "Breath" {
        BreathLevel "breath_level" "Breath level", Decibels -60.0..24.0 = -60.0, Linear, NextNote,
            "Loudness of a tube that is blown while the key is held, its lowest 64 modes; at -60 dB there is no breath.";
        BreathPressure "breath_pressure" "Breath pressure", Percent 0.0..200.0 = 60.0, Linear, Smoothed(20),
            "Pressure in the mouth: 100 % would close a reed, which gives way before; too little does not speak, more is louder and brighter.";
        BreathValve "breath_valve" "Breath valve", Choice[Valve] 0.0..2.0 = 0.0, Linear, NextNote,
            "What the breath goes through: a reed, which it closes, lips, which it opens, or a flute's jet across an edge.";
        BreathOpening "breath_opening" "Breath opening", Percent 0.0..100.0 = 50.0, Linear, Smoothed(20),
            "How far reed or lips stand open at rest, or how thick the jet is: more air speaks sooner and is brighter.";
        BreathLip "breath_lip" "Breath lip", Semitones -12.0..12.0 = 0.0, Linear, Smoothed(20),
            "Tension of reed or lips, or how near the lips are to the edge: a little bends the pitch, much makes the note crack.";
        BreathNoise "breath_noise" "Breath noise", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Turbulence of the breath: wind that the tube colours.";
        BreathSteepening "breath_steepening" "Breath steepening", DecibelsPerOctave 0.0..12.0 = 0.0, Linear, Smoothed(20),
            "How much softer higher modes are heard for each halving of the pressure below 200 %: loud brass is bright.";
        BreathAttack "breath_attack" "Breath attack", Seconds 0.0..2.0 = 0.03, Linear, NextNote,
            "Time until the breath has its pressure.";
        BreathTongue "breath_tongue" "Breath tongue", Percent 0.0..100.0 = 25.0, Linear, NextNote,
            "How much more pressure the tongue lets go at the start, for a twentieth of a second.";
    }
    "Rattle" {
        Rattle "rattle" "Rattle", Choice[Rattle] 0.0..2.0 = 0.0, Linear, NextNote,
            "What the lowest 64 modes hit as they swing: nothing, an edge beside the body, or a loose mass that lies on it.";
        RattleGap "rattle_gap" "Rattle gap", Percent 0.0..100.0 = 3.0, Linear, NextNote,
            "Distance of the edge from the body at rest, as a share of its swing after a full strike.";
        RattleMass "rattle_mass" "Rattle mass", Number 0.01..10.0 = 0.1, Logarithmic, NextNote,
            "Weight of the loose mass, in the unit of the mallet's.";
        RattleRate "rattle_rate" "Rattle rate", Hertz 1.0..500.0 = 30.0, Logarithmic, NextNote,
            "How often the loose mass hits after a full strike: a tight spring brings it back soon.";
        RattleHardness "rattle_hardness" "Rattle hardness", Percent 0.0..100.0 = 80.0, Linear, NextNote,
            "Contact time of each hit, from 10 ms (0 %) to 0.05 ms (100 %).";
        RattlePosition "rattle_position" "Rattle position", Percent 1.0..50.0 = 12.0, Linear, NextNote,
            "Where along the string it touches.";
    }
    "Input" {
        InputLevel "input_level" "Input level", Decibels -60.0..24.0 = -60.0, Linear, Smoothed(20),
            "Force of what comes in as sound on the modes of notes whose keys are held; at -60 dB there is none.";
    }
    "Strike" {
        Velocity "velocity" "Velocity to force", Percent 0.0..100.0 = 100.0, Linear, NextNote,
            "How much velocity sets the force of mallet, pluck, noise and bow: 100 % is the square of velocity, 0 % is full force always.";
        VaryPosition "vary_position" "Vary position", Percent 0.0..10.0 = 0.0, Linear, NextNote,
            "How far from its place each strike and pluck falls at most, by chance, as a share of the length.";
        VaryHardness "vary_hardness" "Vary hardness", Percent 0.0..50.0 = 0.0, Linear, NextNote,
            "How much harder or softer each strike and pluck is at most, by chance.";
        VaryModes "vary_modes" "Vary modes", Decibels 0.0..12.0 = 0.0, Linear, NextNote,
            "How much louder or softer each strike leaves each mode at most, by chance.";
    }
    "Body" {
        Decay "decay" "Decay", Seconds 0.005..60.0 = 1.0, Logarithmic, Smoothed(20),
            "Time in which a held note falls by 60 dB (T60).";
        Release "release" "Release", Seconds 0.005..60.0 = 0.3, Logarithmic, Smoothed(20),
            "Longest T60 once the note is released; modes that decay faster do not change.";
        Damper "damper" "Damper", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the release damping acts while the note is held.";
        NoteOff "note_off" "Note off", Choice[NoteOff] 0.0..1.0 = 0.0, Linear, NextNote,
            "Whether a released note is damped or rings on as a drum does.";
        DecayTilt "decay_tilt" "Decay by mode", Number 0.0..2.0 = 0.0, Linear, Smoothed(20),
            "How higher modes decay faster: the T60 of a mode is divided by its ratio to this power.";
        Tilt "tilt" "Brightness", DecibelsPerOctave -24.0..24.0 = 0.0, Linear, NextNote,
            "Tilts the levels of the modes by their ratio.";
        Colour "colour" "Colour", DecibelsPerOctave -24.0..0.0 = 0.0, Linear, Smoothed(20),
            "How much softer higher modes are heard, while the note sounds: an envelope that opens it lets partials enter one by one.";
        Stretch "stretch" "Stretch", Number 0.5..2.0 = 1.0, Linear, NextNote,
            "Raises the ratios of the modes to this power: spreads or squeezes the spectrum.";
        Width "width" "Width", Percent 0.0..100.0 = 100.0, Linear, NextNote,
            "How far apart the modes are panned.";
        Coefficients "coefficients" "Coefficients", Choice[Coefficients] 0.0..1.0 = 0.0, Linear, NextNote,
            "Exact tuning and decay, or the original formulas with their drift, clamped short of exploding.";
        Tension "tension" "Tension", Semitones 0.0..24.0 = 0.0, Linear, Smoothed(20),
            "How far a full strike stretches head or string: the pitch rises by this much, and falls as the sound decays.";
        Bloom "bloom" "Bloom", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "How much of its energy a loud sound passes on from each half octave to the next, as gongs and cymbals do.";
        BloomTime "bloom_time" "Bloom time", Seconds 0.05..10.0 = 0.5, Logarithmic, Smoothed(20),
            "Time in which the energy of a full strike climbs to the high modes.";
        DriftLevel "drift_level" "Drift level", Decibels 0.0..24.0 = 0.0, Linear, Smoothed(20),
            "How much softer each mode becomes at most as it wanders by itself, by chance and unlike the others.";
        DriftPitch "drift_pitch" "Drift pitch", Cents 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the pitch of each mode wanders at most, up or down, unless something plays or touches it.";
        DriftRate "drift_rate" "Drift rate", Hertz 0.05..20.0 = 3.0, Logarithmic, Smoothed(20),
            "How often a second each mode turns to another level and pitch.";
        Touch "touch" "Touch", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "How firmly a finger touches the sounding body: it damps each mode by how far that moves there.";
        TouchPosition "touch_position" "Touch position", Percent 0.0..100.0 = 50.0, Linear, Smoothed(20),
            "Where the finger touches, in per cent of the body's length.";
    }
    "Pitch" {
        Tune "tune" "Tune", Semitones -48.0..48.0 = 0.0, Linear, Smoothed(10),
            "Transposition.";
        Fine "fine" "Fine tune", Cents -100.0..100.0 = 0.0, Linear, Smoothed(10),
            "Fine transposition.";
        Tuning "tuning" "Tuning A4", Hertz 400.0..480.0 = 440.0, Linear, NextNote, fixed,
            "Frequency of A4.";
        KeyTrack "key_track" "Key tracking", Percent 0.0..100.0 = 100.0, Linear, NextNote, fixed,
            "How far pitch follows the key, about C4; 0 % gives every key the pitch of C4.";
        Sweep "sweep" "Sweep", Semitones -60.0..60.0 = 0.0, Linear, NextNote,
            "Where the pitch starts, above or below the note.";
        SweepTime "sweep_time" "Sweep time", Seconds 0.001..10.0 = 0.1, Logarithmic, NextNote,
            "Time until the sweep has arrived at the note.";
        SweepCurve "sweep_curve" "Sweep curve", Percent -100.0..100.0 = 50.0, Linear, NextNote,
            "0 % is a straight line; above, the sweep falls fast and settles slowly; below, the reverse.";
        Vibrato "vibrato" "Vibrato", Cents 0.0..1200.0 = 0.0, Linear, Smoothed(20),
            "Vibrato depth, each way.";
        VibratoRate "vibrato_rate" "Vibrato rate", Hertz 0.05..20.0 = 5.0, Logarithmic, Smoothed(20),
            "Vibrato frequency.";
        VibratoDelay "vibrato_delay" "Vibrato delay", Seconds 0.0..5.0 = 0.0, Linear, NextNote,
            "Time over which the patch's own vibrato fades in; what routes add acts at once.";
        VibratoSync "vibrato_sync" "Vibrato sync", Choice[NoteValue] 0.0..9.0 = 0.0, Linear, Smoothed(0),
            "Note value that one vibrato lasts at the song's tempo, in place of the vibrato rate.";
        Glide "glide" "Glide", Seconds 0.0..10.0 = 0.0, Linear, NextNote, fixed,
            "Time to slide from the note before, or that for each octave; 0 is off.";
        GlideWhen "glide_when" "Glide when", Choice[GlideWhen] 0.0..1.0 = 0.0, Linear, NextNote,
            "Slide to every note, or only to those that start while another key is down.";
        GlideBy "glide_by" "Glide by", Choice[GlideBy] 0.0..1.0 = 0.0, Linear, NextNote,
            "Every slide takes the glide's time, or each octave of it does.";
    }
    "Control" {
        BendRange "bend_range" "Bend range", Semitones 0.0..48.0 = 2.0, Linear, Smoothed(0),
            "Pitch-bend range, unless the channel has set its own (RPN 0).";
    }
    "LFO 1" {
        Lfo1Rate "lfo1_rate" "LFO 1 rate", Hertz 0.01..40.0 = 5.0, Logarithmic, Smoothed(20),
            "How many times a second it goes round.";
        Lfo1Sync "lfo1_sync" "LFO 1 sync", Choice[NoteValue] 0.0..9.0 = 0.0, Linear, Smoothed(0),
            "Note value that one round lasts at the song's tempo, in place of the rate.";
        Lfo1Shape "lfo1_shape" "LFO 1 shape", Choice[Shape] 0.0..5.0 = 0.0, Linear, Smoothed(0),
            "How it moves; steps are a new random number each round, drift slides from one to the next.";
        Lfo1Phase "lfo1_phase" "LFO 1 phase", Percent 0.0..100.0 = 0.0, Linear, NextNote, fixed,
            "Where in its round it starts.";
        Lfo1Fade "lfo1_fade" "LFO 1 fade-in", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time from the strike in which it fades in.";
        Lfo1Scope "lfo1_scope" "LFO 1 scope", Choice[Scope] 0.0..1.0 = 0.0, Linear, NextNote,
            "Whether each note has one of its own, which starts with it, or all notes use one, whose rate routes cannot move.";
    }
    "LFO 2" {
        Lfo2Rate "lfo2_rate" "LFO 2 rate", Hertz 0.01..40.0 = 5.0, Logarithmic, Smoothed(20),
            "How many times a second it goes round.";
        Lfo2Sync "lfo2_sync" "LFO 2 sync", Choice[NoteValue] 0.0..9.0 = 0.0, Linear, Smoothed(0),
            "Note value that one round lasts at the song's tempo, in place of the rate.";
        Lfo2Shape "lfo2_shape" "LFO 2 shape", Choice[Shape] 0.0..5.0 = 0.0, Linear, Smoothed(0),
            "How it moves; steps are a new random number each round, drift slides from one to the next.";
        Lfo2Phase "lfo2_phase" "LFO 2 phase", Percent 0.0..100.0 = 0.0, Linear, NextNote, fixed,
            "Where in its round it starts.";
        Lfo2Fade "lfo2_fade" "LFO 2 fade-in", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time from the strike in which it fades in.";
        Lfo2Scope "lfo2_scope" "LFO 2 scope", Choice[Scope] 0.0..1.0 = 0.0, Linear, NextNote,
            "Whether each note has one of its own, which starts with it, or all notes use one, whose rate routes cannot move.";
    }
    "LFO 3" {
        Lfo3Rate "lfo3_rate" "LFO 3 rate", Hertz 0.01..40.0 = 5.0, Logarithmic, Smoothed(20),
            "How many times a second it goes round.";
        Lfo3Sync "lfo3_sync" "LFO 3 sync", Choice[NoteValue] 0.0..9.0 = 0.0, Linear, Smoothed(0),
            "Note value that one round lasts at the song's tempo, in place of the rate.";
        Lfo3Shape "lfo3_shape" "LFO 3 shape", Choice[Shape] 0.0..5.0 = 0.0, Linear, Smoothed(0),
            "How it moves; steps are a new random number each round, drift slides from one to the next.";
        Lfo3Phase "lfo3_phase" "LFO 3 phase", Percent 0.0..100.0 = 0.0, Linear, NextNote, fixed,
            "Where in its round it starts.";
        Lfo3Fade "lfo3_fade" "LFO 3 fade-in", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time from the strike in which it fades in.";
        Lfo3Scope "lfo3_scope" "LFO 3 scope", Choice[Scope] 0.0..1.0 = 0.0, Linear, NextNote,
            "Whether each note has one of its own, which starts with it, or all notes use one, whose rate routes cannot move.";
    }
    "Envelope 1" {
        Envelope1Delay "envelope1_delay" "Envelope 1 delay", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time from the strike before it rises.";
        Envelope1Attack "envelope1_attack" "Envelope 1 attack", Seconds 0.0005..20.0 = 0.005, Logarithmic, NextNote,
            "Time in which it rises to the top.";
        Envelope1Hold "envelope1_hold" "Envelope 1 hold", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time that it stays there.";
        Envelope1Decay "envelope1_decay" "Envelope 1 decay", Seconds 0.001..60.0 = 0.3, Logarithmic, NextNote,
            "Time in which it falls to the sustain level.";
        Envelope1Sustain "envelope1_sustain" "Envelope 1 sustain", Percent 0.0..100.0 = 50.0, Linear, NextNote,
            "Where it stays until the note is released.";
        Envelope1Release "envelope1_release" "Envelope 1 release", Seconds 0.001..60.0 = 0.3, Logarithmic, NextNote,
            "Time in which it falls to nothing after that.";
        Envelope1Curve "envelope1_curve" "Envelope 1 curve", Percent -100.0..100.0 = 50.0, Linear, NextNote,
            "0 % is straight lines; above, it moves fast and settles slowly; below, the reverse.";
    }
    "Envelope 2" {
        Envelope2Delay "envelope2_delay" "Envelope 2 delay", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time from the strike before it rises.";
        Envelope2Attack "envelope2_attack" "Envelope 2 attack", Seconds 0.0005..20.0 = 0.005, Logarithmic, NextNote,
            "Time in which it rises to the top.";
        Envelope2Hold "envelope2_hold" "Envelope 2 hold", Seconds 0.0..10.0 = 0.0, Linear, NextNote,
            "Time that it stays there.";
        Envelope2Decay "envelope2_decay" "Envelope 2 decay", Seconds 0.001..60.0 = 0.3, Logarithmic, NextNote,
            "Time in which it falls to the sustain level.";
        Envelope2Sustain "envelope2_sustain" "Envelope 2 sustain", Percent 0.0..100.0 = 50.0, Linear, NextNote,
            "Where it stays until the note is released.";
        Envelope2Release "envelope2_release" "Envelope 2 release", Seconds 0.001..60.0 = 0.3, Logarithmic, NextNote,
            "Time in which it falls to nothing after that.";
        Envelope2Curve "envelope2_curve" "Envelope 2 curve", Percent -100.0..100.0 = 50.0, Linear, NextNote,
            "0 % is straight lines; above, it moves fast and settles slowly; below, the reverse.";
    }
    "Macros" {
        Macro1 "macro1" "Macro 1", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro2 "macro2" "Macro 2", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro3 "macro3" "Macro 3", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro4 "macro4" "Macro 4", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro5 "macro5" "Macro 5", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro6 "macro6" "Macro 6", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro7 "macro7" "Macro 7", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
        Macro8 "macro8" "Macro 8", Percent 0.0..100.0 = 0.0, Linear, Smoothed(20),
            "Has no effect by itself: routes lead it to other parameters.";
    }
    "Routes" {
        Route1 "route1" "Route 1 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route2 "route2" "Route 2 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route3 "route3" "Route 3 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route4 "route4" "Route 4 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route5 "route5" "Route 5 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route6 "route6" "Route 6 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route7 "route7" "Route 7 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route8 "route8" "Route 8 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route9 "route9" "Route 9 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route10 "route10" "Route 10 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route11 "route11" "Route 11 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route12 "route12" "Route 12 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route13 "route13" "Route 13 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route14 "route14" "Route 14 amount", Percent -100.0..100.0 = 4.166_666_5, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route15 "route15" "Route 15 amount", Percent -100.0..100.0 = 25.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
        Route16 "route16" "Route 16 amount", Percent -100.0..100.0 = -50.0, Linear, Smoothed(20),
            "How far the route moves its destination, in travel of that knob.";
    }
    "Voices" {
        Voices "voices" "Voices", Count 1.0..64.0 = 16.0, Linear, NextNote,
            "How many notes sound at once.";
        Mode "mode" "Mode", Choice[PlayMode] 0.0..2.0 = 0.0, Linear, NextNote,
            "Many notes, one note struck each time, or one note struck only after a rest.";
        Priority "priority" "Priority", Choice[Priority] 0.0..2.0 = 0.0, Linear, NextNote,
            "Which of the held keys sounds in mono and legato; the others wait.";
        Unison "unison" "Unison", Count 1.0..8.0 = 1.0, Linear, NextNote,
            "How many voices play each note, together as loud as one.";
        UnisonDetune "unison_detune" "Unison detune", Cents 0.0..100.0 = 10.0, Linear, NextNote,
            "How far the outermost unison voices lie from the note, each way; the others lie evenly between them.";
        UnisonSpread "unison_spread" "Unison spread", Percent 0.0..100.0 = 50.0, Linear, NextNote,
            "How much of the stereo field unison voices take, the lowest on the left.";
        UnisonPhase "unison_phase" "Unison phase", Percent 0.0..100.0 = 100.0, Linear, NextNote,
            "How much the phases at which unison voices start differ; 0 % starts them all alike.";
        Choke "choke" "Choke group", Count 0.0..16.0 = 0.0, Linear, NextNote,
            "Notes of a choke group silence each other; 0 is none.";
    }
    "Soundbox" {
        Soundbox "soundbox" "Soundbox", Choice[Soundbox] 0.0..5.0 = 0.0, Linear, AtOnce,
            "A body with resonances of its own, through which all notes pass: none, or a violin's, a guitar's and so on.";
        SoundboxSize "soundbox_size" "Soundbox size", Percent 25.0..800.0 = 100.0, Logarithmic, AtOnce,
            "How much larger the body is than a violin, a classical guitar, a concert grand, a man's vocal tract, or a trumpet.";
        SoundboxVowel "soundbox_vowel" "Soundbox vowel", Percent 0.0..100.0 = 50.0, Linear, AtOnce,
            "What a voice sings: u at 0 %, then o, a, e, and i at 100 %.";
        SoundboxMix "soundbox_mix" "Soundbox mix", Percent 0.0..100.0 = 100.0, Linear, AtOnce,
            "From what is played (0 %) to what the body makes of it (100 %), at equal power.";
    }
    "Strings" {
        StringsLevel "strings_level" "Strings", Percent 0.0..100.0 = 0.0, Linear, AtOnce,
            "How loudly sympathetic strings ring along with what is played.";
        StringsTuning "strings_tuning" "Strings tuning", Choice[StringsTuning] 0.0..3.0 = 0.0, Linear, AtOnce,
            "What the strings are tuned to: all keys of two octaves, or a chord.";
        StringsTune "strings_tune" "Strings tune", Semitones -24.0..24.0 = 0.0, Linear, AtOnce,
            "Tunes all strings higher or lower; the lowest is C2 at 0 st.";
        StringsLowDecay "strings_low_decay" "Strings low decay", Seconds 0.05..30.0 = 6.0, Logarithmic, AtOnce,
            "T60 of the strings up to 200 Hz.";
        StringsHighDecay "strings_high_decay" "Strings high decay", Seconds 0.05..30.0 = 2.0, Logarithmic, AtOnce,
            "T60 of the strings from 6.4 kHz on.";
    }
    "Tremolo" {
        TremoloDepth "tremolo_depth" "Tremolo depth", Percent 0.0..100.0 = 0.0, Linear, AtOnce,
            "How far a motor takes the loudness down and up again; 100 % is down to silence.";
        TremoloRate "tremolo_rate" "Tremolo rate", Hertz 0.1..20.0 = 5.0, Logarithmic, AtOnce,
            "How often it does so in a second.";
        TremoloStereo "tremolo_stereo" "Tremolo stereo", Percent 0.0..100.0 = 0.0, Linear, AtOnce,
            "How far the right side is ahead; at 100 % the sides go up and down in turn.";
    }
    "Drive" {
        Drive "drive" "Drive", Decibels 0.0..36.0 = 0.0, Linear, AtOnce,
            "Lifts what is soft by so much and holds what is loud: full scale stays full scale.";
    }
    "Tone" {
        ToneLow "tone_low" "Tone low", Decibels -18.0..18.0 = 0.0, Linear, AtOnce,
            "Gain below 250 Hz.";
        ToneHigh "tone_high" "Tone high", Decibels -18.0..18.0 = 0.0, Linear, AtOnce,
            "Gain above 3.5 kHz.";
    }
    "Space" {
        Space "space" "Space", Choice[Space] 0.0..3.0 = 0.0, Linear, AtOnce,
            "The body that reverberates, every mode of it a mass: none, a sheet of metal, a spring tank, or a small room.";
        SpaceSize "space_size" "Space size", Percent 25.0..200.0 = 100.0, Logarithmic, AtOnce,
            "Size against a plate of 2 m × 1 m, a guitar amplifier’s tank, or a drum booth of 3 m.";
        SpaceMaterial "space_material" "Space material", Choice[SpaceMaterial] 0.0..4.0 = 0.0, Linear, AtOnce,
            "What the plate or the springs are made of: sets the speed of waves in it.";
        SpaceLowDecay "space_low_decay" "Space low decay", Seconds 0.05..30.0 = 3.0, Logarithmic, AtOnce,
            "T60 of the space up to 200 Hz.";
        SpaceHighDecay "space_high_decay" "Space high decay", Seconds 0.05..30.0 = 1.0, Logarithmic, AtOnce,
            "T60 of the space from 6.4 kHz on.";
        SpacePreDelay "space_pre_delay" "Space pre-delay", Seconds 0.0..0.25 = 0.0, Linear, AtOnce,
            "Time before the space hears what is played.";
        SpaceMix "space_mix" "Space mix", Percent 0.0..100.0 = 25.0, Linear, AtOnce,
            "From what is played (0 %) to what the space makes of it (100 %), at equal power.";
        StereoWidth "stereo_width" "Stereo width", Percent 0.0..200.0 = 100.0, Linear, AtOnce,
            "How wide the stereo image of it all is: 0 % is mono, 200 % the widest.";
    }
    "Output" {
        Gain "gain" "Gain", Decibels -60.0..12.0 = -6.0, Linear, Smoothed(20),
            "Output level.";
        Pan "pan" "Pan", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20),
            "Output position, left to right.";
        Limiter "limiter" "Limiter", Choice[Limiter] 0.0..1.0 = 1.0, Linear, AtOnce,
            "Brings loud chords below −0.3 dBFS true peak, without latency; what stays below −1 dBFS passes unchanged.";
    }
}
