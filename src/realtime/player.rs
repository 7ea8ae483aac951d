//! The player on the audio thread: it renders songs, live events and kits into blocks for the device and the recorder.

use super::block_clock::{BlockClock, Moment};
use super::convert::{DeviceSample, interleave};
use super::fade::Fade;
use super::live::LiveInputs;
use super::recorder::Tap;
use super::status::Status;
use super::stream::Source;
use crate::engine::{Ensemble, Event, EventKind, TelemetryWriter};
use crate::io::{SILENCE_INTERVAL, Song, SongCursor};
use crate::params::Param;
use crate::params::learned::{Controllers, Learned, Movement, Takeover};
use crate::sound::kit::KEYS;
use crate::sound::{Collector, Kit, Mix, Tuning};
use rtrb::{Consumer, Producer, RingBuffer};
use std::sync::Arc;

/// Maximum number of frames rendered at a time. A longer block of the device is rendered in pieces.
pub const MAX_BLOCK: usize = 4096;

/// Maximum number of kits that wait for the audio thread.
const KIT_CAPACITY: usize = 32;

/// Maximum number of movements of parameters by controllers that wait for the display.
const MOVED_CAPACITY: usize = 1024;

/// The settings of a player.
pub struct Setup<'a> {
    /// Frames per second.
    pub sample_rate: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The initial kit of the channels that are not in `channels`.
    pub kit: &'a Arc<Kit>,
    /// Initial kits of single channels, 0–15. If a channel occurs several times, its last kit is used.
    pub channels: &'a [(u8, Arc<Kit>)],
    /// The kits that program changes select.
    pub programs: &'a [Arc<Kit>],
    /// The mix of the channels; with none, they are only added.
    pub mix: Option<&'a Mix>,
    /// The tuning of all channels.
    pub tuning: &'a Tuning,
    /// A song that is played from the first frame on.
    pub song: Option<Song>,
}

/// Sends kits to a player, and frees them when the player no longer uses them; tells what controllers change in them.
pub struct KitSender {
    queue: Producer<(u8, Arc<Kit>)>,
    collector: Collector,
    moved: Consumer<(u8, Param, f32)>,
}

impl KitSender {
    /// Plays `kit` on a channel from its next note on. Returns false if too many kits are waiting already.
    pub fn send(&mut self, channel: u8, kit: &Arc<Kit>) -> bool {
        self.collector.keep(kit);
        self.queue.push((channel, kit.clone())).is_ok()
    }

    /// The next parameter that a controller has moved: its channel and value. Movements that nobody asks for are not kept for ever.
    pub fn next_moved(&mut self) -> Option<(u8, Param, f32)> {
        self.moved.pop().ok()
    }
}

/// Plays on the audio thread. [`Source::fill`] is real-time safe: it never allocates, locks or fails.
pub struct Player {
    ensemble: Ensemble,
    programs: usize,
    song: Option<SongCursor<Song>>,
    inputs: LiveInputs,
    kits: Consumer<(u8, Arc<Kit>)>,
    /// The controllers that move parameters, and which have hold of them on each channel.
    learned: Learned,
    takeovers: Vec<Takeover>,
    moved: Producer<(u8, Param, f32)>,
    clock: BlockClock,
    events: Vec<Event>,
    left: Vec<f32>,
    right: Vec<f32>,
    tap: Option<Tap>,
    status: Arc<Status>,
    telemetry: TelemetryWriter,
    fade: Fade,
    /// Frames since the end of the song.
    tail: u64,
    ended: bool,
    /// Keeps the received kits alive. Fields are dropped in order, so this one must come after the ensemble.
    _collector: Collector,
}

impl Player {
    /// Makes a player, and the sender of its kits. Allocates.
    pub fn new(setup: Setup, inputs: LiveInputs, tap: Option<Tap>, status: Arc<Status>) -> (Self, KitSender) {
        let sample_rate = f64::from(setup.sample_rate);
        let song = setup.song.map(|song| SongCursor::new(song, sample_rate));
        let densest = song.as_ref().map_or(0, |song| song.densest_block(MAX_BLOCK));
        let (queue, kits) = RingBuffer::new(KIT_CAPACITY);
        let (moved, all_moved) = RingBuffer::new(MOVED_CAPACITY);
        let collector = Collector::default();
        let ensemble = Ensemble::of_kits(sample_rate, setup.seed, setup.kit, setup.programs.to_vec());
        let channels = setup.channels.iter();
        let mut ensemble = channels.fold(ensemble, |ensemble, (channel, kit)| ensemble.with_kit(*channel, kit));
        // Reserves room for every kit and space, so that the audio thread need not allocate.
        ensemble.reserve(KEYS);
        ensemble.reserve_space();
        if let Some(mix) = setup.mix {
            ensemble = ensemble.with_mix(mix);
        }
        ensemble.set_tuning(setup.tuning);
        let player = Self {
            ensemble,
            programs: setup.programs.len(),
            song,
            events: Vec::with_capacity(densest + inputs.capacity()),
            inputs,
            kits,
            learned: Learned::default(),
            takeovers: (0..16).map(|_| Takeover::default()).collect(),
            moved,
            clock: BlockClock::new(sample_rate),
            left: vec![0.0; MAX_BLOCK],
            right: vec![0.0; MAX_BLOCK],
            tap,
            telemetry: TelemetryWriter::new(status.telemetry().clone(), sample_rate),
            status,
            fade: Fade::new(sample_rate),
            tail: 0,
            ended: false,
            _collector: collector.clone(),
        };
        (player, KitSender { queue, collector, moved: all_moved })
    }

