//! Tests with every kind of sound file: complete, cut off and invalid.

use super::*;
use std::io::Write;

fn parsed(bytes: &[u8]) -> Result<Recording> {
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(bytes).unwrap();
    file.seek(SeekFrom::Start(0)).unwrap();
    read(file, "x")
}

fn chunk(id: &[u8; 4], body: &[u8]) -> Vec<u8> {
    let padding = vec![0; body.len() % 2];
    [&id[..], &(body.len() as u32).to_le_bytes(), body, &padding].concat()
}

/// A `fmt ` chunk's contents for 8 kHz.
fn format(code: u16, channels: u16, bits: u16) -> Vec<u8> {
    let align = bits / 8 * channels;
    let mut body = Vec::new();
    [code, channels].iter().for_each(|word| body.extend(word.to_le_bytes()));
    [8000, 8000 * u32::from(align)].iter().for_each(|word: &u32| body.extend(word.to_le_bytes()));
    [align, bits].iter().for_each(|word| body.extend(word.to_le_bytes()));
    body
}

fn riff(chunks: &[Vec<u8>]) -> Vec<u8> {
    let chunks = chunks.concat();
    [&b"RIFF"[..], &(4 + chunks.len() as u32).to_le_bytes(), b"WAVE", &chunks].concat()
}

#[test]
fn samples_of_every_kind_are_exact() {
    let pcm = |bits: u16, data: &[u8]| parsed(&riff(&[chunk(b"fmt ", &format(1, 1, bits)), chunk(b"data", data)]));
    for (bits, data, expected) in [
        (8, &[0_u8, 128, 192][..], &[-1.0_f32, 0.0, 0.5][..]),
        (16, &[0, 0x80, 0, 0, 0, 0x40, 1, 0], &[-1.0, 0.0, 0.5, 1.0 / 32_768.0]),
        (24, &[0, 0, 0x80, 0, 0, 0x40, 1, 0, 0], &[-1.0, 0.5, 1.0 / 8_388_608.0]),
        (32, &[0, 0, 0, 0x80, 0, 0, 0, 0x40], &[-1.0, 0.5]),
    ] {
        let found = pcm(bits, data).unwrap();
        assert_eq!((found.sample_rate, &found.channels[0][..]), (8000, expected), "{bits}");
        assert_eq!((found.encoding, found.warnings.len()), (format!("{bits}-bit PCM"), 0));
    }
    let bytes: Vec<u8> = [0.1_f32, -3.5].iter().flat_map(|x| x.to_le_bytes()).collect();
    let found = parsed(&riff(&[chunk(b"fmt ", &format(3, 2, 32)), chunk(b"data", &bytes)])).unwrap();
    assert_eq!(found.channels, [[0.1], [-3.5]]);
    let bytes: Vec<u8> = [0.25_f64, -3.5].iter().flat_map(|x| x.to_le_bytes()).collect();
    let found = parsed(&riff(&[chunk(b"fmt ", &format(3, 1, 64)), chunk(b"data", &bytes)])).unwrap();
    assert_eq!(found.channels, [[0.25, -3.5]]);
}

#[test]
fn extensible_files_long_files_and_strange_chunks_are_read() {
    let mut extensible = format(0xfffe, 1, 16);
    // Size of the extension, valid bits, speakers, and the GUID of PCM.
    extensible.extend([22, 0, 16, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71]);
    let data = [0, 0x40, 0, 0xc0];
    let odd = chunk(b"LIST", &[1, 2, 3]);
    let found =
        parsed(&riff(&[odd, chunk(b"fmt ", &extensible), chunk(b"data", &data), chunk(b"id3 ", b"x")])).unwrap();
    assert_eq!((found.channels, found.warnings.len()), (vec![vec![0.5, -0.5]], 0));

    let ds64 = [100_u64, 4, 2].iter().flat_map(|size| size.to_le_bytes()).chain([0; 4]).collect::<Vec<u8>>();
    let mut long = riff(&[chunk(b"ds64", &ds64), chunk(b"fmt ", &format(1, 1, 16)), chunk(b"data", &data)]);
    long[..4].copy_from_slice(b"RF64");
    let len = long.len();
    long[len - 8..len - 4].copy_from_slice(&u32::MAX.to_le_bytes());
    // The chunk after the samples must not be read as samples.
    long.extend(chunk(b"LIST", &[1, 2]));
    let found = parsed(&long).unwrap();
    assert_eq!((found.channels, found.warnings.len()), (vec![vec![0.5, -0.5]], 0));
}

#[test]
fn a_file_that_breaks_off_is_read_as_far_as_it_goes() {
    let whole = riff(&[chunk(b"fmt ", &format(1, 2, 16)), chunk(b"data", &[0, 64, 0, 64, 0, 32, 0, 32])]);
    let found = parsed(&whole[..whole.len() - 1]).unwrap();
    assert_eq!(
        (found.channels, found.warnings),
        (vec![vec![0.5]; 2], vec!["the file breaks off: 1 of 2 frames are there".to_owned()])
    );
    let mut open = whole.clone();
    let at = open.len() - 12;
    open[at..at + 4].copy_from_slice(&[0; 4]);
    let found = parsed(&open).unwrap();
    assert_eq!((found.frames(), found.warnings.len()), (2, 1));
    // A declared length of “unknown” is not a fault.
    open[at..at + 4].copy_from_slice(&[0xff; 4]);
    assert_eq!((parsed(&open).unwrap().frames(), parsed(&open).unwrap().warnings.len()), (2, 0));
}

