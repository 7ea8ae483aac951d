//! Records the output to a file on a separate thread; the audio thread never waits for it.

use crate::error::{Error, Result};
use crate::io::{Output, SampleFormat, WavFormat, WavWriter};
use rtrb::{Consumer, Producer, RingBuffer};
use std::sync::Arc;
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};
use std::sync::atomic::{AtomicU8, AtomicU64};
use std::thread::JoinHandle;
use std::time::Duration;

/// Length of the queue in seconds: frames are lost if the disk stalls for longer.
const QUEUE_SECONDS: usize = 20;

/// Number of frames transferred at a time.
const CHUNK: usize = 1024;

/// How long the writer sleeps if the queue is empty.
const NAP: Duration = Duration::from_millis(20);

/// Orders to the recorder's thread.
const RECORD: u8 = 0;
const FINISH: u8 = 1;
const ABANDON: u8 = 2;

/// The audio thread's end of the queue.
pub struct Tap {
    queue: Producer<f32>,
    scratch: Vec<f32>,
    lost: Arc<AtomicU64>,
}

impl Tap {
    /// Passes frames to the recorder. Counts them as lost if the queue is full. Real-time safe.
    pub(super) fn record(&mut self, left: &[f32], right: &[f32]) {
        for (left, right) in left.chunks(CHUNK).zip(right.chunks(CHUNK)) {
            let samples = &mut self.scratch[..2 * left.len()];
            for (frame, (left, right)) in samples.chunks_exact_mut(2).zip(left.iter().zip(right)) {
                (frame[0], frame[1]) = (*left, *right);
            }
            if self.queue.push_entire_slice(samples).is_err() {
                self.lost.fetch_add(left.len() as u64, Relaxed);
            }
        }
    }
}

/// The result of a recording.
#[derive(Debug)]
pub struct Recorded {
    /// Frames in the file.
    pub frames: u64,
    /// Frames that were lost because the disk was too slow.
    pub lost: u64,
    /// Why the recording ended early, if it did. The file is complete up to that point.
    pub problem: Option<Error>,
}

/// A recording in progress.
pub struct Recording {
    thread: JoinHandle<Result<Recorded>>,
    order: Arc<AtomicU8>,
}

impl Recording {
    /// Starts to record stereo floats into `output`, which must be a file.
    ///
    /// # Errors
    /// [`Error::Value`] if the output is not seekable, [`Error::Io`] if the thread cannot be started.
    pub fn start(mut output: Output, sample_rate: u32) -> Result<(Tap, Self)> {
        if !output.is_seekable() {
            return Err(Error::value("--record", format!("{} is a pipe or device: expected a file", output.name())));
        }
        let (queue, waiting) = RingBuffer::new(2 * QUEUE_SECONDS * sample_rate as usize);
        let (order, lost) = (Arc::new(AtomicU8::new(RECORD)), Arc::new(AtomicU64::new(0)));
        let format = WavFormat { sample_rate, channels: 2, samples: SampleFormat::Float32 };
        let name = output.name().to_owned();
        let (ordered, losing) = (order.clone(), lost.clone());
        let thread = std::thread::Builder::new()
            .name("recorder".to_owned())
            .spawn(move || {
                let written = write(waiting, &mut output, format, &ordered);
                if ordered.load(Acquire) == ABANDON {
                    return Ok(Recorded { frames: 0, lost: 0, problem: None });
                }
                let (frames, problem) = match written {
                    Ok(frames) => (frames, None),
                    // The frames on the disk are made a complete file.
                    Err(error) => (output.salvage_wav(format)?, Some(error)),
                };
                output.commit()?;
                Ok(Recorded { frames, lost: losing.load(Relaxed), problem })
            })
            .map_err(|source| Error::io(name, source))?;
        Ok((Tap { queue, scratch: vec![0.0; 2 * CHUNK], lost }, Self { thread, order }))
    }

    /// Stops the recording and deletes the file.
    pub fn abandon(self) {
        self.order.store(ABANDON, Release);
        let _ = self.thread.join();
    }

    /// Whether the recording has ended early, because of a problem.
    pub fn has_ended(&self) -> bool {
        self.thread.is_finished()
    }

