//! How an ensemble renders: it cuts blocks into chunks, every part renders a chunk on its own, and the parts are mixed.

use super::Ensemble;
use super::choke::Playing;
use super::chunk::Chunk;
use crate::engine::Event;
use crate::engine::synth::{part, silence_inaudible};
use crate::engine::workers::{Alone, Workers};
use crate::engine::zones::Owners;

/// The end of a chunk, and its reason.
struct Cut {
    /// How many of the events belong to the chunk.
    events: usize,
    /// The frame of the block at which it ends.
    end: usize,
    /// The last frame that an event of the chunk can have, counted from the chunk's start.
    last: usize,
    cause: Cause,
}

#[derive(Clone, Copy)]
enum Cause {
    /// The block ends, or the chunk has its maximum length.
    Length,
    /// The next event is a note for which the pool has no room. The choice of the notes to steal depends on the state of
    /// all parts at this frame, so all parts are rendered up to it.
    Pool,
    /// The next event configures an MPE zone. The owners of channels change only between two chunks.
    Zone { master: u8, members: u8 },
}

impl Cut {
    /// A chunk that starts at frame `start` of the block and ends before the event at `index`, which is at `frame` of
    /// the chunk.
    fn before(index: usize, start: usize, frame: usize, cause: Cause) -> Self {
        Self { events: index, end: start + frame, last: frame, cause }
    }
}

impl Ensemble {
    /// Renders the next frames and overwrites the slices: as many frames as the shorter one has (any number; they are
    /// meant to be equally long). The rest of a longer one stays unchanged. `events` are in order of their frames.
    /// Real-time safe.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        self.process_with_input(events, &[], left, right);
    }

    /// As [`Ensemble::process`], with the incoming sound `input`, as in
    /// [`Synth::process_with_input`](crate::engine::Synth::process_with_input). Real-time safe.
    pub(crate) fn process_with_input(&mut self, events: &[Event], input: &[f32], left: &mut [f32], right: &mut [f32]) {
        self.process_by(&Alone, events, input, left, right);
    }

    /// As [`Ensemble::process`], with the incoming sound `input`, but `workers` do the work: parts, and notes of a part, do not depend
    /// on each other. The output is bit for bit the same. As real-time safe as `workers` are.
    pub fn process_by(
        &mut self,
        workers: &impl Workers,
        mut events: &[Event],
        input: &[f32],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let (frames, mut start) = (left.len().min(right.len()), 0);
        // Runs at least once: a block without frames can still have events.
        loop {
            let owners = self.owners;
            let cut = self.cut(events, start, frames);
            let (now, later) = events.split_at(cut.events);
            let chunk = Chunk {
                events: now,
                input: part(input, start, cut.end),
                start,
                last: cut.last,
                frames: cut.end - start,
                owners,
                programs: &self.programs,
            };
            let groups = self.playing.each_ref().map(Playing::choke_groups);
            workers.each(&mut self.parts, |part| part.play(workers, &chunk, &groups));
            let is_heard = self.parts.iter().any(|part| part.is_heard);
            if !now.is_empty() {
                self.playing.iter_mut().zip(&self.parts).for_each(|(playing, part)| playing.follow(&part.synth));
            }
            if is_heard || !now.is_empty() {
                self.lender.take_back(&mut self.parts);
            }
            let (left, right) = (&mut left[start..cut.end], &mut right[start..cut.end]);
            left.fill(0.0);
            right.fill(0.0);
            // In channel order, since the rounding of the sum depends on the order of the additions.
            self.parts.iter().for_each(|part| part.add_to(left, right));
            let mix = [&mut *left, &mut *right];
            let rings = self.shared_space.as_mut().is_some_and(|space| space.process(&chunk, &self.parts, mix));
            if let Some(stems) = &mut self.stems {
                let space = self.shared_space.as_ref().filter(|_| rings).map(|space| space.output());
                stems.take(chunk.frames, &mut self.parts, space, self.gain);
            }
            if self.gain != 1.0 && (is_heard || rings) {
                left.iter_mut().chain(&mut *right).for_each(|sample| *sample *= self.gain);
            }
            self.limiter.process(&chunk, is_heard || rings, [&mut *left, &mut *right]);
            silence_inaudible(left, right);
            (events, start) = (later, cut.end);
            match cut.cause {
                Cause::Length if cut.end == frames => break,
                Cause::Length | Cause::Pool => {}
                Cause::Zone { master, members } => {
                    let Some((event, later)) = later.split_first() else { break };
                    self.configure_zone(owners, event, master, members);
                    events = later;
                }
            }
        }
    }

    /// Finds the end of the chunk that starts at frame `start` of a block of `frames` frames, and lends the parts the
    /// voices that their notes can need until then. Afterwards `self.owners` holds the owners after the chunk.
    fn cut(&mut self, events: &[Event], start: usize, frames: usize) -> Cut {
        let before = self.owners;
        let end = frames.min(start + self.chunk_frames);
        // An event beyond the end of the block counts as one at its last frame.
        let is_last = end == frames;
        let count = if is_last { events.len() } else { events.partition_point(|event| (event.frame as usize) < end) };
        let mut cut = Cut {
            events: count,
            end,
            last: frames.saturating_sub(1).min(end).saturating_sub(start),
            cause: Cause::Length,
        };
        let chunk = |cut: &Cut| Chunk {
            events: &events[..cut.events],
            input: &[],
            start,
            last: cut.last,
            frames: cut.end - start,
            owners: before,
            programs: &self.programs,
        };
        let mut heard = events[..cut.events].iter().map(|event| self.owners.hear(event)).enumerate();
        if let Some((index, (master, members))) = heard.find_map(|(index, zone)| Some((index, zone?))) {
            let frame = chunk(&cut).frame(&events[index]);
            cut = Cut::before(index, start, frame, Cause::Zone { master, members });
        }
        if let Some((index, frame)) = self.lender.lend(&mut self.parts, &chunk(&cut)) {
            cut = Cut::before(index, start, frame, Cause::Pool);
            self.owners = before;
            events[..index].iter().for_each(|event| _ = self.owners.hear(event));
        }
        cut
    }

    /// Configures a zone in all parts. Where a channel's owner has changed, the new owner gets the channel's
    /// controllers.
    fn configure_zone(&mut self, before: Owners, event: &Event, master: u8, members: u8) {
        for channel in 0..16 {
            let [from, to] = [before, self.owners].map(|owners| usize::from(owners.of(channel)));
            if from != to {
                let held = self.parts[from].synth.channel(channel);
                self.parts[to].synth.set_channel(channel, held);
            }
        }
        // Every part needs the zones.
        self.parts.iter_mut().for_each(|part| part.synth.configure_zone(master, members));
        self.parts[usize::from(before.of(master))].synth.handle(event);
    }
}
