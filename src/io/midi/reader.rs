//! Reads the events of tracks by tick, and repairs or reports those that cannot be read.

use super::container::Track;
use super::fault::{Fault, Found, MOST_REPAIRS};
use super::limits::MAX_EVENTS;
use super::system_exclusive::DrumParts;
use super::tuning_standard;
use super::unheeded::Unheeded;
use crate::engine::EventKind;
use crate::engine::midi::parse_message;
use crate::io::bars::Bars;
use midly::live::LiveEvent;
use midly::num::u4;
use midly::{EventIter, MetaMessage, MidiMessage, Timing, TrackEvent, TrackEventKind};
use std::fmt;
use std::mem::discriminant;

/// The contents of the tracks that were read so far.
pub(super) struct TrackReader {
    /// Tick, channel and event.
    pub(super) events: Vec<(u64, u8, EventKind)>,
    /// Tick and microseconds per quarter note.
    pub(super) tempos: Vec<(u64, u32)>,
    pub(super) last_tick: u64,
    pub(super) repairs: Vec<Repair>,
    /// Tuning messages with their ticks.
    pub(super) tunings: Vec<(u64, tuning_standard::Message)>,
    pub(super) unheeded: Unheeded,
    pub(super) bars: Bars,
    drum_parts: DrumParts,
    lenient: bool,
}

/// A fault that was repaired, one or more times in a track.
pub(super) struct Repair {
    track: usize,
    /// The first fault of its kind.
    fault: Fault,
    /// How it was repaired.
    remedy: &'static str,
    /// Where it first occurred.
    place: String,
    times: usize,
}

/// The position of an event: its track number, its tick, and its first byte in the file.
#[derive(Clone, Copy)]
struct Spot {
    track: usize,
    tick: u64,
    byte: usize,
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { fault, remedy, place, times, .. } = self;
        write!(f, "{place}: {fault}: {remedy}")?;
        if *times > 1 { write!(f, " ({times} times in this track)") } else { Ok(()) }
    }
}

impl TrackReader {
    pub(super) fn new(timing: Timing, lenient: bool) -> Self {
        let (events, tempos, repairs) = (Vec::new(), Vec::new(), Vec::new());
        let (tunings, unheeded) = (Vec::new(), Unheeded::default());
        let (bars, drum_parts) = (Bars::new(timing), DrumParts::default());
        Self { events, tempos, last_tick: 0, repairs, tunings, unheeded, bars, drum_parts, lenient }
    }

    /// Reads the track with this number. Errors name the position.
    pub(super) fn read(&mut self, track: &Track, number: usize) -> Result<(), String> {
        let whole = track.bytes.len() == track.promised;
        let mut tick = 0u64;
        let mut events = EventIter::new(track.bytes);
        // Status byte of the last channel message. In lenient reading, it stays valid after meta events.
        let mut status = None;
        while let (rest, running, Some(event)) = (events.unread(), events.running_status(), events.next()) {
            let spot = |tick| Spot { track: number, tick, byte: track.start + track.bytes.len() - rest.len() };
            let Ok(event) = event else {
                let Found { fault, delta, after } = Fault::find(rest, running);
                let spot = spot(tick + u64::from(delta));
                match (fault, status, after) {
                    (Fault::CutOff, ..) => {
                        if whole {
                            self.repair(spot, fault, "left out")?;
                        }
                        break;
                    }
                    (Fault::NoStatus, Some(_), _) => {
                        self.repair(spot, fault, "running status continues")?;
                        events = EventIter::new(rest);
                        *events.running_status_mut() = status;
                    }
                    (_, _, Some(after)) => {
                        let mended = match fault {
                            Fault::Data(_, message) => mend(message),
                            _ => None,
                        };
                        let remedy = match (fault, mended) {
                            (Fault::LongTime, _) => "read nevertheless",
                            (_, Some(_)) => "127 is taken for it",
                            (_, None) => "left out",
                        };
                        self.repair(spot, fault, remedy)?;
                        if let Fault::Data(_, [running, ..]) = fault {
                            status = Some(running);
                        }
                        tick = spot.tick;
                        self.last_tick = self.last_tick.max(tick);
                        self.events.extend(mended.map(|(channel, kind)| (tick, channel, kind)));
                        self.check_count(spot)?;
                        events = EventIter::new(after);
                        *events.running_status_mut() = status;
                    }
                    _ => {
                        self.repair(spot, fault, "the rest of the track is left out")?;
                        break;
                    }
                }
                continue;
            };
            status = events.running_status().or(status);
            tick += u64::from(event.delta.as_int());
            self.last_tick = self.last_tick.max(tick);
            if self.take(event, spot(tick))? {
                break;
            }
        }
        if !whole {
            let (there, promised) = (track.bytes.len(), track.promised);
            let spot = Spot { track: number, tick, byte: track.start + there };
            self.repair(spot, Fault::FileCutOff([there, promised]), "played as far as it goes")?;
        }
        Ok(())
    }

