//! The audio thread compared with the engine alone, in a simulated host.

use super::*;
use crate::plugin::Sprung;
use crate::state::{State, VIEW};
use sprung::engine::NoteId;
use sprung::patch::Patch;
use sprung::preset::{Playable, Preset};
use std::cell::Cell;
use std::collections::VecDeque;

const RATE: f64 = 48_000.0;
const FRAMES: usize = 4_800;

/// A simulated host.
struct Host {
    events: VecDeque<NoteEvent<()>>,
    ended: Vec<(u32, VoiceID, Key)>,
    voices: Cell<Option<u32>>,
    transport: Transport,
}

impl Host {
    fn new(events: &[NoteEvent<()>]) -> Self {
        Self {
            events: events.iter().copied().collect(),
            ended: Vec::new(),
            voices: Cell::new(None),
            transport: Transport::new(RATE as f32),
        }
    }
}

impl ProcessContext<Sprung> for Host {
    fn plugin_api(&self) -> PluginApi {
        PluginApi::Clap
    }
    fn execute_background(&self, (): ()) {}
    fn execute_gui(&self, (): ()) {}
    fn transport(&self) -> &Transport {
        &self.transport
    }
    fn next_event(&mut self) -> Option<NoteEvent<()>> {
        self.events.pop_front()
    }
    fn try_send_event(
        &mut self,
        event: NoteEvent<()>,
    ) -> Result<(), (NoteEvent<()>, nice_plug_core::context::process::SendEventError)> {
        let NoteEvent::VoiceTerminated { timing, voice_id, key, .. } = event else { panic!("{event:?}") };
        self.ended.push((timing, voice_id, key));
        Ok(())
    }
    fn set_latency_samples(&self, _: u32) {}
    fn request_restart(&self) {}
    fn set_current_voice_capacity(&self, voices: u32) {
        self.voices.set(Some(voices));
    }
}

fn on(timing: u32, id: i32, key: u8) -> NoteEvent<()> {
    let (channel, key) = (Channel::Number(0), Key::Number(key));
    NoteEvent::NoteOn { timing, voice_id: VoiceID::ID(id), channel, key, velocity: 0.8 }
}

fn off(timing: u32, id: i32) -> NoteEvent<()> {
    let (voice_id, channel, key) = (VoiceID::ID(id), Channel::Wildcard, Key::Wildcard);
    NoteEvent::NoteOff { timing, voice_id, channel, key, velocity: 0.5 }
}

fn params(patch: Patch) -> SprungParams {
    let params = SprungParams::default();
    let preset = Preset { patch, ..Preset::find("Init").unwrap().clone() };
    params.load(State::new(Playable::Preset(preset), 3, VIEW).into());
    params
}

/// Renders a stereo block with the shell.
fn stereo(live: &mut Live, params: &SprungParams, host: &mut Host, frames: usize) -> ([Vec<f32>; 2], ProcessStatus) {
    // The shell must overwrite old contents of the host's buffers.
    let mut out = [vec![9.0; frames], vec![9.0; frames]];
    let [left, right] = &mut out;
    let status = live.process(params, &[], &mut [left, right], &mut None, host);
    (out, status)
}

/// The same notes, rendered by the engine alone.
fn alone(patch: &Patch, events: &[(u32, EventKind)], frames: usize) -> [Vec<f32>; 2] {
    let mut synth = Synth::new(RATE, 3);
    synth.set_patch(patch);
    let events: Vec<Event> =
        events.iter().map(|(frame, kind)| Event { frame: *frame, channel: 0, kind: *kind }).collect();
    let mut out = [vec![0.0; frames], vec![0.0; frames]];
    let [left, right] = &mut out;
    synth.process(&events, left, right);
    out
}

fn strike(key: u8, id: i32) -> EventKind {
    EventKind::NoteOn { key, detune: 0.0, velocity: 0.8, id: NoteId::new(id) }
}

#[test]
fn the_shell_has_the_bits_of_the_engine() {
    let patch = Preset::find("Church Bell").unwrap().patch.clone().with(Param::Decay, 0.123_456_79);
    let params = params(patch.clone());
    let mut live = Live::new(RATE, false, &params);
    let mut host = Host::new(&[on(100, 1, 60), on(100, 2, 67), off(2_000, 1)]);
    let (out, _) = stereo(&mut live, &params, &mut host, FRAMES);
    let release = EventKind::NoteOff { key: 60, velocity: 0.5, id: NoteId::new(1) };
    let expected = alone(&patch, &[(100, strike(60, 1)), (100, strike(67, 2)), (2_000, release)], FRAMES);
    assert!(expected[0].iter().any(|sample| *sample != 0.0));
    assert_eq!(out, expected);

    live.reset(&params);
    let mut mono = vec![9.0; FRAMES];
    let mut host = Host::new(&[on(100, 1, 60), on(100, 2, 67), off(2_000, 1)]);
    live.process(&params, &[], &mut [&mut mono], &mut None, &mut host);
    let mean: Vec<f32> = expected[0].iter().zip(&expected[1]).map(|(left, right)| 0.5 * (left + right)).collect();
    assert_eq!(mono, mean, "mono is the mean, after a reset as from the start");
}

