//! How a synth responds to events: notes, note expressions, parameters and their modulation.

use super::Synth;
use crate::engine::event::{Event, EventKind, Expression, finite, unit};
use crate::engine::note::{Note, Notes, nearest_channel, nearest_key};
use crate::engine::voice_manager::{has_room, make_room};
use crate::params::{Change, Param};
use crate::sound::contact::velocity_of;
use crate::sound::tuning::Pitch;

impl Synth {
    /// Handles one event, at the frame that is rendered next.
    pub fn handle(&mut self, event: &Event) {
        // An offset that changes nothing must not cause a control tick, since hosts repeat offsets at the borders of blocks.
        if let EventKind::Modulate { id: None, param, offset } = event.kind
            && self.instruments.offset(param) == finite(offset).clamp(-1.0, 1.0)
        {
            return;
        }
        let channel = nearest_channel(event.channel);
        // A new tempo takes effect at the next regular control tick.
        self.needs_control |= !matches!(event.kind, EventKind::Tempo(_));
        let was_silent = self.is_silent();
        match event.kind {
            EventKind::NoteOn { key, detune, velocity, id } => {
                let detune = finite(detune).clamp(-128.0, 128.0);
                self.key_down(Note { channel, key, detune, velocity: unit(velocity), id, ..Note::NONE });
            }
            EventKind::Strike { key, contact } => {
                let velocity = velocity_of(contact.impulse);
                self.key_down(Note { channel, key, velocity, contact: Some(contact), ..Note::NONE });
            }
            EventKind::Nudge { key, mode, amplitude } => {
                for (note, voice) in self.manager.sounding_on(channel, key) {
                    if let Some(instrument) = self.instruments.of_note(note) {
                        voice.nudge(instrument, mode.into(), unit(amplitude));
                    }
                }
            }
            EventKind::NoteOff { key, velocity, id } => {
                self.note_off(Notes { id, ..Notes::on(channel, key) }, velocity);
            }
            EventKind::Release { notes, velocity } => self.note_off(notes, velocity),
            EventKind::Silence { notes } => self.manager.silence(notes),
            EventKind::PolyPressure { key, pressure } => {
                self.express(Notes::on(channel, key), Expression::Pressure, pressure);
            }
            EventKind::Express { notes, expression, value } => self.express(notes, expression, value),
            EventKind::ChannelPressure(pressure) => self.channels.press(channel, unit(pressure)),
            EventKind::PitchBend(bend) => self.channels.bend(channel, finite(bend).clamp(-1.0, 1.0)),
            EventKind::Control { controller, value } => self.control(channel, controller, unit(value)),
            EventKind::Param { param, value } => {
                self.instruments.set(param, value, self.clock);
                self.follow_param();
            }
            EventKind::Modulate { id: None, param, offset } => {
                self.instruments.modulate(param, finite(offset).clamp(-1.0, 1.0), self.clock);
                self.follow_param();
            }
            EventKind::Modulate { id: Some(id), param, offset } => {
                self.modulate_notes(|note| note.id == Some(id), param, offset);
            }
            EventKind::ModulateNotes { notes, param, offset } => {
                self.modulate_notes(|note| notes.include(note), param, offset);
            }
            EventKind::Tempo(beats_per_minute) => {
                let beat_rate = f64::from(finite(beats_per_minute).clamp(1.0, 10_000.0)) / 60.0;
                self.instruments.set_tempo(beat_rate, self.clock);
            }
            EventKind::Tune { key, pitch, sounding } => {
                self.tune(nearest_key(key), finite(pitch).clamp(0.0, 128.0), sounding)
            }
            EventKind::Choke { group } => self.manager.choke(group),
            EventKind::Program(_) => {}
        }
        self.set_effects(was_silent);
    }

