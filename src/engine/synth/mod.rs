//! A synth: it plays a kit from a stream of events and renders stereo samples.

mod channels;
mod controllers;
mod events;
mod instruments;
mod notes_apart;
mod outputs;
mod pads;
mod process;

use super::controls::Controls;
use super::modulation::Behind;
use super::note::{EndedNote, Note, nearest_channel, nearest_key};
use super::space::Space;
use super::voice::SynthVoice;
use super::voice_manager::{Footprint, PlayMode, Priority, VoiceManager, VoicePool};
use super::{Snapshot, VoiceState};
use crate::dsp::limiter::Work;
use crate::dsp::{Cell, Limiter};
use crate::params::{Choice, Param, Values};
use crate::patch::Patch;
use crate::sound::{Kit, Tuning};
use channels::Channels;
use instruments::{DEFAULT_BEAT_RATE, Instruments};
pub use outputs::Outputs;
pub(crate) use pads::PadGroup;
use pads::PadSums;
use std::sync::Arc;

pub(super) use process::{add, flush, part, silence_inaudible};

/// Sample rates that the engine runs at, in Hz.
pub const SAMPLE_RATES: std::ops::RangeInclusive<u32> = 1_000..=768_000;

/// Returns an error if a sample rate in Hz is not one of [`SAMPLE_RATES`].
///
/// # Errors
/// A message that says what would be right.
pub(crate) fn check_rate(sample_rate: u32) -> Result<(), String> {
    let (low, high) = SAMPLE_RATES.into_inner();
    if SAMPLE_RATES.contains(&sample_rate) {
        Ok(())
    } else {
        Err(format!("{sample_rate} is out of range: expected {low} to {high} Hz"))
    }
}

/// Size of a synth's own pool: for 64 notes of 64 modes with 64 more that fade, or for 24 notes of 512 modes.
const POOL: Footprint = Footprint { voices: 256, cells: 256 };

/// A synthesizer that plays one kit on sixteen MIDI channels, which can form MPE zones.
///
/// The same seed, kit, events and sample rate give the same output, bit for bit, for all block sizes.
/// [`Synth::new`], [`Synth::prepare`], [`Synth::reserve`], [`Synth::reserve_space`] and [`Synth::set_patch`] allocate.
/// [`Synth::set_kit`] is real-time safe under the conditions in its documentation. All other methods always are.
pub struct Synth {
    manager: VoiceManager<SynthVoice>,
    /// The size of its own pool of voices. None for a part of an ensemble, where the ensemble makes room for notes.
    own_pool: Option<Footprint>,
    instruments: Instruments,
    channels: Channels,
    /// The effects after the voices.
    space: Space,
    /// The routes that move them, and the note by whose strike and channel they do.
    behind: Behind,
    newest: Note,
    limiter: Limiter,
    /// Number of notes started so far.
    note_serial: u64,
    /// Whether notes are counted and do not sound.
    leaves_out_notes: bool,
    /// Frames since the start. Control ticks are at the multiples of [`CONTROL_FRAMES`](crate::dsp::CONTROL_FRAMES).
    clock: u64,
    /// An event was handled since the last `control_tick()`: run it before rendering.
    needs_control: bool,
    /// The pads of kits by themselves, if their stems are wanted.
    pads: Option<Box<PadSums>>,
}

impl Synth {
    /// A synth with the default patch and its own pool of voices. The sample rate is clamped to [`SAMPLE_RATES`].
    pub fn new(sample_rate: f64, seed: u64) -> Self {
        Self::with_own_voices(Instruments::new(allowed(sample_rate), seed, Kit::of_patch(&Patch::default())))
    }

    /// A synth that takes its voices from this pool.
    pub(super) fn with_voices(sample_rate: f64, seed: u64, pool: VoicePool<SynthVoice>) -> Self {
        Self::with_pool(Instruments::new(allowed(sample_rate), seed, Kit::of_patch(&Patch::default())), pool)
    }

    fn with_own_voices(instruments: Instruments) -> Self {
        let pool = voices(instruments.sample_rate(), POOL);
        Self { own_pool: Some(POOL), ..Self::with_pool(instruments, pool) }
    }

    fn with_pool(instruments: Instruments, pool: VoicePool<SynthVoice>) -> Self {
        let sample_rate = instruments.sample_rate();
        let mut synth = Self {
            manager: VoiceManager::new(pool),
            own_pool: None,
            instruments,
            channels: Channels::new(sample_rate),
            space: Space::new(sample_rate),
            behind: Behind::NONE,
            newest: Note::NONE,
            limiter: Limiter::new(sample_rate),
            note_serial: 0,
            leaves_out_notes: false,
            clock: 0,
            needs_control: false,
            pads: None,
        };
        synth.configure_manager();
        synth.set_effects(true);
        synth
    }

    /// Changes the sample rate and restarts the synth. It keeps the kit, its parameters, the tuning and the reserved
    /// room.
    pub fn prepare(&mut self, sample_rate: f64) {
        let sample_rate = allowed(sample_rate);
        let space = self.space.at_rate(sample_rate);
        *self = Self { space, ..Self::with_own_voices(self.instruments.at_rate(sample_rate)) };
        self.set_effects(true);
    }