#[test]
fn what_comes_in_drives_what_is_held() {
    let patch = Patch::default().with(Param::InputLevel, -20.0).with(Param::MalletLevel, -60.0);
    let params = params(patch.clone());
    let input: Vec<f32> = (0..FRAMES).map(|n| if n % 300 < 9 { 0.4 } else { 0.0 }).collect();
    let mut synth = Synth::new(RATE, 3);
    synth.set_patch(&patch);
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    let note = Event { frame: 100, channel: 0, kind: strike(60, 1) };
    synth.process_with_input(&[note], &input, &mut left, &mut right);
    assert!(left.iter().any(|sample| sample.abs() > 1e-4));
    let mean: Vec<f32> = left.iter().zip(&right).map(|(left, right)| 0.5 * (left + right)).collect();

    let mut live = Live::new(RATE, false, &params);
    let mut out = [vec![9.0; FRAMES], vec![9.0; FRAMES]];
    let [to_left, to_right] = &mut out;
    live.process(&params, &input, &mut [to_left, to_right], &mut None, &mut Host::new(&[on(100, 1, 60)]));
    assert_eq!(out, [left, right]);
    live.reset(&params);
    let mut mono = vec![9.0; FRAMES];
    live.process(&params, &input, &mut [&mut mono], &mut None, &mut Host::new(&[on(100, 1, 60)]));
    assert_eq!(mono, mean);
}

#[test]
fn an_event_at_the_end_of_a_part_belongs_to_the_next_frame() {
    let params = params(Patch::default());
    let mut live = Live::new(RATE, false, &params);
    let (before, _) = stereo(&mut live, &params, &mut Host::new(&[on(64, 1, 60)]), 64);
    let (after, _) = stereo(&mut live, &params, &mut Host::new(&[]), 64);
    let [expected, _] = alone(&Patch::default(), &[(64, strike(60, 1))], 128);
    assert_eq!([&before[0][..], &after[0][..]].concat(), expected);
}

#[test]
fn knobs_are_followed_at_once_in_silence_and_smoothly_in_sound() {
    let params = params(Patch::default());
    let mut live = Live::new(RATE, false, &params);
    let index = Param::Gain as usize;
    let quiet = Param::Gain.info().normalise(-20.0) as f32;
    params.knobs()[index].turn(quiet);
    let (out, _) = stereo(&mut live, &params, &mut Host::new(&[on(0, 1, 60)]), 64);
    assert_eq!(out, alone(&Patch::default().with(Param::Gain, -20.0), &[(0, strike(60, 1))], 64));

    params.knobs()[index].turn(params.state().positions[index] + 0.2);
    let value = params.state().values.get(Param::Gain);
    let (after, _) = stereo(&mut live, &params, &mut Host::new(&[]), 64);
    let louder = EventKind::Param { param: Param::Gain, value };
    let patch = Patch::default().with(Param::Gain, -20.0);
    let [expected, _] = alone(&patch, &[(0, strike(60, 1)), (64, louder)], 128);
    assert_eq!(after[0], expected[64..]);
    assert_eq!(live.synth.values().get(Param::Gain), value);
}

#[test]
fn a_loaded_patch_and_seed_play_from_the_next_note_on() {
    let params = params(Patch::default());
    let mut live = Live::new(RATE, false, &params);
    stereo(&mut live, &params, &mut Host::new(&[]), 64);
    let snare = Preset::find("Snare").unwrap();
    params.load(State::new(Playable::Preset(snare.clone()), 4, VIEW).into());
    let (out, _) = stereo(&mut live, &params, &mut Host::new(&[on(0, 1, 60)]), FRAMES);
    assert_eq!(live.synth.kit(), &snare.kit());
    let with_seed = |seed| {
        let mut synth = Synth::new(RATE, seed);
        synth.set_patch(&snare.patch);
        let mut out = [vec![0.0; 64 + FRAMES], vec![0.0; 64 + FRAMES]];
        let [left, right] = &mut out;
        synth.process(&[Event { frame: 64, channel: 0, kind: strike(60, 1) }], left, right);
        out.map(|channel| channel[64..].to_vec())
    };
    assert_eq!(out, with_seed(4));
    assert_ne!(out, with_seed(3), "a snare is random");
}

