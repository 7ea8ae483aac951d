//! Sixteen MIDI channels, a synth each, mixed in channel order: what a MIDI file plays on.

use super::lender::{Lender, Stretch};
use super::mix_limiter::MixLimiter;
use super::note::{nearest_channel, nearest_key};
use super::synth::allowed;
use super::zones::Owners;
use super::{Event, EventKind, Snapshot, Synth};
use crate::dsp::limiter::Work;
use crate::params::Param;
use crate::patch::Patch;
use crate::sound::{Kit, Tuning};
use std::sync::Arc;

/// Frames that are mixed at a time, unless [`Ensemble::with_chunk`] says otherwise.
const CHUNK: usize = 1024;

/// Sixteen synths behind one stream of events.
///
/// Each channel has its own kit, controllers and polyphony. An MPE configuration message makes a zone, whose members
/// play on the instrument of their master channel. A note of a choke group silences that group on every
/// channel. One limiter is at the end of the mix: it is on while any channel that has had a note has a kit that asks
/// for it. Gives the same bits however the frames are divided into blocks. Real-time safe once built.
pub struct Ensemble {
    parts: Vec<Part>,
    programs: Vec<Arc<Kit>>,
    /// The kits that channels have been built with, kept so that none is freed in a program change.
    starts: Vec<Arc<Kit>>,
    /// What each part plays, for the others to know.
    playing: [Playing; 16],
    chunk: usize,
    owners: Owners,
    lender: Lender,
    limiter: MixLimiter,
}

/// What one channel plays: its synth, and the frames of the chunk that is being mixed.
pub struct Part {
    channel: usize,
    synth: Synth,
    left: Vec<f32>,
    right: Vec<f32>,
    /// Whether the chunk has sound.
    heard: bool,
}

/// What a part plays, as far as other parts need to know: which of them its notes choke.
#[derive(Clone)]
struct Playing {
    kit: Arc<Kit>,
    /// The choke group of the kit's parameters.
    choke: f32,
}

/// As [`Playing`], while a chunk is played.
#[derive(Clone, Copy)]
struct Groups<'a> {
    kit: &'a Kit,
    choke: f32,
}

impl Groups<'_> {
    /// The choke group of a key; 0 for one that is silent.
    fn of(&self, key: u8, tuning: &Tuning) -> u8 {
        self.kit.tuned_pad(nearest_key(key), tuning).map_or(0, |(pad, ..)| self.kit.choke(pad, self.choke))
    }
}

/// The events and frames that every part plays in one go.
#[derive(Clone, Copy)]
struct Chunk<'a> {
    events: &'a [Event],
    /// The frames of the events count from so many before the chunk.
    start: usize,
    /// The last frame of the chunk that an event can be at.
    last: usize,
    frames: usize,
    programs: &'a [Arc<Kit>],
    /// Choke groups of the channels before the events.
    groups: [Groups<'a>; 16],
    /// Who plays which channel.
    owners: Owners,
}

impl Ensemble {
    /// An ensemble in which every channel starts with `patch` and program changes choose from `programs`
    /// (a number beyond the list changes nothing). Allocates.
    pub fn new(sample_rate: f64, seed: u64, patch: &Patch, programs: &[Patch]) -> Self {
        Self::of_kits(sample_rate, seed, &Kit::of_patch(patch), programs.iter().map(Kit::of_patch).collect())
    }

    /// As [`Ensemble::new`], with kits. Allocates.
    pub fn of_kits(sample_rate: f64, seed: u64, kit: &Arc<Kit>, programs: Vec<Arc<Kit>>) -> Self {
        let part = |channel: u64| {
            let synth = Synth::with_voices(sample_rate, seed.wrapping_add(channel << 32), Lender::for_part());
            Part { channel: channel as usize, synth, left: vec![0.0; CHUNK], right: vec![0.0; CHUNK], heard: false }
        };
        let largest = programs.iter().map(|kit| kit.sounds().len()).max().unwrap_or(1);
        let mut ensemble = Self {
            parts: (0..16).map(part).collect(),
            programs,
            starts: Vec::new(),
            playing: std::array::from_fn(|_| Playing { kit: kit.clone(), choke: 0.0 }),
            chunk: CHUNK,
            owners: Owners::default(),
            lender: Lender::new(sample_rate),
            limiter: MixLimiter::new(allowed(sample_rate)),
        };
        ensemble.reserve(largest);
        (0..16).fold(ensemble, |ensemble, channel| ensemble.with_kit(channel, kit))
    }

