//! Random events and parameters, like those of plugin validators: the output stays finite and reproducible.

use crate::host::reference::{assert_clean, assert_same_bits, assert_sound};
use crate::host::{Address, Instance, Parameter, Rendered, Sent, Timed};
use crate::thorough;
use clack_host::events::event_types::NoteExpressionType as Kind;
use sprung::internals::random::{key, uniform};

/// A source of random choices.
struct Dice {
    stream: u64,
    n: u64,
}

impl Dice {
    fn new(seed: u64) -> Self {
        Self { stream: key(seed, 77), n: 0 }
    }

    /// Uniform in 0–1, without 1.
    fn unit(&mut self) -> f64 {
        self.n += 1;
        f64::from(uniform(self.stream, self.n) + 1.0) / 2.0
    }

    fn below(&mut self, end: u32) -> u32 {
        (self.unit() * f64::from(end)) as u32
    }

    fn note(&mut self) -> Address {
        Address::note(self.below(16) as i16, self.below(128) as i16, self.below(40) as i32)
    }

    /// A single note, or an address with wildcards that match many notes.
    fn address(&mut self) -> Address {
        let mut address = self.note();
        for field in [&mut address.channel, &mut address.key] {
            if self.below(4) == 0 {
                *field = -1;
            }
        }
        if self.below(3) == 0 {
            address.id = -1;
        }
        address
    }

    fn event(&mut self, parameters: &[Parameter]) -> Sent {
        let parameter = &parameters[self.below(parameters.len() as u32) as usize];
        let kinds =
            [Kind::Volume, Kind::Pan, Kind::Tuning, Kind::Vibrato, Kind::Expression, Kind::Brightness, Kind::Pressure];
        match self.below(12) {
            0..=2 => Sent::On(self.note(), self.unit()),
            3 => Sent::Off(self.address(), self.unit()),
            4 => Sent::Choke(self.address()),
            5 => Sent::Express(self.address(), kinds[self.below(7) as usize], self.unit() * 8.0 - 3.0),
            6 | 7 => {
                let value = self.unit() * parameter.max;
                Sent::Value(parameter.id, if parameter.max > 1.0 { value.round() } else { value })
            }
            8 => Sent::Modulate(parameter.id, self.address(), (self.unit() - 0.5) * 2.0 * parameter.max),
            9 => Sent::Tempo(20.0 + 300.0 * self.unit()),
            10 => Sent::Midi([0x80 + self.below(128) as u8, self.below(128) as u8, self.below(128) as u8]),
            _ => Sent::Midi([0xB0 + self.below(16) as u8, 116 + self.below(12) as u8, self.below(128) as u8]),
        }
    }

    fn song(&mut self, parameters: &[Parameter], events: usize, frames: u64) -> Vec<Timed> {
        let mut song: Vec<Timed> = (0..events)
            .map(|_| {
                let frame = (self.unit() * frames as f64) as u64;
                self.event(parameters).at(frame)
            })
            .collect();
        song.sort_by_key(|timed| timed.frame);
        song
    }
}

fn play(song: &[Timed], rate: f64, frames: usize, block: impl FnMut() -> usize) -> Rendered {
    Instance::new().play(rate, 8192).render(song, frames, block)
}

pub(crate) fn random_events_give_clean_sound_at_every_rate() {
    let parameters = Instance::new().parameters();
    for (rate, seed) in [1_234.567_8, 8_000.0, 44_100.0, 48_000.0, 192_000.0, 768_000.0].into_iter().zip(0..) {
        let mut dice = Dice::new(seed);
        let frames = thorough::of(9_600, 48_000);
        let song = dice.song(&parameters, frames / 32, frames as u64);
        let rendered = play(&song, rate, 2 * frames, || 1 + dice.below(700) as usize);
        assert_sound(&format!("{rate} Hz"), &rendered.channels);
    }
}

/// Random events give the same samples and the same ended notes for all block sizes.
pub(crate) fn random_events_sound_the_same_in_all_blocks() {
    let parameters = Instance::new().parameters();
    for seed in (10..).take(thorough::of(3, 8)) {
        let mut dice = Dice::new(seed);
        let song = dice.song(&parameters, 400, 12_000);
        let whole = play(&song, 48_000.0, 14_400, || 8_192);
        let single = play(&song, 48_000.0, 14_400, || 1);
        let random = play(&song, 48_000.0, 14_400, || 1 + dice.below(900) as usize);
        assert_sound(&format!("seed {seed}"), &whole.channels);
        for (what, other) in [("blocks of 1", single), ("random blocks", random)] {
            assert_same_bits(&format!("seed {seed}, {what}"), &other.channels, &whole.channels);
            let notes = |rendered: &Rendered| {
                let mut notes: Vec<Address> = rendered.ended.iter().map(|end| end.note).collect();
                notes.sort_unstable();
                notes
            };
            assert_eq!(notes(&other), notes(&whole), "seed {seed}, {what}: ended notes");
        }
    }
}

/// Random values of all parameters at once, each with some notes, as parameter fuzzers do.
pub(crate) fn random_settings_sound_clean() {
    let parameters = Instance::new().parameters();
    for seed in (30..).take(thorough::of(15, 60)) {
        let mut dice = Dice::new(seed);
        let mut song: Vec<Timed> = parameters
            .iter()
            .map(|parameter| {
                let extreme = [0.0, 1.0, dice.unit(), dice.unit()][dice.below(4) as usize];
                Sent::Value(parameter.id, (extreme * parameter.max).round().clamp(0.0, parameter.max)).at(0)
            })
            .collect();
        for (timed, parameter) in song.iter_mut().zip(&parameters) {
            if parameter.max <= 1.0 {
                let position = [0.0, 1.0, dice.unit(), dice.unit()][dice.below(4) as usize];
                timed.sent = Sent::Value(parameter.id, position);
            }
        }
        for n in 0..6 {
            song.push(Sent::On(dice.note(), dice.unit()).at(n * 997));
        }
        let rendered = play(&song, 44_100.0, 22_050, || 441);
        assert_clean(&format!("settings {seed}"), &rendered.channels);
    }
}

/// Values far outside their ranges, sent during processing.
pub(crate) fn wild_values_sound_clean() {
    let parameters = Instance::new().parameters();
    let wild = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308, 5e-324, -0.0, 1e9];
    let mut song = Vec::new();
    for (n, value) in (0_u64..).zip(wild) {
        song.push(Sent::On(Address::note(0, 50 + n as i16, n as i32), 0.7).at(n * 500));
        for parameter in &parameters {
            song.push(Sent::Value(parameter.id, value).at(n * 500 + 7));
            song.push(Sent::Modulate(parameter.id, Address::id(-1), value).at(n * 500 + 9));
            song.push(Sent::Modulate(parameter.id, Address::id(n as i32), value).at(n * 500 + 11));
        }
    }
    song.sort_by_key(|timed| timed.frame);
    assert_clean("wild values", &play(&song, 48_000.0, 24_000, || 64).channels);
}
