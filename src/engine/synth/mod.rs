//! A kit, its voices, and a stream of events in; stereo samples out.

mod channels;
mod controllers;
mod events;
mod instruments;
mod process;

use super::Snapshot;
use super::controls::Smoother;
use super::note::{Note, nearest_channel, nearest_key};
use super::voice::SynthVoice;
use super::voice_manager::{Footprint, PlayMode, Priority, VoiceManager, VoicePool};
use crate::dsp::limiter::Work;
use crate::dsp::{Cell, Limiter};
use crate::params::{Choice, Param, Values};
use crate::patch::Patch;
use crate::sound::{Kit, Tuning};
use channels::Channels;
use instruments::{DEFAULT_BEAT_RATE, Instruments};
use std::sync::Arc;

/// Sample rates that the engine runs at, in Hz.
pub const SAMPLE_RATES: std::ops::RangeInclusive<u32> = 1_000..=768_000;

/// What a synth of its own can sound: 64 notes of 64 modes with 64 more that fade, or 24 of 512.
const POOL: Footprint = Footprint { voices: 256, cells: 256 };

/// A synthesizer that plays one kit on sixteen channels (as MPE uses them).
///
/// The same seed, kit, events and sample rate give the same bits, however the frames are divided into blocks.
/// [`Synth::new`], [`Synth::prepare`], [`Synth::reserve`] and [`Synth::set_patch`] allocate; [`Synth::set_kit`] is
/// real-time safe on the conditions that it names, and everything else always.
pub struct Synth {
    manager: VoiceManager<SynthVoice>,
    /// The size of its own pool of voices; none for a part of an ensemble, which makes room for its notes.
    own_pool: Option<Footprint>,
    instruments: Instruments,
    channels: Channels,
    limiter: Limiter,
    /// Counts the notes started.
    note_serial: u64,
    /// Frames since the start: control ticks fall on its multiples of [`CONTROL_FRAMES`](crate::dsp::CONTROL_FRAMES).
    clock: u64,
    /// An event was handled since the last `control_tick()`: run it before rendering.
    needs_control: bool,
}

impl Synth {
    /// A synth with the default patch and voices of its own. The sample rate is brought into [`SAMPLE_RATES`].
    pub fn new(sample_rate: f64, seed: u64) -> Self {
        Self::with_own_voices(Instruments::new(allowed(sample_rate), seed, Kit::of_patch(&Patch::default())))
    }

