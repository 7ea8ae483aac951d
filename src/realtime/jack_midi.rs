//! A JACK port as live input, with the exact frame of each event from JACK.

use super::block_clock::Stamp;
use super::live::{LiveEvent, LiveSender};
use super::midi_ports::Wanted;
use crate::engine::midi::parse_message;
use jack::{AsyncClient, Client, ClientOptions, ClientStatus, Control, MidiIn, Port, PortFlags, ProcessScope};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// Time between two searches for ports, or for a server that was lost.
const SCAN: Duration = Duration::from_secs(1);

/// How long a client may take to end.
const END: Duration = Duration::from_secs(2);

/// A MIDI input port in the JACK graph. `JackMidi::poll` must be called regularly.
pub(crate) struct JackMidi {
    wanted: Option<Wanted>,
    client: Option<AsyncClient<Notifications, Process>>,
    /// Kept here while there is no client.
    sender: Option<LiveSender>,
    home: (Sender<LiveSender>, Receiver<LiveSender>),
    gone: Arc<AtomicBool>,
    scan_at: Instant,
}

struct Notifications(Arc<AtomicBool>);

impl jack::NotificationHandler for Notifications {
    #[expect(unsafe_code, reason = "the trait asks for what a signal handler may do; this sets a flag")]
    unsafe fn shutdown(&mut self, _: ClientStatus, _: &str) {
        self.0.store(true, Ordering::Release);
    }
}

struct Process {
    port: Port<MidiIn>,
    sender: Option<LiveSender>,
    home: Sender<LiveSender>,
}

impl jack::ProcessHandler for Process {
    fn process(&mut self, client: &Client, scope: &ProcessScope) -> Control {
        let cycle = scope.last_frame_time();
        if let Some(sender) = &mut self.sender {
            for message in self.port.iter(scope) {
                if let Some((channel, kind)) = parse_message(message.bytes) {
                    let at = client.frames_to_time(cycle.wrapping_add(message.time));
                    let stamp = Stamp::Device(Duration::from_micros(at));
                    sender.send(LiveEvent { stamp, channel, kind });
                }
            }
        }
        Control::Continue
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        if let Some(sender) = self.sender.take() {
            // This fails if the receiver no longer exists.
            let _ = self.home.send(sender);
        }
    }
}

impl JackMidi {
    /// Nothing is opened yet. The user can still connect ports that are not `wanted`.
    pub(crate) fn new(wanted: Option<Wanted>, sender: LiveSender) -> Self {
        Self {
            wanted,
            client: None,
            sender: Some(sender),
            home: channel(),
            gone: Arc::new(AtomicBool::new(false)),
            scan_at: Instant::now(),
        }
    }

    /// Closes the port, releases the held keys, and returns the sender; none if the server does not answer.
    pub(super) fn into_sender(mut self) -> Option<LiveSender> {
        if let Some(client) = self.client.take() {
            // Dropping the client of a dead server can take long.
            std::thread::spawn(move || drop(client));
        }
        let mut sender = self.sender.take().or_else(|| self.home.1.recv_timeout(END).ok())?;
        sender.release_held();
        Some(sender)
    }

    /// Opens the port if there is a server, and connects the wanted ports. Returns messages for the user.
    pub(crate) fn poll(&mut self) -> Vec<Result<String, String>> {
        if self.gone.swap(false, Ordering::AcqRel)
            && let Some(client) = self.client.take()
        {
            // Dropping the client of a dead server can take long.
            std::thread::spawn(move || drop(client));
        }
        if Instant::now() < self.scan_at {
            return vec![];
        }
        self.scan_at = Instant::now() + SCAN;
        let mut news = vec![];
        if self.client.is_none() {
            if self.sender.is_none() {
                self.sender = self.home.1.try_recv().ok();
            }
            let Some(mut sender) = self.sender.take() else { return news };
            sender.release_held();
            self.client = open(sender, self.home.0.clone(), self.gone.clone());
            if self.client.is_none() {
                self.sender = self.home.1.try_recv().ok();
                return news;
            }
            news.push(Ok("MIDI port ‘sprung:midi_in’ is open".to_owned()));
        }
        if let (Some(client), Some(wanted)) = (&self.client, &self.wanted) {
            let client = client.as_client();
            let flags = match wanted {
                Wanted::All => PortFlags::IS_OUTPUT | PortFlags::IS_PHYSICAL,
                Wanted::Named(_) => PortFlags::IS_OUTPUT,
            };
            let own = format!("{}:midi_in", client.name());
            for port in client.ports(None, Some("midi"), flags).into_iter().filter(|port| wanted.wants(port)) {
                // Fails if the two are connected already.
                if client.connect_ports_by_name(&port, &own).is_ok() {
                    news.push(Ok(format!("MIDI port ‘{port}’ is connected")));
                }
            }
        }
        news
    }
}

fn open(
    sender: LiveSender,
    home: Sender<LiveSender>,
    gone: Arc<AtomicBool>,
) -> Option<AsyncClient<Notifications, Process>> {
    let opened = Client::new("sprung", ClientOptions::NO_START_SERVER).ok().and_then(|(client, _)| {
        let port = client.register_port("midi_in", MidiIn::default()).ok()?;
        Some((client, port))
    });
    let Some((client, port)) = opened else {
        let _ = home.send(sender);
        return None;
    };
    client.activate_async(Notifications(gone), Process { port, sender: Some(sender), home }).ok()
}