    /// The same ensemble with another kit on a channel (one above 15 is taken as 15) from the start. Allocates.
    #[must_use]
    pub fn with_kit(mut self, channel: u8, kit: &Arc<Kit>) -> Self {
        self.starts.push(kit.clone());
        self.reserve(kit.sounds().len());
        self.set_kit(channel, kit);
        self
    }

    /// Makes room for kits of up to so many sounds on every channel, so that [`Ensemble::set_kit`] need not. Allocates.
    pub fn reserve(&mut self, sounds: usize) {
        self.parts.iter_mut().for_each(|part| part.synth.reserve(sounds));
    }

    /// The same ensemble, mixing up to `frames` frames (at least 1) at a time: more than it would of itself pay where
    /// parts are played side by side. Allocates.
    #[must_use]
    pub fn with_chunk(mut self, frames: usize) -> Self {
        self.chunk = frames.max(1);
        for Part { left, right, .. } in &mut self.parts {
            left.resize(self.chunk, 0.0);
            right.resize(self.chunk, 0.0);
        }
        self
    }

    /// Renders the next frames over what the slices hold: as many as the shorter of the two has (any number; they are
    /// meant to be of one length). The rest of a longer one stays as it is. `events` are in order of their frames.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.process_by(|parts, play| parts.iter_mut().for_each(play), events, left, right);
    }

    /// As [`Ensemble::process`], with the parts played by `each`: it calls the function that it is given once with
    /// every part, in any order and on any threads, as no part depends on another. The bits are the same. As
    /// real-time safe as `each` is.
    pub fn process_by(
        &mut self,
        each: impl Fn(&mut [Part], &(dyn Fn(&mut Part) + Sync)),
        events: &[Event],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let (mut events, frames, mut start) = (events, left.len().min(right.len()), 0);
        // At least once: a block of no frames still brings its events.
        loop {
            let mut end = frames.min(start + self.chunk);
            let mut now =
                if end == frames { events.len() } else { events.partition_point(|event| (event.frame as usize) < end) };
            // Events beyond the end of the block are taken as its last frame's.
            let mut last = frames.saturating_sub(1).min(end).saturating_sub(start);
            let owners = self.owners;
            let mut zones = events[..now].iter().map(|event| self.owners.hear(event)).enumerate();
            let mut zone = zones.find_map(|(index, zone)| Some((&events[index], index, zone?)));
            if let Some((event, index, _)) = zone {
                // Channels change their owners between two chunks.
                (now, end) = (index, start + (event.frame as usize).saturating_sub(start).min(last));
                last = end - start;
            }
            let stretch = Stretch { events: &events[..now], start, last, owners, programs: &self.programs };
            let unserved = self.lender.lend(&mut self.parts, |part| &mut part.synth, &stretch);
            if let Some((index, frame)) = unserved {
                (now, end, last, zone) = (index, start + frame, frame, None);
                self.owners = owners;
                events[..now].iter().for_each(|event| _ = self.owners.hear(event));
            }
            let groups = self.playing.each_ref().map(|playing| Groups { kit: &playing.kit, choke: playing.choke });
            let programs = &self.programs;
            let chunk = Chunk { events: &events[..now], start, last, frames: end - start, programs, groups, owners };
            each(&mut self.parts, &|part| part.play(chunk));
            for (playing, part) in self.playing.iter_mut().zip(&self.parts) {
                playing.note(&part.synth);
            }
            let is_heard = self.parts.iter().any(|part| part.heard);
            if is_heard || now > 0 {
                self.lender.take_back(&mut self.parts, |part| &mut part.synth);
            }
            let (left, right) = (&mut left[start..end], &mut right[start..end]);
            self.mix(left, right);
            let limited = |event: &Event| (owners.of(nearest_channel(event.channel)), *event);
            self.limiter.process(
                events[..now].iter().map(limited),
                [start, last],
                &self.programs,
                is_heard,
                [left, right],
            );
            if let Some((event, index, (master, members))) = zone {
                self.hand_over_from(owners);
                // Every part knows the zones.
                self.parts.iter_mut().for_each(|part| part.synth.configure_zone(master, members));
                self.parts[usize::from(owners.of(master))].synth.handle(event);
                (events, start) = (&events[index + 1..], end);
                continue;
            }
            if end == frames && unserved.is_none() {
                break;
            }
            (events, start) = (&events[now..], end);
        }
    }

    /// Hands what channels hold over to their owners where these are others than before.
    fn hand_over_from(&mut self, before: Owners) {
        for channel in 0..16 {
            let [from, to] = [before, self.owners].map(|owners| usize::from(owners.of(channel)));
            if from != to {
                let held = self.parts[from].synth.channel(channel);
                self.parts[to].synth.set_channel(channel, held);
            }
        }
    }

    /// Adds up the parts, in the order of their channels.
    fn mix(&self, left: &mut [f32], right: &mut [f32]) {
        left.fill(0.0);
        right.fill(0.0);
        for part in self.parts.iter().filter(|part| part.heard) {
            add(left, &part.left);
            add(right, &part.right);
        }
    }

    /// Plays another kit on a channel (one above 15 is taken as 15) from its next note on. As real-time safe as
    /// [`Synth::set_kit`]: the ensemble itself keeps its programs and the kits that it was built with.
    pub fn set_kit(&mut self, channel: u8, kit: &Arc<Kit>) {
        let channel = nearest_channel(channel);
        let synth = &mut self.parts[usize::from(channel)].synth;
        synth.set_kit(kit);
        self.playing[usize::from(channel)].note(synth);
        self.limiter.set_kit(channel, kit);
    }

    /// Tunes the keys of all channels in another way from the next note on. Notes that sound keep their pitch.
    /// Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.parts.iter_mut().for_each(|part| part.synth.set_tuning(tuning));
    }

    /// What sounds now, on all channels together. Real-time safe.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.parts.iter().for_each(|part| part.synth.show(&mut snapshot));
        snapshot
    }

    /// How much the limiter has worked. Real-time safe.
    pub fn limiter_work(&self) -> Work {
        self.limiter.work()
    }

    /// Whether nothing sounds any more. Real-time safe.
    pub fn is_silent(&self) -> bool {
        self.parts.iter().all(|part| part.synth.is_silent())
    }

    /// Most notes that have sounded at once on one channel each, added up.
    pub fn voices_used(&self) -> usize {
        self.parts.iter().map(|part| part.synth.voices_used()).sum()
    }
}

