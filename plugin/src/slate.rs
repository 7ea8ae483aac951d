//! The patch that was loaded last, exactly, where the audio thread can read it without waiting.
//!
//! It lies in a sequence lock: a reader that comes while it is written takes nothing, and tries again in the next block.

use sprung::params::{PARAM_COUNT, PARAMS};
use sprung::patch::routes::{MAX_ROUTES, Response, Route, Source};
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};
use sprung_sequence_lock::SequenceLock;
use std::array::from_fn;

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

/// Words that a [`Loaded`] is kept in: values, positions, the seed, the routes, the number of modes, and the modes.
const WORDS: usize = 2 * PARAM_COUNT + MAX_ROUTES + 5 * MAX_MODES + 3;

/// One [`Loaded`], to be read by any thread and written by one at a time.
pub(crate) struct Slate(SequenceLock<WORDS>);

impl Slate {
    pub(crate) fn new(loaded: &Loaded) -> Self {
        let slate = Self(SequenceLock::default());
        slate.write(loaded, || {});
        slate
    }

    /// Writes, with `meanwhile` run before readers may read again. One writer at a time: the caller's lock.
    pub(crate) fn write(&self, loaded: &Loaded, meanwhile: impl FnOnce()) {
        let Loaded { patch, positions, seed } = loaded;
        let modes = patch.modes.as_slice();
        let values = PARAMS.iter().map(|info| patch.get(info.param)).chain(*positions).map(f32::to_bits);
        let of_mode = |mode: &Mode| [mode.ratio, mode.level, mode.decay, mode.strike, mode.pan].map(f32::to_bits);
        let numbers = [*seed as u32, (*seed >> 32) as u32];
        let routes = (0..MAX_ROUTES).map(|place| patch.routes.get(place).map_or(0, word));
        let numbers = numbers.into_iter().chain(routes).chain([modes.len() as u32]);
        self.0.write(values.chain(numbers).chain(modes.iter().flat_map(of_mode)), meanwhile);
    }

    /// Runs `read` and gives what it gave, with the generation, unless a writer was at work. Real-time safe if
    /// `read` is.
    pub(crate) fn read<T>(&self, read: impl FnOnce(u32) -> T) -> Option<T> {
        self.0.read(read)
    }

    /// What is written here. Only whole within [`Slate::read`]. Real-time safe.
    pub(crate) fn get(&self) -> Loaded {
        let mut words = self.0.words();
        let mut get = || words.next().unwrap_or(0);
        let mut patch = Patch::default();
        PARAMS.iter().for_each(|info| patch.set(info.param, f32::from_bits(get())));
        let positions = from_fn(|_| f32::from_bits(get()));
        let seed = u64::from(get()) | u64::from(get()) << 32;
        (0..MAX_ROUTES).for_each(|place| patch.routes.set(place, route(get())));
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

/// A route as a word: four bytes, of which the last says that there is one. A scale is counted from 1.
fn word(Route { source, destination, response, scale }: Route) -> u32 {
    let scale = scale.map_or(0, |scale| scale as u32 + 1);
    const { assert!(PARAM_COUNT <= 256) }
    source as u32 | (destination as u32) << 8 | scale << 16 | (response as u32 | 128) << 24
}

/// The route of a word.
fn route(word: u32) -> Option<Route> {
    let [source, destination, scale, response] = word.to_le_bytes().map(usize::from);
    Some(Route {
        source: *Source::ALL.get(source)?,
        destination: PARAMS.get(destination)?.param,
        response: *Response::ALL.get(response.checked_sub(128)?)?,
        scale: scale.checked_sub(1).and_then(|scale| Source::ALL.get(scale).copied()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;
    use sprung::preset::Preset;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::{Duration, Instant};

    fn loaded(name: &str, seed: u64) -> Loaded {
        Loaded::new(Preset::find(name).unwrap().patch, seed)
    }

    #[test]
    fn what_is_put_is_what_is_got() {
        let slate = Slate::new(&loaded("Init", 0));
        for (seed, preset) in [0, 1 << 40, u64::MAX].into_iter().zip(Preset::factory()) {
            let mut loaded = Loaded::new(preset.patch, seed);
            loaded.positions[3] = 0.123;
            let movable = PARAMS.iter().filter(|info| info.is_modulatable());
            for (place, info) in movable.rev().enumerate().take(MAX_ROUTES).skip(seed as usize % 2) {
                let (source, scale) = (Source::ALL[place], Source::ALL.get(23 - 2 * place.min(11)).copied());
                let (destination, response) = (info.param, Response::ALL[place % 4]);
                loaded.patch.routes.set(place, Some(Route { source, destination, response, scale }));
            }
            slate.write(&loaded, || assert_eq!(slate.read(|_| ()), None, "nothing is read while it is written"));
            assert_eq!(slate.read(|_| slate.get()), Some(loaded));
        }
    }

    #[test]
    fn readers_get_one_whole_patch_or_none() {
        let both = [loaded("Church Bell", 1), loaded("Kick", 2)];
        let slate = Slate::new(&both[0]);
        let done = AtomicBool::new(false);
        let (mut seen, mut mixtures) = ([0, 0], 0);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let mut turn = 0;
                // An even number of turns, so that the second patch is the last.
                while turn % 2 == 1 || !done.load(Ordering::Relaxed) {
                    slate.write(&both[turn % 2], || {});
                    turn += 1;
                }
            });
            let start = Instant::now();
            while seen.contains(&0) || start.elapsed() < Duration::from_millis(200) {
                if start.elapsed() > Duration::from_secs(30) {
                    break;
                }
                let Some(got) = slate.read(|_| slate.get()) else { continue };
                match both.iter().position(|loaded| *loaded == got) {
                    Some(which) => seen[which] += 1,
                    None => mixtures += 1,
                }
            }
            done.store(true, Ordering::Relaxed);
        });
        assert_eq!(mixtures, 0, "of {seen:?} whole patches");
        assert!(!seen.contains(&0), "each patch is read some time: {seen:?}");
        assert_eq!(slate.read(|_| slate.get()), Some(both[1]));
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
