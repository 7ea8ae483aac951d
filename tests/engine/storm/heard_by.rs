//! Which events of a case reach which synth: that of their channel, or of all members of a zone.

use super::case::Case;
use super::gains::unit;
use sprung::engine::{Event, EventKind};

/// For each event, whether the synth of a channel receives it: events of its channel, or of a zone's members if it is
/// the master; all events if it is the only synth.
pub(crate) fn heard_by(case: &Case, index: u8) -> Vec<bool> {
    let (mut lower, mut upper, mut chosen) = (0_u8, 0_u8, [[127_u8; 2]; 16]);
    let mut is_heard = |event: &Event| {
        let channel = event.channel & 15;
        let master = |channel: u8| match channel {
            1..=15 if channel <= lower => Some(0),
            0..=14 if channel >= 15 - upper => Some(15),
            _ => None,
        };
        let owner = master(channel).unwrap_or(channel);
        if let EventKind::Control { controller, value } = event.kind {
            let data = (unit(value) * 127.0 + 0.5) as u8;
            match controller {
                101 => chosen[usize::from(channel)][0] = data,
                100 => chosen[usize::from(channel)][1] = data,
                98 | 99 => chosen[usize::from(channel)] = [127; 2],
                121 => {
                    let reset = (0..16_u8).filter(|other| *other == channel || master(*other) == Some(channel));
                    reset.for_each(|other| chosen[usize::from(other)] = [127; 2]);
                }
                6 if channel == 0 && chosen[0] == [0, 6] => {
                    lower = data.min(15);
                    upper = upper.min(14_u8.saturating_sub(lower));
                }
                6 if channel == 15 && chosen[15] == [0, 6] => {
                    upper = data.min(15);
                    lower = lower.min(14_u8.saturating_sub(upper));
                }
                _ => {}
            }
        }
        // The program changes of members do not apply to the master.
        owner == index && (owner == channel || !matches!(event.kind, EventKind::Program(_)))
    };
    case.events.iter().map(|event| !case.ensemble || is_heard(event)).collect()
}
