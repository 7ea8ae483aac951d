//! The stream of a device: it gets every block from the source that it plays, and returns the source when it ends.

use super::block_clock::Moment;
use super::convert::DeviceSample;
use super::device::Found;
use super::status::Status;
use cpal::traits::{DeviceTrait, StreamTrait};
use cpal::{ErrorKind, OutputCallbackInfo, SampleFormat, SizedSample};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

/// How long a device may take to respond.
const TIMEOUT: Duration = Duration::from_secs(2);

/// The source of a device's sound, for example a [`super::Player`].
pub trait Source: Send + 'static {
    /// Renders the next block into the interleaved samples of a device with this many channels. Real-time safe.
    fn fill<T: DeviceSample>(&mut self, out: &mut [T], channels: usize, moment: Moment);
}

/// The player while a stream owns it. It is returned through `home` when the stream is dropped.
struct Loan<S: Source> {
    player: Option<Box<S>>,
    home: Sender<Box<S>>,
}

impl<S: Source> Drop for Loan<S> {
    fn drop(&mut self) {
        if let Some(player) = self.player.take() {
            // This fails if the receiver no longer exists.
            let _ = self.home.send(player);
        }
    }
}

/// Starts to play. If the stream fails, the reason is sent to `trouble`. The player is sent to `home` when the stream
/// is dropped, or at once if it cannot be started.
pub(super) fn open<S: Source>(
    found: &Found,
    player: Box<S>,
    home: Sender<Box<S>>,
    trouble: Sender<String>,
    status: Arc<Status>,
) -> Result<cpal::Stream, cpal::Error> {
    let loan = Loan { player: Some(player), home };
    let stream = match found.format {
        SampleFormat::F32 => build::<f32, S>(found, loan, trouble, status),
        SampleFormat::I32 => build::<i32, S>(found, loan, trouble, status),
        SampleFormat::I16 => build::<i16, S>(found, loan, trouble, status),
        _ => build::<u8, S>(found, loan, trouble, status),
    }?;
    stream.play()?;
    Ok(stream)
}

fn build<T: DeviceSample + SizedSample, S: Source>(
    found: &Found,
    mut loan: Loan<S>,
    trouble: Sender<String>,
    status: Arc<Status>,
) -> Result<cpal::Stream, cpal::Error> {
    let channels = usize::from(found.config.channels);
    let callback = move |out: &mut [T], info: &OutputCallbackInfo| {
        let now = Instant::now();
        let times = info.timestamp();
        let since_zero = |instant: cpal::StreamInstant| instant.duration_since(cpal::StreamInstant::ZERO);
        let moment = Moment { now, called: since_zero(times.callback), heard: since_zero(times.playback) };
        if let Some(player) = &mut loan.player {
            player.fill(out, channels, moment);
        }
    };
    let failed = move |error: cpal::Error| match error.kind() {
        ErrorKind::Xrun => status.count_xrun(),
        ErrorKind::RealtimeDenied | ErrorKind::DeviceChanged => {}
        // The stream has ended, so allocating here does no harm.
        _ => drop(trouble.send(error.to_string())),
    };
    found.device.build_output_stream(found.config, callback, failed, Some(TIMEOUT))
}
