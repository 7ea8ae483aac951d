//! The parts of the sound's way, the knobs of each in groups, and the manual's page about it.

use sprung::params::Param::{self, *};
use sprung::params::{PARAMS, ParamInfo};

/// A part, by its name: that of its section, if it has one.
pub(super) type Part = &'static str;

/// Knobs that belong together, under a title.
pub(super) type Group = (&'static str, Vec<&'static ParamInfo>);

/// Parameters under a title.
type Titled = (&'static str, &'static [Param]);

/// The parts with more than one group, and their groups in the order of what one sets first.
const GROUPS: [(Part, &[Titled]); 12] = [
    (
        "Mallet",
        &[
            ("Strength", &[MalletLevel, MalletVelocity]),
            ("Contact", &[MalletPulse, MalletHardness, MalletMass, MalletSpeed, MalletKey]),
        ],
    ),
    ("Pluck", &[("Strength", &[PluckLevel, PluckVelocity]), ("Finger", &[PluckHardness, PluckPosition, PluckWidth])]),
    (
        "Noise",
        &[
            ("Strength", &[NoiseLevel, NoiseVelocity, NoiseHeld]),
            ("Burst", &[NoiseAttack, NoiseTime, NoiseDecay]),
            ("Repeats", &[NoiseHits, NoiseSpacing]),
            ("Colour", &[NoiseColour, NoiseReach]),
        ],
    ),
    ("Bow", &[("Strength", &[BowLevel, BowVelocity]), ("Hair", &[BowForce, BowSlip, BowPosition])]),
    (
        "Breath",
        &[
            ("Strength", &[BreathLevel, BreathPressure, BreathAttack, BreathTongue]),
            ("Valve", &[BreathValve, BreathOpening, BreathLip]),
            ("Air", &[BreathNoise, BreathSteepening]),
        ],
    ),
    ("Rattle", &[("What", &[Rattle, RattleGap, RattlePosition]), ("Mass", &[RattleMass, RattleRate, RattleHardness])]),
    ("Strike", &[("Velocity", &[Velocity]), ("By chance", &[VaryPosition, VaryHardness, VaryModes])]),
    (
        "Body",
        &[
            ("Ringing", &[Decay, Release, Damper, NoteOff, DecayTilt, Coefficients]),
            ("Colour", &[Tilt, Colour, Stretch, Width, Touch, TouchPosition]),
            ("Slow", &[Tension, Bloom, BloomTime, DriftLevel, DriftPitch, DriftRate]),
        ],
    ),
    (
        "Pitch",
        &[
            ("Tuning", &[Tune, Fine, Tuning, KeyTrack, BendRange]),
            ("Sweep", &[Sweep, SweepTime, SweepCurve]),
            ("Vibrato", &[Vibrato, VibratoRate, VibratoDelay, VibratoSync]),
            ("Glide", &[Glide, GlideWhen, GlideBy]),
        ],
    ),
    (
        "Voices",
        &[("Notes", &[Voices, Mode, Priority, Choke]), ("Unison", &[Unison, UnisonDetune, UnisonSpread, UnisonPhase])],
    ),
    (
        "Strings",
        &[("Strings", &[StringsLevel, StringsTuning, StringsTune]), ("Decay", &[StringsLowDecay, StringsHighDecay])],
    ),
    (
        "Space",
        &[
            ("Space", &[Space, SpaceSize, SpaceMaterial]),
            ("Decay", &[SpaceLowDecay, SpaceHighDecay, SpacePreDelay]),
            ("Mix", &[SpaceMix, StereoWidth]),
        ],
    ),
];

/// The knobs of a part.
pub(super) fn groups(part: Part) -> Vec<Group> {
    let of_section = || vec![("", PARAMS.iter().filter(|info| info.section == part).collect())];
    let own = GROUPS.iter().find(|(name, _)| *name == part);
    own.map_or_else(of_section, |(_, groups)| {
        groups.iter().map(|(title, params)| (*title, params.iter().map(|param| param.info()).collect())).collect()
    })
}

/// What a part without a lamp does.
pub(super) fn help(part: Part) -> &'static str {
    match part {
        "Pitch" => "Transposes, sweeps, shakes and slides the pitch; how far the pitch wheel bends it.",
        "Voices" => "How many notes sound at once, and how many voices each has.",
        "Tuning" => "The scale, and the frequency of each key.",
        "Strike" => "How velocity and chance change each strike.",
        "Body" => "Its modes, how they ring, and what it is made of.",
        "Body 2" => "What the other body is made of.",
        "Joint" => "How the two bodies act on each other, and how loud the second one is.",
        "Output" => "Level, place and limiter.",
        _ => "",
    }
}

/// The page of the manual that explains a part.
pub(super) fn topic(part: Part) -> &'static str {
    match part {
        "Body" | "Rattle" | "Pitch" => "bodies",
        "Voices" | "Tuning" => "tuning",
        "Soundbox" | "Strings" | "Tremolo" | "Drive" | "Tone" | "Space" | "Output" => "space",
        _ => "exciters",
    }
}

/// Tabs that lead to what looks most unlike, one after the other.
#[cfg(test)]
pub(in crate::editor) fn names() -> [&'static str; 6] {
    ["Mallet", "Body", "Model", "Space", "Voices", "Tuning"]
}
