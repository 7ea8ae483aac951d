//! Tests of the WAV writer, whose files are read back with hound and by hand.

use super::*;
use std::io::{Cursor, Read};

const FORMATS: [SampleFormat; 3] = [SampleFormat::Int16, SampleFormat::Int24, SampleFormat::Float32];

/// A pipe, which cannot seek.
#[derive(Default)]
struct Pipe<'a>(Option<&'a mut Vec<u8>>);

impl Write for Pipe<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.as_mut().unwrap().extend(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Pipe<'_> {
    fn seek(&mut self, _: SeekFrom) -> std::io::Result<u64> {
        Err(std::io::ErrorKind::NotSeekable.into())
    }
}

fn format(samples: SampleFormat, channels: u16) -> WavFormat {
    WavFormat { sample_rate: 48_000, channels, samples }
}

fn write(out: impl Write + Seek, format: WavFormat, dither: Option<u64>, frames: Option<u64>, samples: &[f32]) -> u64 {
    let mut writer = WavWriter::new(out, "x", format, dither, frames).unwrap();
    let negated: Vec<f32> = samples.iter().map(|sample| -sample).collect();
    for (left, right) in samples.chunks(3).zip(negated.chunks(3)) {
        writer.write(left, right).unwrap();
    }
    let clipped = writer.clipped();
    writer.finish().unwrap();
    clipped
}

fn file(format: WavFormat, dither: Option<u64>, samples: &[f32]) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    write(&mut out, format, dither, None, samples);
    out.into_inner()
}

fn integers(wav: &[u8]) -> Vec<i32> {
    hound::WavReader::new(wav).unwrap().into_samples().map(|sample| sample.unwrap()).collect()
}

#[test]
fn a_pipe_gets_the_bytes_of_a_file() {
    for samples in FORMATS {
        for channels in [1, 2] {
            for frames in [0, 1, 6, 7] {
                let signal: Vec<f32> = (0..frames).map(|n| n as f32 * 0.1 - 0.3).collect();
                let format = format(samples, channels);
                let mut piped = Vec::new();
                write(Pipe(Some(&mut piped)), format, Some(1), Some(frames), &signal);
                let file = file(format, Some(1), &signal);
                assert_eq!(piped, file, "{format:?} {frames}");

                let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
                assert_eq!(word(4) + 8, file.len(), "the RIFF chunk is the file");
                assert_eq!(file.len() % 2, 0, "chunks are padded to even lengths");
                let reader = hound::WavReader::new(&file[..]).unwrap();
                assert_eq!((u64::from(reader.duration()), reader.spec()), (frames, format.spec()));
            }
        }
    }
}

#[test]
fn samples_become_the_nearest_step() {
    let signal = [0.0, 0.5, -1.0, 1.0, 1.5, f32::from_bits(1), 1.5 / 32768.0, 2.5 / 32768.0];
    let mut out = Cursor::new(Vec::new());
    let clipped = write(&mut out, format(SampleFormat::Int16, 1), None, None, &signal);
    assert_eq!(integers(out.get_ref()), [0, 16384, -32768, 32767, 32767, 0, 2, 2]);
    assert_eq!(clipped, 1);
    assert_eq!(integers(&file(format(SampleFormat::Int24, 2), None, &[0.25])), [1 << 21, -(1 << 21)]);
}

#[test]
fn floats_are_kept_exactly_and_never_clipped() {
    let signal = [0.1, -3.7, 1e-30, f32::MAX];
    let mut out = Cursor::new(Vec::new());
    assert_eq!(write(&mut out, format(SampleFormat::Float32, 1), Some(1), None, &signal), 0);
    let read: Vec<f32> = hound::WavReader::new(&out.get_ref()[..]).unwrap().samples().map(|s| s.unwrap()).collect();
    assert_eq!(read, signal);
}

