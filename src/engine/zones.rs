//! MPE zones: member channels that carry one note each, and a master channel whose messages apply to all members.
//!
//! Source: MIDI Polyphonic Expression 1.0 (M1-100-UM): a configuration message is registered parameter 6 on channel
//! 1 (the lower zone) or 16 (the upper zone), whose value is the number of member channels.

use super::event::unit;
use super::midi::{controller, seven_bits};
use super::note::nearest_channel;
use super::{Event, EventKind};

/// Bend range of member channels, in semitones.
pub(crate) const MEMBER_BEND_RANGE: f32 = 48.0;

const LOWER_MASTER: u8 = 0;
const UPPER_MASTER: u8 = 15;

/// The zones in use; none until a configuration message arrives. Real-time safe.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Zones {
    lower: u8,
    upper: u8,
}

impl Zones {
    /// Handles a configuration message. Ignores it if `channel` cannot be a master. If two zones overlap, the later one
    /// gets the channels.
    pub(crate) fn configure(&mut self, channel: u8, members: u8) {
        let members = members.min(15);
        let (zone, other) = match channel {
            LOWER_MASTER => (&mut self.lower, &mut self.upper),
            UPPER_MASTER => (&mut self.upper, &mut self.lower),
            _ => return,
        };
        *zone = members;
        // Sixteen channels minus two masters.
        *other = (*other).min(14_u8.saturating_sub(members));
    }

    /// The master channel of the zone that `channel` is a member of.
    pub(crate) fn master_of(&self, channel: u8) -> Option<u8> {
        if (1..=self.lower).contains(&channel) {
            Some(LOWER_MASTER)
        } else if channel < UPPER_MASTER && channel >= UPPER_MASTER - self.upper {
            Some(UPPER_MASTER)
        } else {
            None
        }
    }

    /// The channels that a message on `channel` affects: itself, and the members of its zone if it is a master.
    pub(crate) fn reach(&self, channel: u8) -> impl Iterator<Item = u8> + use<> {
        let zones = *self;
        (0..16).filter(move |other| *other == channel || zones.master_of(*other) == Some(channel))
    }

    /// The channels with the same bend range as `channel`: all members of its zone, or only itself if it is no member.
    pub(crate) fn siblings(&self, channel: u8) -> impl Iterator<Item = u8> + use<> {
        let (zones, master) = (*self, self.master_of(channel));
        (0..16).filter(move |other| *other == channel || (master.is_some() && zones.master_of(*other) == master))
    }
}

/// Maps each channel of an ensemble to the channel whose instrument plays it: the master's for members of a zone, else
/// its own. Real-time safe.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Owners {
    zones: Zones,
    /// For the lower and the upper master: whether each byte of the selected registered parameter's number is that of
    /// the MPE configuration. If both are, the next data entry gives the number of members.
    chosen: [[bool; 2]; 2],
}

impl Owners {
    /// The channel whose instrument plays `channel`.
    pub(crate) fn of(&self, channel: u8) -> u8 {
        self.zones.master_of(channel).unwrap_or(channel)
    }

    /// Handles an event. Returns the master channel and the number of members if it configures a zone.
    pub(crate) fn hear(&mut self, event: &Event) -> Option<(u8, u8)> {
        let EventKind::Control { controller: number, value } = event.kind else { return None };
        let channel = nearest_channel(event.channel);
        if number == controller::RESET {
            for (master, chosen) in [LOWER_MASTER, UPPER_MASTER].into_iter().zip(&mut self.chosen) {
                if master == channel || self.zones.master_of(master) == Some(channel) {
                    *chosen = [false; 2];
                }
            }
            return None;
        }
        let chosen = match channel {
            LOWER_MASTER => &mut self.chosen[0],
            UPPER_MASTER => &mut self.chosen[1],
            _ => return None,
        };
        let data = seven_bits(unit(value));
        match number {
            controller::RPN => chosen[0] = data == 0,
            controller::RPN_FINE => chosen[1] = data == ZONE_PARAMETER,
            controller::NRPN | controller::NRPN_FINE => *chosen = [false; 2],
            controller::DATA if *chosen == [true; 2] => {
                self.zones.configure(channel, data);
                return Some((channel, data));
            }
            _ => {}
        }
        None
    }
}

/// Number of the registered parameter for the MPE configuration.
const ZONE_PARAMETER: u8 = 6;

#[cfg(test)]
mod tests {
    use super::*;

    fn members(zones: &Zones, master: u8) -> Vec<u8> {
        zones.reach(master).filter(|channel| *channel != master).collect()
    }

    #[test]
    fn zones_grow_from_both_ends_and_the_later_one_wins() {
        let mut zones = Zones::default();
        assert!(members(&zones, 0).is_empty());
        zones.configure(0, 3);
        zones.configure(15, 2);
        assert_eq!((members(&zones, 0), members(&zones, 15)), (vec![1, 2, 3], vec![13, 14]));
        assert_eq!((zones.master_of(2), zones.master_of(14), zones.master_of(7)), (Some(0), Some(15), None));
        assert_eq!(zones.siblings(2).collect::<Vec<_>>(), [1, 2, 3]);
        assert_eq!(zones.siblings(7).collect::<Vec<_>>(), [7]);
        zones.configure(15, 12);
        assert_eq!((members(&zones, 0), members(&zones, 15).len()), (vec![1, 2], 12));
        zones.configure(0, 15);
        assert_eq!((members(&zones, 0).len(), members(&zones, 15)), (15, vec![]));
        zones.configure(0, 0);
        assert_eq!(zones.master_of(1), None);
        zones.configure(5, 3);
        assert!((0..16).all(|channel| zones.master_of(channel).is_none()));
    }
}
