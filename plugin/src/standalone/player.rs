//! The audio thread of the program: renders MIDI input and the window's notes for the device.

use crate::live::Live;
use crate::params::SprungParams;
use sprung::engine::{Event, EventKind};
use sprung::internals::learned::{Movement, Takeover};
use sprung::internals::realtime::{BlockClock, DeviceSample, Fade, MAX_BLOCK, Moment, interleave};
use sprung::realtime::{LiveInputs, Source, Status};
use std::sync::Arc;

/// Plays the window's sound. [`Source::fill`] is real-time safe.
pub(super) struct WindowPlayer {
    params: Arc<SprungParams>,
    live: Live,
    inputs: LiveInputs,
    takeover: Takeover,
    clock: BlockClock,
    events: Vec<Event>,
    left: Vec<f32>,
    right: Vec<f32>,
    fade: Fade,
    status: Arc<Status>,
}

impl WindowPlayer {
    /// For a sample rate in Hz. Allocates.
    pub(super) fn new(sample_rate: u32, params: Arc<SprungParams>, inputs: LiveInputs, status: Arc<Status>) -> Self {
        let sample_rate = f64::from(sample_rate);
        Self {
            live: Live::new(sample_rate, false, &params),
            params,
            events: Vec::with_capacity(inputs.capacity()),
            inputs,
            takeover: Takeover::default(),
            clock: BlockClock::new(sample_rate),
            left: vec![0.0; MAX_BLOCK],
            right: vec![0.0; MAX_BLOCK],
            fade: Fade::new(sample_rate),
            status,
        }
    }

    /// Continues at another sample rate: sounding notes end. Allocates.
    pub(super) fn set_sample_rate(&mut self, sample_rate: u32) {
        let sample_rate = f64::from(sample_rate);
        self.live = Live::new(sample_rate, false, &self.params);
        (self.clock, self.fade) = (BlockClock::new(sample_rate), Fade::new(sample_rate));
    }
}

