//! The state of a MIDI channel: pitch wheel, pressure, controllers and registered parameters.

use super::gain::StereoGain;
use super::midi::{controller, seven_bits};
use super::modulation::Positions;
use super::portamento::{NoteGlide, Portamento};
use crate::params::PlayMode;
use crate::patch::routes::Source;

/// The controllers of a channel, in the units that voices use. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    /// −1 to 1.
    pub(crate) bend: f32,
    /// Bend range in semitones, if RPN 0 has set it. It overrides the patch's.
    pub(crate) bend_range: Option<f32>,
    /// 0–1.
    pub(crate) wheel: f32,
    /// 0–1.
    pub(crate) pressure: f32,
    /// −0.5 to 0.5, from controller 74.
    pub(crate) brightness: f32,
    /// 0–1.
    pub(crate) breath: f32,
    /// Whether the soft pedal is down.
    pub(crate) soft: bool,
    volume: f32,
    /// 0–1.
    pub(crate) expression: f32,
    pan: f32,
    balance: f32,
    gain: StereoGain,
    registered: Registered,
    portamento: Portamento,
    /// Whether the legato footswitch is down.
    legato: bool,
    /// Whether mono mode or poly mode was chosen; none for the patch's mode.
    mono: Option<bool>,
}

/// The registered parameters that a channel has: bend range, fine tuning and coarse tuning.
#[derive(Clone, Copy, Debug)]
struct Registered {
    /// The parameter that data entry sets, as most and least significant seven bits; (127, 127) is none.
    number: (u8, u8),
    /// Values of the three parameters, as most and least significant seven bits.
    data: [(u8, u8); 3],
}

impl Registered {
    const NONE: (u8, u8) = (127, 127);
    const BEND_RANGE: usize = 0;
    const FINE: usize = 1;
    const COARSE: usize = 2;
    const MPE: (u8, u8) = (0, 6);
    /// A bend range of two semitones, and no transposition.
    const INITIAL: Self = Self { number: Self::NONE, data: [(2, 0), (64, 0), (64, 0)] };

    /// The value that data entry sets; none if there is no such parameter.
    fn selected(&mut self) -> Option<&mut (u8, u8)> {
        let (0, number) = self.number else { return None };
        self.data.get_mut(usize::from(number))
    }

    fn semitones_and_cents(&self) -> f32 {
        let (semitones, cents) = self.data[Self::BEND_RANGE];
        f32::from(semitones) + f32::from(cents) / 100.0
    }

    fn tuning(&self) -> f32 {
        let (high, low) = self.data[Self::FINE];
        let fine = (f32::from(high) * 128.0 + f32::from(low) - 8192.0) / 8192.0;
        f32::from(self.data[Self::COARSE].0) - 64.0 + fine
    }
}

