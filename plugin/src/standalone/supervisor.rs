//! Follows devices and ports, and saves the state, while the window is open.

use super::chosen::{choice, plain, substitute, systems};
use super::messages::{print, report, show, tell};
use super::player::WindowPlayer;
use super::store::Store;
use crate::devices::{Chosen, Devices, Output};
use crate::params::SprungParams;
use sprung::internals::realtime::{device, midi_ports};
use sprung::realtime::{Found, LiveInputs, LiveSender, MidiIn, Session, Status};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Time between two checks of devices, ports and requests.
const POLL: Duration = Duration::from_millis(50);

/// Time between two checks for changes to save.
const SAVE: Duration = Duration::from_secs(5);

/// Time between two searches for devices, while the window shows them.
const SEARCH: Duration = Duration::from_secs(3);

/// How long a window may take to close after it was asked to. A window that is not visible may never close.
const PATIENCE: Duration = Duration::from_secs(2);

/// A device that plays, with the senders of events for it: one for MIDI ports, one for the end.
pub(super) struct Opened {
    pub(super) session: Session<WindowPlayer>,
    senders: [LiveSender; 2],
}

impl Opened {
    /// Begins to play on the chosen device.
    pub(super) fn of(chosen: &Chosen, params: &Arc<SprungParams>) -> sprung::Result<Self> {
        let found = Found::find(&choice(chosen))?;
        let status = Arc::new(Status::of(params.link().telemetry.clone()));
        let (senders, inputs) = LiveInputs::new();
        let player = WindowPlayer::new(found.sample_rate(), params.clone(), inputs, status.clone());
        let started = Session::start(&found, choice(chosen), player, status);
        let session = started.inspect_err(|_| params.link().disconnect())?;
        Ok(Self { session, senders })
    }
}

/// A device that plays, what it listens to, and the sender for the end.
struct Playing {
    session: Session<WindowPlayer>,
    midi: Option<MidiIn>,
    closing: LiveSender,
}

/// Follows devices and ports, and saves the state, while the window is open. Runs on its own thread.
pub(super) struct Supervisor {
    pub(super) params: Arc<SprungParams>,
    pub(super) store: Store,
    /// Whether the window is closed.
    pub(super) is_closed: Arc<AtomicBool>,
    pub(super) chosen: Chosen,
}

impl Supervisor {
    /// Runs until the window is closed. Without an open device it waits for one.
    pub(super) fn run(mut self, opened: Option<Opened>) -> Result<(), String> {
        device::silence_library();
        let mut playing = opened.map(|opened| self.listening(opened));
        let mut asked: Option<Instant> = None;
        let mut save_at = Instant::now() + SAVE;
        let mut search_at = Instant::now();
        let mut open_at = Instant::now() + SEARCH;
        // A problem with the file is reported once.
        let mut reported = None;
        while !self.is_closed.load(Relaxed) {
            match &mut playing {
                Some(Playing { session, midi, .. }) => {
                    // Without a stream the device is gone, with one it has come back.
                    let news = session.poll();
                    if session.is_playing() {
                        tell(&self.params, news)
                    } else {
                        report(&self.params, news)
                    }
                    // Ports come and go, and the computer's keys play as well.
                    midi.iter_mut().flat_map(MidiIn::poll).for_each(|message| show(&self.params, message));
                }
                None if Instant::now() >= open_at => {
                    let open = |chosen: &Chosen| Opened::of(chosen, &self.params);
                    let first = open(&self.chosen).ok().map(|opened| (self.chosen.clone(), opened));
                    let found = first.or_else(|| substitute(&self.chosen, open, systems));
                    playing = found.map(|(chosen, opened)| self.begin(chosen, opened));
                    open_at = Instant::now() + SEARCH;
                }
                None => {}
            }
            let params = self.params.clone();
            let devices = &params.link().devices;
            if let Some(request) = devices.take_request() {
                match &mut playing {
                    Some(playing) => self.change(request, playing),
                    None => playing = self.open(request),
                }
                search_at = Instant::now();
            }
            if Instant::now() >= search_at && devices.was_watched() {
                devices.show(self.devices(playing.as_ref().map(|playing| &playing.session)));
                params.link().repaint.request_repaint();
                search_at = Instant::now() + SEARCH;
            }
            if Instant::now() > save_at {
                save_at = Instant::now() + SAVE;
                let problem = self.store.save_if_changed(&self.params).err();
                if problem != reported {
                    report(&self.params, problem.clone());
                    reported = problem;
                }
            }
            if self.params.link().is_closing() && asked.get_or_insert_with(Instant::now).elapsed() > PATIENCE {
                break;
            }
            std::thread::sleep(POLL);
        }
        // The state is written before the fade: if the user starts the program again at once, the file is complete and
        // unlocked.
        let ended = self.store.save(&self.params);
        drop(self.store);
        if let Some(Playing { session, midi, mut closing }) = playing {
            drop(midi);
            if !session.finish(&mut closing) {
                print("warning: the sound device does not answer; left it behind");
            }
        }
        if !self.is_closed.load(Relaxed) {
            // The window's thread still waits for its window, which does not close.
            if let Err(error) = &ended {
                print(&format!("error: {error}"));
            }
            std::process::exit(ended.is_err().into());
        }
        ended
    }