#[test]
fn the_tail_is_told_and_then_silence() {
    let params = params(Patch::default().with(Param::Decay, 0.01));
    let mut live = Live::new(RATE, false, &params);
    let (_, status) = stereo(&mut live, &params, &mut Host::new(&[]), 64);
    assert_eq!(status, ProcessStatus::Normal);
    let mut host = Host::new(&[on(10, 5, 60)]);
    let (_, status) = stereo(&mut live, &params, &mut host, 64);
    let ProcessStatus::Tail(tail) = status else { panic!("{status:?}") };
    assert!((64..4_800).contains(&tail), "{tail} frames");
    assert_eq!(host.ended, []);
    let (_, status) = stereo(&mut live, &params, &mut host, tail as usize + 32);
    assert_eq!(status, ProcessStatus::Normal);
    assert_eq!(host.ended, [(tail + 31, VoiceID::ID(5), Key::Number(60))]);
    host.events.push_back(on(0, 6, 60));
    let (_, status) = stereo(&mut live, &params, &mut host, 64);
    assert_eq!(status, ProcessStatus::KeepAlive, "not counted again so soon");
    let (_, status) = stereo(&mut live, &params, &mut host, 4_096);
    assert_eq!((status, host.ended.len()), (ProcessStatus::Normal, 2));
    let (out, _) = stereo(&mut live, &params, &mut host, 64);
    assert_eq!((out[0].iter().all(|sample| *sample == 0.0), host.ended.len()), (true, 2), "told once");
}

#[test]
fn tempo_and_voices_are_told_when_they_change() {
    let params = params(Patch::default().with(Param::Voices, 5.0));
    let mut live = Live::new(RATE, false, &params);
    let mut host = Host::new(&[]);
    host.transport.tempo = Some(90.0);
    stereo(&mut live, &params, &mut host, 64);
    assert_eq!((live.tempo, host.voices.take()), (Some(90.0), Some(5)));
    stereo(&mut live, &params, &mut host, 64);
    assert_eq!(host.voices.take(), None);
    live.reset(&params);
    assert_eq!(live.tempo, None, "the synth has forgotten it, so it is told again");
}

#[test]
fn a_kit_takes_the_place_of_a_sound_while_that_rings_on() {
    let kit = "kit = 1\nname = \"k\"\nkeys = [{ key = 36, sound = \"Kick\" }, { key = 38, sound = \"Snare\" }]";
    let kit = Playable::parse(kit, "x", &mut |name| Preset::find(name).cloned()).unwrap();
    let params = params(Patch::default());
    let mut live = Live::new(RATE, false, &params);
    let mut synth = Synth::new(RATE, 3);
    let play = |synth: &mut Synth, key, id| {
        let mut out = [vec![0.0; 64], vec![0.0; 64]];
        let [left, right] = &mut out;
        synth.process(&[Event { frame: 0, channel: 0, kind: strike(key, id) }], left, right);
        out
    };
    let (out, _) = stereo(&mut live, &params, &mut Host::new(&[on(0, 1, 60)]), 64);
    assert_eq!(out, play(&mut synth, 60, 1));
    let mut state = State::new(kit.clone(), 3, VIEW);
    state.values.set(Param::Gain, -12.0);
    state.positions[Param::Gain as usize] = Param::Gain.info().normalise(-12.0) as f32;
    let before = Arc::downgrade(&params.loaded());
    params.load(state.into());
    synth.set_kit(&kit.kit());
    let mut values = *kit.kit().values();
    values.set(Param::Gain, -12.0);
    synth.set_values(&values);
    let (out, _) = stereo(&mut live, &params, &mut Host::new(&[on(0, 2, 38)]), 64);
    assert_eq!(out, play(&mut synth, 38, 2));
    assert!(before.upgrade().is_some(), "the audio thread has freed nothing");
    params.load(params.state().into());
    assert!(before.upgrade().is_none(), "it is freed by who loads next");
}

#[test]
fn a_click_in_the_window_is_heard_but_not_in_a_file() {
    for is_offline in [false, true] {
        let params = params(Patch::default());
        let mut live = Live::new(RATE, is_offline, &params);
        params.link().play(Touch::Down { key: 60, velocity: 0.8 });
        let (out, _) = stereo(&mut live, &params, &mut Host::new(&[]), 64);
        assert_eq!(out[0].iter().all(|sample| *sample == 0.0), is_offline);
    }
}

#[test]
fn the_load_is_measured_while_the_window_looks() {
    let params = params(Patch::default());
    let mut live = Live::new(RATE, false, &params);
    let telemetry = &params.link().telemetry;
    stereo(&mut live, &params, &mut Host::new(&[]), 64);
    assert_eq!(telemetry.load().frames, 0, "nobody looks");
    telemetry.snapshot();
    stereo(&mut live, &params, &mut Host::new(&[]), 64);
    let load = telemetry.load();
    assert!((load.frames, load.blocks) == (64, 1) && load.mean_share > 0.0, "{load:?}");
}
