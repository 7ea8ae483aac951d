//! A kit, its voices, and a stream of events in; stereo samples out.

use super::channel::{Channel, Wheels};
use super::controls::Smoother;
use super::event::{Expression, finite, unit};
use super::instrument::Instrument;
use super::midi::{controller, seven_bits};
use super::modulation::{modulated, moved};
use super::note::{Note, Notes, nearest_channel, nearest_key};
use super::voice::{SynthVoice, footprint};
use super::voice_manager::{Footprint, PlayMode, Priority, Voice, VoiceManager, VoicePool, has_room, make_room};
use super::zones::{MEMBER_BEND_RANGE, Zones};
use super::{Event, EventKind, Snapshot};
use crate::dsp::limiter::Work;
use crate::dsp::{CONTROL_FRAMES, Cell, Limiter};
use crate::params::{self, Change, Choice, PARAM_COUNT, Param, Values};
use crate::patch::Patch;
use crate::sound::kit::Pad;
use crate::sound::tuning::Pitch;
use crate::sound::{Kit, Sound, Tuning};
use crate::units::gain_from_db;
use std::sync::Arc;

/// Sample rates that the engine runs at, in Hz.
pub const SAMPLE_RATES: std::ops::RangeInclusive<u32> = 1_000..=768_000;

/// A synthesizer that plays one kit on sixteen channels (as MPE uses them).
///
/// The same seed, kit, events and sample rate give the same bits, however the frames are divided into blocks.
/// [`Synth::new`], [`Synth::prepare`], [`Synth::reserve`] and [`Synth::set_patch`] allocate; everything else is real-time
/// safe.
pub struct Synth {
    manager: VoiceManager<SynthVoice>,
    /// The size of its own pool of voices; none for a part of an ensemble, which makes room for its notes.
    own_pool: Option<Footprint>,
    /// One for each sound of the kit: dropped before the kit, which has a handle of each sound.
    instruments: Vec<Instrument>,
    kit: Arc<Kit>,
    /// The parameters of the whole kit as they were set.
    values: Values,
    /// Serial number of the first instrument; the others follow it.
    first_patch: u32,
    /// Counts the bodies.
    bodies: u32,
    sample_rate: f64,
    seed: u64,
    tuning: Tuning,
    limiter: Limiter,
    channels: [Channel; 16],
    zones: Zones,
    /// How far each parameter is moved away from its value, in knob travel.
    offsets: [f32; PARAM_COUNT],
    /// Frames until the gains of all channels have arrived.
    gains_moving: u32,
    /// Counts the notes started.
    note_serial: u64,
    /// Frames since the start: control ticks fall on its multiples of [`CONTROL_FRAMES`].
    clock: u64,
    /// An event was handled since the last `control()`: run it before rendering.
    needs_control: bool,
}

impl Synth {
    /// A synth with the default patch and voices of its own. The sample rate is brought into [`SAMPLE_RATES`].
    pub fn new(sample_rate: f64, seed: u64) -> Self {
        Self::with_kit(allowed(sample_rate), seed, Kit::of_patch(&Patch::default()))
    }

    /// A synth that plays on voices of this pool and has no other.
    pub(super) fn with_voices(sample_rate: f64, seed: u64, pool: VoicePool<SynthVoice>) -> Self {
        Self::with_pool(allowed(sample_rate), seed, Kit::of_patch(&Patch::default()), pool)
    }

    fn with_kit(sample_rate: f64, seed: u64, kit: Arc<Kit>) -> Self {
        Self { own_pool: Some(POOL), ..Self::with_pool(sample_rate, seed, kit, voices(sample_rate, POOL)) }
    }

