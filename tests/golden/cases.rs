//! The golden cases: every factory preset, every song in `assets/midi`, and the engine's other features.

use crate::score::{BLOCKS, Score};
use sprung::engine::{EventKind, NoteId};
use sprung::internals::text::slug;
use sprung::params::Param;
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

/// Name of the case that plays the preset `init`.
pub(crate) const INIT: &str = "preset-init";

/// All cases.
pub(crate) fn all() -> Vec<Score> {
    // The longest come first, so that no core waits for them at the end.
    let mut cases = crate::songs::all();
    // The bank is large, so each preset is played in only one other block size; the sizes take turns.
    let turns = (0..BLOCKS.len()).cycle().map(|turn| &BLOCKS[turn..=turn]);
    cases.extend(Preset::factory().iter().zip(turns).map(|(one, blocks)| preset(one).in_blocks(blocks)));
    cases.extend(engine());
    cases
}

/// The case that plays the preset `init`.
pub(crate) fn init() -> Score {
    preset(Preset::find("init").expect("there is a preset init"))
}

/// A strike, the same key again while it sounds, then a higher note bent up and down.
fn preset(preset: &Preset) -> Score {
    let name = format!("preset-{}", slug(&preset.name));
    let mut score = Score::new(&name, preset.patch.clone(), 2.0).on(0.001, 48, 100).on(0.4003, 48, 60).off(0.8, 48);
    score = score.on(1.0, 67, 100);
    for step in 1..=20_u8 {
        let bend = libm::sinf(f32::from(step) * 0.314_159_27);
        score = score.then(1.0 + 0.0203 * f64::from(step), 0, EventKind::PitchBend(bend));
    }
    score = score.off(1.6, 67);
    if name == INIT { score.keeping_audio() } else { score }
}

/// Three masses that differ in every property of a mode.
fn trio() -> Patch {
    let modes = ModeTable::new(&[
        Mode { pan: -0.5, ..Mode::UNIT },
        Mode { ratio: 2.76, level: 0.5, decay: 0.6, strike: 0.5, pan: 0.5 },
        Mode { ratio: 5.4, level: -0.25, decay: 0.3, strike: 0.0, pan: 0.0 },
    ]);
    Patch { modes, ..Patch::default() }
}

fn engine() -> Vec<Score> {
    let patch = trio();
    vec![
        pedals(patch.clone()),
        stealing(patch.clone().with(Param::Voices, 4.0)),
        line("engine-mono", patch.clone().with(Param::Mode, 1.0).with(Param::Glide, 0.05)),
        line("engine-legato", patch.clone().with(Param::Mode, 2.0).with(Param::Glide, 0.1)).keeping_audio(),
        choking(patch.clone().with(Param::Choke, 1.0)),
        automation(patch.clone().with(Param::MalletPulse, 1.0)).keeping_audio(),
        controllers(patch.clone().with(Param::MalletLevel, -60.0).with(Param::PluckLevel, 0.0).with_route(
            0,
            Source::Pressure,
            Param::Damper,
            80.0,
        )),
        noise(patch.clone().with(Param::MalletLevel, -60.0).with(Param::NoiseReach, 100.0).with(Param::NoiseTime, 0.3))
            .keeping_audio(),
        programs(patch.clone()),
        rate("engine-22050-hz", 22_050.0),
        rate("engine-192-khz", 192_000.0),
        line("engine-classic", patch.clone().with(Param::Coefficients, 1.0)),
        space(patch),
    ]
}

/// Sustain with a re-strike, sostenuto, soft, then reset and all notes off.
fn pedals(patch: Patch) -> Score {
    Score::new("engine-pedals", patch.with(Param::Decay, 3.0).with(Param::Release, 0.1), 2.0)
        .on(0.0, 60, 100)
        .control(0.05, 64, 127)
        .off(0.1, 60)
        .on(0.2, 60, 80)
        .off(0.3, 60)
        .control(0.5, 64, 0)
        .on(0.6, 64, 100)
        .control(0.65, 66, 127)
        .on(0.7, 67, 100)
        .off(0.8, 64)
        .off(0.8, 67)
        .control(1.0, 66, 0)
        .control(1.1, 67, 127)
        .on(1.2, 72, 100)
        .control(1.3, 64, 127)
        .off(1.35, 72)
        .control(1.4, 121, 0)
        .on(1.5, 55, 100)
        .control(1.6, 123, 0)
        .on(1.7, 55, 100)
        .control(1.8, 120, 0)
}

/// Twelve notes on four voices, some of them at the same frame.
fn stealing(patch: Patch) -> Score {
    (0..12).fold(Score::new("engine-stealing", patch, 1.5), |score, note| {
        let index = f64::from(note / 2);
        score.on(0.1013 * index, 48 + 5 * note, 127 - 9 * note)
    })
}

/// Overlapping and separate notes of a melody.
fn line(name: &str, patch: Patch) -> Score {
    Score::new(name, patch, 1.5)
        .on(0.0, 48, 100)
        .on(0.2, 55, 90)
        .on(0.35, 60, 110)
        .off(0.5, 60)
        .off(0.6, 55)
        .off(0.7, 48)
        .on(0.9, 50, 100)
        .off(1.1, 50)
}

