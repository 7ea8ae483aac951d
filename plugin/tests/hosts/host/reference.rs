//! Renders with the engine alone: the reference for all comparisons of bits.

use sprung::engine::{Event, EventKind, Synth};
use sprung::patch::Patch;
use std::cell::RefCell;

/// An event of the engine with its frame in the song.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At(pub(crate) u64, pub(crate) u8, pub(crate) EventKind);

/// Renders `frames` frames, left and right, in one block.
pub(crate) fn render(patch: &Patch, sample_rate: f64, song: &[At], frames: usize) -> [Vec<f32>; 2] {
    // The one that has rendered before, if its rate is the same: it takes longer to make one than to render a short song.
    thread_local! {
        static LAST: RefCell<Option<(f64, Synth)>> = const { RefCell::new(None) };
    }
    let last = LAST.take().filter(|(rate, _)| *rate == sample_rate).map(|(_, synth)| synth);
    let mut synth = last.unwrap_or_else(|| {
        let mut synth = Synth::new(sample_rate, 0);
        synth.reserve_space();
        synth
    });
    synth.set_patch(patch);
    synth.reset();
    let events: Vec<Event> =
        song.iter().map(|&At(frame, channel, kind)| Event { frame: frame as u32, channel, kind }).collect();
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; frames]);
    synth.process(&events, &mut left, &mut right);
    LAST.set(Some((sample_rate, synth)));
    [left, right]
}

/// Fails unless both have the same bits. Reports the first and the largest difference.
#[track_caller]
pub(crate) fn assert_same_bits(what: &str, found: &[Vec<f32>], expected: &[Vec<f32>]) {
    assert_eq!(found.len(), expected.len(), "{what}: channels");
    for (channel, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found.len(), expected.len(), "{what}: frames");
        let pairs = || found.iter().zip(expected);
        if let Some(frame) = pairs().position(|(a, b)| a.to_bits() != b.to_bits()) {
            let differing = pairs().filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            let worst = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            panic!(
                "{what}: channel {channel} differs from frame {frame} on ({} instead of {}), in {differing} of {} \
                 frames, by up to {worst:e}",
                found[frame],
                expected[frame],
                found.len(),
            );
        }
    }
}

/// Fails if a sample is NaN, infinite or subnormal, or if everything is silent.
#[track_caller]
pub(crate) fn assert_sound(what: &str, channels: &[Vec<f32>]) {
    assert_clean(what, channels);
    let peak = channels.iter().flatten().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    assert!(peak > 1e-3, "{what}: silent, the peak is {peak}");
}

/// Fails if a sample is NaN, infinite or subnormal.
#[track_caller]
pub(crate) fn assert_clean(what: &str, channels: &[Vec<f32>]) {
    for (channel, samples) in channels.iter().enumerate() {
        let bad = samples.iter().position(|sample| !sample.is_finite() || sample.is_subnormal());
        if let Some(frame) = bad {
            panic!("{what}: {:e} at frame {frame} of channel {channel}", samples[frame]);
        }
    }
}
