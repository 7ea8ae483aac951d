//! MIDI Tuning Standard: bulk dumps, single notes and octaves, in real time or not, as pitches of keys on channels.
//!
//! A device has tuning programs, each with a pitch for every key, and each channel plays one of them: program 0, until registered
//! parameters 3 and 4 choose another program and bank (MIDI Tuning, MIDI Manufacturers Association, 1999). An octave tuning sets the
//! keys of its channels at once; as a dump it is a program. Requests of dumps change nothing. Drums on channel 10 are not tuned.

use super::limits::MAX_EVENTS;
use super::system_exclusive::is_reset;
use crate::engine::EventKind;
use crate::engine::banks::DRUM_CHANNEL;
use crate::engine::midi::controller::{DATA, NRPN, NRPN_FINE, RESET, RPN, RPN_FINE};
use crate::engine::midi::seven_bits;
use std::collections::BTreeMap;

/// Registered parameters, by their less significant bytes: tuning program and tuning bank.
const PROGRAM: u8 = 3;
const BANK: u8 = 4;

/// Characters of the name in a dump.
const NAME: usize = 16;

/// A pitch for each key, in semitones.
type Pitches = [f32; 128];

/// What a message changes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Change {
    /// Pitches of keys in a tuning program, which has its bank in the upper seven bits.
    Keys { program: u16, keys: Vec<(u8, f32)> },
    /// Semitones by which all channels are off: by master fine tuning, or coarse (GM2, 4.1), whichever the place says.
    Master { place: usize, semitones: f32 },
    /// Semitones by which each step of the octave, from C, is off; on the channels whose bits are set.
    Octave { channels: u16, offsets: [f32; 12] },
    /// All channels and the master are as they were at first; what tuning programs are stays.
    Reset,
}

/// A tuning message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Message {
    change: Change,
    /// Whether sounding notes follow.
    sounding: bool,
}

impl Message {
    /// Reads a system exclusive message after its byte F0; none if it is of another kind.
    pub(super) fn read(message: &[u8]) -> Option<Self> {
        let master = |place, semitones| Some(Self { change: Change::Master { place, semitones }, sounding: true });
        let (universal, kind, data) = match message {
            _ if is_reset(message) => return Some(Self { change: Change::Reset, sounding: true }),
            [0x7F, _, 0x04, 0x03, fine, coarse, 0xF7] => {
                return master(0, offset(*coarse, *fine));
            }
            [0x7F, _, 0x04, 0x04, _, coarse, 0xF7] => return master(1, f32::from(*coarse) - 64.0),
            [universal @ (0x7E | 0x7F), _, 0x08, kind, data @ .., 0xF7] => (universal, kind, data),
            _ => return None,
        };
        let program = |bank: u8, program: u8| u16::from(bank) << 7 | u16::from(program);
        let change = match (kind, data) {
            (0x01, [number, rest @ ..]) => Change::Keys { program: program(0, *number), keys: dump(rest)? },
            (0x04, [bank, number, rest @ ..]) => Change::Keys { program: program(*bank, *number), keys: dump(rest)? },
            (0x02, [number, _, keys @ ..]) => Change::Keys { program: program(0, *number), keys: notes(keys) },
            (0x07, [bank, number, _, keys @ ..]) => {
                Change::Keys { program: program(*bank, *number), keys: notes(keys) }
            }
            (0x05 | 0x06, [bank, number, rest @ ..]) => {
                let steps = if *kind == 0x05 { 12 } else { 24 };
                let offsets = octave(rest.get(NAME..NAME + steps)?)?;
                let keys = (0..).zip(stretched(offsets)).collect();
                Change::Keys { program: program(*bank, *number), keys }
            }
            (0x08 | 0x09, [high, middle, low, steps @ ..]) => {
                Change::Octave { channels: channels([*high, *middle, *low]), offsets: octave(steps)? }
            }
            _ => return None,
        };
        Some(Self { change, sounding: *universal == 0x7F })
    }
}

/// The semitones by which the steps of an octave are off: a byte of cents for each, or two of 1/8192 of a semitone.
fn octave(steps: &[u8]) -> Option<[f32; 12]> {
    if let Ok(cents) = <&[u8; 12]>::try_from(steps) {
        return Some(cents.map(|cents| (f32::from(cents) - 64.0) / 100.0));
    }
    let steps: &[u8; 24] = steps.try_into().ok()?;
    Some(std::array::from_fn(|step| offset(steps[2 * step], steps[2 * step + 1])))
}