    /// Writes the frames that are still waiting, and completes the file. The [`Tap`] should no longer be in use.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Exists`] if no file could be kept.
    pub fn finish(self) -> Result<Recorded> {
        self.order.store(FINISH, Release);
        self.thread.join().unwrap_or_else(|_| Err(Error::value("--record", "the recorder broke down")))
    }
}

/// Writes until the order to stop arrives and the queue is empty. Returns the number of frames.
fn write(mut queue: Consumer<f32>, output: &mut Output, format: WavFormat, order: &AtomicU8) -> Result<u64> {
    let name = output.name().to_owned();
    let mut writer = WavWriter::new(output.stream(), &name, format, None, None)?;
    let mut samples = vec![0.0; 2 * CHUNK];
    let (mut left, mut right) = (Vec::with_capacity(CHUNK), Vec::with_capacity(CHUNK));
    let mut frames = 0;
    loop {
        // The order is read before the queue: then all frames that were played before the order are already in the
        // queue.
        let stopping = order.load(Acquire) != RECORD;
        let waiting = (queue.slots() / 2).min(CHUNK);
        if waiting == 0 {
            if stopping {
                writer.finish()?;
                return Ok(frames);
            }
            std::thread::sleep(NAP);
            continue;
        }
        let samples = &mut samples[..2 * waiting];
        if queue.pop_entire_slice(samples).is_err() {
            continue;
        }
        left.clear();
        right.clear();
        for frame in samples.chunks_exact(2) {
            left.push(frame[0]);
            right.push(frame[1]);
        }
        writer.write(&left, &right)?;
        frames += waiting as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{Inputs, Target};

    fn start(directory: &tempfile::TempDir, rate: u32) -> (Tap, Recording, std::path::PathBuf) {
        let path = directory.path().join("take.wav");
        let output = Output::create(&Target::new(&path), false, &Inputs::default()).unwrap();
        let (tap, recording) = Recording::start(output, rate).unwrap();
        (tap, recording, path)
    }

    #[test]
    fn a_recording_holds_exactly_what_was_played() {
        let directory = tempfile::tempdir().unwrap();
        let (mut tap, recording, path) = start(&directory, 48_000);
        let left: Vec<f32> = (0..10_001).map(|n| n as f32 * 0.001 - 3.0).collect();
        let right: Vec<f32> = left.iter().map(|sample| -sample).collect();
        for (left, right) in left.chunks(64).zip(right.chunks(64)) {
            tap.record(left, right);
        }
        assert!(!path.exists(), "a file that is not whole yet has another name");
        let recorded = recording.finish().unwrap();
        assert_eq!((recorded.frames, recorded.lost), (10_001, 0));
        let samples: Vec<f32> = hound::WavReader::open(&path).unwrap().into_samples().map(|s| s.unwrap()).collect();
        let expected: Vec<f32> = left.iter().zip(&right).flat_map(|(left, right)| [*left, *right]).collect();
        assert_eq!(samples, expected);
    }

    #[test]
    fn what_the_disk_is_too_slow_for_is_counted_and_the_rest_kept() {
        let directory = tempfile::tempdir().unwrap();
        let (mut tap, recording, path) = start(&directory, 8_000);
        let block = vec![0.5; 65_536];
        for _ in 0..20 {
            tap.record(&block, &block);
        }
        let recorded = recording.finish().unwrap();
        assert!(recorded.lost > 0, "{recorded:?}");
        assert_eq!(recorded.frames + recorded.lost, 20 * 65_536);
        assert_eq!(u64::from(hound::WavReader::open(&path).unwrap().duration()), recorded.frames);
    }

    #[test]
    fn an_abandoned_recording_leaves_no_file() {
        let directory = tempfile::tempdir().unwrap();
        let (mut tap, recording, _) = start(&directory, 48_000);
        tap.record(&[0.5], &[0.5]);
        recording.abandon();
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0);
    }

    #[test]
    fn pipes_and_devices_are_refused() {
        let output = Output::create(&Target::new("/dev/null"), false, &Inputs::default()).unwrap();
        let error = Recording::start(output, 48_000).err().unwrap().to_string();
        assert_eq!(error, "--record: /dev/null is a pipe or device: expected a file");
    }
}