    /// A synth that plays on voices of this pool and has no other.
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
            limiter: Limiter::new(sample_rate),
            note_serial: 0,
            clock: 0,
            needs_control: false,
        };
        synth.configure_manager();
        synth
    }

    /// Changes the sample rate and starts anew, keeping the kit, its parameters, the tuning and the room for other kits.
    pub fn prepare(&mut self, sample_rate: f64) {
        *self = Self::with_own_voices(self.instruments.at_rate(allowed(sample_rate)));
    }

    /// Makes room for kits of up to so many sounds, so that [`Synth::set_kit`] need not. Allocates.
    pub fn reserve(&mut self, sounds: usize) {
        self.instruments.reserve(sounds);
    }

    /// Silences everything and forgets all controllers, modulation and tempo; the kit, its parameters and the tuning
    /// stay. What follows is what a new synth would play.
    pub fn reset(&mut self) {
        self.manager.reset();
        self.limiter.reset();
        self.instruments.reset();
        self.channels = Channels::new(self.instruments.sample_rate());
        (self.note_serial, self.clock, self.needs_control) = (0, 0, false);
        self.configure_manager();
    }

    /// What is random of notes starts from another seed with the next one; shared oscillators go on. Real-time safe.
    pub fn set_seed(&mut self, seed: u64) {
        self.instruments.set_seed(seed);
    }

    /// Tunes the keys in another way from the next note on: those of sounds without a tuning of their own. Notes that
    /// sound keep their pitch. Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.instruments.set_tuning(tuning);
    }

    /// The tuning in use. Real-time safe.
    pub fn tuning(&self) -> &Tuning {
        self.instruments.tuning()
    }

    /// Plays another kit from the next note on. Notes that sound go on with the sound that they have. Parameters start
    /// again from [`Kit::values`].
    ///
    /// Real-time safe if there is room for its sounds ([`Synth::reserve`]) and somebody keeps the kit before
    /// ([`Shelf`](crate::sound::Shelf)).
    pub fn set_kit(&mut self, kit: &Arc<Kit>) {
        self.instruments.set_kit(kit, self.clock);
        self.configure_manager();
    }

    /// As [`Synth::set_kit`], with a kit of one sound that is made of a patch. Allocates and frees.
    pub fn set_patch(&mut self, patch: &Patch) {
        self.set_kit(&Kit::of_patch(patch));
    }

    /// Sets all parameters of the kit at once, without slopes: what was set before has no part in the notes from now on.
    /// Notes that sound jump, so this is for times when nothing does. Modulation stays. Real-time safe.
    pub fn set_values(&mut self, values: &Values) {
        self.instruments.set_values(values, self.clock);
        for (note, voice) in self.manager.active() {
            self.instruments.of_note(note).into_iter().for_each(|instrument| voice.follow(instrument));
        }
        self.needs_control = true;
        self.configure_manager();
    }

    /// The kit in use. Real-time safe.
    pub fn kit(&self) -> &Arc<Kit> {
        self.instruments.kit()
    }

    /// The parameters of the kit as last set, modulation left out. Real-time safe.
    pub fn values(&self) -> &Values {
        self.instruments.values()
    }

    /// Finished notes, kept until the next [`Synth::process`]. Each is reported once: when its voice is silent or plays
    /// another note, and no held key will return to it. At most [`MAX_ENDED`] are kept; the rest are not reported.
    ///
    /// [`MAX_ENDED`]: super::voice_manager::MAX_ENDED
    pub fn ended(&self) -> &[Note] {
        self.manager.ended()
    }

    /// Whether nothing sounds. An event may change that.
    pub fn is_silent(&self) -> bool {
        self.manager.is_silent()
    }

    /// Adds what sounds now to a snapshot. Real-time safe.
    pub fn show(&self, snapshot: &mut Snapshot) {
        self.manager.sounding_voices().for_each(|voice| snapshot.add(voice));
    }

    /// Most notes that have sounded at once.
    pub fn voices_used(&self) -> usize {
        self.manager.peak()
    }

    /// How much the limiter has worked since the synth was new or reset. Real-time safe.
    pub fn limiter_work(&self) -> Work {
        self.limiter.work()
    }

    /// What a note on a channel takes from the pool if it starts now.
    pub(super) fn need(&self, channel: u8, key: u8) -> Footprint {
        let (channel, key) = (nearest_channel(channel), nearest_key(key));
        let Some(instrument) = self.instruments.of_key(key) else { return Footprint::NONE };
        let (patch, body) = (instrument.patch_serial, instrument.body_serial);
        self.manager.need(instrument, &Note { channel, key, patch, body, ..Note::NONE })
    }

    /// The most that a note takes from the pool.
    pub(super) fn footprint(&self) -> Footprint {
        self.instruments.footprint()
    }

    /// The most that a note of another kit would take.
    pub(super) fn footprint_of(&self, kit: &Kit) -> Footprint {
        self.instruments.footprint_of(kit)
    }

    /// The manager of its voices.
    pub(super) fn manager(&mut self) -> &mut VoiceManager<SynthVoice> {
        &mut self.manager
    }

    /// Hands the manager the parameters that are its own.
    fn configure_manager(&mut self) {
        let value = |param| self.instruments.modulated(param);
        let mode = match self.instruments.kit().is_single() {
            true => PlayMode::from_value(value(Param::Mode)),
            false => PlayMode::Poly,
        };
        let priority = Priority::from_value(value(Param::Priority));
        self.manager.configure(value(Param::Voices) as usize, mode, priority, self.instruments.first_patch());
    }
}

/// A pool of voices. Allocates.
pub(super) fn voices(sample_rate: f64, capacity: Footprint) -> VoicePool<SynthVoice> {
    let sample_rate = allowed(sample_rate);
    let controls = Smoother::new(sample_rate, &Values::default(), DEFAULT_BEAT_RATE).after(0);
    VoicePool::full(capacity, || SynthVoice::new(sample_rate, controls), || Cell::new(sample_rate))
}

/// The nearest of the [`SAMPLE_RATES`]; 48 kHz for NaN.
pub(super) fn allowed(sample_rate: f64) -> f64 {
    let (lowest, highest) = SAMPLE_RATES.into_inner();
    if sample_rate.is_nan() { 48_000.0 } else { sample_rate.clamp(lowest.into(), highest.into()) }
}
