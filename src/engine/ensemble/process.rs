//! How an ensemble renders: blocks cut into chunks that parts play by themselves, and their mix.

use super::Ensemble;
use super::choke::Playing;
use super::chunk::Chunk;
use super::part::Part;
use crate::engine::Event;
use crate::engine::zones::Owners;

/// Where a chunk ends, and why.
struct Cut {
    /// How many of the events belong to the chunk.
    events: usize,
    /// The frame of the block at which it ends.
    end: usize,
    /// The last frame of the chunk that an event can be at.
    last: usize,
    cause: Cause,
}

#[derive(Clone, Copy)]
enum Cause {
    /// The block ends, or the chunk is as long as chunks can be.
    Length,
    /// The next event is a note that the pool cannot serve yet: the notes that give way are chosen by the state of all
    /// parts at its frame.
    Pool,
    /// The next event configures an MPE zone: channels change their owners between two chunks.
    Zone { master: u8, members: u8 },
}

impl Cut {
    /// An end before the event at `index`, which is at a frame of the chunk that starts at `start`.
    fn before(index: usize, start: usize, frame: usize, cause: Cause) -> Self {
        Self { events: index, end: start + frame, last: frame, cause }
    }
}

impl Ensemble {
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
        mut events: &[Event],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let (frames, mut start) = (left.len().min(right.len()), 0);
        // At least once: a block of no frames still brings its events.
        loop {
            let owners = self.owners;
            let cut = self.cut(events, start, frames);
            let (now, later) = events.split_at(cut.events);
            let chunk =
                Chunk { events: now, start, last: cut.last, frames: cut.end - start, owners, programs: &self.programs };
            let groups = self.playing.each_ref().map(Playing::choke_groups);
            each(&mut self.parts, &|part| part.play(&chunk, groups));
            self.playing.iter_mut().zip(&self.parts).for_each(|(playing, part)| playing.follow(&part.synth));
            let is_heard = self.parts.iter().any(|part| part.is_heard);
            if is_heard || !now.is_empty() {
                self.lender.take_back(&mut self.parts);
            }
            let (left, right) = (&mut left[start..cut.end], &mut right[start..cut.end]);
            left.fill(0.0);
            right.fill(0.0);
            // In the order of their channels: the order of additions is part of the bits.
            self.parts.iter().for_each(|part| part.add_to(left, right));
            self.limiter.process(&chunk, is_heard, [left, right]);
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

    /// Finds where the chunk ends that starts at frame `start` of a block of `frames` frames, and lends the parts the
    /// voices that they can need until then. The owners of channels become those after the chunk.
    fn cut(&mut self, events: &[Event], start: usize, frames: usize) -> Cut {
        let before = self.owners;
        let end = frames.min(start + self.chunk_frames);
        // Events beyond the end of the block are taken as its last frame's.
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

    /// Tells the parts of a zone, and hands what channels hold over to their owners where these are others than before.
    fn configure_zone(&mut self, before: Owners, event: &Event, master: u8, members: u8) {
        for channel in 0..16 {
            let [from, to] = [before, self.owners].map(|owners| usize::from(owners.of(channel)));
            if from != to {
                let held = self.parts[from].synth.channel(channel);
                self.parts[to].synth.set_channel(channel, held);
            }
        }
        // Every part knows the zones.
        self.parts.iter_mut().for_each(|part| part.synth.configure_zone(master, members));
        self.parts[usize::from(before.of(master))].synth.handle(event);
    }
}
