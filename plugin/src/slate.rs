//! The patch that was loaded last, exactly, where the audio thread can read it without waiting.
//!
//! A sequence lock over atomics: a writer makes the generation odd, writes, and makes it even again; a reader that
//! finds it odd or changed takes nothing and tries again in the next block. Readers never wait, nothing is allocated,
//! and what is read is always one whole patch.

use sprung::params::{PARAM_COUNT, PARAMS};
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};
use std::array::from_fn;
use std::sync::atomic::{AtomicU32, Ordering, fence};

/// A patch with the knob position that belongs to each value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Loaded {
    pub(crate) patch: Patch,
    /// Where the host's knobs stand while the patch's own values hold.
    pub(crate) positions: [f32; PARAM_COUNT],
    /// What randomness starts from.
    pub(crate) seed: u64,
}

impl Loaded {
    /// A patch with each knob where its value is.
    pub(crate) fn new(patch: Patch, seed: u64) -> Self {
        let positions = from_fn(|index| PARAMS[index].normalise(patch.get(PARAMS[index].param)) as f32);
        Self { patch, positions, seed }
    }

    /// The value of the parameter at `index` of the table with its knob at `position`: the patch's own where it
    /// belongs to the position, else what the position means. Real-time safe.
    pub(crate) fn value(&self, index: usize, position: f32) -> f32 {
        let info = &PARAMS[index];
        if position.to_bits() == self.positions[index].to_bits() {
            self.patch.get(info.param)
        } else {
            info.denormalise(f64::from(position))
        }
    }
}

/// Words that a [`Loaded`] is kept in: values, positions, modes and their number, and the seed.
const WORDS: usize = 2 * PARAM_COUNT + 5 * MAX_MODES + 3;

/// One [`Loaded`], to be read by any thread and written by one at a time.
pub(crate) struct Slate {
    generation: AtomicU32,
    words: [AtomicU32; WORDS],
}

impl Slate {
    pub(crate) fn new(loaded: &Loaded) -> Self {
        let slate = Self { generation: AtomicU32::new(0), words: from_fn(|_| AtomicU32::new(0)) };
        slate.put(loaded);
        slate
    }

    /// Writes, with `meanwhile` run before readers may read again. One writer at a time: the caller's lock.
    pub(crate) fn write(&self, loaded: &Loaded, meanwhile: impl FnOnce()) {
        let generation = self.generation.load(Ordering::Relaxed);
        self.generation.store(generation.wrapping_add(1), Ordering::Relaxed);
        fence(Ordering::Release);
        self.put(loaded);
        meanwhile();
        self.generation.store(generation.wrapping_add(2), Ordering::Release);
    }

    /// Runs `read` and gives what it gave, with the generation, unless a writer was at work. Real-time safe if
    /// `read` is.
    pub(crate) fn read<T>(&self, read: impl FnOnce(u32) -> T) -> Option<T> {
        let generation = self.generation.load(Ordering::Acquire);
        if !generation.is_multiple_of(2) {
            return None;
        }
        let result = read(generation);
        fence(Ordering::Acquire);
        (self.generation.load(Ordering::Relaxed) == generation).then_some(result)
    }

    fn put(&self, loaded: &Loaded) {
        let mut words = self.words.iter();
        let mut put = |bits: u32| {
            if let Some(word) = words.next() {
                word.store(bits, Ordering::Relaxed);
            }
        };
        PARAMS.iter().for_each(|info| put(loaded.patch.get(info.param).to_bits()));
        loaded.positions.iter().for_each(|position| put(position.to_bits()));
        put(loaded.seed as u32);
        put((loaded.seed >> 32) as u32);
        let modes = loaded.patch.modes.as_slice();
        put(modes.len() as u32);
        for mode in modes {
            for field in [mode.ratio, mode.level, mode.decay, mode.strike, mode.pan] {
                put(field.to_bits());
            }
        }
    }

    /// What is written here. Only whole within [`Slate::read`]. Real-time safe.
    pub(crate) fn get(&self) -> Loaded {
        let mut words = self.words.iter().map(|word| word.load(Ordering::Relaxed));
        let mut get = || words.next().unwrap_or(0);
        let mut patch = Patch::default();
        PARAMS.iter().for_each(|info| patch.set(info.param, f32::from_bits(get())));
        let positions = from_fn(|_| f32::from_bits(get()));
        let seed = u64::from(get()) | u64::from(get()) << 32;
        let mut modes = [Mode::UNIT; MAX_MODES];
        let count = (get() as usize).min(MAX_MODES);
        for mode in &mut modes[..count] {
            let [ratio, level, decay, strike, pan] = from_fn(|_| f32::from_bits(get()));
            *mode = Mode { ratio, level, decay, strike, pan };
        }
        patch.modes = ModeTable::new(&modes[..count]);
        Loaded { patch, positions, seed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;
    use sprung::preset::Preset;
    use std::sync::atomic::AtomicBool;

    fn loaded(name: &str, seed: u64) -> Loaded {
        Loaded::new(Preset::find(name).unwrap().patch, seed)
    }

    #[test]
    fn what_is_put_is_what_is_got() {
        let slate = Slate::new(&loaded("Init", 0));
        for (seed, preset) in [0, 1 << 40, u64::MAX].into_iter().zip(Preset::factory()) {
            let mut loaded = Loaded::new(preset.patch, seed);
            loaded.positions[3] = 0.123;
            slate.write(&loaded, || assert_eq!(slate.read(|_| ()), None, "nothing is read while it is written"));
            assert_eq!(slate.read(|_| slate.get()), Some(loaded));
        }
    }

    #[test]
    fn readers_get_one_whole_patch_or_none() {
        let both = [loaded("Church Bell", 1), loaded("Kick", 2)];
        let slate = Slate::new(&both[0]);
        let done = AtomicBool::new(false);
        let mut seen = [0, 0];
        std::thread::scope(|scope| {
            scope.spawn(|| {
                for turn in 0..20_000 {
                    slate.write(&both[turn % 2], || {});
                }
                done.store(true, Ordering::Relaxed);
            });
            while !done.load(Ordering::Relaxed) {
                let Some(got) = slate.read(|_| slate.get()) else { continue };
                let which = both.iter().position(|loaded| *loaded == got);
                seen[which.expect("neither patch, but a mixture")] += 1;
            }
        });
        assert_eq!(slate.read(|_| slate.get()), Some(both[1]), "{seen:?}");
    }

    #[test]
    fn a_knob_that_comes_back_has_the_exact_value_again() {
        // A value of its own on a knob whose position as f32 would not give it back.
        let mut loaded = Loaded::new(Patch::default().with(Param::Decay, 0.123_456_79), 0);
        let index = Param::Decay as usize;
        let position = loaded.positions[index];
        assert_eq!(loaded.value(index, position), 0.123_456_79);
        let moved = loaded.value(index, position + 0.1);
        assert_eq!(moved, Param::Decay.info().denormalise(f64::from(position + 0.1)));
        loaded.positions[index] = 0.75;
        assert_eq!(loaded.value(index, 0.75), 0.123_456_79, "the position that came with it counts");
    }
}
