//! The sound that was loaded last, with exact values and their knob positions, for all threads.
//!
//! **Exact values.** Hosts store knob positions, 0–1, in single precision. Two things keep values exact nevertheless.
//! `ParamInfo::denormalise` gives numbers with about five digits, so that a value that a user types survives the
//! conversion to a position. And while a knob is at the position of its loaded value, it has this value, bit for bit; a
//! knob that comes back has the exact value again. So a preset, a kit or a project gives the same bits as `sprung
//! render`, however the host rounds. Only a position that the host itself sets has the value that its text shows.
//!
//! **No waiting.** A writer sets the knobs while it has the slot, so that the audio thread sees knobs and kit that
//! belong together. A lock-free exchange of pointers was rejected: it needs unsafe code, and does not keep knobs and
//! kit together. The tests here use threads; `plugin/tests/hosts/realtime.rs` runs it under supervision.

use sprung::params::{PARAM_COUNT, PARAMS, Values};
use sprung::sound::Kit;
use std::array::from_fn;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

/// A kit with the values of its parameters and their knob positions. It never changes after it has been shared.
#[derive(Debug, PartialEq)]
pub(crate) struct Loaded {
    pub(crate) kit: Arc<Kit>,
    /// The parameters of the whole kit.
    pub(crate) values: Values,
    /// The host's knob positions that belong to these values.
    pub(crate) positions: [f32; PARAM_COUNT],
    /// Seed of all random numbers.
    pub(crate) seed: u64,
}

impl Loaded {
    /// The value of the parameter at `index` of the table, for a knob position: exactly the loaded value if the knob is
    /// at its position, else the value of the position. Real-time safe.
    pub(crate) fn value(&self, index: usize, position: f32) -> f32 {
        let info = &PARAMS[index];
        if position.to_bits() == self.positions[index].to_bits() {
            self.values.get(info.param)
        } else {
            info.denormalise(f64::from(position))
        }
    }

    /// Like [`Loaded::value`], for all parameters. Real-time safe.
    pub(crate) fn values_at(&self, positions: &[f32; PARAM_COUNT]) -> Values {
        let mut values = self.values;
        for (index, info) in PARAMS.iter().enumerate() {
            values.set(info.param, self.value(index, positions[index]));
        }
        values
    }
}

/// The knob positions of these values.
pub(crate) fn positions_of(values: &Values) -> [f32; PARAM_COUNT] {
    from_fn(|index| PARAMS[index].normalise(values.get(PARAMS[index].param)) as f32)
}

/// The slot from which the audio thread gets the sound that was loaded last. The audio thread never waits: if another
/// thread is using the slot, it continues with its present sound until the next block.
///
/// No thread blocks on the mutex: writers try again until they get it. So unlocking never has to wake a thread, and the
/// audio thread makes no system call. A writer keeps a reference to each sound in a collector. The audio thread takes
/// references only from the slot, so that it never returns to a sound that it has dropped, and never drops the last
/// reference.
pub(crate) struct Slot(Mutex<Arc<Loaded>>);

impl Slot {
    pub(crate) fn new(loaded: Arc<Loaded>) -> Self {
        Self(Mutex::new(loaded))
    }

    /// Replaces the contents. `meanwhile` runs before any other thread can read them. Not for the audio thread.
    pub(crate) fn put(&self, loaded: Arc<Loaded>, meanwhile: impl FnOnce()) {
        let mut slot = loop {
            match self.enter() {
                Some(slot) => break slot,
                None => std::thread::yield_now(),
            }
        };
        *slot = loaded;
        meanwhile();
    }

    /// Runs `read` with the contents, unless another thread is using the slot. `read` sees consistent data if writers
    /// change it only inside [`Slot::put`]. Real-time safe if `read` is.
    pub(crate) fn read<T>(&self, read: impl FnOnce(&Arc<Loaded>) -> T) -> Option<T> {
        self.enter().map(|slot| read(&slot))
    }

    fn enter(&self) -> Option<MutexGuard<'_, Arc<Loaded>>> {
        match self.0.try_lock() {
            Ok(slot) => Some(slot),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;
    use sprung::patch::Patch;
    use sprung::preset::Preset;
    use sprung::sound::Collector;
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    use std::time::{Duration, Instant};

    fn loaded(patch: &Patch, seed: u64) -> Loaded {
        let positions = positions_of(&patch.values);
        Loaded { kit: Kit::of_patch(patch), values: patch.values, positions, seed }
    }

    #[test]
    fn a_reader_gets_what_belongs_together_or_nothing_and_frees_nothing() {
        let both = ["Church Bell", "Kick"].map(|name| &Preset::find(name).unwrap().patch);
        let first = Arc::new(loaded(both[0], 0));
        // Data beside the slot, like the knobs.
        let (slot, beside) = (Slot::new(first.clone()), AtomicU64::new(0));
        let done = AtomicBool::new(false);
        let collector = Collector::default();
        collector.keep(&first);
        drop(first);
        let mut most = 0;
        std::thread::scope(|scope| {
            let reader = scope.spawn(|| {
                let (mut seen, mut last, start) = (0, None, Instant::now());
                while seen < 1_000 && start.elapsed() < Duration::from_secs(30) {
                    let look = |found: &Arc<Loaded>| (found.clone(), beside.load(Ordering::Relaxed));
                    let Some((found, number)) = slot.read(look) else { continue };
                    assert_eq!(found.seed, number);
                    assert_eq!(&found.values, &both[number as usize % 2].values);
                    assert_eq!(found.kit.sounds()[0].patch(), both[number as usize % 2]);
                    let before = last.replace(found);
                    assert!(before.as_ref().is_none_or(|before: &Arc<Loaded>| Arc::strong_count(before) > 1));
                    seen += 1;
                }
                done.store(true, Ordering::Relaxed);
                seen
            });
            for number in 1.. {
                if done.load(Ordering::Relaxed) {
                    break;
                }
                let next = Arc::new(loaded(both[number as usize % 2], number));
                collector.keep(&next);
                slot.put(next, || beside.store(number, Ordering::Relaxed));
                most = most.max(collector.collect());
            }
            assert_eq!(reader.join().unwrap(), 1_000);
        });
        assert!(most <= 3, "{most} were kept at once");
        assert_eq!(collector.collect(), 1, "what is in the slot stays");
        slot.read(|_| assert!(slot.read(|_| ()).is_none(), "two at once"));
    }

    #[test]
    fn a_knob_that_comes_back_has_the_exact_value_again() {
        // A value that cannot be restored from its knob's position as an `f32`.
        let mut loaded = loaded(&Patch::default().with(Param::Decay, 0.123_456_79), 0);
        let index = Param::Decay as usize;
        let position = loaded.positions[index];
        assert_eq!(loaded.value(index, position), 0.123_456_79);
        let moved = loaded.value(index, position + 0.1);
        assert_eq!(moved, Param::Decay.info().denormalise(f64::from(position + 0.1)));
        loaded.positions[index] = 0.75;
        assert_eq!(loaded.value(index, 0.75), 0.123_456_79, "the position that came with it counts");
    }
}
