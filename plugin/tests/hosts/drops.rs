//! Files that are dropped from another program on the real window.

use crate::drag::Drag;
use crate::standalone::{Stand, preset};
use std::path::PathBuf;
use std::time::{Duration, Instant};

const RATE: u32 = 44_100;
/// Longest time that a fit and the next look at the state may take; a debug build on a busy machine is slow.
const PATIENCE: Duration = Duration::from_secs(300);

/// A recording of a struck bar of 440 Hz.
#[allow(clippy::disallowed_methods, reason = "the sound of a test")]
fn recording() -> Vec<u8> {
    let samples = (0..RATE / 2).map(|frame| {
        let time = f64::from(frame) / f64::from(RATE);
        let mode = |hertz: f64, t60: f64| (-6.908 * time / t60).exp() * (std::f64::consts::TAU * hertz * time).sin();
        (12_000.0 * (mode(440.0, 0.4) + 0.5 * mode(1_213.0, 0.2))) as i16
    });
    let data: Vec<u8> = samples.flat_map(i16::to_le_bytes).collect();
    let len = data.len() as u32;
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + len).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    bytes.extend([RATE, 2 * RATE].into_iter().flat_map(u32::to_le_bytes));
    bytes.extend(b"\x02\0\x10\0data");
    bytes.extend(len.to_le_bytes());
    bytes.extend(data);
    bytes
}

pub(crate) fn a_recording_that_is_dropped_on_the_real_window_becomes_the_sound() {
    let stand = Stand::new("drop");
    // Characters that a URI percent-encodes.
    let file = stand.folder.path().join("Stab 100% für Übung.wav");
    std::fs::write(&file, recording()).unwrap();
    let (running, _) = stand.start(&["Marimba"]);
    let drag = |files: &[PathBuf]| {
        let files: Vec<_> = files.iter().map(PathBuf::as_path).collect();
        let window = stand.onlooker.find("Sprung").unwrap();
        Drag::over(&stand.screen.display, window, &files).drop_at([300, 200])
    };
    assert!(!drag(&[stand.folder.path().join("nowhere.wav")]), "a file that is not there is not taken");
    assert!(drag(&[file]), "the window takes the recording");
    let start = Instant::now();
    let saved = || stand.state().is_file().then(|| preset(&stand.state()));
    while !saved().is_some_and(|preset| preset.contains("Stab 100% für Übung")) {
        assert!(start.elapsed() < PATIENCE, "it became no sound: {:?}", saved());
        std::thread::sleep(Duration::from_millis(100));
    }
    let sound = sprung::preset::Preset::parse(&saved().unwrap(), "the saved state").unwrap();
    assert_eq!(sound.guide.home, 69, "the recording’s pitch");
    drop(running);
}
