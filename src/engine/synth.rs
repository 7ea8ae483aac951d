//! The instrument: one patch, its voices, and a stream of events in; stereo samples out.

use super::channel::{Channel, Wheels};
use super::controls::Smoother;
use super::event::{Expression, finite, unit};
use super::midi::{controller, seven_bits};
use super::modulation::{Bus, SharedLfos, modulated};
use super::note::{Note, Notes, nearest_channel, nearest_key};
use super::voice::{Instrument, SynthVoice, footprint};
use super::voice_manager::{Footprint, PlayMode, Priority, VoiceManager, VoicePool, has_room, make_room};
use super::zones::{MEMBER_BEND_RANGE, Zones};
use super::{Event, EventKind, Snapshot};
use crate::dsp::limiter::Work;
use crate::dsp::{CONTROL_FRAMES, Cell, Limiter};
use crate::params::{Change, PARAM_COUNT, PARAMS, Param};
use crate::patch::Patch;
use crate::sound::Tuning;
use crate::sound::tuning::Pitch;

/// Sample rates that the engine runs at, in Hz.
pub const SAMPLE_RATES: std::ops::RangeInclusive<u32> = 1_000..=768_000;

/// A synthesizer that plays one patch on sixteen channels (as MPE uses them).
///
/// The same seed, patch, events and sample rate give the same bits, however the frames are divided into blocks.
/// Only [`Synth::new`] and [`Synth::prepare`] allocate; everything else is real-time safe.
pub struct Synth {
    manager: VoiceManager<SynthVoice>,
    /// The size of its own pool of voices; none for a part of an ensemble, which makes room for its notes.
    own_pool: Option<Footprint>,
    instrument: Instrument,
    tuning: Tuning,
    smoother: Smoother,
    limiter: Limiter,
    channels: [Channel; 16],
    zones: Zones,
    /// How far each parameter is moved away from its value, in knob travel.
    offsets: [f32; PARAM_COUNT],
    /// Frames until the gains of all channels have arrived.
    gains_moving: u32,
    /// A patch since the start has had routes.
    has_routes: bool,
    /// Changes of the smoother that the instrument's settings have, if they have arrived.
    settings_changes: Option<u32>,
    /// The frame at which the instrument's shared oscillators are.
    shared_clock: u64,
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
        let pool = voices(sample_rate, POOL);
        Self { own_pool: Some(POOL), ..Self::with_voices(sample_rate, seed, pool) }
    }

    /// A synth that plays on voices of this pool and has none other.
    pub(super) fn with_voices(sample_rate: f64, seed: u64, pool: VoicePool<SynthVoice>) -> Self {
        let sample_rate = allowed(sample_rate);
        let patch = Patch::default();
        let smoother = Smoother::new(sample_rate, &patch, DEFAULT_BEAT_RATE);
        let controls = smoother.after(0);
        let instrument = Instrument::new(patch, sample_rate, seed, controls);
        let mut synth = Self {
            manager: VoiceManager::new(pool),
            own_pool: None,
            instrument,
            tuning: Tuning::EQUAL,
            smoother,
            limiter: Limiter::new(sample_rate),
            channels: [Channel::new(sample_rate); 16],
            zones: Zones::default(),
            offsets: [0.0; PARAM_COUNT],
            gains_moving: 0,
            has_routes: false,
            settings_changes: None,
            shared_clock: 0,
            note_serial: 0,
            clock: 0,
            needs_control: false,
        };
        synth.configure();
        synth
    }

    /// Changes the sample rate and starts anew, keeping the patch and the tuning.
    pub fn prepare(&mut self, sample_rate: f64) {
        let (patch, tuning) = (self.instrument.patch.clone(), self.tuning);
        *self = Self::new(sample_rate, self.instrument.seed);
        (self.instrument.patch, self.tuning) = (patch, tuning);
        self.reset();
    }

    /// Silences everything and forgets all controllers, modulation and tempo; the patch and the tuning stay. What
    /// follows is what a new synth would play.
    pub fn reset(&mut self) {
        let sample_rate = self.instrument.sample_rate;
        self.manager.reset();
        self.limiter.reset();
        self.instrument.modulated = self.instrument.patch.clone();
        self.smoother = Smoother::new(sample_rate, &self.instrument.modulated, DEFAULT_BEAT_RATE);
        self.settings_changes = None;
        self.instrument.controls = self.smoother.after(0);
        self.instrument.last_pitch = None;
        self.instrument.bus = Bus::new(&self.instrument.patch.routes);
        (self.instrument.shared, self.shared_clock) = (SharedLfos::new(self.instrument.seed), 0);
        self.has_routes = !self.instrument.bus.is_empty();
        (self.instrument.patch_serial, self.instrument.body_serial) = (0, 0);
        self.channels = [Channel::new(sample_rate); 16];
        self.zones = Zones::default();
        self.offsets = [0.0; PARAM_COUNT];
        (self.gains_moving, self.note_serial, self.clock, self.needs_control) = (0, 0, 0, false);
        self.configure();
    }

    /// What is random of notes starts from another seed with the next one; shared oscillators go on. Real-time safe.
    pub fn set_seed(&mut self, seed: u64) {
        self.instrument.seed = seed;
    }

    /// Tunes the keys in another way from the next note on. Notes that sound keep their pitch. Real-time safe.
    pub fn set_tuning(&mut self, tuning: &Tuning) {
        self.tuning = *tuning;
    }

    /// The tuning in use. Real-time safe.
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// Plays another patch from the next note on. Notes that sound go on with the sound that they have.
    pub fn set_patch(&mut self, patch: &Patch) {
        self.instrument.patch = patch.clone();
        self.instrument.modulated = patch.clone();
        for info in PARAMS {
            let offset = self.offsets[info.param as usize];
            self.instrument.modulated.set(info.param, modulated(patch, info.param, offset));
        }
        self.instrument.patch_serial += 1;
        self.instrument.body_serial += 1;
        self.instrument.bus = Bus::new(&patch.routes);
        self.has_routes |= !self.instrument.bus.is_empty();
        // Voices of the old patch keep its controls, so the new ones need no slope.
        let beat_rate = self.smoother.beat_rate();
        self.smoother = Smoother::new(self.instrument.sample_rate, &self.instrument.modulated, beat_rate);
        self.settings_changes = None;
        self.configure();
    }

    /// The patch in use, with the parameters as last set, modulation left out.
    pub fn patch(&self) -> &Patch {
        &self.instrument.patch
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
            self.limiter.process(self.instrument.patch.get(Param::Limiter) != 0.0, left, right);
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
                self.instrument.controls = self.smoother.after(0);
                let brightness = brightness(&self.channels, &self.zones, index);
                self.move_shared(0);
                if self.has_routes {
                    let wheels = wheels(&self.channels, &self.zones, index);
                    self.instrument.positions = wheels.positions(brightness.into());
                }
                let key = nearest_key(key);
                let pitch = self.tuning.pitch(key);
                let soft = |channel: u8| self.channels[usize::from(channel)].soft;
                let note = Note {
                    pitch: pitch.unwrap_or(Pitch::Semitones(key.into())),
                    detune: finite(detune).clamp(-128.0, 128.0),
                    velocity: unit(velocity),
                    soft: soft(index) || self.zones.master_of(index).is_some_and(soft),
                    brightness,
                    id,
                    is_legato: self.manager.has_key_down(),
                    ..self.next_note(index, key)
                };
                self.note_serial += 1;
                if pitch.is_none() {
                    return self.manager.turn_away(note);
                }
                self.make_room(&note);
                if self.manager.note_on(&self.instrument, note) {
                    self.instrument.last_pitch = Some(self.instrument.pitch(&note));
                }
            }
            EventKind::NoteOff { key, velocity, id } => {
                let notes = Notes { id: (id != -1).then_some(id), ..Notes::on(index, key) };
                self.manager.note_off(&self.instrument, notes, unit(velocity));
            }
            EventKind::Release { notes, velocity } => {
                self.manager.note_off(&self.instrument, notes, unit(velocity));
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
                self.instrument.patch.set(param, value);
                self.take_over(param);
            }
            EventKind::Modulate { id: None, param, offset } => {
                self.offsets[param as usize] = finite(offset).clamp(-1.0, 1.0);
                self.take_over(param);
            }
            EventKind::Modulate { id: Some(id), param, offset } => {
                // Notes that were given no identifier cannot be meant.
                if id >= 0 && matches!(param.info().change, Change::Smoothed(_)) {
                    let (now, offset) = (self.smoother.value_after(param, 0), finite(offset).clamp(-1.0, 1.0));
                    let meant = self.manager.active().filter(|(note, _)| note.id == id);
                    meant.for_each(|(_, voice)| voice.modulate(&self.instrument, param, offset, now));
                }
            }
            EventKind::Tempo(beats_per_minute) => {
                self.move_shared(0);
                self.smoother.set_tempo(f64::from(finite(beats_per_minute).clamp(1.0, 10_000.0)) / 60.0);
            }
            EventKind::Choke { group } => self.manager.choke(group),
            EventKind::Program(_) => {}
        }
    }

    /// What is known of the next note before it starts.
    fn next_note(&self, channel: u8, key: u8) -> Note {
        Note {
            channel,
            key,
            serial: self.note_serial,
            patch: self.instrument.patch_serial,
            body: self.instrument.body_serial,
            choke: self.instrument.modulated.get(Param::Choke) as u8,
            ..Note::NONE
        }
    }

    /// What a note on a channel takes from the pool if it starts now.
    pub(super) fn need(&self, channel: u8, key: u8) -> Footprint {
        let (channel, key) = (nearest_channel(channel), nearest_key(key));
        match self.tuning.pitch(key) {
            Some(_) => self.manager.need(&self.instrument, &self.next_note(channel, key)),
            None => Footprint::NONE,
        }
    }

    /// The most that a note of a patch takes from the pool; of the patch in use if none is given.
    pub(super) fn footprint(&self, patch: Option<&Patch>) -> Footprint {
        let Some(patch) = patch else { return footprint(&self.instrument.modulated, 0.0) };
        footprint(patch, self.offsets[Param::Unison as usize])
    }

    /// Its manager.
    pub(super) fn manager(&mut self) -> &mut VoiceManager<SynthVoice> {
        &mut self.manager
    }

    /// Makes room in its own pool for a note.
    fn make_room(&mut self, note: &Note) {
        if let Some(capacity) = self.own_pool {
            let need = self.manager.need(&self.instrument, note);
            if !has_room(capacity, self.manager.pool().free(), need) {
                make_room(std::slice::from_mut(&mut self.manager), |manager| manager, capacity, need);
            }
        }
    }

    /// A parameter has a new value or offset.
    fn take_over(&mut self, param: Param) {
        let value = modulated(&self.instrument.patch, param, self.offsets[param as usize]);
        self.instrument.modulated.set(param, value);
        // Sounding voices cannot take these over without a click: notes from now on have their own.
        if matches!(param, Param::Coefficients | Param::Width) {
            self.instrument.body_serial += 1;
        }
        // Until now, shared oscillators have had the rate before.
        self.move_shared(0);
        self.smoother.set(param, value);
        self.manager.active().for_each(|(_, voice)| voice.follow(&self.instrument));
        self.configure();
    }

    fn express(&mut self, notes: Notes, expression: Expression, value: f32) {
        for (note, voice) in self.manager.active().filter(|(note, _)| notes.include(note)) {
            let brightness = brightness(&self.channels, &self.zones, note.channel);
            voice.express(&self.instrument, expression, value, brightness);
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
                    let on_channel = self.manager.active().filter(|(note, _)| note.channel == channel);
                    on_channel.for_each(|(_, voice)| voice.shade(&self.instrument, brightness));
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
                let controls = self.smoother.after(to_tick as u32);
                self.move_shared(to_tick as u32);
                for (note, voice) in self.manager.active() {
                    let wheels = wheels(&self.channels, &self.zones, note.channel);
                    let controls = (note.patch == self.instrument.patch_serial).then_some(&controls);
                    voice.control(&self.instrument, controls, &self.smoother, wheels, to_tick);
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

    /// Moves the shared oscillators to this frame, and reads what modulators are to follow `ahead` frames from now: if
    /// there are any routes to follow them.
    fn move_shared(&mut self, ahead: u32) {
        if !self.has_routes {
            return;
        }
        let seconds = (self.clock - self.shared_clock) as f64 / self.instrument.sample_rate;
        self.shared_clock = self.clock;
        // Values that slide are read again, until those that they slide to have been read.
        let changes = self.smoother.changes(ahead);
        if changes.is_none() || changes != self.settings_changes {
            let Instrument { bus, settings, .. } = &self.instrument;
            self.instrument.settings = self.smoother.settings_after(ahead, settings, bus);
        }
        self.settings_changes = changes;
        self.instrument.shared.advance(&self.instrument.settings, seconds);
    }

    /// Lets time pass for everything but the voices: all there is to do while none sounds.
    pub(super) fn pass(&mut self, frames: usize) {
        self.clock += frames as u64;
        self.smoother.advance(frames as u32);
        if self.gains_moving > 0 {
            self.channels.iter_mut().for_each(|channel| channel.advance(frames as u32));
            self.gains_moving = self.gains_moving.saturating_sub(frames as u32);
        }
    }

    /// Hands the manager the parameters that are its own.
    fn configure(&mut self) {
        let patch = &self.instrument.modulated;
        let mode = match patch.get(Param::Mode) as u32 {
            0 => PlayMode::Poly,
            1 => PlayMode::Mono,
            _ => PlayMode::Legato,
        };
        let priority = match patch.get(Param::Priority) as u32 {
            0 => Priority::Last,
            1 => Priority::Low,
            _ => Priority::High,
        };
        self.manager.configure(patch.get(Param::Voices) as usize, mode, priority, self.instrument.patch_serial);
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
    let controls = Smoother::new(sample_rate, &Patch::default(), DEFAULT_BEAT_RATE).after(0);
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