impl Source for WindowPlayer {
    fn fill<T: DeviceSample>(&mut self, out: &mut [T], channels: usize, moment: Moment) {
        let channels = channels.max(1);
        let frames = out.len() / channels;
        self.clock.begin(moment, frames as u32);
        for (piece, out) in out.chunks_mut(MAX_BLOCK * channels).enumerate() {
            let start = (piece * MAX_BLOCK) as u32;
            let len = out.len() / channels;
            self.events.clear();
            let (params, takeover) = (&self.params, &mut self.takeover);
            self.inputs.merge(&self.clock, start, start + len as u32, &mut self.events, |_, _, kind| {
                let EventKind::Control { controller, value: at } = kind else { return Some(kind) };
                match takeover.follow(params.learned(), controller, at, |info| params.present(info)) {
                    Movement::Free => return Some(kind),
                    Movement::Nothing => {}
                    Movement::Turns(info) => {
                        params.knobs()[info.param as usize].turn(at);
                        params.link().repaint.request_repaint();
                    }
                }
                None
            });
            let (left, right) = (&mut self.left[..len], &mut self.right[..len]);
            self.live.play(&self.params, &self.events, left, right);
            self.fade.apply(&self.status, left, right);
            interleave(left, right, channels, out);
        }
        self.status.note_delay(self.clock.delay());
        self.params.link().devices.note_block(frames as u32);
        self.live.note_block(frames, moment.now.elapsed());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::Touch;
    use crate::state::{State, VIEW};
    use sprung::engine::Synth;
    use sprung::internals::learned::Controllers;
    use sprung::internals::realtime::Stamp;
    use sprung::params::Param;
    use sprung::preset::Playable;
    use sprung::realtime::LiveEvent;
    use std::time::{Duration, Instant};

    const ON: EventKind = EventKind::NoteOn { key: 69, detune: 0.0, velocity: 1.0, id: None };

    fn player() -> (WindowPlayer, [sprung::realtime::LiveSender; 1], Arc<SprungParams>) {
        let params = Arc::new(SprungParams::default());
        params.load(State::new(Playable::find("Marimba").unwrap(), 0, VIEW).into());
        let (senders, inputs) = LiveInputs::new();
        let status = Arc::new(Status::of(params.link().telemetry.clone()));
        (WindowPlayer::new(48_000, params.clone(), inputs, status), senders, params)
    }

    fn fill(player: &mut WindowPlayer, frames: usize) -> Vec<f32> {
        let mut out = vec![9.0; 2 * frames];
        let moment = Moment { now: Instant::now(), called: Duration::ZERO, heard: Duration::ZERO };
        player.fill(&mut out, 2, moment);
        out
    }

    #[test]
    fn keys_midi_and_knobs_are_heard_with_the_bits_of_the_engine() {
        let (mut player, _, params) = player();
        assert!(fill(&mut player, 64).iter().all(|sample| *sample == 0.0), "silence before anything is played");
        let mut synth = Synth::new(48_000.0, 0);
        synth.set_kit(&params.loaded().kit);
        params.link().play(Touch::Down { key: 69, velocity: 1.0 });
        let (mut left, mut right) = (vec![0.0; 10_000], vec![0.0; 10_000]);
        synth.process(&[Event { frame: 0, channel: 0, kind: ON }], &mut left, &mut right);
        let expected: Vec<f32> = left.into_iter().zip(right).flat_map(|(left, right)| [left, right]).collect();
        assert!(expected.iter().any(|sample| *sample != 0.0));
        // Longer than the pieces that are rendered at a time.
        assert!(fill(&mut player, 10_000) == expected);
        let silence = &params.knobs()[sprung::params::Param::Gain as usize];
        let before = fill(&mut player, 4_800).into_iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        silence.turn(0.0);
        fill(&mut player, 4_800);
        let after = fill(&mut player, 480).into_iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        assert!(after < before / 100.0, "a knob is followed: {before} {after}");
    }

    #[test]
    fn a_bound_controller_turns_its_knob_once_it_has_reached_it_and_does_nothing_else() {
        let (mut player, [mut sender], params) = player();
        params.learned().publish(&Controllers::from([(7, Param::Mode), (8, Param::Tilt)]));
        let mut send = |controller, position: u8| {
            let start = Instant::now();
            let kind = EventKind::Control { controller, value: f32::from(position) / 127.0 };
            sender.send(LiveEvent { stamp: Stamp::System(start), channel: 0, kind });
            for since in [0, 10, 20].map(Duration::from_millis) {
                player.fill(&mut [0.0_f32; 960], 2, Moment { now: start + since, called: since, heard: since });
            }
            [Param::Mode, Param::Tilt].map(|param| params.knobs()[param as usize].position())
        };
        let [mode, tilt] = send(1, 0);
        let away = if tilt < 0.5 { 127 } else { 0 };
        assert_eq!(send(8, away), [mode, tilt]);
        let passed = if tilt < 0.5 { 0 } else { 127 };
        assert_eq!(send(8, passed), [mode, f32::from(passed) / 127.0]);
        params.knobs()[Param::Tilt as usize].turn(0.5);
        assert_eq!(send(8, passed), [mode, 0.5], "the mouse has moved it");
        assert_eq!(send(7, 0), [0.0, 0.5], "a choice");
        assert_eq!(send(7, 127), [1.0, 0.5]);
    }

    #[test]
    fn midi_sounds_and_the_end_is_a_fade() {
        let (mut player, [mut sender], params) = player();
        fill(&mut player, 480);
        let start = Instant::now();
        sender.send(LiveEvent { stamp: Stamp::System(start), channel: 0, kind: ON });
        let mut played = vec![0.0_f32; 960];
        for block in 1..=10 {
            let since = Duration::from_millis(10 * block);
            player.fill(&mut played, 2, Moment { now: start + since, called: since, heard: since });
        }
        assert!(played.iter().any(|sample| *sample != 0.0) && !params.link().telemetry.is_silent());
        player.status.fade();
        for _ in 0..61 {
            fill(&mut player, 480);
        }
        assert!(player.status.is_faded() && fill(&mut player, 480).iter().all(|sample| *sample == 0.0));
    }
}
