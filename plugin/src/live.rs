//! The audio thread: it follows the parameters, handles events at their frames, and renders.

use crate::chord::Chord;
use crate::events::translate;
use crate::link::Touch;
use crate::loaded::Loaded;
use crate::mts_esp;
use crate::params::{Look, SprungParams};
use crate::tail::Tail;
use nice_plug::prelude::*;
use nice_plug_core::midi::{Channel, Key, VoiceID};
use nice_plug_egui::RepaintNotifier;
use rtrb::Consumer;
use sprung::engine::{Event, EventKind, NoteId, Outputs, Snapshot, Synth};
use sprung::internals::display::TelemetryWriter;
use sprung::params::{Change, PARAM_COUNT, PARAMS, Param};
use sprung::sound::KEYS;
use sprung::units::mono_from_stereo;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// Frames rendered at a time if the output is mono.
const MONO_FRAMES: usize = 256;

/// Events that the wrapper can pass on in a block without allocating. A host may send all of VST3's 2,080 controllers
/// at once, several times in a block.
pub(crate) const EVENT_CAPACITY: usize = 8192;

/// Maximum number of voices.
pub(crate) const MAX_VOICES: u32 = sprung::internals::MAX_VOICES as u32;

/// A synth that a host plays. Real-time safe once built.
pub(crate) struct Live {
    synth: Synth,
    /// The loaded sound with its knob positions. It keeps the synth's kit alive. `SprungParams` also refers to it, so
    /// that the audio thread never frees it.
    loaded: Arc<Loaded>,
    /// The knob positions in the last block.
    positions: [f32; PARAM_COUNT],
    /// Offsets of the knobs by modulation of the whole instrument, in the last block.
    offsets: [f32; PARAM_COUNT],
    tempo: Option<f64>,
    /// Number of voices that was last reported to the host.
    voices: u32,
    tail: Tail,
    /// What the effect holds while nobody plays; the instrument has none.
    chord: Option<Chord>,
    /// The frequencies of keys that a master of MTS-ESP says, if its library is there.
    tuning: Option<mts_esp::Client>,
    /// Number of the synth's ended notes that have been reported to the host.
    reported: usize,
    /// Events that the wrapper delivered too early, with the part of the block before their own.
    early: Vec<NoteEvent<()>>,
    /// Buffers for the instrument's stereo output if the host has only one channel for it.
    stereo: [[f32; MONO_FRAMES]; 2],
    /// What is played in the window.
    touches: Consumer<Touch>,
    /// Whether the host renders to a file.
    is_offline: bool,
    telemetry: TelemetryWriter,
    repaint: RepaintNotifier,
}

impl Live {
    /// For a sample rate in Hz; `offline` if the host renders to a file. Allocates.
    pub(crate) fn new(sample_rate: f64, offline: bool, params: &SprungParams) -> Self {
        let loaded = params.loaded();
        let mut synth = Synth::new(sample_rate, loaded.seed);
        // Reserves room for every kit and space, so that the audio thread need not allocate.
        synth.reserve(KEYS);
        synth.reserve_space();
        synth.set_kit(&loaded.kit);
        synth.set_values(&loaded.values);
        let mut live = Self {
            synth,
            positions: loaded.positions,
            loaded,
            offsets: [0.0; PARAM_COUNT],
            tempo: None,
            voices: 0,
            tail: Tail::new(offline),
            chord: None,
            tuning: mts_esp::Client::register(),
            reported: 0,
            early: Vec::with_capacity(EVENT_CAPACITY),
            stereo: [[0.0; MONO_FRAMES]; 2],
            touches: params.link().connect(sample_rate),
            is_offline: offline,
            telemetry: TelemetryWriter::new(params.link().telemetry.clone(), sample_rate),
            repaint: params.link().repaint.clone(),
        };
        live.reset(params);
        live
    }

    /// Holds these keys from the next block on, while nobody plays: a bit for each key. Only the first call allocates.
    pub(crate) fn hold(&mut self, keys: u128) {
        self.chord.get_or_insert_default().hold(keys);
    }

    /// Silences everything, and restarts with the loaded sound.
    pub(crate) fn reset(&mut self, params: &SprungParams) {
        self.follow(params);
        self.synth.reset();
        (self.offsets, self.tempo, self.reported) = ([0.0; PARAM_COUNT], None, 0);
        self.early.clear();
        self.chord.iter_mut().for_each(Chord::reset);
        self.telemetry.reset();
    }