impl Playing {
    /// Takes over what a synth plays.
    fn note(&mut self, synth: &Synth) {
        if !Arc::ptr_eq(&self.kit, synth.kit()) {
            self.kit = synth.kit().clone();
        }
        self.choke = synth.values().get(Param::Choke);
    }
}

impl Part {
    /// Renders a chunk into the part's own frames.
    fn play(&mut self, chunk: Chunk) {
        let Chunk { events, start, last, frames, programs, mut groups, owners } = chunk;
        let Self { channel, synth, heard, .. } = self;
        let (left, right) = (&mut self.left[..frames], &mut self.right[..frames]);
        let mut frame = 0;
        *heard = !synth.is_silent();
        for event in events {
            let sender = nearest_channel(event.channel);
            let owner = owners.of(sender);
            let program = match event.kind {
                // Members play what their master does.
                EventKind::Program(number) if owner == sender => programs.get(usize::from(number)),
                _ => None,
            };
            let sender = usize::from(owner);
            let kind = match event.kind {
                EventKind::NoteOn { key, .. } if sender != *channel => {
                    EventKind::Choke { group: groups[sender].of(key, synth.tuning()) }
                }
                kind => kind,
            };
            if let Some(kit) = program {
                groups[sender] = Groups { kit, choke: kit.values().get(Param::Choke) };
            } else if let EventKind::Param { param: Param::Choke, value } = kind {
                groups[sender].choke = Param::Choke.info().clamp(value);
            }
            let is_for_all = match kind {
                EventKind::Choke { group } => group != 0,
                EventKind::Tempo(_) => true,
                _ => false,
            };
            if sender != *channel && !is_for_all {
                continue;
            }
            let at = (event.frame as usize).saturating_sub(start).min(last).max(frame);
            synth.play(&mut left[frame..at], &mut right[frame..at]);
            frame = at;
            match program {
                Some(kit) => synth.set_kit(kit),
                None => synth.handle(&Event { kind, ..*event }),
            }
            *heard |= !synth.is_silent();
        }
        if *heard {
            synth.play(&mut left[frame..], &mut right[frame..]);
        } else {
            synth.pass(frames - frame);
        }
    }
}

