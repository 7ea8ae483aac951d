//! What a MIDI channel remembers: its wheel, pressure, controllers and registered parameters.

use crate::dsp::ramp::Ramp;
use libm::sqrtf;

/// Channel controllers, in the units that voices use them in. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    /// −1 to 1.
    pub(crate) bend: f32,
    /// Bend range in semitones set by RPN 0, which overrides the patch's.
    pub(crate) bend_range: Option<f32>,
    /// Tuning in semitones set by RPN 1 and 2.
    pub(crate) tuning: f32,
    /// 0–1.
    pub(crate) wheel: f32,
    /// 0–1.
    pub(crate) pressure: f32,
    /// The soft pedal.
    pub(crate) soft: bool,
    volume: f32,
    expression: f32,
    pan: f32,
    gains: [Ramp; 2],
    ramp_frames: u32,
    registered: Registered,
}

/// The registered parameter that data entry goes to, as most and least significant seven bits; 127, 127 is none.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Registered {
    number: (u8, u8),
    data: (u8, u8),
}

impl Registered {
    const NONE: Self = Self { number: (127, 127), data: (0, 0) };
}

/// Controllers that a channel itself acts on.
mod controller {
    pub(super) const WHEEL: u8 = 1;
    pub(super) const DATA: u8 = 6;
    pub(super) const VOLUME: u8 = 7;
    pub(super) const PAN: u8 = 10;
    pub(super) const EXPRESSION: u8 = 11;
    pub(super) const DATA_FINE: u8 = 38;
    pub(super) const SOFT: u8 = 67;
    pub(super) const NRPN_FINE: u8 = 98;
    pub(super) const NRPN: u8 = 99;
    pub(super) const RPN_FINE: u8 = 100;
    pub(super) const RPN: u8 = 101;
    pub(super) const RESET: u8 = 121;
}

impl Channel {
    /// A channel as after power-on: wheel centred, volume and expression full, pan centred.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self {
            bend: 0.0,
            bend_range: None,
            tuning: 0.0,
            wheel: 0.0,
            pressure: 0.0,
            soft: false,
            volume: 1.0,
            expression: 1.0,
            pan: 0.5,
            gains: [Ramp::at_rest(1.0); 2],
            // Controllers come in steps of 1/127; 10 ms make a slope of them.
            ramp_frames: (0.01 * sample_rate) as u32,
            registered: Registered::NONE,
        }
    }

    /// Takes in a controller at a value 0–1. Pedals that hold notes and mode messages are the voice manager's.
    pub(crate) fn control(&mut self, controller: u8, value: f32) {
        let data = (value * 127.0 + 0.5) as u8;
        match controller {
            controller::WHEEL => self.wheel = value,
            controller::SOFT => self.soft = value >= 0.5,
            controller::VOLUME => self.volume = value,
            controller::EXPRESSION => self.expression = value,
            // MIDI's centre is 64 of 127: 1–127 about 64, as RP-036 recommends.
            controller::PAN => self.pan = ((value * 127.0 - 1.0) / 126.0).clamp(0.0, 1.0),
            controller::RPN => self.registered.number.0 = data,
            controller::RPN_FINE => self.registered.number.1 = data,
            controller::NRPN | controller::NRPN_FINE => self.registered = Registered::NONE,
            controller::DATA => {
                self.registered.data = (data, 0);
                self.set_registered();
            }
            controller::DATA_FINE => {
                self.registered.data.1 = data;
                self.set_registered();
            }
            controller::RESET => self.reset_controllers(),
            _ => {}
        }
        if matches!(controller, controller::VOLUME | controller::EXPRESSION | controller::PAN | controller::RESET) {
            let gain = self.volume * self.volume * self.expression * self.expression;
            let (left, right) = pan_gains(self.pan);
            self.gains[0].set(gain * left, self.ramp_frames);
            self.gains[1].set(gain * right, self.ramp_frames);
        }
    }

    /// RPN 0: bend range, 1: fine tuning, 2: coarse tuning.
    fn set_registered(&mut self) {
        let (coarse, fine) = (f32::from(self.registered.data.0), f32::from(self.registered.data.1));
        match self.registered.number {
            (0, 0) => self.bend_range = Some(coarse + fine / 100.0),
            (0, 1) => self.tuning = self.tuning_coarse() + (coarse * 128.0 + fine - 8192.0) / 8192.0,
            (0, 2) => self.tuning = coarse - 64.0 + (self.tuning - self.tuning_coarse()),
            _ => {}
        }
    }

    fn tuning_coarse(&self) -> f32 {
        libm::roundf(self.tuning)
    }

    /// "Reset all controllers" as RP-015 has it: volume, pan and registered parameters keep their values.
    fn reset_controllers(&mut self) {
        self.bend = 0.0;
        self.wheel = 0.0;
        self.pressure = 0.0;
        self.expression = 1.0;
        self.soft = false;
        self.registered = Registered::NONE;
    }

    /// Left and right gain `frames` frames from now.
    pub(crate) fn gains_after(&self, frames: u32) -> (f32, f32) {
        (self.gains[0].after(frames), self.gains[1].after(frames))
    }

    /// Lets `frames` frames pass.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.gains.iter_mut().for_each(|gain| gain.advance(frames));
    }
}