    fn with_pool(sample_rate: f64, seed: u64, kit: Arc<Kit>, pool: VoicePool<SynthVoice>) -> Self {
        let (rates, offsets) = ([sample_rate, DEFAULT_BEAT_RATE], [0.0; PARAM_COUNT]);
        let instrument = |sound: &Arc<Sound>| Instrument::new(sound.clone(), rates, seed, &offsets, 0);
        let instruments: Vec<Instrument> = kit.sounds().iter().map(instrument).collect();
        let mut synth = Self {
            manager: VoiceManager::new(pool),
            own_pool: None,
            instruments,
            values: *kit.values(),
            kit,
            first_patch: 0,
            bodies: 0,
            sample_rate,
            seed,
            tuning: Tuning::EQUAL,
            limiter: Limiter::new(sample_rate),
            channels: [Channel::new(sample_rate); 16],
            zones: Zones::default(),
            offsets: [0.0; PARAM_COUNT],
            gains_moving: 0,
            note_serial: 0,
            clock: 0,
            needs_control: false,
        };
        synth.number();
        synth.configure();
        synth
    }

    /// Changes the sample rate and starts anew, keeping the kit, its parameters, the tuning and the room for other kits.
    pub fn prepare(&mut self, sample_rate: f64) {
        let mut synth = Self::with_kit(allowed(sample_rate), self.seed, self.kit.clone());
        (synth.values, synth.tuning) = (self.values, self.tuning);
        synth.reserve(self.instruments.capacity());
        synth.reset();
        *self = synth;
    }

    /// Makes room for kits of up to so many sounds, so that [`Synth::set_kit`] need not. Allocates.
    pub fn reserve(&mut self, sounds: usize) {
        self.instruments.reserve(sounds.saturating_sub(self.instruments.len()));
    }

    /// Silences everything and forgets all controllers, modulation and tempo; the kit, its parameters and the tuning
    /// stay. What follows is what a new synth would play.
    pub fn reset(&mut self) {
        let (sample_rate, seed) = (self.sample_rate, self.seed);
        self.manager.reset();
        self.limiter.reset();
        self.offsets = [0.0; PARAM_COUNT];
        for (instrument, sound) in self.instruments.iter_mut().zip(self.kit.sounds()) {
            *instrument = Instrument::new(sound.clone(), [sample_rate, DEFAULT_BEAT_RATE], seed, &self.offsets, 0);
            instrument.begin_at(moved_by(&self.kit, &self.values));
        }
        (self.first_patch, self.bodies) = (0, 0);
        self.number();
        self.channels = [Channel::new(sample_rate); 16];
        self.zones = Zones::default();
        (self.gains_moving, self.note_serial, self.clock, self.needs_control) = (0, 0, 0, false);
        self.configure();
    }

    /// What is random of notes starts from another seed with the next one; shared oscillators go on. Real-time safe.
    pub fn set_seed(&mut self, seed: u64) {
        self.seed = seed;
        self.instruments.iter_mut().for_each(|instrument| instrument.seed = seed);
    }