fn add(sum: &mut [f32], part: &[f32]) {
    sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Notes;

    const FRAMES: usize = 480;

    fn on(channel: u8, key: u8) -> Event {
        let kind = EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: -1 };
        Event { frame: 20, channel, kind }
    }

    fn off(channel: u8, key: u8) -> Event {
        Event { frame: 0, channel, kind: EventKind::NoteOff { key, velocity: 0.5, id: -1 } }
    }

    /// What a synth and an ensemble make of the events, each a block of its own.
    fn both(events: &[Event]) -> [Vec<f32>; 2] {
        let patch = Patch::default().with(Param::Release, 0.01);
        let mut synth = Synth::new(48_000.0, 0);
        synth.set_patch(&patch);
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]);
        let (mut alone, mut mixed) = (Vec::new(), Vec::new());
        for event in events {
            let (mut left, mut right) = ([9.0; FRAMES], [9.0; FRAMES]);
            synth.process(&[*event], &mut left, &mut right);
            alone.extend(left);
            ensemble.process(&[*event], &mut left, &mut right);
            mixed.extend(left);
        }
        [alone, mixed]
    }

    #[test]
    fn channels_and_keys_beyond_midi_are_the_last() {
        let expected = both(&[on(15, 127), off(15, 127)]);
        assert!(expected.iter().flatten().any(|sample| sample.abs() > 0.01), "it sounds");
        assert!(expected[0] != both(&[on(15, 127), off(0, 127)])[0], "a note-off elsewhere releases nothing");
        for (channel, key) in [(16, 127), (31, 200), (255, 255), (15, 128)] {
            assert!(both(&[on(channel, key), off(15, 127)]) == expected, "{channel} {key}");
            assert!(both(&[on(15, 127), off(channel, key)]) == expected, "{channel} {key}");
            let notes = Notes { id: None, channel: Some(channel), key: Some(key) };
            let release = Event { frame: 0, channel, kind: EventKind::Release { notes, velocity: 0.5 } };
            assert!(both(&[on(15, 127), release]) == expected, "{channel} {key}");
        }
        let mut ensemble = Ensemble::new(48_000.0, 0, &Patch::default(), &[]);
        ensemble.set_kit(200, &Kit::of_patch(&Patch::default().with(Param::Gain, -3.0)));
        assert_eq!(ensemble.parts[15].synth.values().get(Param::Gain), -3.0);
    }

    #[test]
    fn the_members_of_a_zone_play_on_their_master_s_instrument() {
        let control = |channel, controller, value: u8| {
            let kind = EventKind::Control { controller, value: f32::from(value) / 127.0 };
            Event { frame: 0, channel, kind }
        };
        let bend = |channel, bend| Event { frame: 0, channel, kind: EventKind::PitchBend(bend) };
        let pressure = |channel| Event { frame: 7, channel, kind: EventKind::ChannelPressure(0.7) };
        for (master, first, second) in [(0, 1, 15), (15, 14, 3)] {
            let zone = [control(master, 101, 0), control(master, 100, 6), control(master, 6, 15)];
            let notes = [bend(first, 0.25), on(first, 57), on(second, 60), bend(second, -0.5), bend(master, 1.0)];
            let rest = [pressure(first), off(first, 57), control(master, 64, 127), off(second, 60), on(second, 60)];
            let events: Vec<Event> = zone.into_iter().chain(notes).chain(rest).collect();
            let [alone, mixed] = both(&events);
            // Seeds differ by channel, but nothing here is random.
            assert!(alone == mixed, "{master}");
            assert!(alone.iter().any(|sample| sample.abs() > 0.01), "it sounds");
        }
    }

    #[test]
    fn channels_keep_what_they_hold_when_a_zone_is_made_or_dissolved() {
        let at = |frame, channel, kind| Event { frame, channel, kind };
        let control = |frame, channel, controller, value: u8| {
            at(frame, channel, EventKind::Control { controller, value: f32::from(value) / 127.0 })
        };
        let zone =
            |frame, members| [control(frame, 0, 101, 0), control(frame, 0, 100, 6), control(frame, 0, 6, members)];
        let note = |frame, channel, key| at(frame, channel, on(channel, key).kind);
        let events: Vec<Event> = [control(5, 2, 7, 30), control(5, 2, 10, 100), at(6, 2, EventKind::PitchBend(0.5))]
            .into_iter()
            .chain([note(90, 2, 50), note(100, 5, 64)])
            .chain(zone(100, 15))
            .chain([note(100, 2, 57), note(101, 3, 60), control(1500, 2, 7, 90)])
            .chain(zone(1600, 0))
            .chain([note(1600, 2, 59), note(2000, 3, 62)])
            .collect();
        // Short, so that what was struck before a zone is over when its channel moves on.
        let patch = Patch::default().with(Param::Release, 0.005).with(Param::Limiter, 0.0);
        let mut synth = Synth::new(48_000.0, 0);
        synth.set_patch(&patch);
        let mut alone = ([0.0; 3000], [0.0; 3000]);
        synth.process(&events, &mut alone.0, &mut alone.1);
        for block in [3000, 7, 64] {
            let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]).with_chunk(50);
            let mut mixed = (vec![], vec![]);
            for start in (0..3000).step_by(block) {
                let frames = block.min(3000 - start);
                let here = events.iter().filter(|event| (start..start + frames).contains(&(event.frame as usize)));
                let here: Vec<Event> =
                    here.map(|event| Event { frame: event.frame - start as u32, ..*event }).collect();
                let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
                ensemble.process(&here, &mut left, &mut right);
                mixed.0.extend(left);
                mixed.1.extend(right);
            }
            // In one synth, an event on one channel makes the notes of others set out anew for the same place.
            let worst = |one: &[f32], other: &[f32]| {
                one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f32::max)
            };
            let worst = [worst(&alone.0, &mixed.0), worst(&alone.1, &mixed.1)];
            assert!(worst.iter().all(|worst| *worst < 0.01), "blocks of {block}: {worst:?}");
        }
        assert!(alone.0.iter().any(|sample| sample.abs() > 0.01), "it sounds");
    }

    #[test]
    fn keys_that_are_held_while_a_zone_is_made_are_let_go() {
        let data = |controller, value: u8| {
            let kind = EventKind::Control { controller, value: f32::from(value) / 127.0 };
            Event { frame: 0, channel: 0, kind }
        };
        let mut ensemble = Ensemble::new(48_000.0, 0, &Patch::default().with(Param::Release, 0.01), &[]);
        let (mut left, mut right) = ([0.0; FRAMES], [0.0; FRAMES]);
        ensemble.process(&[on(5, 60)], &mut left, &mut right);
        ensemble.process(&[data(101, 0), data(100, 6), data(6, 15)], &mut left, &mut right);
        (0..10).for_each(|_| ensemble.process(&[], &mut left, &mut right));
        assert!(ensemble.is_silent());
    }

    #[test]
    fn of_sides_that_differ_in_length_the_shorter_counts() {
        let patch = Patch::default();
        for (left_frames, right_frames) in [(100, 400), (400, 100), (0, 400)] {
            let mut synth = Synth::new(48_000.0, 0);
            let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]).with_chunk(64);
            let (mut left, mut right) = (vec![9.0; left_frames], vec![9.0; right_frames]);
            synth.process(&[on(0, 60)], &mut left, &mut right);
            let alone = (left.clone(), right.clone());
            left.fill(9.0);
            right.fill(9.0);
            ensemble.process(&[on(0, 60)], &mut left, &mut right);
            assert!((left.clone(), right.clone()) == alone);
            let frames = left_frames.min(right_frames);
            for side in [&left, &right] {
                assert!(side[..frames].iter().all(|sample| *sample != 9.0));
                assert!(side[frames..].iter().all(|sample| *sample == 9.0), "the rest stays as it was");
            }
            assert!(frames == 0 || left[..frames].iter().any(|sample| sample.abs() > 0.01), "it sounds");
            // The next block goes on where this one has ended.
            let (mut rest, mut whole) = (([0.0; 300], [0.0; 300]), ([0.0; 400], [0.0; 400]));
            synth.process(&[], &mut rest.0, &mut rest.1);
            let mut other = Synth::new(48_000.0, 0);
            other.process(&[on(0, 60)], &mut whole.0, &mut whole.1);
            assert!(frames == 0 || whole.0[frames..] == rest.0[..400 - frames]);
        }
    }
}
