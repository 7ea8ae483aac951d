//! The sound of each pad of a kit by itself, before the effects: sums of voices for stems. Offline only: it allocates.

use crate::engine::note::Note;
use crate::engine::voice::SynthVoice;
use crate::sound::Kit;

/// Pads whose sound is one stem: those of a choke group, or the pad of a single key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PadGroup {
    /// The pads of this choke group.
    Choke(u8),
    /// The pad of this key, which is in no choke group.
    Key(u8),
}

/// After this many notes, those that have ended are forgotten.
const MOST_NOTES: usize = 1024;

/// The sums of the voices of each group since they were last taken.
#[derive(Default)]
pub(super) struct PadSums {
    /// The groups of notes, by their serial numbers.
    notes: Vec<(u64, PadGroup)>,
    sums: Vec<(PadGroup, [Vec<f32>; 2])>,
    /// Frames since the sums were taken.
    frames: usize,
    /// The voice that is being rendered.
    voice: [Vec<f32>; 2],
}

impl PadGroup {
    /// The group of a key in a kit, with the choke group that its pad has. None for a kit of one sound, whose stem is the channel's.
    pub(crate) fn of(kit: &Kit, key: u8, choke: u8) -> Option<Self> {
        let group = if choke == 0 { Self::Key(key) } else { Self::Choke(choke) };
        (!kit.is_single()).then_some(group)
    }
}

impl PadSums {
    /// Remembers the group of a note that starts.
    pub(super) fn begin(&mut self, note: &Note, kit: &Kit, is_sounding: impl Fn(u64) -> bool) {
        if self.notes.len() >= MOST_NOTES {
            self.notes.retain(|(serial, _)| is_sounding(*serial));
        }
        self.notes.extend(PadGroup::of(kit, note.key, note.choke).map(|group| (note.serial, group)));
    }

    /// Renders a voice: adds it to the mix and to the sum of its group.
    pub(super) fn render(&mut self, note: &Note, voice: &mut SynthVoice, input: &[f32], mix: [&mut [f32]; 2]) {
        let [left, right] = mix;
        let Some((_, group)) = self.notes.iter().rev().find(|(serial, _)| *serial == note.serial) else {
            return voice.render(input, left, right);
        };
        let index = self.sums.iter().position(|(known, _)| known == group).unwrap_or_else(|| {
            self.sums.push((*group, Default::default()));
            self.sums.len() - 1
        });
        let end = self.frames + left.len();
        let [own_left, own_right] = &mut self.voice;
        for own in [&mut *own_left, own_right] {
            own.clear();
            own.resize(left.len(), 0.0);
        }
        voice.render(input, own_left, own_right);
        let (_, sums) = &mut self.sums[index];
        for ((own, mix), sum) in self.voice.iter().zip([left, right]).zip(sums) {
            sum.resize(end, 0.0);
            let sum = sum[self.frames..].iter_mut();
            for ((own, mix), sum) in own.iter().zip(mix).zip(sum) {
                *mix += *own;
                *sum += *own;
            }
        }
    }

    /// Advances by frames that were rendered.
    pub(super) fn pass(&mut self, frames: usize) {
        self.frames += frames;
    }

    /// Gives the sums of all groups that have sounded, and starts again. What is missing at the end of a sum is silence.
    pub(super) fn take(&mut self, mut visit: impl FnMut(PadGroup, [&[f32]; 2])) {
        for (group, sums) in &mut self.sums {
            if !sums[0].is_empty() {
                visit(*group, sums.each_ref().map(Vec::as_slice));
                sums.iter_mut().for_each(Vec::clear);
            }
        }
        self.frames = 0;
    }
}