    /// Tunes the keys in another way from the next note on: those of sounds without a tuning of their own. Notes that
    /// sound keep their pitch. Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.tuning = *tuning;
    }

    /// The tuning in use. Real-time safe.
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// Plays another kit from the next note on. Notes that sound go on with the sound that they have. Parameters start
    /// again from [`Kit::values`].
    ///
    /// Real-time safe if there is room for its sounds ([`Synth::reserve`]) and somebody keeps the kit before
    /// ([`Shelf`](crate::sound::Shelf)).
    pub fn set_kit(&mut self, kit: &Arc<Kit>) {
        let (sounds, before) = (kit.sounds(), self.instruments.len());
        let goes_on = kit.is_single() && self.kit.is_single();
        let beat_rate = self.instruments[0].smoother.beat_rate();
        self.instruments.truncate(sounds.len());
        for (instrument, sound) in self.instruments.iter_mut().zip(sounds) {
            instrument.play(sound, &self.offsets);
            instrument.last_pitch.take_if(|_| !goes_on);
        }
        for sound in sounds.iter().skip(self.instruments.len()) {
            let rates = [self.sample_rate, beat_rate];
            let instrument = Instrument::new(sound.clone(), rates, self.seed, &self.offsets, self.clock);
            self.instruments.push(instrument);
        }
        // Only now: until here, the kit before has kept the sounds that were let go of.
        self.kit = kit.clone();
        self.values = *kit.values();
        self.first_patch = self.first_patch.wrapping_add(before as u32);
        self.number();
        self.configure();
    }

    /// As [`Synth::set_kit`], with a kit of one sound that is made of a patch. Allocates and frees.
    pub fn set_patch(&mut self, patch: &Patch) {
        self.set_kit(&Kit::of_patch(patch));
    }

    /// The kit in use. Real-time safe.
    pub fn kit(&self) -> &Arc<Kit> {
        &self.kit
    }

    /// The parameters of the kit as last set, modulation left out. Real-time safe.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// Gives each instrument the serial numbers that the notes of its sound have.
    fn number(&mut self) {
        for (instrument, patch) in self.instruments.iter_mut().zip(0_u32..) {
            self.bodies = self.bodies.wrapping_add(1);
            (instrument.patch_serial, instrument.body_serial) = (self.first_patch.wrapping_add(patch), self.bodies);
        }
    }

    /// Finished notes, kept until the next [`Synth::process`]. Each is reported once: when its voice is silent or plays
    /// another note, and no held key will return to it. After more than [`MAX_ENDED`] in one call the rest are not
    /// told.
    ///
    /// [`MAX_ENDED`]: super::voice_manager::MAX_ENDED
    pub fn ended(&self) -> &[Note] {
        self.manager.ended()
    }

    /// Frames until silence if nothing more happens: exact to a control tick ([`CONTROL_FRAMES`]) once strikes have
    /// ended and parameters have arrived where they slide to, no less than that during a strike; 0 if nothing sounds.
    /// Real-time safe: some microseconds a voice when something has happened to it, next to nothing otherwise.
    pub fn tail_frames(&mut self) -> u64 {
        let to_tick = (CONTROL_FRAMES as u64 - self.clock % CONTROL_FRAMES as u64) % CONTROL_FRAMES as u64;
        self.manager.active().map(|(_, voice)| voice.tail_frames(to_tick)).max().unwrap_or(0)
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

    /// Renders the next frames over what the slices hold: as many as the shorter of the two has (any number; they are
    /// meant to be of one length). The rest of a longer one stays as it is. `events` are in order of their frames.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let (left, right) = (&mut left[..frames], &mut right[..frames]);
        self.manager.clear_ended();
        let mut frame = 0;
        for event in events {
            let at = (event.frame as usize).min(frames.saturating_sub(1)).max(frame);
            self.play_limited(&mut left[frame..at], &mut right[frame..at]);
            self.handle(event);
            frame = at;
        }
        self.play_limited(&mut left[frame..], &mut right[frame..]);
    }

    fn play_limited(&mut self, left: &mut [f32], right: &mut [f32]) {
        let is_heard = self.play(left, right);
        if is_heard || !self.limiter.is_idle() {
            let limiter = self.values.choice::<params::Limiter>(Param::Limiter);
            self.limiter.process(limiter == params::Limiter::On, left, right);
        }
    }

    /// Renders frames in which nothing happens over what the slices hold, without the limiter. Returns whether there
    /// may be sound in them.
    pub(super) fn play(&mut self, left: &mut [f32], right: &mut [f32]) -> bool {
        left.fill(0.0);
        right.fill(0.0);
        let is_heard = !self.manager.is_silent();
        self.render(left, right);
        if is_heard {
            left.iter_mut().chain(right).for_each(|sample| *sample = without_subnormals(*sample));
        }
        is_heard
    }

    /// Takes in one event, at the frame that is rendered next.
    pub fn handle(&mut self, event: &Event) {
        let index = nearest_channel(event.channel);
        // A tempo can wait for the next control tick.
        self.needs_control |= !matches!(event.kind, EventKind::Tempo(_));
        match event.kind {
            EventKind::NoteOn { key, detune, velocity, id } => {
                let key = nearest_key(key);
                self.note_on(Note {
                    channel: index,
                    key,
                    pitch: Pitch::Semitones(key.into()),
                    detune: finite(detune).clamp(-128.0, 128.0),
                    velocity: unit(velocity),
                    brightness: brightness(&self.channels, &self.zones, index),
                    id,
                    is_legato: self.manager.has_key_down(),
                    serial: self.note_serial,
                    ..Note::NONE
                });
                self.note_serial += 1;
            }
            EventKind::NoteOff { key, velocity, id } => {
                let notes = Notes { id: (id != -1).then_some(id), ..Notes::on(index, key) };
                self.manager.note_off(&self.instruments[0], notes, unit(velocity));
            }
            // A kit of several sounds is polyphonic, in which no note returns to another.
            EventKind::Release { notes, velocity } => {
                self.manager.note_off(&self.instruments[0], notes, unit(velocity));
            }
            EventKind::Silence { notes } => self.manager.silence(notes),
            EventKind::PolyPressure { key, pressure } => {
                self.express(Notes::on(index, key), Expression::Pressure, pressure);
            }
            EventKind::Express { notes, expression, value } => self.express(notes, expression, value),
            EventKind::ChannelPressure(pressure) => self.channels[usize::from(index)].pressure = unit(pressure),
            EventKind::PitchBend(bend) => self.channels[usize::from(index)].bend = finite(bend).clamp(-1.0, 1.0),
            EventKind::Control { controller, value } => self.control(index, controller, unit(value)),
            EventKind::Param { param, value } => {
                self.values.set(param, value);
                self.take_over(param);
            }
            EventKind::Modulate { id: None, param, offset } => {
                self.offsets[param as usize] = finite(offset).clamp(-1.0, 1.0);
                self.take_over(param);
            }
            EventKind::Modulate { id: Some(id), param, offset } => {
                // Notes that were given no identifier cannot be meant.
                if id >= 0 && matches!(param.info().change, Change::Smoothed(_)) {
                    let offset = finite(offset).clamp(-1.0, 1.0);
                    for (note, voice) in self.manager.active().filter(|(note, _)| note.id == id) {
                        if let Some(instrument) = playing(&self.instruments, note) {
                            voice.modulate(instrument, param, offset, instrument.smoother.value_after(param, 0));
                        }
                    }
                }
            }
            EventKind::Tempo(beats_per_minute) => {
                let beat_rate = f64::from(finite(beats_per_minute).clamp(1.0, 10_000.0)) / 60.0;
                for instrument in &mut self.instruments {
                    instrument.move_shared(self.clock, 0);
                    instrument.smoother.set_tempo(beat_rate);
                }
            }
            EventKind::Choke { group } => self.manager.choke(group),
            EventKind::Program(_) => {}
        }
    }

    /// What a note on a channel takes from the pool if it starts now.
    pub(super) fn need(&self, channel: u8, key: u8) -> Footprint {
        let (channel, key) = (nearest_channel(channel), nearest_key(key));
        let Some((pad, ..)) = place(&self.kit, &self.tuning, key) else { return Footprint::NONE };
        let instrument = &self.instruments[pad.sound];
        let (patch, body) = (instrument.patch_serial, instrument.body_serial);
        self.manager.need(instrument, &Note { channel, key, patch, body, ..Note::NONE })
    }

    /// The most that a note of a kit takes from the pool; of the kit in use if none is given.
    pub(super) fn footprint(&self, kit: Option<&Kit>) -> Footprint {
        let most = |footprints: &mut dyn Iterator<Item = Footprint>| footprints.fold(Footprint::NONE, Footprint::max);
        let Some(kit) = kit else { return most(&mut self.instruments.iter().map(SynthVoice::footprint)) };
        let offset = self.offsets[Param::Unison as usize];
        most(&mut kit.sounds().iter().map(|sound| {
            let patch = sound.patch();
            footprint(&patch.modes, modulated(&patch.values, Param::Unison, offset))
        }))
    }

    /// Its manager.
    pub(super) fn manager(&mut self) -> &mut VoiceManager<SynthVoice> {
        &mut self.manager
    }

    /// A key goes down: the note, without what its pad, its sound and the pedals make of it.
    fn note_on(&mut self, mut note: Note) {
        let Some((pad, pitch, detune)) = place(&self.kit, &self.tuning, note.key) else {
            return self.manager.turn_away(note);
        };
        let soft = |channel: u8| self.channels[usize::from(channel)].soft;
        let choke = modulated(&self.values, Param::Choke, self.offsets[Param::Choke as usize]);
        let instrument = &mut self.instruments[pad.sound];
        instrument.controls = instrument.smoother.after(0);
        instrument.move_shared(self.clock, 0);
        if instrument.has_routes() {
            let wheels = wheels(&self.channels, &self.zones, note.channel);
            instrument.positions = wheels.positions(note.brightness.into(), |_| true);
        }
        note = Note {
            pitch,
            detune: note.detune + detune,
            soft: soft(note.channel) || self.zones.master_of(note.channel).is_some_and(soft),
            patch: instrument.patch_serial,
            body: instrument.body_serial,
            choke: self.kit.choke(pad, choke),
            gain: gain_from_db(pad.gain_db.into()) as f32,
            pan: pad.pan,
            ..note
        };
        if let Some(capacity) = self.own_pool {
            let need = self.manager.need(instrument, &note);
            if !has_room(capacity, self.manager.pool().free(), need) {
                make_room(std::slice::from_mut(&mut self.manager), |manager| manager, capacity, need);
            }
        }
        if self.manager.note_on(instrument, note) {
            instrument.last_pitch = Some(instrument.pitch(&note));
        }
    }

    /// A parameter of the kit has a new value or offset.
    fn take_over(&mut self, param: Param) {
        for instrument in &mut self.instruments {
            let (travel, offset) = (moved_by(&self.kit, &self.values), self.offsets[param as usize]);
            let value = travel(param, instrument.sound.patch().get(param));
            instrument.set(param, value, offset, self.clock);
            // Sounding voices cannot take these over without a click: notes from now on have their own.
            if matches!(param, Param::Coefficients | Param::Width) {
                self.bodies = self.bodies.wrapping_add(1);
                instrument.body_serial = self.bodies;
            }
        }
        for (note, voice) in self.manager.active() {
            playing(&self.instruments, note).into_iter().for_each(|instrument| voice.follow(instrument));
        }
        self.configure();
    }

    fn express(&mut self, notes: Notes, expression: Expression, value: f32) {
        for (note, voice) in self.manager.active().filter(|(note, _)| notes.include(note)) {
            let brightness = brightness(&self.channels, &self.zones, note.channel);
            voice.express(playing(&self.instruments, note), expression, value, brightness);
        }
    }

    fn control(&mut self, index: u8, number: u8, value: f32) {
        let down = value >= 0.5;
        for channel in self.zones.reach(index) {
            match number {
                controller::SUSTAIN => self.manager.sustain(channel, down),
                controller::SOSTENUTO => self.manager.sostenuto(channel, down),
                controller::ALL_SOUND_OFF => self.manager.all_sound_off(channel),
                // The mode messages 124–127 imply all notes off.
                controller::ALL_NOTES_OFF..=127 => self.manager.all_notes_off(channel),
                controller::RESET => {
                    self.manager.sustain(channel, false);
                    self.manager.sostenuto(channel, false);
                    let on_channel = self.manager.active().filter(|(note, _)| note.channel == channel);
                    on_channel.for_each(|(_, voice)| voice.relax());
                }
                _ => {}
            }
            // A master's wheels and pressure act beside its members' own; its reset is theirs as well.
            if channel == index || number == controller::RESET {
                self.channels[usize::from(channel)].control(number, value);
            }
        }
        self.gains_moving = self.channels[usize::from(index)].slope_frames();
        match number {
            controller::DATA | controller::DATA_FINE => self.enter(index, number, value),
            controller::BRIGHTNESS => {
                for channel in self.zones.reach(index) {
                    let brightness = brightness(&self.channels, &self.zones, channel);
                    self.manager.brighten(channel, brightness);
                    for (note, voice) in self.manager.active().filter(|(note, _)| note.channel == channel) {
                        voice.shade(playing(&self.instruments, note), brightness);
                    }
                }
            }
            _ => {}
        }
    }

    /// Data entry of what concerns several channels: the members of a zone, and their bend range.
    fn enter(&mut self, index: u8, number: u8, value: f32) {
        let channel = self.channels[usize::from(index)];
        if channel.awaits_bend_range() {
            let siblings = self.zones.siblings(index);
            siblings.for_each(|sibling| self.channels[usize::from(sibling)].bend_range = channel.bend_range);
        } else if channel.awaits_zone() && number == controller::DATA {
            self.configure_zone(index, seven_bits(value));
        }
    }

    /// What a channel holds, and for how many frames gains still slide.
    pub(super) fn channel(&self, channel: u8) -> (Channel, u32) {
        (self.channels[usize::from(channel)], self.gains_moving)
    }

    /// Takes over what another synth's channel held.
    pub(super) fn set_channel(&mut self, channel: u8, (held, gains_moving): (Channel, u32)) {
        self.channels[usize::from(channel)] = held;
        self.gains_moving = self.gains_moving.max(gains_moving);
    }

    /// Takes in an MPE configuration message: `members` channels are of the zone of a master.
    pub(super) fn configure_zone(&mut self, master: u8, members: u8) {
        let before = self.zones;
        self.zones.configure(master, members);
        self.needs_control = true;
        // Who changes masters starts anew: what the last one held is let go.
        for channel in (0..16).filter(|channel| before.master_of(*channel) != self.zones.master_of(*channel)) {
            self.manager.all_notes_off(channel);
            self.manager.sustain(channel, false);
            self.manager.sostenuto(channel, false);
            let member = self.zones.master_of(channel).is_some();
            self.channels[usize::from(channel)].bend_range = member.then_some(MEMBER_BEND_RANGE);
        }
    }

    /// Renders frames in which nothing happens, adding to both slices.
    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let (frames, mut frame) = (left.len(), 0);
        while frame < frames {
            let into_tick = (self.clock % CONTROL_FRAMES as u64) as usize;
            if self.manager.is_silent() {
                self.needs_control = false;
                return self.pass(frames - frame);
            }
            let to_tick = CONTROL_FRAMES - into_tick;
            if into_tick == 0 {
                self.manager.active().for_each(|(_, voice)| voice.settle());
                self.manager.free_finished();
            }
            if into_tick == 0 || self.needs_control {
                for instrument in &mut self.instruments {
                    instrument.look_ahead(self.clock, to_tick as u32);
                }
                for (note, voice) in self.manager.active() {
                    let wheels = wheels(&self.channels, &self.zones, note.channel);
                    voice.control(playing(&self.instruments, note), wheels, to_tick);
                }
                self.manager.active().for_each(|(_, voice)| voice.sweep(to_tick));
                self.needs_control = false;
            }
            let end = frames.min(frame + to_tick);
            for (_, voice) in self.manager.active() {
                voice.render(&mut left[frame..end], &mut right[frame..end]);
            }
            self.pass(end - frame);
            frame = end;
        }
    }

    /// Lets time pass for everything but the voices: all there is to do while none sounds.
    pub(super) fn pass(&mut self, frames: usize) {
        self.clock += frames as u64;
        self.instruments.iter_mut().for_each(|instrument| instrument.smoother.advance(frames as u32));
        if self.gains_moving > 0 {
            self.channels.iter_mut().for_each(|channel| channel.advance(frames as u32));
            self.gains_moving = self.gains_moving.saturating_sub(frames as u32);
        }
    }

    /// Hands the manager the parameters that are its own.
    fn configure(&mut self) {
        let value = |param| modulated(&self.values, param, self.offsets[param as usize]);
        let own = PlayMode::from_value(value(Param::Mode));
        let mode = if self.kit.is_single() { own } else { PlayMode::Poly };
        let priority = Priority::from_value(value(Param::Priority));
        self.manager.configure(value(Param::Voices) as usize, mode, priority, self.first_patch);
    }
}