/// Semitones, −1 to 1, in two bytes.
fn offset(high: u8, low: u8) -> f32 {
    (f32::from(high) * 128.0 + f32::from(low) - 8192.0) / 8192.0
}

/// The pitches of all keys by the offsets of the octave's steps.
fn stretched(offsets: [f32; 12]) -> Pitches {
    std::array::from_fn(|key| key as f32 + offsets[key % 12])
}

/// The pitches of a bulk dump, after its program: sixteen characters, three bytes for each key, and a checksum, which is not
/// looked at: there are programs that count other bytes in.
fn dump(data: &[u8]) -> Option<Vec<(u8, f32)>> {
    let pitches = data.get(NAME..NAME + 3 * 128)?;
    Some((0..).zip(pitches.chunks_exact(3)).filter_map(|(key, bytes)| Some((key, pitch(bytes)?))).collect())
}

/// The keys of a single note change, each with its pitch.
fn notes(data: &[u8]) -> Vec<(u8, f32)> {
    data.chunks_exact(4).filter_map(|bytes| Some((bytes[0], pitch(&bytes[1..])?))).collect()
}

/// A pitch: a key, and 14 bits of its semitone. None for the value that changes nothing.
fn pitch(bytes: &[u8]) -> Option<f32> {
    let [key, high, low] = *bytes else { return None };
    let fraction = (f32::from(high) * 128.0 + f32::from(low)) / 16_384.0;
    (bytes != [0x7F; 3]).then_some(f32::from(key) + fraction)
}

/// The channels of an octave tuning, a bit each. The first byte has the bits of channels 15 and 16.
fn channels([high, middle, low]: [u8; 3]) -> u16 {
    u16::from(high & 3) << 14 | u16::from(middle & 127) << 7 | u16::from(low & 127)
}

/// The state of a device, and the events that its channels get.
struct Device {
    /// Tuning programs that are not equal-tempered.
    programs: BTreeMap<u16, Pitches>,
    /// For each channel: the selected registered parameter, the tuning program, and the pitches that it has.
    selected: [[u8; 2]; 16],
    playing: [u16; 16],
    pitches: [Pitches; 16],
    /// The pitches without the master's fine and coarse tuning in semitones, and that.
    wanted: [Pitches; 16],
    master: [f32; 2],
    events: Vec<(u64, u8, EventKind)>,
}

/// The pitches of equal temperament.
fn equal() -> Pitches {
    std::array::from_fn(|key| key as f32)
}

/// Adds the pitches of keys that tuning messages, with their ticks, and changes of the tuning program give to channels. Events and
/// messages are in order of time; at one tick, the messages come first.
pub(super) fn spread(
    events: Vec<(u64, u8, EventKind)>,
    messages: &[(u64, Message)],
) -> Result<Vec<(u64, u8, EventKind)>, String> {
    if messages.is_empty() {
        return Ok(events);
    }
    let mut device = Device {
        programs: BTreeMap::new(),
        selected: [[127; 2]; 16],
        playing: [0; 16],
        master: [0.0; 2],
        wanted: [equal(); 16],
        pitches: [equal(); 16],
        events: Vec::with_capacity(events.len()),
    };
    let mut messages = messages.iter().peekable();
    for (tick, channel, kind) in events {
        while let Some((at, message)) = messages.next_if(|(at, _)| *at <= tick) {
            device.obey(*at, message)?;
        }
        device.events.push((tick, channel, kind));
        device.follow(tick, channel, &kind)?;
    }
    Ok(device.events)
}

impl Device {
    fn obey(&mut self, tick: u64, Message { change, sounding }: &Message) -> Result<(), String> {
        match change {
            Change::Keys { program, keys } => {
                let pitches = self.programs.entry(*program).or_insert_with(equal);
                for (key, pitch) in keys {
                    if let Some(place) = pitches.get_mut(usize::from(*key)) {
                        *place = *pitch;
                    }
                }
                let (pitches, playing) = (*pitches, self.playing);
                (0..16)
                    .filter(|channel| playing[usize::from(*channel)] == *program)
                    .try_for_each(|channel| self.tune(tick, channel, &pitches, *sounding))
            }
            Change::Master { place, semitones } => {
                self.master[*place] = *semitones;
                let wanted = self.wanted;
                (0..).zip(&wanted).try_for_each(|(channel, pitches)| self.tune(tick, channel, pitches, *sounding))
            }
            Change::Reset => {
                (self.master, self.playing) = ([0.0; 2], [0; 16]);
                let equal = self.programs.get(&0).copied().unwrap_or_else(equal);
                (0..16).try_for_each(|channel| self.tune(tick, channel, &equal, *sounding))
            }
            Change::Octave { channels, offsets } => {
                let pitches = stretched(*offsets);
                (0..16)
                    .filter(|channel| channels >> channel & 1 == 1)
                    .try_for_each(|channel| self.tune(tick, channel, &pitches, *sounding))
            }
        }
    }

