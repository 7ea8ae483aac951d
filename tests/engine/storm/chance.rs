//! Random cases, as bytes for [`super::case::decode`].
//!
//! Each case uses its own selection of event kinds and pause lengths (as in "Swarm Testing", Groce et al. 2012). So
//! cases are found that only explode without a certain event, and a case without events that move gains has a sharp
//! bound.

use super::case::{Kind, PARAM_IDS, RECORD};
use sprung::internals::random::{Sequence, key};

/// The parameters with the largest effect on pitch and damping: half of the cases set some of them.
const MOVING: [&str; 9] =
    ["glide", "vibrato", "vibrato_rate", "mode", "sweep", "sweep_time", "release", "decay", "bend_range"];

struct Stream(Sequence);

impl Stream {
    /// 0–1.
    fn unit(&mut self) -> f64 {
        f64::from(self.0.uniform()) * 0.5 + 0.5
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }

    /// A random byte, in half of the cases at an end of its range.
    fn edgy(&mut self) -> u8 {
        [0, 255, self.byte(), self.byte()][self.below(4)]
    }
}

fn byte_of(kind: Kind) -> u8 {
    Kind::ALL.iter().position(|other| *other == kind).expect("every kind is listed") as u8
}

/// The bytes of case number `serial` of a seed.
pub(crate) fn case(seed: u64, serial: u64) -> Vec<u8> {
    let mut stream = Stream(Sequence::new(key(seed, serial)));
    let s = &mut stream;
    let preset = if s.chance(0.25) { 128 + s.byte() / 2 } else { 0 };
    let ensemble = if s.chance(0.01) { 128 } else { 0 };
    // One in four plays on many outputs. It is not drawn, so that all cases are what they were before there were such outputs.
    let outputs = if serial % 4 == 3 { 64 } else { 0 };
    // Few cases are long, and few use tiny blocks.
    let tail = if s.chance(0.05) { 200 + s.below(40) } else { 100 + s.below(100) } as u8;
    let block = [0, 0, 0, 1, 2, 3, 5, 6][s.below(8)];
    let mut bytes = vec![s.byte(), preset, ensemble | outputs | block, s.byte(), tail];

    // Many patches have only a few changed parameters; some are completely random.
    let params = PARAM_IDS.split_whitespace().count();
    let settings = if s.chance(0.1) { params } else { s.below(10) };
    for n in 0..settings {
        let param = if settings == params { n } else { s.below(params) };
        bytes.extend([byte_of(Kind::Set), 0, param as u8, s.edgy(), s.byte()]);
    }
    if s.chance(0.5) {
        for id in MOVING {
            if s.chance(0.5) {
                let param = PARAM_IDS.split_whitespace().position(|other| other == id).expect("an id of the list");
                bytes.extend([byte_of(Kind::Set), 0, param as u8, s.edgy(), s.byte()]);
            }
        }
    }
    if s.chance(0.4) {
        for _ in 0..1 + s.below(8) {
            bytes.extend([byte_of(Kind::Route), s.byte(), s.byte(), s.byte(), s.edgy()]);
        }
    }
    if s.chance(0.4) {
        let modes = if s.chance(0.1) { 1 + s.below(64) } else { 1 + s.below(4) };
        // Most ratios are between 0.5 and 20.
        let spread = if s.chance(0.2) { 256.0 } else { 80.0 };
        for _ in 0..modes {
            let ratio = (128.0 - 0.35 * spread + s.unit() * spread).clamp(0.0, 255.0) as u8;
            bytes.extend([byte_of(Kind::Mode), ratio, s.edgy(), s.byte(), s.edgy()]);
        }
    }

    let few = s.chance(0.7);
    let mut menu: Vec<Kind> =
        Kind::ALL[3..].iter().copied().filter(|_| s.chance(if few { 0.15 } else { 0.6 })).collect();
    let notes = 1 + s.below(4);
    menu.extend(std::iter::repeat_n(Kind::NoteOn, menu.len() / notes + 1));
    let longest_pause = [1, 9, 40, 128, 160, 190][s.below(6)];
    let most = if s.chance(0.02) { 300 } else { 1 + s.below(40) };
    let events = 1 + s.below(most);
    let (lowest, keys) = [(0, 128), (60, 1), (115, 13), (0, 12), (36, 48)][s.below(5)];
    for n in 0..events {
        let kind = if n == 0 { Kind::NoteOn } else { menu[s.below(menu.len())] };
        let pause = s.below(longest_pause) as u8;
        let [a, b, c] = match kind {
            Kind::NoteOn => [(lowest + s.below(keys)) as u8, s.edgy().max(1), if few { 0 } else { s.byte() }],
            Kind::NoteOff => [(lowest + s.below(keys)) as u8, s.byte(), 0],
            Kind::Roll => [(lowest + s.below(keys)) as u8, s.byte(), s.byte() / 2],
            Kind::Bend | Kind::ChannelPressure => [0, s.edgy(), 0],
            Kind::Registered => [s.byte(), s.byte(), 0],
            _ => [s.byte(), s.edgy(), s.byte()],
        };
        bytes.extend([byte_of(kind), pause, a, b, c]);
    }
    debug_assert_eq!(bytes.len() % RECORD, 0);
    bytes
}