    /// Applies changes of the sound, of the knobs, and of the modulation of the whole instrument. While another thread
    /// is writing them, nothing changes until the next block.
    fn follow(&mut self, params: &SprungParams) {
        let Some(Look { positions, offsets, new_sound }) = params.look(&self.loaded) else { return };
        let before = std::mem::replace(&mut self.positions, positions);
        let moved = |index: usize| positions[index].to_bits() != before[index].to_bits();
        // While nothing sounds, values change without smoothing, so that values set before playing apply from the first
        // note on. The same holds for a new kit, which does not sound yet.
        let at_once = new_sound.is_some() || (self.synth.is_silent() && (0..PARAM_COUNT).any(moved));
        if let Some(loaded) = new_sound {
            self.synth.set_seed(loaded.seed);
            self.synth.set_kit(&loaded.kit);
            // Assigned last: until here, the previous `loaded` has kept the previous kit alive.
            self.loaded = loaded;
            self.chord.iter_mut().for_each(Chord::strike_again);
        }
        if at_once {
            self.tail.forget();
            self.synth.set_values(&self.loaded.values_at(&positions));
        } else {
            for (index, info) in PARAMS.iter().enumerate() {
                if moved(index) {
                    let value = self.loaded.value(index, positions[index]);
                    if info.change == Change::NextNote {
                        self.chord.iter_mut().for_each(Chord::strike_again);
                    }
                    self.handle(0, EventKind::Param { param: info.param, value });
                }
            }
        }
        for ((info, offset), before) in PARAMS.iter().zip(offsets).zip(std::mem::replace(&mut self.offsets, offsets)) {
            if offset != before {
                self.handle(0, EventKind::Modulate { id: None, param: info.param, offset });
            }
        }
    }

    /// Applies the song's tempo.
    fn follow_tempo(&mut self, tempo: Option<f64>) {
        if let Some(tempo) = tempo
            && self.tempo != Some(tempo)
        {
            self.tempo = Some(tempo);
            self.handle(0, EventKind::Tempo(tempo as f32));
        }
    }

    /// Applies the frequencies that a master of MTS-ESP says.
    fn follow_tuning(&mut self) {
        self.tuning.iter_mut().for_each(mts_esp::Client::look);
        let a4 = self.synth.values().get(Param::Tuning).into();
        for key in 0..KEYS as u8 {
            let Some(tuning) = &mut self.tuning else { return };
            if let Some(kind) = tuning.change(key, a4) {
                self.handle(0, kind);
            }
        }
    }

    /// Handles an event. A chord of the effect ends before a note that is played, and begins after the last one.
    fn handle(&mut self, channel: u8, kind: EventKind) {
        if let Some(chord) = &mut self.chord
            && chord.note_event(channel, &kind)
        {
            self.follow_chord();
        }
        self.pass_on(channel, kind);
        self.follow_chord();
    }

    /// Ends and begins notes of the chord, if there is one.
    fn follow_chord(&mut self) {
        while let Some(kind) = self.chord.as_mut().and_then(Chord::next_event) {
            self.pass_on(Chord::CHANNEL, kind);
        }
    }

    fn pass_on(&mut self, channel: u8, kind: EventKind) {
        self.tail.forget();
        let event = Event { frame: 0, channel, kind };
        self.note(&event);
        self.synth.handle(&event);
    }

    /// Publishes an event for the window, which shows keys and wheels also while nothing sounds.
    fn note(&mut self, event: &Event) {
        self.telemetry.note_event(event);
        self.repaint.request_repaint();
    }

    /// Plays the window's touches at the first frame of the block. Offline they are discarded: a click must not get
    /// into a file.
    fn follow_touches(&mut self) {
        // The number is limited, since the window may send more while this loop runs.
        for _ in 0..self.touches.buffer().capacity() {
            let Ok(touch) = self.touches.pop() else { return };
            if !self.is_offline {
                touch.events().for_each(|(channel, kind)| self.handle(channel, kind));
            }
        }
    }

    /// Renders a block and overwrites `outputs`, one channel or two, and the `others` beside them if there are any. `input` is
    /// the incoming sound: empty, or one sample per frame.
    pub(crate) fn process<P: Plugin<SysExMessage = ()>>(
        &mut self,
        params: &SprungParams,
        input: &[f32],
        outputs: &mut [&mut [f32]],
        others: &mut Option<Outputs<'_>>,
        context: &mut impl ProcessContext<P>,
    ) -> ProcessStatus {
        // Reading the clock takes no lock, and no system call on the supported systems.
        let start = self.telemetry.is_watched().then(Instant::now);
        self.follow(params);
        self.follow_tempo(context.transport().tempo);
        self.follow_tuning();
        self.follow_touches();
        self.follow_chord();
        // A change of the play mode may have ended notes that were waiting for a key.
        self.report_ended(0, context);
        let voices = self.synth.values().get(Param::Voices) as u32;
        if voices != self.voices {
            self.voices = voices;
            context.set_current_voice_capacity(voices);
        }
        let frames = outputs.first().map_or(0, |channel| channel.len());
        let mut frame = 0;
        for index in 0..self.early.len() {
            let event = self.early[index];
            self.take(&event, frame, context);
        }
        self.early.clear();
        while let Some(event) = context.next_event() {
            let at = (event.timing() as usize).max(frame);
            // The wrapper splits blocks at parameter changes, and delivers events at the frame of a change with the
            // part before it. Such events are kept for the next part: parameters at the same frame are always applied
            // first, wherever the host's blocks end.
            if at >= frames && self.early.len() < self.early.capacity() {
                self.early.push(event);
                continue;
            }
            let at = at.min(frames);
            self.render(input, outputs, others, frame..at, context);
            frame = at;
            self.take(&event, frame, context);
        }
        self.render(input, outputs, others, frame..frames, context);
        if !self.synth.is_silent() {
            self.repaint.request_repaint();
        }
        if let Some(start) = start {
            self.telemetry.note_block(frames, start.elapsed());
        }
        self.tail.status(&mut self.synth, frames)
    }