    /// Follows the choice of a tuning program.
    fn follow(&mut self, tick: u64, channel: u8, kind: &EventKind) -> Result<(), String> {
        let EventKind::Control { controller, value } = *kind else { return Ok(()) };
        let (index, data) = (usize::from(channel), seven_bits(value));
        let playing = self.playing[index];
        match (controller, self.selected[index]) {
            (RPN, _) => self.selected[index][0] = data,
            (RPN_FINE, _) => self.selected[index][1] = data,
            // A parameter that is not registered is selected, or none.
            (NRPN | NRPN_FINE | RESET, _) => self.selected[index] = [127; 2],
            (DATA, [0, PROGRAM]) => self.playing[index] = playing & !127 | u16::from(data),
            (DATA, [0, BANK]) => self.playing[index] = playing & 127 | u16::from(data) << 7,
            _ => {}
        }
        if self.playing[index] == playing {
            return Ok(());
        }
        let pitches = self.programs.get(&self.playing[index]).copied().unwrap_or_else(equal);
        self.tune(tick, channel, &pitches, false)
    }

    /// Gives a channel the pitches that it does not have yet, with the master's tuning.
    fn tune(&mut self, tick: u64, channel: u8, pitches: &Pitches, sounding: bool) -> Result<(), String> {
        if channel == DRUM_CHANNEL {
            return Ok(());
        }
        self.wanted[usize::from(channel)] = *pitches;
        let own = &mut self.pitches[usize::from(channel)];
        for (key, (own, pitch)) in (0..).zip(own.iter_mut().zip(pitches)) {
            let pitch = pitch + self.master[0] + self.master[1];
            if *own != pitch {
                *own = pitch;
                self.events.push((tick, channel, EventKind::Tune { key, pitch, sounding }));
            }
        }
        if self.events.len() > MAX_EVENTS {
            return Err(format!("too many changes of the tuning: expected at most {MAX_EVENTS} events in all"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn control(tick: u64, controller: u8, value: u8) -> (u64, u8, EventKind) {
        (tick, 2, EventKind::Control { controller, value: f32::from(value) / 127.0 })
    }

    fn tuned(events: &[(u64, u8, EventKind)]) -> Vec<(u64, u8, u8, f32, bool)> {
        let tune = |(tick, channel, kind): &(u64, u8, EventKind)| match kind {
            EventKind::Tune { key, pitch, sounding } => Some((*tick, *channel, *key, *pitch, *sounding)),
            _ => None,
        };
        events.iter().filter_map(tune).collect()
    }

    #[test]
    fn single_notes_are_read_in_real_time_or_not() {
        for (bytes, program, sounding) in [
            (&[0x7F, 0x7F, 8, 2, 5, 2, 60, 67, 64, 0, 61, 0x7F, 0x7F, 0x7F, 0xF7][..], 5, true),
            (&[0x7E, 0x00, 8, 7, 1, 5, 1, 60, 67, 64, 0, 0xF7], 133, false),
            (&[0x7F, 0x00, 8, 7, 0, 5, 1, 60, 67, 64, 0, 0xF7], 5, true),
        ] {
            let change = Change::Keys { program, keys: vec![(60, 67.5)] };
            assert_eq!(Message::read(bytes), Some(Message { change, sounding }));
        }
        assert_eq!(Message::read(&[0x7E, 0x7F, 8, 0, 0, 0xF7]), None, "a request of a dump");
        assert_eq!(Message::read(&[0x7E, 0x7F, 8, 1, 0, 0xF7]), None, "a dump without its keys");
    }

    #[test]
    fn a_bulk_dump_tunes_every_key_of_the_channels_that_play_its_program() {
        let keys = (0..128).flat_map(|key| if key == 69 { [69, 64, 0] } else { [key, 0, 0] });
        let dump: Vec<u8> =
            [0x7E, 0, 8, 1, 3].into_iter().chain(*b"sixteen letters.").chain(keys).chain([0, 0xF7]).collect();
        let message = Message::read(&dump).unwrap();
        let choose = [control(5, RPN, 0), control(5, RPN_FINE, PROGRAM), control(5, DATA, 3), control(9, DATA, 0)];
        let events = spread(choose.to_vec(), &[(0, message)]).unwrap();
        assert_eq!(tuned(&events), [(5, 2, 69, 69.5, false), (9, 2, 69, 69.0, false)]);
    }

    #[test]
    fn a_dump_of_an_octave_is_a_program() {
        let choose = [
            control(5, RPN, 0),
            control(5, RPN_FINE, BANK),
            control(5, DATA, 2),
            control(5, RPN_FINE, PROGRAM),
            control(5, DATA, 3),
        ];
        let coarse = [&[64; 4][..], &[50], &[64; 7]].concat();
        let fine = [[0x40, 0].repeat(4), vec![0x20, 0], [0x40, 0].repeat(7)].concat();
        for (kind, steps, offset) in [(5, coarse, -0.14), (6, fine, -0.5)] {
            let whole = [&[0x7E, 0, 8, kind, 2, 3][..], b"sixteen letters.", &steps, &[0, 0xF7]].concat();
            let events = spread(choose.to_vec(), &[(0, Message::read(&whole).unwrap())]).unwrap();
            let tuned = tuned(&events);
            // Every E, from the choice of the program on.
            assert_eq!((tuned.len(), tuned[0], tuned[10].2), (11, (5, 2, 4, 4.0 + offset, false), 124), "{kind}");
            let short = [&whole[..whole.len() - 3], &[0xF7]].concat();
            assert_eq!(Message::read(&short), None, "{kind}: a dump without its last step");
        }
    }

    #[test]
    fn a_master_tuning_moves_all_keys_but_drums_and_adds_up() {
        let messages = [
            (5, Message::read(&[0x7F, 0x7F, 4, 4, 0, 66, 0xF7]).unwrap()),
            (6, Message::read(&[0x7F, 0x7F, 4, 3, 0, 0x20, 0xF7]).unwrap()),
            (7, Message::read(&[0x7E, 0x7F, 9, 1, 0xF7]).unwrap()),
        ];
        let events = spread(vec![control(9, 7, 100)], &messages).unwrap();
        let tuned = tuned(&events);
        assert_eq!((tuned.len(), tuned[60]), (3 * 15 * 128, (5, 0, 60, 62.0, true)));
        assert_eq!((tuned[15 * 128 + 60], tuned[15 * 128 + 9 * 128].1), ((6, 0, 60, 61.5, true), 10));
        assert_eq!(tuned[2 * 15 * 128 + 60], (7, 0, 60, 60.0, true), "a reset takes it back");
    }

    #[test]
    fn other_parameters_and_a_reset_choose_no_tuning_program() {
        let message = Message::read(&[0x7F, 0x7F, 8, 2, 5, 1, 60, 67, 64, 0, 0xF7]).unwrap();
        for (between, tunes) in [(7, 1), (NRPN, 0), (NRPN_FINE, 0), (RESET, 0)] {
            let choose =
                [control(1, RPN, 0), control(1, RPN_FINE, PROGRAM), control(1, between, 1), control(2, DATA, 5)];
            let events = spread(choose.to_vec(), &[(0, message.clone())]).unwrap();
            assert_eq!(tuned(&events).len(), tunes, "{between}");
        }
    }

    #[test]
    fn octaves_tune_the_channels_they_name() {
        let mut bytes = vec![0x7F, 0, 8, 8, 0, 0, 0b100];
        bytes.extend([64, 64, 64, 64, 50, 64, 64, 64, 64, 64, 64, 64, 0xF7]);
        let events = spread(vec![control(1, 7, 100)], &[(0, Message::read(&bytes).unwrap())]).unwrap();
        let tuned = tuned(&events);
        assert_eq!((tuned.len(), tuned[0]), (11, (0, 2, 4, 4.0 - 0.14, true)));
        let mut bytes = vec![0x7E, 0, 8, 9, 3, 127, 127];
        bytes.extend([0x40, 0].repeat(11));
        bytes.extend([0x7F, 0x7F, 0xF7]);
        let events = spread(vec![control(1, 7, 100)], &[(0, Message::read(&bytes).unwrap())]).unwrap();
        // All channels but that of drums, the ten highest keys of the octave.
        assert_eq!(events.len(), 1 + 15 * 10);
    }
}
