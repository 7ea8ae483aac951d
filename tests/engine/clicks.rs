//! Nothing clicks: the largest step between two samples is at most that of the undisturbed sound plus −60 dBFS.

use crate::events::{event, off, on};
use sprung::engine::{Ensemble, Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::{Mode, ModeTable, Patch};

const RATE: f64 = 48_000.0;
const FRAMES: usize = 12_000;
/// −60 dBFS, the allowed increase.
const ALLOWANCE: f32 = 0.001;

fn pedal(frame: u32, controller: u8, value: f32) -> Event {
    event(frame, EventKind::Control { controller, value })
}

fn largest_jump(patch: &Patch, programs: &[Patch], events: &[Event]) -> f32 {
    let mut ensemble = Ensemble::new(RATE, 1, patch, programs);
    let mut sound = [vec![0.0; FRAMES], vec![0.0; FRAMES]];
    let [left, right] = &mut sound;
    ensemble.process(events, left, right);
    jump(&sound)
}

/// The largest step between two samples of a channel; the sound must be in both channels.
fn jump(sound: &[Vec<f32>; 2]) -> f32 {
    for channel in sound {
        assert!(channel.iter().any(|sample| sample.abs() > 0.01), "something sounds on either channel");
    }
    let jumps = sound.iter().flat_map(|channel| channel.windows(2)).map(|pair| (pair[1] - pair[0]).abs());
    // A NaN counts as a step; `max` alone would ignore it.
    jumps.fold(0.0, |most, jump| if jump.is_nan() { f32::INFINITY } else { f32::max(most, jump) })
}

/// The sounds for the tests: a sine, a mallet instrument whose modes are panned right and left, and a kick drum with a
/// sweep.
fn patches() -> [(&'static str, Patch); 3] {
    // The limiter would react to loud parts, whether disturbed or not.
    let sine = Patch::default().with(Param::Decay, 3.0).with(Param::Gain, 0.0).with(Param::Limiter, 0.0);
    let mut mallet = sine.clone().with(Param::MalletPulse, 1.0).with(Param::MalletHardness, 60.0);
    let modes = [(1.0, 0.6, 0.7), (3.93, 0.25, -0.9), (9.6, 0.1, 0.4), (17.0, 0.05, -0.2)];
    mallet.modes = ModeTable::new(&modes.map(|(ratio, level, pan)| Mode { ratio, level, pan, ..Mode::UNIT }));
    let kick = sine.clone().with(Param::Sweep, 24.0).with(Param::SweepTime, 0.08).with(Param::Decay, 0.5);
    [("sine", sine), ("mallet", mallet), ("kick", kick)]
}

/// The sound after a program change: other modes, panned differently, quieter and with another strike.
fn program() -> Patch {
    let mut patch = Patch::default()
        .with(Param::Gain, -12.0)
        .with(Param::MalletLevel, -60.0)
        .with(Param::PluckLevel, 0.0)
        .with(Param::Decay, 0.5)
        .with(Param::Limiter, 0.0);
    let modes = [(1.0, 0.5, -0.8), (2.76, 0.3, 0.9), (5.4, 0.2, -0.3)];
    patch.modes = ModeTable::new(&modes.map(|(ratio, level, pan)| Mode { ratio, level, pan, ..Mode::UNIT }));
    patch
}

/// Compares the steps of `disturbed` with those of `undisturbed`. Both are functions of a key and a time, and are tried
/// for every patch, several keys, and times at all phases.
fn check(
    change: impl Fn(Patch) -> Patch,
    undisturbed: impl Fn(u8, u32) -> Vec<Event>,
    disturbed: impl Fn(u8, u32) -> Vec<Event>,
) {
    check_against(change, |key, moment| [undisturbed(key, moment)], disturbed);
}

/// Like [`check`], with several undisturbed sounds, of which the one with the largest step counts.
fn check_against<const N: usize>(
    change: impl Fn(Patch) -> Patch,
    undisturbed: impl Fn(u8, u32) -> [Vec<Event>; N],
    disturbed: impl Fn(u8, u32) -> Vec<Event>,
) {
    for (name, patch) in patches() {
        let free = patch.clone().with(Param::Voices, 16.0);
        let programs = [program()];
        // Most undisturbed sounds are the same at every time.
        let mut before = (None, 0.0);
        for key in [28, 40, 60, 84] {
            for moment in [4800, 4907, 5151] {
                let sounds = Some(undisturbed(key, moment));
                if before.0 != sounds {
                    let jumps = sounds.iter().flatten().map(|events| largest_jump(&free, &programs, events));
                    let most = jumps.fold(0.0, f32::max);
                    before = (sounds, most);
                }
                let before = before.1;
                let after = largest_jump(&change(patch.clone()), &programs, &disturbed(key, moment));
                assert!(
                    after <= before + ALLOWANCE,
                    "{name}, key {key}, frame {moment}: a jump of {after} where {before} is the sound's own"
                );
            }
        }
    }
}

#[test]
fn stealing_does_not_click() {
    let notes = |key, moment| vec![on(0, key), on(moment, key + 7)];
    check(|patch| patch.with(Param::Voices, 1.0), notes, notes);
}

#[test]
fn stealing_every_voice_at_once_does_not_click() {
    let patch = patches()[0].1.clone().with(Param::Voices, 64.0).with(Param::Gain, -24.0);
    let chord = |frame, channel| (20..84).map(move |key| Event { channel, ..on(frame, key) });
    let events: Vec<Event> = chord(0, 0).chain(chord(4800, 1)).collect();
    // On an ensemble, each channel has its own 64 voices; on a synth, the second chord steals all voices of the first.
    let undisturbed = largest_jump(&patch, &[], &events);
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(&patch);
    let mut sound = [vec![0.0; FRAMES], vec![0.0; FRAMES]];
    let [left, right] = &mut sound;
    synth.process(&events, left, right);
    let disturbed = jump(&sound);
    assert!(disturbed <= undisturbed + ALLOWANCE, "a jump of {disturbed} where {undisturbed} is the sound's own");
}

#[test]
fn choking_does_not_click() {
    let notes = |key, moment| vec![on(0, key), on(moment, key + 7)];
    check(|patch| patch.with(Param::Choke, 1.0), notes, notes);
}

#[test]
fn striking_a_sounding_note_does_not_click() {
    // Undisturbed means two masses of the same pitch struck together: a second strike also sweeps the pitch of the sounding mass.
    let other = |frame, key| Event { channel: 1, ..on(frame, key) };
    check(|patch| patch, |key, _| vec![on(0, key), other(0, key)], |key, moment| vec![on(0, key), on(moment, key)]);
}

#[test]
fn retuning_and_bending_do_not_click() {
    // Undisturbed means the higher of the two pitches, struck twice: during the glide, modes can come into phase.
    let upper = |key| vec![on(0, key + 7), Event { channel: 1, ..on(0, key + 7) }];
    for glide in [0.0, 0.05] {
        check(
            |patch| patch.with(Param::Mode, 2.0).with(Param::Glide, glide),
            |key, _| upper(key),
            |key, moment| vec![on(0, key), on(moment, key + 7), off(moment + 3000, key + 7)],
        );
    }
    check(
        |patch| patch.with(Param::BendRange, 7.0),
        |key, _| upper(key),
        |key, moment| vec![on(0, key), event(moment, EventKind::PitchBend(1.0))],
    );
}

#[test]
fn lifting_a_pedal_does_not_click() {
    for controller in [64, 66] {
        check(
            |patch| patch.with(Param::Release, 0.05),
            |key, _| vec![on(0, key)],
            |key, moment| vec![on(0, key), pedal(10, controller, 1.0), off(100, key), pedal(moment, controller, 0.0)],
        );
    }
}

#[test]
fn releasing_does_not_click() {
    check(
        |patch| patch.with(Param::Release, 0.05),
        |key, _| vec![on(0, key)],
        |key, moment| vec![on(0, key), off(moment, key)],
    );
}

#[test]
fn changing_the_preset_does_not_click() {
    check(
        |patch| patch,
        |key, _| vec![on(0, key)],
        |key, moment| vec![on(0, key), event(moment, EventKind::Program(0))],
    );
}

/// Next to the sounding note, on the same key, and replacing it if there is only one voice; at once or later.
#[test]
fn a_note_of_another_preset_does_not_click() {
    another_preset(&[(7, 16.0, 0), (0, 1.0, 37)]);
}

#[test]
#[ignore = "takes seconds"]
fn nor_does_it_at_other_times() {
    another_preset(&[(7, 16.0, 37), (0, 16.0, 0), (7, 1.0, 0), (0, 16.0, 37), (7, 1.0, 37), (0, 1.0, 0)]);
}

fn another_preset(cases: &[(u8, f32, u32)]) {
    let program = |frame| event(frame, EventKind::Program(0));
    let other = |event| Event { channel: 1, ..event };
    for &(interval, voices, later) in cases {
        check(
            |patch| patch.with(Param::Voices, voices),
            |key, moment| vec![on(0, key), other(program(0)), other(on(moment + later, key + interval))],
            |key, moment| vec![on(0, key), program(moment), on(moment + later, key + interval)],
        );
    }
}

#[test]
fn a_click_is_found_on_either_channel() {
    let undisturbed = [vec![0.02; 100], vec![0.03; 100]];
    assert_eq!(jump(&undisturbed), 0.0);
    for side in [0, 1] {
        let mut clicks = undisturbed.clone();
        clicks[side][50..].iter_mut().for_each(|sample| *sample += 2.0 * ALLOWANCE);
        assert!(jump(&clicks) > ALLOWANCE, "{side}");
        clicks[side][50] = f32::NAN;
        assert_eq!(jump(&clicks), f32::INFINITY, "{side}");
    }
}

#[test]
fn silencing_a_channel_does_not_click() {
    check(
        |patch| patch,
        |key, _| vec![on(0, key)],
        |key, moment| vec![on(0, key), event(moment, EventKind::Control { controller: 120, value: 0.0 })],
    );
}

#[test]
fn turning_volume_gain_and_decay_does_not_click() {
    for kind in [
        EventKind::Control { controller: 7, value: 0.0 },
        EventKind::Param { param: Param::Gain, value: -60.0 },
        EventKind::Param { param: Param::Decay, value: 0.05 },
    ] {
        check(|patch| patch, |key, _| vec![on(0, key)], |key, moment| vec![on(0, key), event(moment, kind)]);
    }
}

#[test]
fn panning_does_not_click() {
    // Undisturbed are the sound in the middle and, where it is louder, the sound on that side.
    for value in [0.1, 0.9] {
        let pan = |frame| event(frame, EventKind::Control { controller: 10, value });
        check_against(
            |patch| patch,
            |key, _| [vec![on(0, key)], vec![pan(0), on(0, key)]],
            |key, moment| vec![on(0, key), pan(moment)],
        );
    }
}
