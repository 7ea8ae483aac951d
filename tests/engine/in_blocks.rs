//! Plays events in blocks of one size.

use sprung::engine::Event;

/// The bits of the left channel, then those of the right. The frames of events count from the first block.
pub(crate) fn in_blocks(
    events: &[Event],
    frames: usize,
    block: usize,
    mut process: impl FnMut(&[Event], &mut [f32], &mut [f32]),
) -> Vec<u32> {
    let (mut left, mut right) = (vec![9.0; frames], vec![9.0; frames]);
    for start in (0..frames).step_by(block) {
        let end = frames.min(start + block);
        let within = |event: &&Event| (start..end).contains(&(event.frame as usize));
        let now = events.iter().filter(within).map(|event| Event { frame: event.frame - start as u32, ..*event });
        process(&now.collect::<Vec<_>>(), &mut left[start..end], &mut right[start..end]);
    }
    left.into_iter().chain(right).map(f32::to_bits).collect()
}