impl Channel {
    /// A channel in its power-on state: wheel and pan centred, volume and expression at maximum.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self {
            bend: 0.0,
            bend_range: None,
            wheel: 0.0,
            pressure: 0.0,
            brightness: 0.0,
            breath: 0.0,
            soft: false,
            volume: 1.0,
            expression: 1.0,
            pan: 0.5,
            balance: 0.5,
            gain: StereoGain::new(sample_rate),
            registered: Registered::INITIAL,
            portamento: Portamento::default(),
            legato: false,
            mono: None,
        }
    }

    /// Handles a controller at a value 0–1. The voice manager handles sustain, sostenuto and mode messages.
    pub(crate) fn control(&mut self, controller: u8, value: f32) {
        let data = seven_bits(value);
        self.portamento.control(controller, value);
        match controller {
            controller::LEGATO => self.legato = value >= 0.5,
            controller::MONO => self.mono = Some(true),
            controller::POLY => self.mono = Some(false),
            controller::WHEEL => self.wheel = value,
            controller::BREATH => self.breath = value,
            controller::SOFT => self.soft = value >= 0.5,
            controller::BRIGHTNESS => self.brightness = centred(value) - 0.5,
            controller::VOLUME => self.volume = value,
            controller::EXPRESSION => self.expression = value,
            controller::PAN => self.pan = centred(value),
            controller::BALANCE => self.balance = centred(value),
            controller::RPN => self.registered.number.0 = data,
            controller::RPN_FINE => self.registered.number.1 = data,
            controller::NRPN | controller::NRPN_FINE => self.registered.number = Registered::NONE,
            controller::DATA => self.enter(|entry| *entry = (data, 0)),
            controller::DATA_FINE => self.enter(|entry| entry.1 = data),
            controller::INCREMENT => self.step(1),
            controller::DECREMENT => self.step(-1),
            controller::RESET => self.reset_controllers(),
            _ => {}
        }
        if controller::is_gain(controller) || controller == controller::RESET {
            let gain = self.volume * self.volume * self.expression * self.expression;
            // A pan does not mix the sides of a sound, so it is a balance: both positions add up.
            self.gain.aim(gain, (self.pan + (self.balance - 0.5)).clamp(0.0, 1.0));
        }
    }

    /// Changes the value of the selected registered parameter.
    fn enter(&mut self, change: impl FnOnce(&mut (u8, u8))) {
        if let Some(entry) = self.registered.selected() {
            change(entry);
            if self.registered.number.1 == Registered::BEND_RANGE as u8 {
                self.bend_range = Some(self.registered.semitones_and_cents());
            }
        }
    }

    /// Changes the selected registered parameter by a step: a semitone, but the finest one of fine tuning. (RP-018 has cents for the
    /// bend range, which most devices set in semitones.)
    fn step(&mut self, by: i32) {
        let is_fine = self.registered.number.1 == Registered::FINE as u8;
        self.enter(|entry| {
            let unit = if is_fine { 1 } else { 128 };
            let value = 128 * i32::from(entry.0) + i32::from(entry.1) + unit * by;
            if (0..128 * 128).contains(&value) {
                *entry = ((value / 128) as u8, (value % 128) as u8);
            }
        });
    }

    /// Whether data entry sets the size of an MPE zone.
    pub(crate) fn awaits_zone(&self) -> bool {
        self.registered.number == Registered::MPE
    }

    /// Whether data entry sets the bend range.
    pub(crate) fn awaits_bend_range(&self) -> bool {
        self.registered.number == (0, Registered::BEND_RANGE as u8)
    }

    /// The glide of a note that starts now, if it is not its patch's.
    pub(crate) fn glide(&mut self) -> Option<NoteGlide> {
        self.portamento.start()
    }

    /// The mode that the channel's controllers have chosen; none for the patch's.
    pub(crate) fn mode(&self) -> Option<PlayMode> {
        match self.mono {
            _ if self.legato => Some(PlayMode::Legato),
            Some(true) => Some(PlayMode::Mono),
            Some(false) => Some(PlayMode::Poly),
            None => None,
        }
    }

    /// Tuning in semitones set by RPN 1 and 2.
    pub(crate) fn tuning(&self) -> f32 {
        self.registered.tuning()
    }

    /// "Reset all controllers" according to RP-015: volume, pan and registered parameters keep their values.
    fn reset_controllers(&mut self) {
        self.bend = 0.0;
        self.wheel = 0.0;
        self.breath = 0.0;
        self.pressure = 0.0;
        self.expression = 1.0;
        self.soft = false;
        self.legato = false;
        self.registered.number = Registered::NONE;
    }

    /// Left and right gain `frames` frames from now.
    pub(crate) fn gains_after(&self, frames: u32) -> (f32, f32) {
        self.gain.after(frames).into()
    }

    /// Frames that gains take to reach their target.
    pub(crate) fn slope_frames(&self) -> u32 {
        self.gain.slope_frames()
    }

    /// Sets the gains to their targets at once.
    pub(crate) fn land(&mut self) {
        self.gain.land();
    }

    /// Advances the gains by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.gain.advance(frames);
    }
}

/// The channels whose controllers a voice follows.
#[derive(Clone, Copy)]
pub(crate) struct Wheels<'a> {
    /// The note's own channel.
    pub(crate) channel: &'a Channel,
    /// The master channel of the note's MPE zone.
    pub(crate) master: Option<&'a Channel>,
}