#[test]
fn what_is_no_sound_is_refused_with_what_would_be_right() {
    let wav = |code, channels, bits| riff(&[chunk(b"fmt ", &format(code, channels, bits)), chunk(b"data", &[0; 64])]);
    for (bytes, message) in [
        (vec![], "x: the file is empty: expected a sound file"),
        (b"MThd and more".to_vec(), "x: this is not a sound file: expected WAV, AIFF, FLAC, Ogg Vorbis or MP3"),
        (riff(&[]), "x: the WAV ends before its ‘fmt ’ chunk: expected a whole file"),
        (riff(&[chunk(b"fmt ", &format(1, 1, 16))]), "x: the WAV ends before its ‘data’ chunk: expected a whole file"),
        (riff(&[chunk(b"data", &[0; 4])]), "x: the ‘fmt ’ chunk is missing before ‘data’"),
        (
            riff(&[chunk(b"fmt ", &format(1, 1, 16)), chunk(b"data", &[])]),
            "x: there is no sound in the file: expected at least one frame",
        ),
        (wav(7, 1, 8), "x: samples are coded as µ-law: expected PCM or floats"),
        (wav(1, 0, 16), "x: 0 channels at 8000 Hz: expected at least 1 of each"),
        (
            wav(3, 1, 16),
            "x: samples are floats of 16 bits, 2 bytes a frame of 1 channels: expected integers of 8, 16, 24 or 32 bits, \
             or floats of 32 or 64",
        ),
    ] {
        assert_eq!(parsed(&bytes).unwrap_err().to_string(), message);
    }
}

#[test]
fn samples_that_are_not_numbers_are_named() {
    let mut found = parsed(&riff(&[chunk(b"fmt ", &format(1, 2, 16)), chunk(b"data", &[0; 64])])).unwrap();
    assert!(found.check_finite("x").is_ok());
    found.channels[1][8] = f32::NAN;
    let message = "x: frame 8 (0.001 s) of channel 2 is not a number: expected finite samples";
    assert_eq!(found.check_finite("x").unwrap_err().to_string(), message);
}

/// Largest difference from a sine of 440 Hz at half of `gain` on the left, and of 880 Hz at a quarter on the right,
/// beginning at frame `start`. The ends are left out, since lossy coders are inaccurate there.
#[cfg(feature = "codecs")]
fn error(found: &Recording, start: usize, gain: f64) -> f64 {
    let sine = |frequency: f64, n: usize| libm::sin(std::f64::consts::TAU * frequency * n as f64 / 22_050.0);
    let frames = 400..1800;
    let error = |n: usize| {
        let [left, right] = [0, 1].map(|channel| f64::from(found.channels[channel][start + n]));
        (left - 0.5 * gain * sine(440.0, n)).abs().max((right - 0.25 * gain * sine(880.0, n)).abs())
    };
    frames.map(error).fold(0.0, f64::max)
}

#[cfg(feature = "codecs")]
#[test]
fn coded_files_hold_the_same_sound() {
    // LAME, which coded the MP3, scales the signal to 95 % as a guard against clipping.
    for (bytes, frames, gain, tolerance) in [
        (&include_bytes!("../../../tests/sounds/tone.aiff")[..], Some(6000), 1.0, 2e-5),
        (&include_bytes!("../../../tests/sounds/tone.flac")[..], Some(6000), 1.0, 2e-5),
        (&include_bytes!("../../../tests/sounds/tone.ogg")[..], Some(6000), 1.0, 0.02),
        (&include_bytes!("../../../tests/sounds/tone.mp3")[..], None, 0.95, 0.003),
    ] {
        let found = parsed(bytes).unwrap();
        let name = &found.encoding;
        assert_eq!((found.sample_rate, found.channels.len()), (22_050, 2), "{name}");
        assert!(found.warnings.is_empty(), "{name}: {:?}", found.warnings);
        if let Some(frames) = frames {
            assert_eq!(found.frames(), frames, "{name}");
        }
        // An MP3 has a delay that depends on its coder.
        let starts = if frames.is_some() { 0..1 } else { 0..found.frames() - 1800 };
        let least = starts.map(|start| error(&found, start, gain)).fold(f64::INFINITY, f64::min);
        assert!(least < tolerance, "{name}: {least}");
        let part = parsed(&bytes[..bytes.len() * 9 / 10]);
        match part {
            Ok(part) => {
                assert!(part.frames() > 200 && part.frames() < found.frames(), "{name}: {}", part.frames());
                assert!(!part.warnings.is_empty(), "{name}");
            }
            // The sound of so short an Ogg file is in a single page.
            Err(error) => assert!(name == "Ogg" && error.to_string().contains("expected"), "{name}: {error}"),
        }
        for len in [12, 40] {
            let message = parsed(&bytes[..len]).unwrap_err().to_string();
            assert!(message.starts_with("x: ") && message.contains("expected"), "{name}, {len} bytes: {message}");
        }
    }
}

#[test]
fn another_rate_is_the_same_sound() {
    let sine = |rate: f64, n: usize| libm::sin(std::f64::consts::TAU * 1000.0 * n as f64 / rate) as f32;
    let channels = vec![(0..44_100).map(|n| sine(44_100.0, n)).collect(); 2];
    let sound = Recording { sample_rate: 44_100, channels, encoding: String::new(), warnings: Vec::new() };
    let found = resampled(&sound, 48_000).unwrap();
    assert_eq!((found.frames(), found.sample_rate), (48_000, 48_000));
    let error = |n: usize| (found.channels[1][n] - sine(48_000.0, n)).abs();
    assert!((2000..46_000).map(error).fold(0.0, f32::max) < 1e-4);
    assert_eq!(resampled(&sound, 44_100).unwrap(), sound);
    assert!(resampled(&sound, 0).unwrap_err().to_string().contains("sample rate: "));
}
