//! How several threads render the notes of a synth: each note by itself, added up as by one thread.
//!
//! Between two events no note depends on another, and what they share moves by the clock alone. So a note takes a copy of that, and
//! plays up to the next event at once. Every voice has a sum of its own, since rounding depends on the order in which voices are
//! added: the output is bit for bit that of one thread.

use super::Synth;
use super::channels::Channels;
use super::process::{Stretch, add, part};
use crate::engine::instrument::Instrument;
use crate::engine::voice::SynthVoice;
use crate::engine::voice_manager::Slot;
use crate::engine::workers::Workers;

/// Notes are handed out if they have at least this many frames to render in all, which takes some 50 µs or more; waking a thread takes
/// some 10 µs.
const SHARED_FRAMES: usize = 2048;

/// A note up to the next event.
struct NoteApart<'a> {
    index: usize,
    slot: &'a mut Slot<SynthVoice>,
    /// Copies of what it shares with other notes.
    instrument: Option<Instrument>,
    channels: Channels,
    clock: u64,
    needs_control: bool,
    /// Left and right of each voice.
    voices: Vec<[Vec<f32>; 2]>,
    /// The frame of the control tick at which the note was over, if it was.
    end: Option<usize>,
}

impl NoteApart<'_> {
    /// Plays `frames` frames, as [`Synth::render`] would.
    fn play(&mut self, input: &[f32], frames: usize) {
        self.voices = self.slot.voices().map(|_| [vec![0.0; frames], vec![0.0; frames]]).collect();
        let mut frame = 0;
        while frame < frames {
            let stretch = Stretch::new(self.clock, frames - frame);
            if stretch.is_tick {
                self.slot.voices_mut().for_each(|(_, voice)| voice.settle());
                if self.slot.is_over() {
                    self.end = Some(frame);
                    return;
                }
            }
            if stretch.is_tick || self.needs_control {
                if let Some(instrument) = &mut self.instrument {
                    instrument.look_ahead(self.clock, stretch.to_tick as u32);
                }
                for (note, voice) in self.slot.voices_mut() {
                    voice.control(self.instrument.as_ref(), self.channels.wheels(note.channel), stretch.to_tick);
                    voice.sweep(stretch.to_tick);
                }
                self.needs_control = false;
            }
            let end = frame + stretch.frames;
            for ((_, voice), [left, right]) in self.slot.voices_mut().zip(&mut self.voices) {
                voice.render(part(input, frame, end), &mut left[frame..end], &mut right[frame..end]);
            }
            self.clock += stretch.frames as u64;
            if let Some(instrument) = &mut self.instrument {
                instrument.knobs.advance(stretch.frames as u32);
            }
            self.channels.advance(stretch.frames as u32);
            frame = end;
        }
    }
}

impl Synth {
    /// Whether there is enough to do for [`Synth::render_apart`]. Sums of pads are made by one thread.
    pub(super) fn has_notes_to_share(&self, frames: usize) -> bool {
        let notes = self.manager.count_notes();
        notes > 1 && notes * frames >= SHARED_FRAMES && self.pads.is_none()
    }

    /// Renders frames without events, and adds each voice to both slices, as [`Synth::render`] does. Allocates.
    pub(super) fn render_apart(&mut self, workers: &impl Workers, input: &[f32], left: &mut [f32], right: &mut [f32]) {
        let frames = left.len();
        let Self { manager, instruments, channels, clock, needs_control, .. } = self;
        let apart = |(index, slot): (usize, _)| {
            let slot: &mut Slot<_> = slot;
            let instrument = instruments.of_note(slot.note()).cloned();
            let (channels, clock, needs_control) = (channels.clone(), *clock, *needs_control);
            NoteApart { index, slot, instrument, channels, clock, needs_control, voices: Vec::new(), end: None }
        };
        let mut notes: Vec<_> = manager.notes_mut().map(apart).collect();
        workers.each(&mut notes, |note| note.play(input, frames));
        for [own_left, own_right] in notes.iter().flat_map(|note| &note.voices) {
            add(left, own_left);
            add(right, own_right);
        }
        let end = notes.iter().map(|note| note.end.unwrap_or(frames)).max().unwrap_or(0);
        let mut ended: Vec<_> = notes.iter().filter_map(|note| Some((note.end?, note.index))).collect();
        // In the order in which they end.
        ended.sort_unstable();
        manager.end(ended.into_iter().map(|(_, index)| index));
        self.follow_notes(frames, end);
    }

    /// Advances what notes share by `frames` frames. The last note is over at the control tick at frame `end`, if that comes.
    fn follow_notes(&mut self, frames: usize, end: usize) {
        let mut frame = 0;
        while frame < frames {
            if frame > end {
                self.needs_control = false;
                return self.pass(frames - frame);
            }
            let stretch = Stretch::new(self.clock, frames - frame);
            if stretch.is_tick || self.needs_control {
                self.instruments.control(self.clock, stretch.to_tick as u32);
                self.needs_control = false;
            }
            self.pass(stretch.frames);
            frame += stretch.frames;
        }
    }
}
