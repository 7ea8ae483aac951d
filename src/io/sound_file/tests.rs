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
    let opus = [&b"OggS\0\x02"[..], &[0; 22], b"OpusHead\x01\x02"].concat();
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
        (wav(0x55, 1, 8), "x: samples are coded as MP3: expected PCM or floats"),
        (wav(9, 1, 8), "x: samples are coded as format 9: expected PCM or floats"),
        (opus, "x: this is Opus: expected WAV, AIFF, FLAC, Ogg Vorbis or MP3"),
        (
            include_bytes!("../../../tests/sounds/wrong-codebook.ogg").to_vec(),
            "x: no decoder can read this, so it is damaged: expected Ogg",
        ),
        (wav(1, 0, 16), "x: it has 0 channels: expected 1 to 64"),
        (
            wav(3, 1, 16),
            "x: samples are floats of 16 bits, 2 bytes a frame of 1 channels: expected integers of 8, 16, 24 or 32 bits, \
             or floats of 32 or 64",
        ),
    ] {
        assert_eq!(parsed(&bytes).unwrap_err().to_string(), message);
    }
}

/// A WAV of one frame of 8-bit samples.
fn of_layout(sample_rate: u32, channels: u16) -> Vec<u8> {
    let mut format = format(1, channels, 8);
    format[4..8].copy_from_slice(&sample_rate.to_le_bytes());
    riff(&[chunk(b"fmt ", &format), chunk(b"data", &vec![128; channels.into()])])
}

#[test]
fn rates_and_channels_that_nothing_can_work_on_are_refused() {
    for (rate, channels) in [(1000, 1), (768_000, 1), (8000, 64)] {
        let found = parsed(&of_layout(rate, channels)).unwrap();
        assert_eq!((found.sample_rate, found.channels.len()), (rate, channels.into()));
    }
    for rate in [0, 1, 999, 768_001, 4_000_000_000] {
        let message = format!("x: its sample rate of {rate} is out of range: expected 1000 to 768000 Hz");
        assert_eq!(parsed(&of_layout(rate, 1)).unwrap_err().to_string(), message);
    }
    for channels in [65, 65_535] {
        let message = format!("x: it has {channels} channels: expected 1 to 64");
        assert_eq!(parsed(&of_layout(8000, channels)).unwrap_err().to_string(), message);
    }
}

/// Replaces the checksum of an Ogg file's first page, which is its first 58 bytes.
fn seal(ogg: &mut [u8]) {
    ogg[22..26].fill(0);
    let add = |sum: u32, byte: &u8| {
        let shift = |sum: u32, _| (sum << 1) ^ ((sum >> 31) * 0x04c1_1db7);
        (0..8).fold(sum ^ (u32::from(*byte) << 24), shift)
    };
    let sum = ogg[..58].iter().fold(0, add);
    ogg[22..26].copy_from_slice(&sum.to_le_bytes());
}

#[test]
fn rates_of_coded_files_are_checked_too() {
    // MP3 has only rates from 8 to 48 kHz. An AIFF has its rate as an 80-bit float.
    let mut aiff = include_bytes!("../../../tests/sounds/tone.aiff").to_vec();
    let rate = aiff.windows(4).position(|name| name == b"COMM").unwrap() + 16;
    aiff[rate..rate + 6].copy_from_slice(&[0x40, 0x1e, 0xee, 0x6b, 0x28, 0x00]);
    let mut ogg = include_bytes!("../../../tests/sounds/tone.ogg").to_vec();
    seal(&mut ogg);
    assert!(parsed(&ogg).is_ok(), "the checksum is right");
    ogg[40..44].copy_from_slice(&4_000_000_000_u32.to_le_bytes());
    seal(&mut ogg);
    for (bytes, rate) in [(aiff, 4_000_000_000_u32), (ogg, 4_000_000_000)] {
        let message = format!("x: its sample rate of {rate} is out of range: expected 1000 to 768000 Hz");
        assert_eq!(parsed(&bytes).unwrap_err().to_string(), message);
    }
}

