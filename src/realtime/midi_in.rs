//! Live MIDI input: the system's ports, or a port of the JACK server.

use super::jack_midi::JackMidi;
use super::live::LiveSender;
use super::midi_ports::{MidiPorts, Wanted};

/// The source of live MIDI input.
pub enum MidiIn {
    /// No input.
    None(Box<LiveSender>),
    /// The system's ports.
    Ports(MidiPorts),
    /// A port of the JACK server.
    Jack(Box<JackMidi>),
}

impl MidiIn {
    /// Listens to `all` ports, to `none`, or to those whose name contains this text. `jack` is true if the device
    /// belongs to a JACK server.
    pub fn new(wanted: &str, jack: bool, sender: LiveSender) -> Self {
        let wanted = match wanted {
            "none" => None,
            "all" => Some(Wanted::All),
            name => Some(Wanted::Named(name.to_owned())),
        };
        match wanted {
            wanted if jack => Self::Jack(Box::new(JackMidi::new(wanted, sender))),
            Some(wanted) => Self::Ports(MidiPorts::new(wanted, sender)),
            None => Self::None(Box::new(sender)),
        }
    }

    /// Ends the input and returns the sender for use by another input; none if the system does not release it.
    pub fn into_sender(self) -> Option<LiveSender> {
        match self {
            Self::None(sender) => Some(*sender),
            Self::Ports(ports) => ports.into_sender(),
            Self::Jack(port) => port.into_sender(),
        }
    }

    /// Checks for ports that have appeared or disappeared, and returns messages about them. Must be called regularly.
    pub fn poll(&mut self) -> Vec<String> {
        match self {
            Self::None(_) => vec![],
            Self::Ports(ports) => ports.poll(),
            Self::Jack(port) => port.poll(),
        }
    }
}
