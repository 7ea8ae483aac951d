//! The system's MIDI ports as live input: connects the wanted ones as they appear and disappear.

use super::block_clock::Stamp;
use super::live::{LiveEvent, LiveSender};
use crate::engine::midi::parse_message;
use midir::{Ignore, MidiInput, MidiInputConnection, MidiInputPort};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Time between two searches for ports.
const SCAN: Duration = Duration::from_secs(1);

const CLIENT: &str = "sprung";

/// The MIDI ports to listen to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// All ports.
    All,
    /// Ports whose name contains this text.
    Named(String),
}

impl Wanted {
    pub(super) fn wants(&self, name: &str) -> bool {
        match self {
            Self::All => true,
            Self::Named(part) => name.to_lowercase().contains(&part.to_lowercase()),
        }
    }
}

struct Connected {
    id: String,
    name: String,
    _connection: MidiInputConnection<()>,
}

/// Connections to MIDI ports. `MidiPorts::poll` must be called regularly.
pub(crate) struct MidiPorts {
    wanted: Wanted,
    /// Shared by the ports' threads, none of which is the audio thread.
    sender: Arc<Mutex<LiveSender>>,
    connected: Vec<Connected>,
    scan_at: Instant,
    /// Whether keys of a port that has disappeared may still be down.
    is_releasing: bool,
    /// The problem that was reported last, and is still there.
    problem: Option<String>,
}

impl MidiPorts {
    /// Makes no connections yet.
    pub(crate) fn new(wanted: Wanted, sender: LiveSender) -> Self {
        Self {
            wanted,
            sender: Arc::new(Mutex::new(sender)),
            connected: vec![],
            scan_at: Instant::now(),
            is_releasing: false,
            problem: None,
        }
    }

    /// Ends the connections, releases the held keys, and returns the sender.
    pub(super) fn into_sender(mut self) -> Option<LiveSender> {
        // Each connection's thread refers to the sender, and ends with the connection.
        self.connected.clear();
        let mut sender = Arc::into_inner(self.sender)?.into_inner().ok()?;
        sender.release_held();
        Some(sender)
    }

    /// Connects new ports and drops those that have disappeared. Returns messages for the user: what was done, or
    /// what went wrong.
    pub(crate) fn poll(&mut self) -> Vec<Result<String, String>> {
        if Instant::now() < self.scan_at {
            return vec![];
        }
        self.scan_at = Instant::now() + SCAN;
        let mut news = vec![];
        let problem = self.scan(&mut news);
        if problem != self.problem {
            news.extend(problem.clone().map(Err));
            self.problem = problem;
        }
        news
    }

    /// Connects and drops ports, and adds messages about them to `news`. Returns the present problem, if any.
    fn scan(&mut self, news: &mut Vec<Result<String, String>>) -> Option<String> {
        let input = match MidiInput::new(CLIENT) {
            Ok(input) => input,
            Err(error) => return Some(format!("no MIDI: the system has no sequencer ({error})")),
        };
        let ports: Vec<(MidiInputPort, String)> =
            input.ports().into_iter().filter_map(|port| input.port_name(&port).ok().map(|name| (port, name))).collect();
        let released = self.connected.len();
        self.connected.retain(|connected| {
            let stays = ports.iter().any(|(port, _)| port.id() == connected.id);
            if !stays {
                news.push(Err(format!("MIDI port ‘{}’ is gone; waiting for it to come back", connected.name)));
            }
            stays
        });
        let is_lost = self.connected.len() < released;
        // A port that has disappeared cannot release its held keys.
        self.is_releasing |= is_lost;
        if self.is_releasing
            && let Ok(mut sender) = self.sender.lock()
        {
            self.is_releasing = !sender.release_held();
        }
        let mut failed = vec![];
        for (port, name) in &ports {
            let id = port.id();
            let new = self.connected.iter().all(|connected| connected.id != id);
            if new && self.wanted.wants(name) && !name.starts_with(CLIENT) {
                match connect(port, name, self.sender.clone()) {
                    Some(connection) => {
                        news.push(Ok(format!("MIDI port ‘{name}’ is connected")));
                        self.connected.push(Connected { id, name: name.clone(), _connection: connection });
                    }
                    None => failed.push(format!("‘{name}’")),
                }
            }
        }
        if !failed.is_empty() {
            return Some(format!("MIDI port {} cannot be connected", failed.join(", ")));
        }
        match &self.wanted {
            // That a port is gone has just been said.
            Wanted::Named(part) if self.connected.is_empty() && !is_lost => {
                let names: Vec<_> = ports.iter().map(|(_, name)| format!("‘{name}’")).collect();
                let there = if names.is_empty() {
                    "there is none".to_owned()
                } else {
                    format!("there are {}", names.join(", "))
                };
                Some(format!("no MIDI port has ‘{part}’ in its name ({there}); waiting for one"))
            }
            _ => None,
        }
    }
}

/// The names of the MIDI ports of this system.
pub fn names() -> Vec<String> {
    MidiInput::new(CLIENT)
        .map_or_else(|_| vec![], |input| input.ports().iter().filter_map(|port| input.port_name(port).ok()).collect())
}

/// The MIDI ports of this system, as text.
pub fn list() -> String {
    let ports = names();
    let ports: String = match ports.is_empty() {
        true => "  no ports\n".to_owned(),
        false => ports.iter().map(|name| format!("  --midi-in {name:?}\n")).collect(),
    };
    format!("MIDI\n{ports}")
}

fn connect(port: &MidiInputPort, name: &str, sender: Arc<Mutex<LiveSender>>) -> Option<MidiInputConnection<()>> {
    let mut input = MidiInput::new(CLIENT).ok()?;
    input.ignore(Ignore::All);
    let receive = move |_: u64, bytes: &[u8], (): &mut ()| {
        let stamp = Stamp::System(Instant::now());
        if let Some((channel, kind)) = parse_message(bytes)
            && let Ok(mut sender) = sender.lock()
        {
            sender.send(LiveEvent { stamp, channel, kind });
        }
    };
    input.connect(port, name, receive, ()).ok()
}
