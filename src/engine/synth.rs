//! The instrument: one patch, its voices, and a stream of events in; stereo samples out.

use super::channel::{Channel, controller};
use super::controls::Smoother;
use super::voice::{Instrument, SynthVoice};
use super::voice_manager::{Note, PlayMode, VoiceManager};
use super::{Event, EventKind, Snapshot};
use crate::dsp::CONTROL_FRAMES;
use crate::params::Param;
use crate::patch::Patch;

/// Sample rates that the engine runs at, in Hz.
pub const SAMPLE_RATES: std::ops::RangeInclusive<u32> = 8_000..=768_000;

/// A synthesizer that plays one patch on sixteen channels (as MPE uses them).
///
/// The same seed, patch, events and sample rate give the same bits, however the frames are divided into blocks.
/// Only [`Synth::new`] and [`Synth::prepare`] allocate; everything else is real-time safe.
pub struct Synth {
    manager: VoiceManager<SynthVoice>,
    instrument: Instrument,
    smoother: Smoother,
    channels: [Channel; 16],
    /// Frames until the gains of all channels have arrived.
    gains_moving: u32,
    /// Counts the patches loaded.
    patch_serial: u32,
    /// Counts the notes started.
    note_serial: u64,
    /// Frames since the start: control ticks fall on its multiples of [`CONTROL_FRAMES`].
    clock: u64,
    /// Something has happened at this frame that voices have not yet heard of.
    news: bool,
}

impl Synth {
    /// A synth with the default patch. The sample rate is brought into [`SAMPLE_RATES`].
    pub fn new(sample_rate: f64, seed: u64) -> Self {
        let sample_rate = allowed(sample_rate);
        let patch = Patch::default();
        let smoother = Smoother::new(sample_rate, &patch);
        let controls = smoother.after(0);
        let mut synth = Self {
            manager: VoiceManager::new(|| SynthVoice::new(sample_rate, controls)),
            instrument: Instrument { patch, sample_rate, seed, controls, last_pitch: None },
            smoother,
            channels: [Channel::new(sample_rate); 16],
            gains_moving: 0,
            patch_serial: 0,
            note_serial: 0,
            clock: 0,
            news: false,
        };
        synth.configure();
        synth
    }

    /// Changes the sample rate and starts anew, keeping the patch.
    pub fn prepare(&mut self, sample_rate: f64) {
        let patch = self.instrument.patch;
        *self = Self::new(sample_rate, self.instrument.seed);
        self.instrument.patch = patch;
        self.reset();
    }

    /// Silences everything and forgets all controllers; the patch stays. What follows is what a new synth would play.
    pub fn reset(&mut self) {
        let sample_rate = self.instrument.sample_rate;
        self.manager.reset();
        self.smoother = Smoother::new(sample_rate, &self.instrument.patch);
        self.instrument.controls = self.smoother.after(0);
        self.instrument.last_pitch = None;
        self.channels = [Channel::new(sample_rate); 16];
        self.gains_moving = 0;
        (self.patch_serial, self.note_serial, self.clock, self.news) = (0, 0, 0, false);
        self.configure();
    }

    /// Plays another patch from the next note on. Notes that sound go on with the sound that they have.
    pub fn set_patch(&mut self, patch: &Patch) {
        self.instrument.patch = *patch;
        self.patch_serial += 1;
        // Voices of the old patch keep its controls, so the new ones need no slope.
        self.smoother = Smoother::new(self.instrument.sample_rate, patch);
        self.configure();
    }

    /// The patch in use, with the parameters as last set.
    pub fn patch(&self) -> &Patch {
        &self.instrument.patch
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

    /// Renders the next `left.len()` frames (any number) over what the slices hold; both are of one length.
    /// `events` are in order of their frames.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        left.fill(0.0);
        right.fill(0.0);
        let mut frame = 0;
        for event in events {
            let at = (event.frame as usize).min(left.len().saturating_sub(1)).max(frame);
            self.render(&mut left[frame..at], &mut right[frame..at]);
            self.handle(event);
            frame = at;
        }
        self.render(&mut left[frame..], &mut right[frame..]);
    }

