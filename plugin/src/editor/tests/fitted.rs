//! Recordings dropped on the window are fitted to a sound.

use super::dropped::Dropped;
use super::fake_host::Call;
use super::pictures::{Stage, compare, finish, stage};
use super::renderer::Renderer;
use crate::editor::theme::{SIZE, Theme, install_fonts};
use crate::editor::widgets::progress::{Face, paint};
use crate::state::State;
use egui::{Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use sprung::analysis::modes::{self, Settings};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::routes::{Route, Source};
use sprung::preset::Playable;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

const RATE: u32 = 48_000;
/// Longest time that a fit may take here; a debug build on a busy machine is slow.
const PATIENCE: Duration = Duration::from_secs(300);
/// Modes of a bar: ratio, T60 in seconds, amplitude.
const MODES: [(f64, f64, f64); 3] = [(1.0, 0.35, 0.4), (2.756, 0.25, 0.25), (5.404, 0.15, 0.15)];

/// A strike at a frequency, of this length in seconds; the decay times are multiplied by `longer`.
#[allow(clippy::disallowed_methods, reason = "the sound of a test")]
fn strike(frequency: f64, seconds: f64, longer: f64) -> Vec<f64> {
    let at = |n: usize| {
        let t = n as f64 / f64::from(RATE);
        let mode = |(ratio, t60, amplitude): (f64, f64, f64)| {
            amplitude * (-6.908 * t / (longer * t60)).exp() * (TAU * ratio * frequency * t).sin()
        };
        MODES.map(mode).iter().sum()
    };
    (0..(seconds * f64::from(RATE)) as usize).map(at).collect()
}

/// A WAV file of 16 bits.
fn wav(samples: &[f64]) -> Vec<u8> {
    let len = 2 * samples.len() as u32;
    let mut bytes = Vec::new();
    bytes.extend(b"RIFF");
    bytes.extend((36 + len).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    bytes.extend(RATE.to_le_bytes());
    bytes.extend((2 * RATE).to_le_bytes());
    bytes.extend(b"\x02\0\x10\0data");
    bytes.extend(len.to_le_bytes());
    bytes.extend(samples.iter().flat_map(|sample| ((sample * 32_767.0).round() as i16).to_le_bytes()));
    bytes
}

impl Stage {
    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    fn drop_files(&mut self, paths: &[&Path]) {
        let files = paths.iter().map(|path| Arc::new(Dropped(path.to_path_buf())) as Arc<_>);
        self.harness.input_mut().dropped_files.extend(files);
        self.harness.run_steps(2);
    }

    fn is_fitting(&self) -> bool {
        self.harness.query_by_role(Role::ProgressIndicator).is_some()
    }

    /// Waits until the fit is over.
    #[track_caller]
    fn wait(&mut self) {
        let begun = Instant::now();
        while self.is_fitting() {
            assert!(begun.elapsed() < PATIENCE, "it takes too long");
            std::thread::sleep(Duration::from_millis(10));
            self.harness.step();
        }
        self.harness.run_steps(2);
    }

    /// Checks that the status line contains these words.
    #[track_caller]
    fn assert_says(&self, words: &str) {
        assert!(self.harness.query_by_label_contains(words).is_some(), "the lowest line does not say: {words}");
    }
}

/// Frequency and T60 of the modes of a sound played on a key, the loudest first.
fn heard(state: &State, key: u8) -> Vec<(f64, f64)> {
    let Playable::Preset(preset) = &state.playable else { panic!("a preset") };
    let mut synth = Synth::new(f64::from(RATE), 0);
    synth.set_patch(&preset.patch);
    synth.reset();
    let (mut left, mut right) = (vec![0.0; 19_200], vec![0.0; 19_200]);
    let on = EventKind::NoteOn { key, detune: 0.0, velocity: 100.0 / 127.0, id: None };
    synth.process(&[Event { frame: 0, channel: 0, kind: on }], &mut left, &mut right);
    let settings = Settings { most_modes: 12, ..Settings::default() };
    let found = modes::modes(&[left], f64::from(RATE), &settings, &mut |_| true).unwrap();
    let mut modes = found.strikes[0].modes.clone();
    modes.sort_by(|a, b| b.level_db.total_cmp(&a.level_db));
    modes.iter().map(|mode| (mode.frequency, mode.t60)).collect()
}

#[test]
fn pictures_of_the_panel_are_as_accepted() {
    for (name, theme, width, is_ending) in
        [("fitting", Theme::Dark, 420.0, false), ("fitting-least", Theme::Light, 240.0, true)]
    {
        let mut is_new = true;
        let show = move |ui: &mut egui::Ui| {
            if std::mem::take(&mut is_new) {
                install_fonts(ui.ctx());
                theme.apply(ui.ctx());
            }
            let window = ui.ctx().content_rect();
            ui.painter().rect_filled(window, 0.0, theme.palette().panel);
            let face = Face {
                verb: "Fitting",
                name: "church bell, struck softly.wav",
                share: 0.43,
                is_ending,
                cancel: "Cancel the fit",
            };
            paint(ui, window, &face, theme.palette());
        };
        let mut harness = Harness::builder().with_size(vec2(width, 100.0)).renderer(Renderer::default()).build_ui(show);
        harness.run_steps(3);
        compare(name, &mut harness);
    }
    finish();
}

#[test]
fn a_recording_that_is_dropped_becomes_a_sound_of_its_pitch_and_modes_and_is_undone() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    let path = stage.file("small bar.wav", &wav(&strike(440.0, 0.4, 1.0)));
    stage.drop_files(&[&path]);
    assert!(stage.is_fitting());
    stage.harness.check_accessibility();
    assert!(stage.params.state() == before, "until it is over, the sound is what it was");
    stage.wait();
    stage.assert_says("Key estimated as A4");
    assert_eq!(stage.params.name(), "small bar");
    let fitted = stage.params.state();
    let Playable::Preset(preset) = &fitted.playable else { panic!("a preset") };
    assert_eq!(preset.guide.home, 69);
    assert!(preset.comment.starts_with("Fitted to small bar.wav.\n"), "{}", preset.comment);
    assert!(preset.patch.modes.as_slice().iter().any(|mode| (mode.ratio - 2.756).abs() < 0.01));
    // Played on its key, and an octave higher.
    for (key, octaves) in [(69, 1.0), (81, 2.0)] {
        let found = heard(&fitted, key);
        for (ratio, t60, _) in MODES {
            let frequency = 440.0 * octaves * ratio;
            let nearest = found.iter().min_by(|a, b| (a.0 - frequency).abs().total_cmp(&(b.0 - frequency).abs()));
            let (at, rings) = *nearest.unwrap();
            assert!((at / frequency - 1.0).abs() < 0.003, "{frequency} Hz: {found:?}");
            assert!((rings / t60 - 1.0).abs() < 0.25, "{frequency} Hz: {rings} s in place of {t60} s");
        }
    }
    let calls = stage.host.calls();
    assert!(matches!(&calls[..], [Call::Begin(_), .., Call::End(_)]), "the host is told: {calls:?}");
    stage.button("Undo");
    assert!(stage.params.state() == before, "one step");
    stage.button("Redo");
    assert!(stage.params.state() == fitted);
}

#[test]
fn a_fit_is_cancelled_and_a_second_one_refused_meanwhile() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    let path = stage.file("long.wav", &wav(&strike(220.0, 3.0, 8.0)));
    let other = stage.file("other.wav", &wav(&strike(440.0, 0.3, 1.0)));
    stage.drop_files(&[&path]);
    stage.drop_files(&[&other]);
    stage.assert_says("long.wav is still being fitted");
    stage.button("Cancel the fit");
    // With the pointer over a widget, the status line would show its hint instead of the message.
    stage.harness.event(egui::Event::PointerGone);
    stage.wait();
    stage.assert_says("cancelled: long.wav");
    assert!(stage.params.state() == before && stage.host.calls().is_empty());
    // The panel is gone, and another recording can be dropped. The window is then closed during that fit.
    stage.drop_files(&[&path]);
    assert!(stage.is_fitting());
}

