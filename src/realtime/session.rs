//! A session: plays on a device that may disappear and come back.

use super::device::{Choice, Found};
use super::fade::FADE;
use super::live::LiveSender;
use super::player::Player;
use super::status::Status;
use super::stream::{self, Source};
use crate::error::{Error, Result};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// Time between two searches for a lost device.
const RETRY: Duration = Duration::from_secs(1);

/// A device that requests no block for this long is lost.
const PATIENCE: Duration = Duration::from_secs(4);

/// How long released notes may sound at the end. After that, the remaining sound is faded out.
const RELEASE: Duration = Duration::from_millis(700);

/// How long a stream may take to end.
const END: Duration = Duration::from_secs(2);

/// Plays on a device from [`Session::start`] until it is finished or dropped. [`Session::poll`] must be called
/// regularly.
pub struct Session<S: Source = Player> {
    choice: Choice,
    description: String,
    sample_rate: u32,
    is_jack: bool,
    rates: Vec<u32>,
    status: Arc<Status>,
    stream: Option<cpal::Stream>,
    /// Kept here while there is no stream.
    player: Option<Box<S>>,
    home: (Sender<Box<S>>, Receiver<Box<S>>),
    trouble: (Sender<String>, Receiver<String>),
    retry_at: Instant,
    last_frames: (u64, Instant),
}

impl<S: Source> Session<S> {
    /// Starts to play on a device. `choice` is the choice that led to the device; it is used again to find the device.
    ///
    /// # Errors
    /// [`Error::Value`] if the device cannot be started.
    pub fn start(found: &Found, choice: Choice, player: S, status: Arc<Status>) -> Result<Self> {
        let mut session = Self {
            choice: Choice { rate: Some(found.sample_rate()), ..choice },
            description: found.to_string(),
            sample_rate: found.sample_rate(),
            is_jack: found.is_jack(),
            rates: found.rates().to_vec(),
            status,
            stream: None,
            player: Some(Box::new(player)),
            home: channel(),
            trouble: channel(),
            retry_at: Instant::now(),
            last_frames: (0, Instant::now()),
        };
        session.open(found)?;
        Ok(session)
    }

    /// The device and its settings, as text.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Seconds from the time stamp of an event to the time at which the device says it is heard; 0 before the first block.
    pub fn delay(&self) -> f64 {
        self.status.delay()
    }

    /// Frames per second.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// Whether the device belongs to a JACK server.
    pub fn is_jack(&self) -> bool {
        self.is_jack
    }

    /// The sample rates to offer for this device, in Hz.
    pub fn rates(&self) -> &[u32] {
        &self.rates
    }

    /// Whether a stream is open on the device.
    pub fn is_playing(&self) -> bool {
        self.stream.is_some()
    }

    /// Changes to another device or other settings. `fit` adapts the player to a sample rate while no stream has the
    /// player.
    ///
    /// # Errors
    /// [`Error::Value`] if the device cannot be found or started: the session then returns to its old device, or waits
    /// for it.
    pub fn change(&mut self, choice: Choice, fit: impl Fn(&mut S, u32)) -> Result<()> {
        let is_same = (&choice.host, &choice.device) == (&self.choice.host, &self.choice.device);
        let found = match Found::find(&choice) {
            // A device that allows only one stream cannot be queried while it plays.
            Err(_) if is_same => None,
            found => Some(found?),
        };
        // A device can be opened again only when it is completely closed.
        if let Some(ended) = self.close() {
            let _ = ended.recv_timeout(END);
        }
        if self.player.is_none() {
            return Err(Error::value("--device", "the present one does not answer, so it cannot be left".to_owned()));
        }
        let before = self.sample_rate;
        let opened = found.map_or_else(|| Found::find(&choice), Ok).and_then(|found| {
            self.player.iter_mut().for_each(|player| fit(player, found.sample_rate()));
            self.open(&found).map(|()| found)
        });
        match opened {
            Ok(found) => {
                self.choice = Choice { rate: Some(found.sample_rate()), ..choice };
                (self.description, self.sample_rate) = (found.to_string(), found.sample_rate());
                self.is_jack = found.is_jack();
                self.rates = found.rates().to_vec();
                Ok(())
            }
            Err(error) => {
                self.player.iter_mut().for_each(|player| fit(player, before));
                // If this fails too, `poll` searches for the device as for one that has disappeared.
                self.retry_at = Instant::now();
                if let Ok(found) = Found::find(&self.choice) {
                    let _ = self.open(&found);
                }
                Err(error)
            }
        }
    }