    /// Listens to the chosen MIDI ports for a device that plays.
    fn listening(&self, Opened { session, senders: [midi, closing] }: Opened) -> Playing {
        let midi = Some(self.listen(session.is_jack(), midi));
        Playing { session, midi, closing }
    }

    /// Begins with the first device.
    fn begin(&mut self, chosen: Chosen, opened: Opened) -> Playing {
        self.chosen = chosen;
        tell(&self.params, Some(format!("playing on {}", opened.session.description())));
        self.listening(opened)
    }

    /// Begins with the requested device, if it can be opened; if not, only the choice of ports holds.
    fn open(&mut self, request: Chosen) -> Option<Playing> {
        match Opened::of(&request, &self.params) {
            Ok(opened) => {
                let playing = self.begin(request, opened);
                report(&self.params, self.store.save_devices(&self.chosen).err());
                Some(playing)
            }
            Err(error) => {
                report(&self.params, Some(format!("{}; still silent", plain(&error))));
                // The ports are another matter.
                if request.midi_in != self.chosen.midi_in {
                    self.chosen.midi_in = request.midi_in;
                    report(&self.params, self.store.save_devices(&self.chosen).err());
                }
                None
            }
        }
    }

    /// Listens to the chosen MIDI ports.
    fn listen(&self, is_jack: bool, sender: LiveSender) -> MidiIn {
        MidiIn::new(self.chosen.midi_in.as_deref().unwrap_or("all"), is_jack, sender)
    }

    /// Plays on the requested device. If that fails, everything stays as it was.
    fn change(&mut self, mut request: Chosen, Playing { session, midi, .. }: &mut Playing) {
        let was_jack = session.is_jack();
        if choice(&request) != choice(&self.chosen) {
            let changed = session.change(choice(&request), WindowPlayer::set_sample_rate);
            let now = session.description();
            if let Err(error) = &changed {
                let then = if session.is_playing() { "still on" } else { "waiting for" };
                return report(&self.params, Some(format!("{}; {then} {now}", plain(error))));
            }
            tell(&self.params, Some(format!("playing on {now}")));
        }
        let is_other_system = was_jack != session.is_jack();
        // The ports have other names on the other system.
        if is_other_system && request.midi_in.as_deref() != Some("none") {
            request.midi_in = None;
        }
        let is_other_port = request.midi_in != self.chosen.midi_in || is_other_system;
        self.chosen = request;
        if is_other_port {
            *midi = midi.take().and_then(MidiIn::into_sender).map(|sender| self.listen(session.is_jack(), sender));
            let is_lost = midi.is_none().then(|| "MIDI does not answer: start the program again to hear it".to_owned());
            report(&self.params, is_lost);
        }
        report(&self.params, self.store.save_devices(&self.chosen).err());
    }

    /// The present devices and ports.
    fn devices(&self, session: Option<&Session<WindowPlayer>>) -> Devices {
        let output = |device::Output { host, id, description }| Output { host, id, description };
        // A JACK server connects its ports itself.
        let ports = if session.is_some_and(Session::is_jack) { vec![] } else { midi_ports::names() };
        let open = session.filter(|session| session.is_playing());
        let block = open.map_or(0, |_| self.params.link().devices.block());
        let playing = open.map_or(String::new(), |session| {
            let (about, delay) = (session.description(), 1000.0 * session.delay());
            format!("{about}, {block} frames a block, heard {delay:.1} ms after each key")
        });
        Devices {
            outputs: device::outputs().into_iter().map(output).collect(),
            rates: session.map_or(&[][..], Session::rates).to_vec(),
            ports: ports.iter().map(|name| lasting(name).to_owned()).collect(),
            chosen: self.chosen.clone(),
            block,
            playing,
        }
    }
}

/// A port's name without the numbers that ALSA appends: they change when the port is plugged in again.
fn lasting(name: &str) -> &str {
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let are_numbers =
        |last: &str| last.split_once(':').is_some_and(|(client, port)| is_number(client) && is_number(port));
    name.rsplit_once(' ').filter(|(_, last)| are_numbers(last)).map_or(name, |(stable, _)| stable)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_keep_their_names_when_they_are_plugged_in_again() {
        for (name, stable) in [
            ("Keystation 49:Keystation 49 MIDI 1 24:0", "Keystation 49:Keystation 49 MIDI 1"),
            ("Midi Through", "Midi Through"),
            ("Synth 1:2a", "Synth 1:2a"),
            ("", ""),
        ] {
            assert_eq!(lasting(name), stable);
        }
    }
}