    /// Presses a key. The channel and the synth complete the note.
    fn key_down(&mut self, note: Note) {
        let (key, glide) = (nearest_key(note.key), self.channels.glide(note.channel));
        self.note_on(Note {
            key,
            pitch: Pitch::Semitones(key.into()),
            brightness: self.channels.brightness(note.channel),
            is_legato: self.manager.has_key_down(),
            glide,
            serial: self.note_serial,
            ..note
        });
        self.note_serial += 1;
    }

    /// Starts a note. The pad, the sound and the soft pedal complete it first.
    fn note_on(&mut self, mut note: Note) {
        note.output = self.output(&note);
        let Some(instrument) = self.instruments.start(&mut note, self.clock) else {
            if !self.leaves_out_notes {
                self.manager.turn_away(note);
            }
            return;
        };
        note.soft = self.channels.is_soft(note.channel);
        if instrument.has_routes() {
            instrument.positions = self.channels.wheels(note.channel).positions(note.brightness.into(), |_| true);
        }
        if let Some(capacity) = self.own_pool {
            let need = self.manager.need(instrument, &note);
            if !has_room(capacity, self.manager.pool().free(), need) {
                make_room(std::slice::from_mut(&mut self.manager), |manager| manager, capacity, need);
            }
        }
        if self.leaves_out_notes {
            instrument.last_pitch = Some(instrument.pitch(&note));
            return;
        }
        if self.manager.note_on(instrument, note) {
            instrument.last_pitch = Some(instrument.pitch(&note));
            self.behind.strike(&instrument.bus, &instrument.struck(&note));
            self.newest = note;
        }
        if let Some(pads) = &mut self.pads {
            let is_sounding = |serial| self.manager.sounding_voices().any(|(note, _)| note.serial == serial);
            pads.begin(&note, self.instruments.kit(), is_sounding);
        }
    }

    /// Gives a key another pitch, in semitones on the MIDI scale, and moves the sounding notes that have its pitch there if `sounding`
    /// says so.
    fn tune(&mut self, key: u8, pitch: f32, sounding: bool) {
        let pitch = Pitch::Semitones(pitch.into());
        self.instruments.tune(key, pitch);
        let kit = self.instruments.kit();
        for (note, voice) in self.manager.active().filter(|(note, _)| sounding && kit.follows(note.key, key)) {
            if let Some(instrument) = self.instruments.of_note(note) {
                let by = instrument.pitch(&Note { pitch, ..*note }) - instrument.pitch(note);
                let brightness = self.channels.brightness(note.channel);
                voice.express(Some(instrument), Expression::Tuning, by as f32, brightness);
            }
        }
    }

    /// Releases the keys of these notes.
    fn note_off(&mut self, notes: Notes, velocity: f32) {
        // The first instrument is for a voice that returns to a held key, which can only happen in a kit of one sound.
        self.manager.note_off(self.instruments.first(), notes, unit(velocity));
    }

    fn express(&mut self, notes: Notes, expression: Expression, value: f32) {
        for (note, voice) in self.manager.active().filter(|(note, _)| notes.include(note)) {
            let brightness = self.channels.brightness(note.channel);
            voice.express(self.instruments.of_note(note), expression, value, brightness);
        }
    }

    /// Sets the offset of a parameter for notes, in knob travel.
    fn modulate_notes(&mut self, are: impl Fn(&Note) -> bool, param: Param, offset: f32) {
        let offset = finite(offset).clamp(-1.0, 1.0);
        if !matches!(param.info().change, Change::Smoothed(_)) {
            return;
        }
        for (note, voice) in self.manager.active().filter(|(note, _)| are(note)) {
            if let Some(instrument) = self.instruments.of_note(note) {
                voice.modulate(instrument, param, offset, instrument.knobs.after(param, 0));
            }
        }
    }

    /// Passes a parameter of the kit on to voices and manager, after its value or offset has changed.
    fn follow_param(&mut self) {
        for (note, voice) in self.manager.active() {
            self.instruments.of_note(note).into_iter().for_each(|instrument| voice.follow(instrument));
        }
        self.configure_manager();
    }
}