/// Gains of a position from 0 (left) to 1 (right): of constant power, and exactly 1 and 1 in the centre.
pub(crate) fn pan_gains(position: f32) -> (f32, f32) {
    (sqrtf(2.0 * (1.0 - position)), sqrtf(2.0 * position))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(channel: &mut Channel, entries: &[(u8, u8)]) {
        entries.iter().for_each(|(controller, value)| channel.control(*controller, f32::from(*value) / 127.0));
    }

    #[test]
    fn rpn_0_sets_the_bend_range_in_semitones_and_cents() {
        let mut channel = Channel::new(48_000.0);
        data(&mut channel, &[(101, 0), (100, 0), (6, 12), (38, 50)]);
        assert_eq!(channel.bend_range, Some(12.5));
        data(&mut channel, &[(101, 127), (100, 127), (6, 2)]);
        assert_eq!(channel.bend_range, Some(12.5), "no registered parameter: data entry goes nowhere");
        data(&mut channel, &[(101, 0), (100, 0), (99, 1), (98, 1), (6, 3)]);
        assert_eq!(channel.bend_range, Some(12.5), "nor to an unregistered one");
    }

    #[test]
    fn rpn_1_and_2_tune() {
        let mut channel = Channel::new(48_000.0);
        data(&mut channel, &[(101, 0), (100, 2), (6, 66), (100, 1), (6, 80), (38, 0)]);
        assert!((channel.tuning - 2.25).abs() < 1e-6, "{}", channel.tuning);
    }

    #[test]
    fn gains_are_unity_at_rest_and_arrive_in_10_ms() {
        let mut channel = Channel::new(48_000.0);
        assert_eq!(channel.gains_after(0), (1.0, 1.0));
        data(&mut channel, &[(10, 64)]);
        channel.advance(480);
        assert_eq!(channel.gains_after(0), (1.0, 1.0), "a centred pan changes nothing");
        data(&mut channel, &[(10, 127), (7, 0)]);
        let (left, right) = channel.gains_after(240);
        assert!((left - 0.5).abs() < 1e-6 && (right - 0.5).abs() < 1e-6);
        assert_eq!(channel.gains_after(480), (0.0, 0.0));
    }

    #[test]
    fn reset_keeps_volume_and_bend_range() {
        let mut channel = Channel::new(48_000.0);
        data(&mut channel, &[(101, 0), (100, 0), (6, 7), (1, 127), (67, 127), (11, 10), (121, 0)]);
        assert_eq!((channel.wheel, channel.soft, channel.bend_range), (0.0, false, Some(7.0)));
        assert_eq!(channel.gains_after(480), (1.0, 1.0));
    }
}
