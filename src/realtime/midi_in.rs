//! Live MIDI input: the system's ports, or a port of the JACK server.

use super::jack_midi::JackMidi;
use super::live::LiveSender;
use super::midi_ports::{MidiPorts, Wanted};

/// The source of live MIDI input.
pub struct MidiIn(Kind);

enum Kind {
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
        Self(match wanted {
            wanted if jack => Kind::Jack(Box::new(JackMidi::new(wanted, sender))),
            Some(wanted) => Kind::Ports(MidiPorts::new(wanted, sender)),
            None => Kind::None(Box::new(sender)),
        })
    }

    /// Ends the input and returns the sender for use by another input; none if the system does not release it.
    pub fn into_sender(self) -> Option<LiveSender> {
        match self.0 {
            Kind::None(sender) => Some(*sender),
            Kind::Ports(ports) => ports.into_sender(),
            Kind::Jack(port) => port.into_sender(),
        }
    }

    /// Checks for ports that have appeared or disappeared, and returns messages about them: what was done, or what went wrong. Must be
    /// called regularly.
    pub fn poll(&mut self) -> Vec<Result<String, String>> {
        match &mut self.0 {
            Kind::None(_) => vec![],
            Kind::Ports(ports) => ports.poll(),
            Kind::Jack(port) => port.poll(),
        }
    }
}