/// A choke group across channels.
fn choking(patch: Patch) -> Score {
    let strike = |key: u8| EventKind::NoteOn { key, detune: 0.25, velocity: 0.8, id: NoteId::new(key.into()) };
    Score::new("engine-choking", patch.with(Param::Decay, 2.0), 1.2)
        .then(0.0, 0, strike(60))
        .then(0.25, 9, strike(64))
        .then(0.5, 0, strike(67))
        .then(0.7, 0, EventKind::Choke { group: 2 })
        .then(0.9, 3, EventKind::Choke { group: 1 })
}

/// Parameters that move while notes sound.
fn automation(patch: Patch) -> Score {
    let mut score = Score::new("engine-automation", patch.with(Param::Vibrato, 30.0), 1.5).on(0.0, 52, 100);
    for (step, (param, value)) in [
        (Param::Gain, -12.0),
        (Param::Decay, 0.2),
        (Param::Tune, 7.0),
        (Param::Pan, -60.0),
        (Param::MalletHardness, 20.0),
        (Param::Decay, 4.0),
        (Param::Fine, -50.0),
        (Param::VibratoRate, 9.0),
        (Param::Gain, 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        let time = 0.0507 * (step + 1) as f64;
        score = score.then(time, 0, EventKind::Param { param, value });
    }
    score.on(0.6, 59, 127).off(0.9, 52).off(1.0, 59)
}

/// Wheel, pressure and a bend range set by RPN 0.
fn controllers(patch: Patch) -> Score {
    let press = |pressure: f32| EventKind::PolyPressure { key: 60, pressure };
    Score::new("engine-controllers", patch.with_route(1, Source::Pressure, Param::Vibrato, 100.0 / 12.0), 1.5)
        .control(0.0, 101, 0)
        .control(0.0, 100, 0)
        .control(0.0, 6, 12)
        .on(0.0, 60, 100)
        .control(0.1, 1, 127)
        .then(0.2, 0, EventKind::PitchBend(1.0))
        .then(0.4, 0, EventKind::PitchBend(-0.5))
        .then(0.5, 0, press(1.0))
        .then(0.7, 0, press(0.0))
        .on(0.8, 64, 100)
        .then(0.9, 0, EventKind::ChannelPressure(0.7))
        .control(1.1, 121, 0)
        .off(1.2, 64)
}

/// Noise bursts: the second strike of a key uses different noise from the first.
fn noise(patch: Patch) -> Score {
    Score::new("engine-noise", patch, 1.0).on(0.0, 45, 100).on(0.3, 45, 100).on(0.31, 57, 100).off(0.6, 57)
}

/// Program changes between and during notes; a number beyond the list is ignored.
fn programs(patch: Patch) -> Score {
    let programs = vec![
        Patch::default().with(Param::Sweep, 24.0),
        patch.clone().with(Param::MalletLevel, -60.0).with(Param::NoiseReach, 100.0),
    ];
    Score::new("engine-programs", patch, 1.2)
        .with_programs(programs)
        .on(0.0, 60, 100)
        .then(0.2, 0, EventKind::Program(0))
        .on(0.3, 60, 100)
        .then(0.5, 0, EventKind::Program(1))
        .then(0.55, 0, EventKind::Program(99))
        .on(0.6, 64, 100)
}

/// All effects behind the voices, with changes of their parameters, and another body by a program change.
fn space(patch: Patch) -> Score {
    let with_space = |space: f32| {
        patch
            .clone()
            .with(Param::MalletPulse, 1.0)
            .with(Param::StringsLevel, 40.0)
            .with(Param::TremoloDepth, 50.0)
            .with(Param::TremoloStereo, 60.0)
            .with(Param::Drive, 6.0)
            .with(Param::ToneLow, 3.0)
            .with(Param::ToneHigh, -2.0)
            .with(Param::Space, space)
            .with(Param::SpacePreDelay, 0.01)
            .with(Param::SpaceMix, 50.0)
            .with(Param::StereoWidth, 150.0)
    };
    let mut score =
        Score::new("engine-space", with_space(2.0), 0.8).with_programs(vec![with_space(1.0)]).on(0.0, 60, 100);
    for (step, (param, value)) in [
        (Param::StringsTuning, 2.0),
        (Param::StringsTune, -5.0),
        (Param::StringsLowDecay, 1.0),
        (Param::TremoloRate, 9.0),
        (Param::Drive, 15.0),
        (Param::ToneHigh, 4.0),
        (Param::SpaceSize, 60.0),
        (Param::SpaceMaterial, 3.0),
        (Param::SpaceHighDecay, 0.2),
        (Param::SpacePreDelay, 0.03),
        (Param::StereoWidth, 30.0),
    ]
    .into_iter()
    .enumerate()
    {
        score = score.then(0.0207 * (step + 1) as f64, 0, EventKind::Param { param, value });
    }
    score.on(0.3, 67, 90).then(0.4, 0, EventKind::Program(0)).on(0.5, 55, 110)
}

/// The same phrase at another sample rate.
fn rate(name: &str, sample_rate: f64) -> Score {
    let patch = trio().with(Param::MalletPulse, 1.0).with(Param::Sweep, 12.0).with(Param::Vibrato, 20.0);
    Score::new(name, patch, 0.6).at_rate(sample_rate).on(0.0, 57, 100).on(0.2, 69, 80).off(0.4, 57)
}