#[test]
fn what_is_no_recording_of_a_strike_says_so_and_changes_nothing() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let before = stage.params.state();
    let files = [
        ("text.wav", b"Not a sound at all.".to_vec(), "text.wav: this is not a sound file: expected WAV"),
        ("empty.flac", Vec::new(), "empty.flac: the file is empty: expected a sound file"),
        (
            "silence.wav",
            wav(&[0.0; 9600]),
            "silence.wav: it is silent, or a constant: expected a strike above −80 dBFS",
        ),
        ("short.wav", wav(&strike(440.0, 0.02, 1.0)), "short.wav: it is shorter than 30 ms: expected a strike"),
        ("cut.wav", wav(&strike(440.0, 0.1, 1.0))[..40].to_vec(), "cut.wav: "),
    ];
    for (name, bytes, says) in files {
        let path = stage.file(name, &bytes);
        stage.drop_files(&[&path]);
        stage.wait();
        stage.assert_says(says);
    }
    let folder = stage.folder.path().join("folder.wav");
    std::fs::create_dir(&folder).unwrap();
    let large = stage.folder.path().join("large.wav");
    std::fs::File::create(&large).unwrap().set_len(33 << 20).unwrap();
    for (path, says) in [
        (folder.as_path(), "folder.wav: this is not a file"),
        (large.as_path(), "large.wav: it has 33 MB: expected at most 32"),
        (Path::new("/nowhere/gone.wav"), "gone.wav: "),
    ] {
        stage.drop_files(&[path]);
        stage.wait();
        stage.assert_says(says);
    }
    assert!(stage.params.state() == before && stage.host.calls().is_empty());
    assert!(stage.harness.query_by_label("Cancel the fit").is_none());
}

