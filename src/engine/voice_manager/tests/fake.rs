//! A voice for tests: it makes no sound and logs the calls that it receives.

use crate::engine::note::Note;
use crate::engine::voice_manager::{Footprint, Unison, Voice};
use std::cell::RefCell;
use std::rc::Rc;

/// The calls that the voices received, in order.
pub(super) type Log = Rc<RefCell<Vec<String>>>;

/// The present state of the instrument: the number of its patch, and its unison voices.
pub(super) struct FakeInstrument {
    pub(super) patch: u32,
    pub(super) unison: usize,
}

/// A voice that logs its calls, and that refuses to read another patch than the one it was started with.
pub(super) struct FakeVoice {
    log: Log,
    cells: usize,
    patch: u32,
    key: u8,
    energy: f64,
    pub(super) over: bool,
}

impl FakeVoice {
    pub(super) fn new(log: &Log) -> Self {
        Self { log: log.clone(), cells: 0, patch: 0, key: 0, energy: 0.0, over: false }
    }
}

impl Voice for FakeVoice {
    type Context = FakeInstrument;
    type Cell = ();
    fn footprint(instrument: &FakeInstrument) -> Footprint {
        Footprint { voices: instrument.unison, cells: 2 * instrument.unison }
    }
    fn add_cell(&mut self, _: Box<()>) {
        self.cells += 1;
    }
    fn take_cell(&mut self) -> Option<Box<()>> {
        self.cells = self.cells.checked_sub(1)?;
        Some(Box::new(()))
    }
    fn start(&mut self, instrument: &FakeInstrument, note: &Note, unison: Unison) {
        assert_eq!((self.cells, unison.count), (2, instrument.unison));
        (self.key, self.over, self.energy) = (note.key, false, f64::from(note.velocity));
        self.patch = instrument.patch;
        self.log.borrow_mut().push(format!("start {}", note.key));
    }
    fn restrike(&mut self, instrument: &FakeInstrument, note: &Note) {
        assert_eq!(instrument.patch, self.patch, "restrike reads another patch");
        self.log.borrow_mut().push(format!("restrike {} as {}", self.key, note.key));
        self.key = note.key;
    }
    fn retune(&mut self, instrument: Option<&FakeInstrument>, note: &Note) {
        assert!(instrument.is_none_or(|instrument| instrument.patch == self.patch), "retune reads another patch");
        let by = if instrument.is_some() { "" } else { " by itself" };
        self.log.borrow_mut().push(format!("retune {} to {}{by}", self.key, note.key));
        self.key = note.key;
    }
    fn damp(&mut self, _share: f32) {}

    fn release(&mut self, velocity: f32) {
        self.log.borrow_mut().push(format!("release {} at {velocity}", self.key));
    }
    fn fade(&mut self) {
        self.log.borrow_mut().push(format!("fade {}", self.key));
    }
    fn energy(&self) -> f64 {
        self.energy
    }
    fn is_over(&self) -> bool {
        self.over
    }
}