#[cfg(feature = "batch")]
#[test]
fn the_rate_of_a_flac_is_checked_too() {
    let encoded = |rate: u32| {
        let mut format = format(1, 1, 16);
        format[4..8].copy_from_slice(&rate.to_le_bytes());
        format[8..12].copy_from_slice(&(2 * rate).to_le_bytes());
        let [mut wav, mut flac] = [(); 2].map(|()| tempfile::tempfile().unwrap());
        wav.write_all(&riff(&[chunk(b"fmt ", &format), chunk(b"data", &[1; 8192])])).unwrap();
        crate::io::flac::encode(&mut wav, &mut flac, "x").unwrap();
        flac.seek(SeekFrom::Start(0)).unwrap();
        read(flac, "x")
    };
    assert_eq!(encoded(1000).unwrap().sample_rate, 1000);
    let message = "x: its sample rate of 999 is out of range: expected 1000 to 768000 Hz";
    assert_eq!(encoded(999).unwrap_err().to_string(), message);
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
fn error(found: &Recording, start: usize, gain: f64) -> f64 {
    let sine = |frequency: f64, n: usize| libm::sin(std::f64::consts::TAU * frequency * n as f64 / 22_050.0);
    let frames = 400..1800;
    let error = |n: usize| {
        let [left, right] = [0, 1].map(|channel| f64::from(found.channels[channel][start + n]));
        (left - 0.5 * gain * sine(440.0, n)).abs().max((right - 0.25 * gain * sine(880.0, n)).abs())
    };
    frames.map(error).fold(0.0, f64::max)
}

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
fn oddities_beside_the_sound_do_not_keep_it_from_being_read() {
    let flac = include_bytes!("../../../tests/sounds/tone.flac");
    let aiff = include_bytes!("../../../tests/sounds/tone.aiff");
    // After its name, a FLAC has the description of the stream, in 4 + 34 bytes. Block 5 is a cue sheet, here of nonsense.
    let cue_sheet = [&flac[..4], &[0], &flac[5..42], &[flac[4] & 0x80 | 5, 0, 0, 3, 1, 2, 3], &flac[42..]].concat();
    let tagged = [b"ID3\x04\0\0\0\0\x01\x02", &[7; 130][..], flac].concat();
    let mut no_least_block = flac.to_vec();
    no_least_block[8..10].fill(0);
    let mut too_long = aiff.to_vec();
    too_long[5] += 1;
    for (bytes, plain, encoding, warnings) in [
        (cue_sheet, &flac[..], "FLAC", vec![]),
        (tagged, flac, "FLAC", vec![]),
        (no_least_block, flac, "FLAC", vec![]),
        (too_long, aiff, "AIFF", vec!["the file says that it is longer than it is"]),
    ] {
        let (found, plain) = (parsed(&bytes).unwrap(), parsed(plain).unwrap());
        assert_eq!(
            (found.encoding.as_str(), found.warnings.iter().map(String::as_str).collect::<Vec<_>>()),
            (encoding, warnings)
        );
        assert!(found.channels == plain.channels && found.sample_rate == plain.sample_rate);
    }
}

#[test]
fn integers_are_read_whether_their_padding_is_above_or_below() {
    let mut fmt = format(1, 1, 24);
    fmt[12] = 4;
    let read = |fmt: &[u8], samples: [i32; 3]| {
        let data: Vec<u8> = samples.into_iter().flat_map(i32::to_le_bytes).collect();
        parsed(&riff(&[chunk(b"fmt ", fmt), chunk(b"data", &data)])).unwrap().channels[0].clone()
    };
    assert_eq!(read(&fmt, [1 << 22, -(1 << 22), 1]), [0.5, -0.5, 1.0 / 8_388_608.0], "above");
    assert_eq!(read(&fmt, [1 << 30, -(1 << 30), 1 << 8]), [0.5, -0.5, 1.0 / 8_388_608.0], "below");
    assert_eq!(read(&fmt, [1 << 22, -(1 << 22), 0]), [1.0 / 512.0, -1.0 / 512.0, 0.0], "below, and faint");
    fmt[14] = 16;
    assert_eq!(read(&fmt, [1 << 14, -(1 << 14), 1]), [0.5, -0.5, 1.0 / 32_768.0], "two bytes above");
}

#[test]
fn compressed_waves_are_decoded() {
    // The loudest numbers of both laws, and silence (ITU-T G.711, tables 1 and 2).
    for (code, encoding, data, expected) in
        [(6, "A-law", [0xaa, 0x2a, 0xd5], [32_256, -32_256, 8]), (7, "µ-law", [0x80, 0x00, 0xff], [32_124, -32_124, 0])]
    {
        let fmt = [&format(code, 1, 8)[..], &[0, 0]].concat();
        let data: Vec<u8> = data.into_iter().cycle().take(3000).collect();
        let found = parsed(&riff(&[chunk(b"fmt ", &fmt), chunk(b"data", &data)])).unwrap();
        assert_eq!((found.encoding.as_str(), found.frames(), found.warnings.len()), (encoding, 3000, 0));
        assert_eq!(found.channels[0][..3], expected.map(|number: i16| f32::from(number) / 32_768.0));
        // An extensible file has other numbers in its place, which the decoder does not understand.
        let guid = [0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71];
        let extensible = [&format(0xfffe, 1, 8)[..], &[22, 0, 8, 0, 4, 0, 0, 0, code as u8, 0], &guid].concat();
        let refused = parsed(&riff(&[chunk(b"fmt ", &extensible), chunk(b"data", &data)])).unwrap_err().to_string();
        assert_eq!(refused, format!("x: samples are coded as {encoding}: expected PCM or floats"));
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
    for rate in [0, 999, 768_001, u32::MAX] {
        let message = resampled(&sound, rate).unwrap_err().to_string();
        assert!(message.contains("out of range: expected 1000 to 768000 Hz"), "{message}");
        assert!(resampled(&Recording { sample_rate: rate, ..sound.clone() }, 48_000).is_err());
    }
}