#[test]
fn dither_is_triangular_seeded_and_its_own_in_each_channel() {
    let signal = vec![0.25 / 32768.0; 40_000];
    let wav = file(format(SampleFormat::Int16, 2), Some(7), &signal);
    assert_eq!(wav, file(format(SampleFormat::Int16, 2), Some(7), &signal));
    assert_ne!(wav, file(format(SampleFormat::Int16, 2), Some(8), &signal));
    let steps = integers(&wav);
    let left: Vec<f64> = steps.iter().step_by(2).map(|step| f64::from(*step)).collect();
    let right: Vec<f64> = steps.iter().skip(1).step_by(2).map(|step| f64::from(*step)).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let product = |a: &[f64], b: &[f64]| mean(&a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>());
    assert!((mean(&left) - 0.25).abs() < 0.02, "the signal survives below a step");
    // The property of TPDF: the error's power is 1/4 step² (rounding 1/12, noise 1/6), independent of the signal.
    assert!((product(&left, &left) - 0.0625 - 0.25).abs() < 0.02, "{}", product(&left, &left));
    assert!((product(&left, &right) + 0.0625).abs() < 0.02, "{}", product(&left, &right));
}

/// The chunks of a RIFF or RF64 file: their names and lengths.
fn chunks(file: &mut (impl Read + Seek)) -> Vec<(String, u64)> {
    let mut chunks = Vec::new();
    let (end, mut at) = (file.seek(SeekFrom::End(0)).unwrap(), 12);
    let mut read = |at: u64, len: usize| {
        let mut bytes = vec![0; len];
        file.seek(SeekFrom::Start(at)).unwrap();
        file.read_exact(&mut bytes).unwrap();
        bytes
    };
    let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte));
    let is_rf64 = read(0, 4) == b"RF64";
    while at < end {
        let (name, size) = (String::from_utf8(read(at, 4)).unwrap(), number(&read(at + 4, 4)));
        let size = if is_rf64 && name == "data" { number(&read(28, 8)) } else { size };
        chunks.push((name, size));
        at += 8 + size + size % 2;
    }
    assert_eq!(at, end, "the last chunk ends with the file");
    chunks
}

#[test]
fn a_file_beyond_4_gib_is_rf64() {
    let format = format(SampleFormat::Int24, 1);
    for (rest, frames) in [(0, 1_431_655_732), (11, 1_431_655_743)] {
        let mut file = tempfile::tempfile().unwrap();
        let mut writer = WavWriter::new(&mut file, "x", format, None, None).unwrap();
        writer.write(&[0.25], &[0.25]).unwrap();
        // A hole in a sparse file: it reads as zeros and takes no disk space.
        let hole = 1_431_655_730;
        writer.out.seek(SeekFrom::Current(3 * hole)).unwrap();
        writer.frames += hole as u64;
        writer.write(&vec![-0.5; 1 + rest], &vec![-0.5; 1 + rest]).unwrap();
        writer.finish().unwrap();

        let chunks = chunks(&mut file);
        let names: Vec<&str> = chunks.iter().map(|(name, _)| name.as_str()).collect();
        let is_long = rest > 0;
        assert_eq!(names, [if is_long { "ds64" } else { "JUNK" }, "fmt ", "data"]);
        assert_eq!(chunks[2].1, 3 * frames);
        assert_eq!(file.metadata().unwrap().len(), format.file_len(frames).unwrap());
        assert_eq!(file.metadata().unwrap().len() - 8 > u64::from(u32::MAX), is_long);
        let mut last = [0; 4];
        file.seek(SeekFrom::End(-4)).unwrap();
        file.read_exact(&mut last).unwrap();
        let sample = i32::from_le_bytes(if frames % 2 == 0 { last } else { [0, last[0], last[1], last[2]] }) >> 8;
        assert_eq!(sample, -(1 << 22));
    }
}

#[test]
fn more_than_a_file_holds_is_refused() {
    let format = format(SampleFormat::Float32, 2);
    assert_eq!(format.file_len(600_000_000).unwrap(), 4_800_000_104);
    for frames in [u64::MAX, u64::MAX / 8, u64::MAX / 16] {
        let error = format.file_len(frames).unwrap_err().to_string();
        assert_eq!(error, format!("length: {frames} frames are more than a file can have"));
        assert!(WavWriter::new(Cursor::new(Vec::new()), "x", format, None, Some(frames)).is_err());
    }
}

#[test]
fn a_length_other_than_announced_is_an_error() {
    let mut out = Vec::new();
    let mut writer = WavWriter::new(Pipe(Some(&mut out)), "x", format(SampleFormat::Int16, 1), None, Some(2)).unwrap();
    writer.write(&[0.0], &[0.0]).unwrap();
    assert!(writer.finish().is_err());
}