#[test]
fn what_is_doubtful_is_said() {
    let stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let [one, other] = ["tone.wav", "other.wav"].map(|name| stage.file(name, &wav(&strike(440.0, 0.2, 0.5))));
    doubtful(stage, &[&one, &other], "other.wav: it has the key and velocity of tone.wav (");
}

#[test]
#[ignore = "takes several seconds"]
fn what_is_doubtful_is_said_of_a_flac_that_does_not_decay() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/sounds/tone.flac"));
    let says = "tone.flac: the sound does not decay: expected something that is struck and rings";
    doubtful(stage("Marimba", SIZE, 1.0, Theme::Dark), &[path], says);
}

fn doubtful(mut stage: Stage, paths: &[&Path], says: &str) {
    stage.tab("Model");
    stage.button("Make it a marimba");
    let changed = stage.params.name();
    stage.drop_files(paths);
    stage.wait();
    stage.harness.event(egui::Event::PointerGone);
    stage.assert_says(&format!("‘{changed}’ was not saved: Undo brings it back; "));
    stage.assert_says(says);
    assert_eq!(stage.params.name(), "tone");
}

#[test]
fn recordings_of_several_keys_that_are_dropped_together_become_one_sound() {
    let mut stage = stage("Marimba", SIZE, 1.0, Theme::Dark);
    let low = stage.file("low.wav", &wav(&strike(220.0, 0.4, 2.0)));
    let high = stage.file("high.wav", &wav(&strike(880.0, 0.2, 0.5)));
    stage.drop_files(&[&low, &high]);
    stage.wait();
    assert_eq!(stage.params.name(), "low");
    let Playable::Preset(preset) = stage.params.state().playable else { panic!("a preset") };
    let is_of_key = |route: Route| route.source == Source::Key && route.destination == Param::Decay;
    assert!(preset.patch.routes.iter().any(|(_, route)| is_of_key(route)), "{:?}", preset.patch.routes);
    assert!(preset.comment.contains("Fitted to low.wav, high.wav."), "{}", preset.comment);
}