/// The instrument that a note was started with, if its sound is still played.
fn playing<'a>(instruments: &'a [Instrument], note: &Note) -> Option<&'a Instrument> {
    let first = instruments.first()?.patch_serial;
    instruments.get(note.patch.wrapping_sub(first) as usize)
}

/// Where a key is played: its pad, and the pitch there with a rest in semitones. None for a key that is silent, because
/// it has no pad or its pitch no frequency.
pub(super) fn place<'a>(kit: &'a Kit, tuning: &Tuning, key: u8) -> Option<(&'a Pad, Pitch, f32)> {
    let pad = kit.pad(key)?;
    let tuning = kit.sounds().get(pad.sound)?.tuning().unwrap_or(tuning);
    let (key, rest) = match pad.pitch {
        None => (key, 0.0),
        Some(pitch) => {
            let nearest = libm::round(pitch).clamp(0.0, 127.0);
            (nearest as u8, (pitch - nearest) as f32)
        }
    };
    Some((pad, tuning.pitch(key)?, rest))
}

/// What a sound's own value of a parameter becomes while those of its kit have `values`. A single sound has the kit's
/// value; each of several is as many knob travels away from its own as the kit's value is from the default.
fn moved_by<'a>(kit: &'a Kit, values: &'a Values) -> impl Fn(Param, f32) -> f32 + 'a {
    move |param, own| {
        let (info, value) = (param.info(), values.get(param));
        let is_of_kit = matches!(param, Param::Voices | Param::Mode | Param::Priority | Param::Choke | Param::Limiter);
        match kit.is_single() {
            true => value,
            false if is_of_kit => own,
            false => moved(param, own, (info.normalise(value) - info.normalise(info.default)) as f32),
        }
    }
}

