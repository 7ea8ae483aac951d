//! The older part of the response: all masses, which work through a block of input within a block, slice by slice.
//!
//! The work on the input of a block is done in the next block and heard in the one after: first the input goes to a grid, then
//! the masses follow group by group, at last their sum becomes frames.
//!
//! While pitch or decay change, the masses of each slice turn with the former coefficients and are then laid out anew with the
//! next ones. They keep their amplitude and phase at the beginning of the block in which the change is heard. The new head of
//! the response comes from the same masses, as a sample of 1 would have moved them.

use super::super::modes::ModeSet;
use super::fourier::Pair;
use super::layout::{Layout, Tuning, grid_points};
use super::masses::{Play, Spectra, Step};
use super::sums::Sums;
use super::taps::{FRACTIONS, Taps, tables};
use crate::dsp::simd::Instructions;
use crate::dsp::simd::vector::LANES;
use std::ops::Range;

/// All masses of a body.
#[derive(Clone, Debug)]
pub(super) struct Tail {
    instructions: Instructions,
    tables: &'static [[Taps; FRACTIONS]; 3],
    modes: &'static ModeSet,
    layout: Layout,
    /// The coefficients that come next, and their layout as far as it is made.
    next: Option<Tuning>,
    next_layout: Layout,
    /// Amplitudes at the beginning of the block, mode by mode, on their way to the next layout.
    held: Pair,
    sums: Sums,
    input: Pair,
    /// Whether the input drives the masses in this block.
    driven: bool,
    /// Groups from this index on are at rest, and groups before this index have done their work in this block.
    live: usize,
    done: usize,
    out: Spectra,
    /// During a change: with the former coefficients, and the two blocks of the new head.
    former: Spectra,
    heads: [Spectra; 2],
}

impl Tail {
    /// No masses, with room for some. Allocates.
    pub(super) fn with_room(instructions: Instructions, modes: usize, frames: usize) -> Self {
        let grid = || vec![0.0; grid_points(frames)];
        let spectra = || std::array::from_fn(|_| grid());
        let room = || vec![0.0; modes + LANES];
        Self {
            instructions,
            tables: tables(),
            modes: ModeSet::none(),
            layout: Layout::with_room(modes, frames),
            next: None,
            next_layout: Layout::with_room(modes, frames),
            held: [room(), room()],
            sums: Sums::new(instructions, frames),
            input: [grid(), grid()],
            driven: false,
            live: 0,
            done: 0,
            out: spectra(),
            former: spectra(),
            heads: [spectra(), spectra()],
        }
    }

    /// Loads other modes. Follow with a change of the coefficients. Real-time safe if there is room for as many.
    pub(super) fn load(&mut self, modes: &'static ModeSet) {
        self.modes = modes;
        let room = self.held[0].len().max(modes.len() + LANES);
        self.held.iter_mut().for_each(|row| row.resize(room, 0.0));
        self.layout.clear();
        (self.live, self.done, self.next) = (0, 0, None);
    }

    pub(super) fn modes(&self) -> &'static ModeSet {
        self.modes
    }

    /// Begins the work on a block of input, with a change of coefficients or without. Until [`Tail::finish`], a change does nothing to
    /// what the masses and the sums have: it may be begun anew.
    pub(super) fn begin(&mut self, input: &[f32], next: Option<Tuning>) {
        self.driven = input.iter().any(|sample| *sample != 0.0);
        if self.driven {
            self.sums.spread(input, &mut self.input);
            self.live = self.layout.groups.len();
        }
        (self.done, self.next) = (0, next);
        self.out.iter_mut().for_each(|row| row.fill(0.0));
        if next.is_some() {
            self.next_layout.clear();
            let rows = self.heads.iter_mut().flatten().chain(&mut self.former).chain(&mut self.held);
            rows.for_each(|row| row.fill(0.0));
        }
    }

    /// Works until a share of the groups has done its work, `part / parts`.
    pub(super) fn work(&mut self, part: usize, parts: usize) {
        let end = self.layout.groups.len() * part / parts;
        let (groups, live) = (self.done..end, self.live.clamp(self.done, end));
        let step = if self.driven { Step::Drive } else { Step::Turn };
        let Self { instructions, tables, layout, input, next, former, out, .. } = self;
        let out = if next.is_some() { former } else { out };
        let playing = &layout.groups[groups.start..live];
        instructions.run(Play { blocks: &mut layout.blocks, groups: playing, tables, step, input, out });
        self.done = end;
        if let Some(tuning) = self.next {
            self.layout.hand_over(&self.layout.groups[groups.start..live], &mut self.held);
            // Masses at rest have nothing to hand over.
            let ready = match self.live {
                0 => tuning.heard * part / parts,
                _ if part == parts => tuning.heard,
                _ => self.layout.covered_by(end),
            };
            let first = self.next_layout.groups.len();
            while self.next_layout.add_group(self.instructions, self.modes, &tuning, ready) {}
            self.begin_groups(first);
        }
    }

    /// The new head of the response, and the amplitudes that were handed over, for the groups of the next layout from `first` on.
    fn begin_groups(&mut self, first: usize) {
        let Self { instructions, tables, next_layout, heads: [head, second], held, input, out, .. } = self;
        for (step, out) in [(Step::Stay, head), (Step::Turn, second)] {
            let Layout { blocks, groups, .. } = &mut *next_layout;
            instructions.run(Play { blocks, groups: &groups[first..], tables, step, input, out });
        }
        next_layout.take_over(first, held);
        if self.live > 0 {
            let Layout { blocks, groups, .. } = &mut *next_layout;
            instructions.run(Play { blocks, groups: &groups[first..], tables, step: Step::Stay, input, out });
        }
    }

    /// Ends a block of work: writes the frames of the tail. During a change, it also writes the tail with the former coefficients
    /// and the head of the response in two parts.
    pub(super) fn finish(&mut self, tail: &mut Pair, change: Option<(&mut Pair, &mut [Pair; 2])>) {
        let is_moving = self.live > 0;
        if let Some(next) = self.next {
            self.sums.damp(next.middle);
        }
        match is_moving {
            true => self.sums.collect(&self.out, false, tail),
            false => tail.iter_mut().for_each(|side| side.fill(0.0)),
        }
        if let Some((former, head)) = change {
            self.sums.collect(&self.former, true, former);
            for (grid, part) in self.heads.iter().zip(head) {
                self.sums.collect(grid, false, part);
            }
            std::mem::swap(&mut self.layout, &mut self.next_layout);
            self.live = if is_moving { self.layout.groups.len() } else { 0 };
            self.next = None;
        }
        self.done = 0;
    }

    /// Sum of the squared amplitudes of some modes at the beginning of the block, or an upper bound of it. Sets masses that have
    /// nearly stopped to rest. Call it before the work on a block begins.
    pub(super) fn measure(&mut self, modes: Range<usize>) -> f64 {
        let blocks = self.layout.blocks_of(modes);
        self.layout.measure(blocks)
    }

    /// Leaves out groups from which no mode below `modes` is live.
    pub(super) fn rest_from(&mut self, modes: usize) {
        let block = self.layout.blocks_of(0..modes).end;
        self.live = self.live.min(self.layout.groups.partition_point(|group| (group.start as usize) < block));
    }

    /// Sum of the squared amplitudes.
    pub(super) fn energy(&self) -> f64 {
        self.layout.energy()
    }

    /// Sets all masses to rest.
    pub(super) fn rest(&mut self) {
        for block in &mut self.layout.blocks {
            block.state = super::masses::Block::REST.state;
        }
        (self.live, self.done, self.next, self.driven) = (0, 0, None, false);
    }
}