    /// Takes in one event, at the frame that is rendered next.
    pub fn handle(&mut self, event: &Event) {
        let index = event.channel & 15;
        let channel = &mut self.channels[usize::from(index)];
        self.news = true;
        match event.kind {
            EventKind::NoteOn { key, detune, velocity, id } => {
                self.instrument.controls = self.smoother.after(0);
                let note = Note {
                    channel: index,
                    key: key & 127,
                    detune: finite(detune).clamp(-128.0, 128.0),
                    velocity: unit(velocity),
                    soft: channel.soft,
                    id,
                    serial: self.note_serial,
                    patch: self.patch_serial,
                    choke: self.instrument.patch.get(Param::Choke) as u8,
                };
                self.note_serial += 1;
                self.manager.note_on(&self.instrument, note);
                self.instrument.last_pitch = Some(self.instrument.pitch(&note));
            }
            EventKind::NoteOff { key, velocity, id } => {
                self.manager.note_off(&self.instrument, index, key & 127, id, unit(velocity));
            }
            EventKind::PolyPressure { key, pressure } => {
                for (note, voice) in self.manager.active() {
                    if (note.channel, note.key) == (index, key & 127) {
                        voice.pressure = unit(pressure);
                    }
                }
            }
            EventKind::ChannelPressure(pressure) => channel.pressure = unit(pressure),
            EventKind::PitchBend(bend) => channel.bend = finite(bend).clamp(-1.0, 1.0),
            EventKind::Control { controller, value } => self.control(index, controller, unit(value)),
            EventKind::Param { param, value } => {
                self.instrument.patch.set(param, value);
                // Sounding voices cannot take these over without a click: notes from now on have their own.
                if matches!(param, Param::Coefficients | Param::Width) {
                    self.patch_serial += 1;
                }
                self.smoother.set(param, self.instrument.patch.get(param));
                self.configure();
            }
            EventKind::Choke { group } => self.manager.choke(group),
            EventKind::Program(_) => {}
        }
    }

    fn control(&mut self, index: u8, number: u8, value: f32) {
        let down = value >= 0.5;
        match number {
            controller::SUSTAIN => self.manager.sustain(index, down),
            controller::SOSTENUTO => self.manager.sostenuto(index, down),
            controller::ALL_SOUND_OFF => self.manager.all_sound_off(index),
            // The mode messages 124–127 imply all notes off.
            controller::ALL_NOTES_OFF..=127 => self.manager.all_notes_off(index),
            _ => {}
        }
        if number == controller::RESET {
            self.manager.sustain(index, false);
            self.manager.sostenuto(index, false);
            let on_channel = self.manager.active().filter(|(note, _)| note.channel == index);
            on_channel.for_each(|(_, voice)| voice.pressure = 0.0);
        }
        let channel = &mut self.channels[usize::from(index)];
        channel.control(number, value);
        self.gains_moving = channel.ramp_frames();
    }

    /// Renders frames in which nothing happens, adding to both slices.
    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let (frames, mut frame) = (left.len(), 0);
        while frame < frames {
            let into_tick = (self.clock % CONTROL_FRAMES as u64) as usize;
            if self.manager.is_silent() {
                self.news = false;
                return self.pass(frames - frame);
            }
            let to_tick = CONTROL_FRAMES - into_tick;
            if into_tick == 0 {
                self.manager.active().for_each(|(_, voice)| voice.settle());
                self.manager.free_finished();
            }
            if into_tick == 0 || self.news {
                let controls = self.smoother.after(to_tick as u32);
                for (note, voice) in self.manager.active() {
                    voice.control(&controls, self.patch_serial, &self.channels[usize::from(note.channel)], to_tick);
                }
                self.manager.active().for_each(|(_, voice)| voice.sweep(to_tick));
                self.news = false;
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
        self.smoother.advance(frames as u32);
        if self.gains_moving > 0 {
            self.channels.iter_mut().for_each(|channel| channel.advance(frames as u32));
            self.gains_moving = self.gains_moving.saturating_sub(frames as u32);
        }
    }

    /// Hands the manager the parameters that are its own.
    fn configure(&mut self) {
        let patch = &self.instrument.patch;
        let mode = match patch.get(Param::Mode) as u32 {
            0 => PlayMode::Poly,
            1 => PlayMode::Mono,
            _ => PlayMode::Legato,
        };
        self.manager.configure(patch.get(Param::Voices) as usize, mode);
    }
}

fn allowed(sample_rate: f64) -> f64 {
    let (lowest, highest) = SAMPLE_RATES.into_inner();
    if sample_rate.is_nan() { 48_000.0 } else { sample_rate.clamp(lowest.into(), highest.into()) }
}

fn finite(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value }
}

fn unit(value: f32) -> f32 {
    finite(value).clamp(0.0, 1.0)
}