/// What a note on a channel follows of it and of the master of its zone.
fn wheels<'a>(channels: &'a [Channel; 16], zones: &Zones, channel: u8) -> Wheels<'a> {
    let of = |channel: u8| &channels[usize::from(channel)];
    Wheels { channel: of(channel), master: zones.master_of(channel).map(of) }
}

/// Brightness of a channel and the master of its zone, −0.5 to 0.5.
fn brightness(channels: &[Channel; 16], zones: &Zones, channel: u8) -> f32 {
    let of = |channel: u8| channels[usize::from(channel)].brightness;
    (of(channel) + zones.master_of(channel).map_or(0.0, of)).clamp(-0.5, 0.5)
}

/// What a synth of its own can sound: 64 notes of 64 modes with 64 more that fade, or 24 of 512.
const POOL: Footprint = Footprint { voices: 256, cells: 256 };

/// A pool of voices. Allocates.
pub(super) fn voices(sample_rate: f64, capacity: Footprint) -> VoicePool<SynthVoice> {
    let sample_rate = allowed(sample_rate);
    let controls = Smoother::new(sample_rate, &Values::default(), DEFAULT_BEAT_RATE).after(0);
    VoicePool::full(capacity, || SynthVoice::new(sample_rate, controls), || Cell::new(sample_rate))
}

/// MIDI's tempo before it has been set: 120 beats a minute.
const DEFAULT_BEAT_RATE: f64 = 2.0;

pub(super) fn allowed(sample_rate: f64) -> f64 {
    let (lowest, highest) = SAMPLE_RATES.into_inner();
    if sample_rate.is_nan() { 48_000.0 } else { sample_rate.clamp(lowest.into(), highest.into()) }
}

/// Zero for a number so small that CPUs take a hundred times as long for it: what is left of −60 dB of gain or of the
/// far end of a pan law when the sound itself has all but died away.
fn without_subnormals(sample: f32) -> f32 {
    if sample.abs() < f32::MIN_POSITIVE { 0.0 } else { sample }
}