    /// Renders a block for the standalone program, with events at their frames. Overwrites the outputs.
    #[cfg(feature = "standalone")]
    pub(crate) fn play(&mut self, params: &SprungParams, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.follow(params);
        self.follow_tuning();
        self.follow_touches();
        events.iter().for_each(|event| self.note(event));
        self.synth.process(events, left, right);
        // This is also reported while no window is open: the program waits for silence before it ends.
        let synth = &self.synth;
        self.telemetry.note_sound(left, right, synth.is_silent(), || {
            let mut snapshot = Snapshot::default();
            synth.show(&mut snapshot);
            snapshot
        });
        if !self.synth.is_silent() {
            self.repaint.request_repaint();
        }
    }

    /// Reports how long the standalone program took to render a block.
    #[cfg(feature = "standalone")]
    pub(crate) fn note_block(&self, frames: usize, busy: std::time::Duration) {
        self.telemetry.note_block(frames, busy);
    }

    /// Handles one event at a frame of the block.
    fn take<P: Plugin<SysExMessage = ()>>(
        &mut self,
        event: &NoteEvent<()>,
        frame: usize,
        context: &mut impl ProcessContext<P>,
    ) {
        if let Some((channel, kind)) = translate(event, context.plugin_api()) {
            match (kind, &self.tuning) {
                (EventKind::NoteOn { key, id, .. }, Some(tuning)) if tuning.leaves_out(channel, key) => {
                    report_end(frame, (channel, key, id), context);
                }
                _ => self.handle(channel, kind),
            }
            self.report_ended(frame, context);
        }
    }

    /// Renders a range of the outputs, and reports the notes that ended to the host.
    fn render<P: Plugin<SysExMessage = ()>>(
        &mut self,
        input: &[f32],
        outputs: &mut [&mut [f32]],
        others: &mut Option<Outputs<'_>>,
        frames: Range<usize>,
        context: &mut impl ProcessContext<P>,
    ) {
        if frames.is_empty() {
            return;
        }
        let last = frames.end - 1;
        let input = &input[frames.start.min(input.len())..frames.end.min(input.len())];
        match outputs {
            [left, right, ..] => {
                let (left, right) = (&mut left[frames.clone()], &mut right[frames.clone()]);
                match others {
                    None => self.synth.process_with_input(&[], input, left, right),
                    Some(others) => {
                        self.synth.process_with_outputs(&[], input, left, right, &mut others.cut(frames));
                    }
                }
                note_sound(&mut self.telemetry, &self.synth, left, right);
                self.reported = 0;
                self.report_ended(last, context);
            }
            [mono] => {
                let inputs = input.chunks(MONO_FRAMES).chain(std::iter::repeat(&[][..]));
                for (part, input) in mono[frames].chunks_mut(MONO_FRAMES).zip(inputs) {
                    let [left, right] = &mut self.stereo;
                    let (left, right) = (&mut left[..part.len()], &mut right[..part.len()]);
                    self.synth.process_with_input(&[], input, left, right);
                    note_sound(&mut self.telemetry, &self.synth, left, right);
                    for ((mono, left), right) in part.iter_mut().zip(left).zip(right) {
                        *mono = mono_from_stereo(*left, *right);
                    }
                    self.reported = 0;
                    self.report_ended(last, context);
                }
            }
            [] => {}
        }
    }

    /// Reports to the host, at a frame of the block, the notes that have ended since the last report.
    fn report_ended<P: Plugin<SysExMessage = ()>>(&mut self, frame: usize, context: &mut impl ProcessContext<P>) {
        let ended = self.synth.ended();
        for note in ended.get(self.reported..).unwrap_or_default() {
            // The host knows nothing of the chord.
            if note.id.is_some_and(Chord::is_own) {
                continue;
            }
            report_end(frame, (note.channel, note.key, note.id), context);
        }
        self.reported = ended.len();
    }
}

/// Reports to the host that a note has ended.
fn report_end<P: Plugin<SysExMessage = ()>>(
    frame: usize,
    (channel, key, id): (u8, u8, Option<NoteId>),
    context: &mut impl ProcessContext<P>,
) {
    let voice_id = id.map_or(VoiceID::Wildcard, |id| VoiceID::ID(id.number()));
    let (channel, key) = (Channel::Number(channel), Key::Number(key));
    // An error means that the host accepts no events, or no more of them: it is ignored.
    let _ = context.try_send_event(NoteEvent::VoiceTerminated { timing: frame as u32, voice_id, channel, key });
}

/// Reports the sound to the window, if one is watching.
fn note_sound(telemetry: &mut TelemetryWriter, synth: &Synth, left: &[f32], right: &[f32]) {
    if telemetry.is_watched() {
        telemetry.note_sound(left, right, synth.is_silent(), || {
            let mut snapshot = Snapshot::default();
            synth.show(&mut snapshot);
            snapshot
        });
    }
}

#[cfg(test)]
mod tests;