    /// The same player with controllers that move parameters of the channel on which they are played.
    #[must_use]
    pub fn with_controllers(self, controllers: &Controllers) -> Self {
        self.learned.publish(controllers);
        self
    }

    /// Renders a piece of a block that begins `start` frames after the start of the block.
    fn render(&mut self, start: u32, len: usize) {
        self.events.clear();
        let was_over = self.song.as_ref().is_none_or(SongCursor::is_over);
        if let Some(song) = &mut self.song {
            song.advance(len, &mut self.events);
        }
        let Self { ensemble, learned, takeovers, moved, .. } = self;
        let end = start + len as u32;
        self.inputs.merge(&self.clock, start, end, &mut self.events, |before, channel, kind| {
            let EventKind::Control { controller, value: at } = kind else { return Some(kind) };
            let takeover = takeovers.get_mut(usize::from(channel))?;
            // Events of this block have not reached the ensemble yet.
            let set = |event: &Event, wanted| match event.kind {
                EventKind::Param { param, value } if (event.channel, param) == (channel, wanted) => Some(value),
                _ => None,
            };
            let movement = takeover.follow(learned, controller, at, |info| {
                let last = before.iter().rev().find_map(|event| set(event, info.param));
                last.unwrap_or_else(|| ensemble.values(channel).get(info.param))
            });
            match movement {
                Movement::Free => Some(kind),
                Movement::Nothing => None,
                Movement::Turns(info) => {
                    let (param, value) = (info.param, info.denormalise(at.into()));
                    let _ = moved.push((channel, param, value));
                    Some(EventKind::Param { param, value })
                }
            }
        });
        for event in &self.events {
            let known = !matches!(event.kind, EventKind::Program(number) if usize::from(number) >= self.programs);
            if known {
                self.telemetry.note_event(event);
            }
        }
        let (left, right) = (&mut self.left[..len], &mut self.right[..len]);
        self.ensemble.process(&self.events, left, right);
        self.fade.apply(&self.status, left, right);
        if let Some(tap) = &mut self.tap {
            tap.record(left, right);
        }
        let silent = self.ensemble.is_silent();
        self.tail = if was_over { self.tail + len as u64 } else { 0 };
        self.ended = silent && was_over && (self.ended || self.tail >= SILENCE_INTERVAL);
        self.status.note_song(self.ended);
        self.telemetry.note_sound(left, right, silent, || self.ensemble.snapshot());
    }
}