    /// Handles an event. Returns true if it ends the track.
    fn take(&mut self, event: TrackEvent, spot: Spot) -> Result<bool, String> {
        let tick = spot.tick;
        match event.kind {
            TrackEventKind::Midi { channel, message } => {
                if let MidiMessage::Controller { controller, value } = message {
                    let bars = &self.bars;
                    let place = || format!("track {}, {}", spot.track, bars.place(tick));
                    self.unheeded.control(controller.as_int(), value.as_int(), place);
                }
                self.events.extend(translate(channel, message).map(|(channel, kind)| (tick, channel, kind)));
            }
            TrackEventKind::SysEx(message) => {
                let events = self.drum_parts.system_exclusive(message);
                if let Some(tuning) = tuning_standard::Message::read(message) {
                    self.tunings.push((tick, tuning));
                } else if events.is_empty() {
                    let bars = &self.bars;
                    self.unheeded.exclusive(|| format!("track {}, {}", spot.track, bars.place(tick)));
                }
                self.events.extend(events.into_iter().map(|(channel, kind)| (tick, channel, kind)));
            }
            TrackEventKind::Meta(MetaMessage::Tempo(tempo)) if tempo == 0 => {
                self.repair(spot, Fault::Tempo, "left out")?;
            }
            TrackEventKind::Meta(MetaMessage::Tempo(tempo)) => self.tempos.push((tick, tempo.as_int())),
            TrackEventKind::Meta(MetaMessage::TimeSignature(beats, note, ..)) => self.bars.change(tick, beats, note),
            TrackEventKind::Meta(MetaMessage::EndOfTrack) => return Ok(true),
            _ => {}
        }
        self.check_count(spot)?;
        Ok(false)
    }

    fn check_count(&self, spot: Spot) -> Result<(), String> {
        if self.events.len() + self.tempos.len() > MAX_EVENTS {
            return Err(self.refused(spot, &format!("too many events: expected at most {MAX_EVENTS} in the file")));
        }
        Ok(())
    }

    /// Records a repair. In strict reading, returns an error instead.
    fn repair(&mut self, spot: Spot, fault: Fault, remedy: &'static str) -> Result<(), String> {
        if !self.lenient {
            return Err(self.refused(spot, &fault.to_string()));
        }
        let is_full = self.repairs.len() >= MOST_REPAIRS;
        let mut of_track = self.repairs.iter_mut().rev().take_while(|repair| repair.track == spot.track);
        let is_alike =
            |repair: &&mut Repair| discriminant(&repair.fault) == discriminant(&fault) && repair.remedy == remedy;
        match of_track.find(is_alike) {
            Some(repair) => repair.times += 1,
            None if is_full => {
                return Err(self.refused(spot, &format!("more than {MOST_REPAIRS} faults: this is hardly a MIDI file")));
            }
            None => {
                let place = self.place(spot);
                self.repairs.push(Repair { track: spot.track, fault, remedy, place, times: 1 });
            }
        }
        Ok(())
    }

    fn refused(&self, spot: Spot, fault: &str) -> String {
        format!("{}: {fault}", self.place(spot))
    }

    fn place(&self, Spot { track, tick, byte }: Spot) -> String {
        format!("track {track}, {} (tick {tick}, byte {byte})", self.bars.place(tick))
    }
}

/// The event of a message with a data byte above 127, which is taken as 127. None if that would be another key or program.
fn mend(message: [u8; 3]) -> Option<(u8, EventKind)> {
    let [status, first, second] = message;
    let names_something = !matches!(status >> 4, 0xd | 0xe);
    let is_lost = names_something && first > 127;
    if is_lost { None } else { parse_message(&[status, first.min(127), second.min(127)]) }
}

/// The channel and event of a message, converted as if its bytes came from a MIDI port.
fn translate(channel: u4, message: MidiMessage) -> Option<(u8, EventKind)> {
    let mut bytes = [0; 3];
    LiveEvent::Midi { channel, message }.write_std(&mut bytes[..]).ok()?;
    parse_message(&bytes)
}