impl Wheels<'_> {
    /// The greater of a controller's values on the channel and on its master.
    pub(super) fn most(&self, position: impl Fn(&Channel) -> f32) -> f64 {
        self.master.map_or(0.0, &position).max(position(self.channel)).into()
    }

    /// Bend and tuning in semitones.
    pub(super) fn semitones(&self, bend_range: f32) -> (f64, f64) {
        let bend = |channel: &Channel| f64::from(channel.bend) * f64::from(channel.bend_range.unwrap_or(bend_range));
        let tuning = |channel: &Channel| f64::from(channel.tuning());
        let own = (bend(self.channel), tuning(self.channel));
        self.master.map_or(own, |master| (own.0 + bend(master), own.1 + tuning(master)))
    }

    /// Controller positions as modulation sources, for a note whose brightness is −0.5 to 0.5. Only the sources for
    /// which `is_read` is true are set.
    pub(super) fn positions(&self, brightness: f64, is_read: impl Fn(Source) -> bool) -> Positions {
        let mut positions = Positions { timbre: (2.0 * brightness) as f32, ..Positions::default() };
        if is_read(Source::Pressure) {
            positions.pressure = self.most(|channel| channel.pressure) as f32;
        }
        if is_read(Source::Bend) {
            let master = self.master.map_or(0.0, |master| master.bend);
            positions.bend = (self.channel.bend + master).clamp(-1.0, 1.0);
        }
        if is_read(Source::Wheel) {
            positions.wheel = self.most(|channel| channel.wheel) as f32;
        }
        if is_read(Source::Breath) {
            positions.breath = self.most(|channel| channel.breath) as f32;
        }
        if is_read(Source::Expression) {
            positions.expression = self.channel.expression * self.master.map_or(1.0, |master| master.expression);
        }
        positions
    }

    pub(super) fn gains_after(&self, frames: u32) -> (f32, f32) {
        let (left, right) = self.channel.gains_after(frames);
        let master = self.master.map_or((1.0, 1.0), |master| master.gains_after(frames));
        (left * master.0, right * master.1)
    }
}

/// Maps a controller's value so that MIDI's centre, 64 of 127, becomes 0.5: 1–127 are symmetrical, as RP-036
/// recommends.
fn centred(value: f32) -> f32 {
    ((value * 127.0 - 1.0) / 126.0).clamp(0.0, 1.0)
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
    fn rpn_1_and_2_tune_each_for_itself() {
        for (entries, semitones) in [
            (&[(101, 0), (100, 2), (6, 66), (100, 1), (6, 80), (38, 0)][..], 2.25),
            (&[(101, 0), (100, 1), (6, 112), (38, 0)], 0.75),
            (&[(101, 0), (100, 1), (6, 16)], -0.75),
            (&[(101, 0), (100, 2), (6, 66), (100, 1), (6, 127), (38, 127), (6, 64)], 2.0),
            (&[(101, 0), (100, 0), (6, 12), (100, 1), (38, 0)], 0.0),
            (&[(101, 0), (100, 2), (96, 0), (96, 0), (97, 0)], 1.0),
            (&[(101, 0), (100, 1), (97, 0), (96, 0), (96, 0)], 1.0 / 8192.0),
            (&[(101, 0), (100, 1), (6, 127), (38, 127), (96, 0)], 8191.0 / 8192.0),
        ] {
            let mut channel = Channel::new(48_000.0);
            data(&mut channel, entries);
            assert!((channel.tuning() - semitones).abs() < 2e-4, "{entries:?}: {}", channel.tuning());
        }
    }

    #[test]
    fn a_fine_entry_alone_keeps_the_semitones() {
        let mut channel = Channel::new(48_000.0);
        data(&mut channel, &[(101, 0), (100, 0), (38, 50)]);
        assert_eq!(channel.bend_range, Some(2.5));
        data(&mut channel, &[(96, 127)]);
        assert_eq!(channel.bend_range, Some(3.5));
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
        data(&mut channel, &[(10, 127), (8, 1), (7, 127)]);
        assert_eq!(channel.gains_after(480), (1.0, 1.0), "pan to the right, balance to the left");
    }

    #[test]
    fn reset_keeps_volume_and_bend_range() {
        let mut channel = Channel::new(48_000.0);
        data(&mut channel, &[(101, 0), (100, 0), (6, 7), (1, 127), (67, 127), (11, 10), (121, 0)]);
        assert_eq!((channel.wheel, channel.soft, channel.bend_range), (0.0, false, Some(7.0)));
        assert_eq!(channel.gains_after(480), (1.0, 1.0));
    }
}