impl Source for Player {
    fn fill<T: DeviceSample>(&mut self, out: &mut [T], channels: usize, moment: Moment) {
        let channels = channels.max(1);
        let frames = out.len() / channels;
        self.clock.begin(moment, frames as u32);
        while let Ok((channel, kit)) = self.kits.pop() {
            self.ensemble.set_kit(channel, &kit);
        }
        if self.status.is_song_halted()
            && let Some(song) = &mut self.song
        {
            song.halt();
        }
        for (piece, out) in out.chunks_mut(MAX_BLOCK * channels).enumerate() {
            let start = piece * MAX_BLOCK;
            let len = out.len() / channels;
            self.render(start as u32, len);
            interleave(&self.left[..len], &self.right[..len], channels, out);
        }
        self.status.note_delay(self.clock.delay());
        self.telemetry.note_block(frames, moment.now.elapsed());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::EventKind;
    use crate::params::Param;
    use crate::patch::Patch;
    use crate::realtime::live::LiveSender;
    use crate::render::{Job, Options, Tail};
    use std::time::{Duration, Instant};

    const SETTINGS: (u32, u64) = (44_100, 7);

    fn player(song: Option<Song>, patch: &Patch) -> (Player, [LiveSender; 1], KitSender, Arc<Status>) {
        let (senders, inputs) = LiveInputs::new();
        let status = Arc::new(Status::default());
        let setup = Setup {
            sample_rate: SETTINGS.0,
            seed: SETTINGS.1,
            kit: &Kit::of_patch(patch),
            channels: &[],
            programs: &[],
            mix: None,
            tuning: &Tuning::EQUAL,
            song,
        };
        let (player, kits) = Player::new(setup, inputs, None, status.clone());
        (player, senders, kits, status)
    }

    fn now() -> Moment {
        Moment { now: Instant::now(), called: Duration::ZERO, heard: Duration::ZERO }
    }

    fn short() -> Patch {
        Patch::default().with(Param::Decay, 0.1).with(Param::Release, 0.05)
    }

    #[test]
    fn a_song_has_the_bits_of_the_renderer_in_any_block() {
        let song = Song::chord(&[60.0, 64.25, 67.0], 0.8, 0.3);
        let options = Options { sample_rate: SETTINGS.0, seed: SETTINGS.1, block: 512, tail: Tail::Auto };
        let mut expected = Vec::new();
        Job::new(&song, &Kit::of_patch(&short()), options)
            .render(|left, right| {
                expected.extend(left.iter().zip(right).flat_map(|(left, right)| [*left, *right]));
                Ok(())
            })
            .unwrap();
        for block in [1, 64, 480, 10_000] {
            let (mut player, _, _, status) = player(Some(song.clone()), &short());
            let mut played = Vec::new();
            while !status.is_song_over() {
                let mut out = vec![9.0_f32; 2 * block];
                player.fill(&mut out, 2, now());
                played.extend(out);
            }
            assert!(played.len() >= expected.len(), "{block}: the end is not cut off");
            let equal = played.iter().zip(&expected).all(|(a, b)| a.to_bits() == b.to_bits());
            assert!(equal, "{block}");
            assert!(played[expected.len()..].iter().all(|sample| *sample == 0.0), "{block}: silence after the end");
            assert!(played.len() < expected.len() + 2 * (2 * block + 128), "{block}: the end is noticed");
        }
    }

    #[test]
    fn a_live_note_sounds_at_the_frame_of_its_stamp() {
        let (mut player, [mut sender], _, _) = player(None, &Patch::default());
        let start = Instant::now();
        let at = |ms| {
            let since = Duration::from_millis(ms);
            Moment { now: start + since, called: since, heard: since }
        };
        let mut out = vec![0.0_f32; 2 * 4410];
        player.fill(&mut out, 2, at(0));
        let stamp = super::super::Stamp::System(start + Duration::from_millis(40));
        let kind = EventKind::NoteOn { key: 69, detune: 0.0, velocity: 1.0, id: None };
        sender.send(super::super::LiveEvent { stamp, channel: 0, kind });
        player.fill(&mut out, 2, at(100));
        let first = out.iter().position(|sample| *sample != 0.0).unwrap() / 2;
        assert_eq!(first, 1764, "40 ms into the block after the one in which it came");
    }

    #[test]
    fn a_bound_controller_moves_the_parameter_of_its_channel_once_it_has_reached_it() {
        // Its knob stands at 0.5.
        let decay = Param::Decay.info();
        let patch = Patch::default().with(Param::Decay, decay.denormalise(0.5));
        let (player, [mut sender], mut kits, _) = player(None, &patch);
        let mut player = player.with_controllers(&Controllers::from([(7, Param::Decay)]));
        let mut play = |player: &mut Player, positions: &[u8]| {
            let start = Instant::now();
            let stamp = super::super::Stamp::System(start);
            for position in positions {
                let kind = EventKind::Control { controller: 7, value: f32::from(*position) / 127.0 };
                sender.send(super::super::LiveEvent { stamp, channel: 2, kind });
            }
            for since in [0, 10, 20].map(Duration::from_millis) {
                player.fill(&mut [0.0_f32; 882], 2, Moment { now: start + since, called: since, heard: since });
            }
        };
        let at = |position: u8| decay.denormalise((f32::from(position) / 127.0).into());
        play(&mut player, &[10, 40]);
        assert_eq!(player.ensemble.values(2).get(Param::Decay), decay.denormalise(0.5), "not yet");
        // Within one block.
        play(&mut player, &[70, 100, 20]);
        assert_eq!(player.ensemble.values(2).get(Param::Decay), at(20));
        assert_eq!(player.ensemble.values(1).get(Param::Decay), decay.denormalise(0.5), "another channel");
        let told: Vec<_> = std::iter::from_fn(|| kits.next_moved()).collect();
        assert_eq!(told, [70, 100, 20].map(|position| (2, Param::Decay, at(position))));
        assert!(kits.send(2, &Kit::of_patch(&patch)));
        play(&mut player, &[21, 22]);
        assert_eq!(player.ensemble.values(2).get(Param::Decay), decay.denormalise(0.5), "another kit does not jump");
    }

    #[test]
    fn kits_are_taken_at_the_next_block_and_a_halted_song_ends() {
        let long = Patch::default().with(Param::Decay, 60.0).with(Param::Release, 0.05);
        let (mut player, _, mut kits, status) = player(Some(Song::chord(&[60.0], 1.0, 100.0)), &long);
        assert!(kits.send(0, &Kit::of_patch(&long.clone().with(Param::Gain, -60.0))));
        let mut out = vec![0_i16; 512];
        player.fill(&mut out, 2, now());
        assert!(out.iter().all(|sample| sample.abs() < 40), "the patch is a quiet one");
        assert!(!status.is_song_over());
        status.halt_song();
        // The key of the halted song is let go of, so the note ends within a quarter of a second.
        for _ in 0..SETTINGS.0 / 4 / 256 {
            player.fill(&mut out, 2, now());
        }
        assert!(status.is_song_over() && status.telemetry().is_silent());
    }
}
