//! Every level of vector instructions gives the same bits.

use sprung::dsp::mode_bank::Level;
use sprung::dsp::random::{key, uniform};
use sprung::engine::{Ensemble, Event, EventKind};
use sprung::params::{PARAMS, Param};
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

const FRAMES: usize = 24_000;
const SOUNDS: u64 = 40;

/// Numbers from 0 to 1, by turns.
struct Stream {
    key: u64,
    n: u64,
}

impl Stream {
    fn next(&mut self) -> f64 {
        self.n += 1;
        f64::from(uniform(self.key, self.n)) * 0.5 + 0.5
    }
}

/// A random patch of 1 to 64 modes. Every third one is left at its defaults but for the modes and the exciter, so that
/// all forms of the kernels come up: mono and stereo, ringing, swept and driven, classic.
fn patch(stream: &mut Stream, sound: u64) -> Patch {
    let mut patch = Patch::default();
    if !sound.is_multiple_of(3) {
        for info in PARAMS {
            patch.set(info.param, info.denormalise(stream.next()));
        }
    }
    patch.set(Param::Exciter, (sound % 4) as f32);
    patch.set(Param::Coefficients, f32::from(u8::from(sound % 7 == 6)));
    let pan = if sound.is_multiple_of(2) { 0.0 } else { 1.0 };
    let modes: Vec<Mode> = (0..1 + (stream.next() * stream.next() * 64.0) as usize)
        .map(|_| Mode {
            ratio: (0.5 + 20.0 * stream.next() * stream.next()) as f32,
            level: (stream.next() * 0.3) as f32,
            decay: (0.01 + stream.next()) as f32,
            strike: stream.next() as f32,
            pan: ((stream.next() * 2.0 - 1.0) * pan) as f32,
        })
        .collect();
    patch.modes = ModeTable::new(&modes);
    patch
}

/// Notes, releases, bends, pressure and parameters, thick at first and then left to ring.
fn events(stream: &mut Stream) -> Vec<Event> {
    let mut events: Vec<Event> = (0..60)
        .map(|_| {
            let frame = (stream.next() * stream.next() * FRAMES as f64) as u32;
            let (key, value) = (36 + (stream.next() * 48.0) as u8, stream.next() as f32);
            let kind = match (stream.next() * 10.0) as u8 {
                0..=4 => EventKind::NoteOn { key, detune: value, velocity: value, id: -1 },
                5 => EventKind::NoteOff { key, velocity: value, id: -1 },
                6 => EventKind::PitchBend(value * 2.0 - 1.0),
                7 => EventKind::ChannelPressure(value),
                8 => EventKind::Control { controller: [1, 7, 10, 11, 64][(value * 4.9) as usize], value },
                _ => {
                    let info = &PARAMS[(stream.next() * PARAMS.len() as f64) as usize % PARAMS.len()];
                    EventKind::Param { param: info.param, value: info.denormalise(value.into()) }
                }
            };
            Event { frame, channel: (frame % 2) as u8, kind }
        })
        .collect();
    events.sort_by_key(|event| event.frame);
    events
}

/// The bits of every sound, the factory's and random ones, mixed into one number (FNV-1a), and the loudest sample.
fn render_all() -> (u64, f32) {
    let (mut hash, mut loudest) = (0xCBF2_9CE4_8422_2325_u64, 0.0_f32);
    let factory = Preset::factory();
    for sound in 0..SOUNDS + factory.len() as u64 {
        let mut stream = Stream { key: key(3, sound), n: 0 };
        let random = patch(&mut stream, sound);
        let patch = factory.get(sound as usize).map_or(random, |preset| preset.patch);
        let events = events(&mut stream);
        let mut ensemble = Ensemble::new(48_000.0, sound, &patch, &[]);
        let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
        ensemble.process(&events, &mut left, &mut right);
        for sample in left.iter().chain(&right) {
            hash = (hash ^ u64::from(sample.to_bits())).wrapping_mul(0x0000_0100_0000_01B3);
            loudest = loudest.max(sample.abs());
        }
    }
    (hash, loudest)
}

#[test]
fn all_levels_give_the_same_bits() {
    let mut found: Vec<(Level, u64)> = vec![];
    for level in Level::ALL {
        if !level.force() {
            println!("{}: ignored, this CPU does not have it", level.name());
            continue;
        }
        let (hash, loudest) = render_all();
        println!("{}: {hash:016x}", level.name());
        assert!(loudest > 0.1, "something sounded");
        found.push((level, hash));
    }
    assert!(!found.is_empty() && found.iter().all(|(_, hash)| *hash == found[0].1), "{found:x?}");
}