    /// Checks the device. Returns a message when it has disappeared or come back.
    pub fn poll(&mut self) -> Option<String> {
        if self.stream.is_some() {
            let reason = self.trouble.1.try_iter().next().or_else(|| self.stalled())?;
            self.close();
            self.retry_at = Instant::now() + RETRY;
            return Some(format!("the sound device is gone: {reason}; waiting for it to come back"));
        }
        if self.player.is_none() {
            self.player = self.home.1.try_recv().ok();
        }
        if self.player.is_none() || Instant::now() < self.retry_at {
            return None;
        }
        self.retry_at = Instant::now() + RETRY;
        let found = Found::find(&self.choice).ok()?;
        self.open(&found).ok()?;
        Some(format!("the sound device is back: {found}"))
    }

    /// Stops the song, releases all notes, waits a moment for silence, fades out the remaining sound, for example a
    /// reverberation, and ends the stream. Returns false if the device hangs and does not return the player.
    pub fn finish(mut self, live: &mut LiveSender) -> bool {
        self.status.halt_song();
        live.release_all();
        // Samples are heard this long after they were rendered.
        let delay = Duration::from_secs_f64(self.delay()).min(RELEASE);
        let start = Instant::now();
        if !self.wait(RELEASE, |status| status.telemetry().is_silent() && start.elapsed() > delay) {
            self.status.fade();
            if self.wait(FADE + 2 * RELEASE, Status::is_faded) {
                std::thread::sleep(delay);
            }
        }
        self.close();
        self.player.is_some()
    }

    /// Waits until the condition holds, as long as a stream is open. Returns false if that takes longer than `limit`.
    fn wait(&self, limit: Duration, so: impl Fn(&Status) -> bool) -> bool {
        let start = Instant::now();
        while self.is_playing() && start.elapsed() < limit {
            if so(&self.status) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        !self.is_playing()
    }

    fn open(&mut self, found: &Found) -> Result<()> {
        let Some(player) = self.player.take() else { return Ok(()) };
        self.trouble.1.try_iter().for_each(drop);
        self.last_frames = (self.status.telemetry().frames(), Instant::now());
        match stream::open(found, player, self.home.0.clone(), self.trouble.0.clone(), self.status.clone()) {
            Ok(stream) => {
                self.stream = Some(stream);
                Ok(())
            }
            Err(error) => {
                self.player = self.home.1.recv_timeout(END).ok();
                Err(Error::value("--device", format!("{found} cannot be played on: {error}")))
            }
        }
    }

    /// Ends the stream on another thread, so that a hanging device cannot block the program. The player is returned
    /// before the device is free; the receiver gets a message when it is.
    fn close(&mut self) -> Option<Receiver<()>> {
        let stream = self.stream.take()?;
        let (done, ended) = channel();
        std::thread::spawn(move || {
            drop(stream);
            let _ = done.send(());
        });
        self.player = self.home.1.recv_timeout(END).ok();
        Some(ended)
    }

    fn stalled(&mut self) -> Option<String> {
        let frames = self.status.telemetry().frames();
        if frames != self.last_frames.0 {
            self.last_frames = (frames, Instant::now());
        }
        (self.last_frames.1.elapsed() > PATIENCE).then(|| "it takes no more sound".to_owned())
    }
}