    /// Makes room for kits of up to `sounds` sounds, so that [`Synth::set_kit`] does not allocate. Allocates.
    pub fn reserve(&mut self, sounds: usize) {
        self.instruments.reserve(sounds);
    }

    /// Makes room for soundboxes, sympathetic strings and any body of the space: 4 MB. Without room these stay off, unless a kit
    /// has them when it is set. Allocates; the first call in a process takes some 10 ms.
    pub fn reserve_space(&mut self) {
        self.space.reserve();
        self.set_effects(self.is_silent());
    }

    /// Silences everything and resets controllers, modulation and tempo. The kit, its parameters and the tuning stay.
    /// From here on the output is that of a new synth.
    pub fn reset(&mut self) {
        self.manager.reset();
        self.limiter.reset();
        self.instruments.reset();
        self.behind = Behind::NONE;
        self.space.reset();
        self.channels = Channels::new(self.instruments.sample_rate());
        self.set_effects(true);
        (self.note_serial, self.clock, self.needs_control) = (0, 0, false);
        self.configure_manager();
    }

    /// Sets the seed of the random numbers, from the next note on. Shared oscillators continue. Real-time safe.
    pub fn set_seed(&mut self, seed: u64) {
        self.instruments.set_seed(seed);
    }

    /// Sets the tuning of all sounds that have none of their own, from the next note on. Sounding notes keep their
    /// pitch. Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.instruments.set_tuning(tuning);
    }

    /// Frames per second.
    pub(super) fn sample_rate(&self) -> f64 {
        self.instruments.sample_rate()
    }

    /// The tuning in use. Real-time safe.
    pub(crate) fn tuning(&self) -> &Tuning {
        self.instruments.tuning()
    }

    /// Plays another kit from the next note on. Sounding notes keep their sound. Parameters start again from
    /// [`Kit::values`]. The effects after the voices change for all notes, within 20 ms; routes move them from the next note on.
    ///
    /// Real-time safe if there is room for the kit's sounds ([`Synth::reserve`]) and for its soundbox, strings and space, if it has
    /// any ([`Synth::reserve_space`]), and if someone else holds the previous kit ([`Collector`](crate::sound::Collector)), so
    /// that it is not freed here.
    pub fn set_kit(&mut self, kit: &Arc<Kit>) {
        self.instruments.set_kit(kit, self.clock);
        self.make_room_for(kit);
        self.configure_manager();
        self.behind = Behind::NONE;
        self.set_effects(self.is_silent());
    }

    /// Makes room for the effects of a kit that will be set. Allocates.
    pub(super) fn make_room_for(&mut self, kit: &Kit) {
        self.space.reserve_for(kit);
    }

    /// As [`Synth::set_kit`], with a kit made of one patch. Allocates and frees.
    pub fn set_patch(&mut self, patch: &Patch) {
        self.set_kit(&Kit::of_patch(patch));
    }

    /// Sets all parameters of the kit at once, without smoothing: earlier values do not affect new notes. Sounding
    /// notes jump to the values, so call it while nothing sounds. Modulation stays. Real-time safe.
    pub fn set_values(&mut self, values: &Values) {
        self.instruments.set_values(values, self.clock);
        for (note, voice) in self.manager.active() {
            self.instruments.of_note(note).into_iter().for_each(|instrument| voice.follow(instrument));
        }
        self.needs_control = true;
        self.configure_manager();
        self.set_effects(self.is_silent());
    }

    /// The kit in use. Real-time safe.
    pub fn kit(&self) -> &Arc<Kit> {
        self.instruments.kit()
    }

    /// The parameters of the kit as last set, without modulation. Real-time safe.
    pub fn values(&self) -> &Values {
        self.instruments.values()
    }

    /// Finished notes, kept until the next [`Synth::process`]. Each is reported once: when its voice is silent or plays
    /// another note, and no held key will return to it. At most `MAX_ENDED` are kept; the rest are not reported.
    pub fn ended(&self) -> &[EndedNote] {
        self.manager.ended()
    }

    /// Whether nothing sounds, neither notes nor the effects after them.
    pub fn is_silent(&self) -> bool {
        self.manager.is_silent() && !self.space.is_awake()
    }

    /// Adds the voices that sound now to a snapshot. Real-time safe.
    pub fn show(&self, snapshot: &mut Snapshot) {
        snapshot.set_limiter(self.limiter.gain());
        let newest = self.manager.sounding_voices().min_by(|(_, one), (_, other)| one.age().total_cmp(&other.age()));
        // The modes of a kit's other sounds are others.
        let shown = newest.map(|(note, _)| note.patch);
        for (note, voice) in self.manager.sounding_voices() {
            snapshot.add(note, voice, Some(note.patch) == shown);
        }
    }

    /// Calls `visit` with each voice that sounds now, in an order that is always the same. Real-time safe if `visit` is and
    /// strikes are not told apart; else it forgets those that have ended, which frees memory.
    pub(crate) fn each_voice(&mut self, visit: &mut dyn FnMut(VoiceState<'_>)) {
        for (note, voice) in self.manager.active() {
            visit(VoiceState::new(note, voice));
            voice.forget_ended_strikes();
        }
    }

    /// The largest number of notes that have sounded at once.
    pub fn voices_used(&self) -> usize {
        self.manager.peak()
    }

    /// How much the limiter has reduced the level since the synth was created or reset. Real-time safe.
    pub fn limiter_work(&self) -> Work {
        self.limiter.work()
    }

    /// The voices and cells that a note of this key on a channel would take from the pool if it started now.
    pub(super) fn need(&self, channel: u8, key: u8) -> Footprint {
        let (channel, key) = (nearest_channel(channel), nearest_key(key));
        let Some(instrument) = self.instruments.of_key(key) else { return Footprint::NONE };
        let (patch, body) = (instrument.patch_serial, instrument.body_serial);
        self.manager.need(instrument, &Note { channel, key, patch, body, ..Note::NONE })
    }

    /// From now on, sums the pads of kits by themselves, for [`Synth::take_pads`]. Not real-time safe from here on.
    pub(super) fn sum_pads(&mut self) {
        self.pads = Some(Box::default());
    }

    /// Gives what the pads of kits have sounded like since the last call, before the effects: left and right of each group. What is
    /// missing at the end is silence.
    pub(super) fn take_pads(&mut self, visit: impl FnMut(PadGroup, [&[f32]; 2])) {
        if let Some(pads) = &mut self.pads {
            pads.take(visit);
        }
    }

    /// Whether notes are left out from now on. They do not sound, but those after them are the same as if they had: they keep their
    /// random numbers, and glide from the pitch before.
    pub(super) fn leave_out_notes(&mut self, leaves_out: bool) {
        self.leaves_out_notes = leaves_out;
    }

    /// The output of a note: its pad's, or in a kit of one sound, that of its channel. Channel 1 and the members of MPE zones,
    /// which play one part together, are on the main output, 0.
    fn output(&self, note: &Note) -> u8 {
        let kit = self.kit();
        match kit.pad(note.key).map_or(0, |pad| pad.output) {
            0 if kit.is_single() && note.channel > 0 && !self.channels.is_member(note.channel) => note.channel + 1,
            own => own,
        }
    }

    /// The most that a note of any sound of the kit takes from the pool.
    pub(super) fn footprint(&self) -> Footprint {
        self.instruments.footprint()
    }

    /// The most that a note of any sound of another kit would take from the pool.
    pub(super) fn footprint_of(&self, kit: &Kit) -> Footprint {
        self.instruments.footprint_of(kit)
    }

    /// The manager of its voices.
    pub(super) fn manager(&mut self) -> &mut VoiceManager<SynthVoice> {
        &mut self.manager
    }

    /// Gives the effects their parameters, with what routes make of them.
    fn set_effects(&mut self, at_once: bool) {
        match self.moved_effects() {
            Some(moved) => self.space.set(&moved, at_once),
            None => self.space.set(self.instruments.values(), at_once),
        }
    }

    /// What routes make of the parameters of the effects, if any route leads there.
    fn moved_effects(&self) -> Option<Values> {
        let instrument = self.instruments.of_note(&self.newest).filter(|_| self.behind.is_on())?;
        let positions = self.channels.wheels(self.newest.channel);
        let positions = positions.positions(self.channels.brightness(self.newest.channel).into(), |_| true);
        let mut moved = *self.instruments.values();
        let value = |param: Param| match param.is_behind_voices() {
            true => self.instruments.values().get(param),
            false => instrument.knobs.modulated(param),
        };
        self.behind.each_value(&positions, value, |param, value| moved.set(param, value));
        Some(moved)
    }

    /// Applies the parameters that belong to the voice manager.
    fn configure_manager(&mut self) {
        let value = |param| self.instruments.modulated(param);
        let mode = match self.instruments.kit().is_single() {
            true => self.channels.mode(PlayMode::from_value(value(Param::Mode))),
            false => PlayMode::Poly,
        };
        let priority = Priority::from_value(value(Param::Priority));
        self.manager.configure(value(Param::Voices) as usize, mode, priority, self.instruments.first_patch());
    }
}

/// A pool of voices. Allocates.
pub(super) fn voices(sample_rate: f64, capacity: Footprint) -> VoicePool<SynthVoice> {
    let sample_rate = allowed(sample_rate);
    let controls = Controls::new(|param| param.info().default, DEFAULT_BEAT_RATE);
    VoicePool::full(capacity, || SynthVoice::new(sample_rate, controls), || Cell::new(sample_rate))
}

/// The sample rate clamped to [`SAMPLE_RATES`]; 48 kHz for NaN.
pub(super) fn allowed(sample_rate: f64) -> f64 {
    let (lowest, highest) = SAMPLE_RATES.into_inner();
    if sample_rate.is_nan() { 48_000.0 } else { sample_rate.clamp(lowest.into(), highest.into()) }
}
