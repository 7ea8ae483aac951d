//! A synth with 16 voices of 64 masses each, in blocks of 480 frames (10 ms at 48 kHz).

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::{MAX_MODES, Mode, ModeTable, Patch};

const VOICES: u8 = 16;
const FRAMES: usize = 480;

/// A synth on which all voices ring, for longer than any measurement.
fn ringing_synth(patch: &Patch) -> Synth {
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_patch(patch);
    let strike = |voice: u8| {
        let kind = EventKind::NoteOn { key: 36 + 2 * voice, detune: 0.0, velocity: 1.0, id: -1 };
        Event { frame: 0, channel: 0, kind }
    };
    let [mut left, mut right] = [[0.0; FRAMES]; 2];
    synth.process(&(0..VOICES).map(strike).collect::<Vec<_>>(), &mut left, &mut right);
    assert_eq!(synth.voices_used(), usize::from(VOICES));
    synth
}

fn synth(criterion: &mut Criterion) {
    let mut patch = Patch::default().with(Param::Decay, 60.0).with(Param::Voices, f32::from(VOICES));
    // Ten times the decay of the patch, so that no mode dies away and is spared while it is measured.
    let mode = |m: usize| Mode { ratio: 1.0 + 0.3 * m as f32, level: 0.1, decay: 10.0, ..Mode::UNIT };
    patch.modes = ModeTable::new(&(0..MAX_MODES).map(mode).collect::<Vec<_>>());
    let [mut left, mut right] = [[0.0; FRAMES]; 2];
    let mut group = criterion.benchmark_group("synth 16 × 64");
    group.throughput(Throughput::Elements(FRAMES as u64));
    for (name, patch) in [("ringing", patch), ("vibrato", patch.with(Param::Vibrato, 30.0))] {
        group.bench_function(name, |bencher| {
            let (mut synth, mut frames) = (ringing_synth(&patch), 0);
            bencher.iter(|| {
                // Struck anew after three minutes of sound, long before the notes have died.
                frames += FRAMES;
                if frames > 180 * 48_000 {
                    (synth, frames) = (ringing_synth(&patch), 0);
                }
                synth.process(&[], &mut left, &mut right);
            });
        });
    }
    group.finish();
}

criterion_group!(benches, synth);
criterion_main!(benches);
