//! Tests of the state that is published about voices and keys.

use super::*;

fn telemetry(sample_rate: f64) -> (Arc<Telemetry>, TelemetryWriter) {
    let telemetry = Arc::new(Telemetry::default());
    (telemetry.clone(), TelemetryWriter::new(telemetry, sample_rate))
}

#[test]
fn load_is_a_share_of_the_period() {
    let (telemetry, writer) = telemetry(48_000.0);
    let ms = Duration::from_millis;
    [1, 12, 2].into_iter().for_each(|busy| writer.note_block(480, ms(busy)));
    let load = telemetry.load();
    assert_eq!((load.frames, load.blocks, load.late_blocks), (1440, 3, 1));
    assert!((load.mean_share - 0.5).abs() < 1e-6 && (load.worst_share - 1.2).abs() < 1e-6, "{load:?}");
    writer.note_block(480, ms(2));
    assert!((telemetry.load().recent_share - 0.2).abs() < 1e-6, "the recent worst is forgotten once it was told");
}

#[test]
fn wheels_stand_where_they_were_moved_last() {
    let (telemetry, mut writer) = telemetry(48_000.0);
    let mut tell = |kind| {
        writer.note_event(&Event { frame: 0, channel: 3, kind });
        telemetry.wheels(3)
    };
    assert_eq!(tell(EventKind::PitchBend(-0.5)), [-0.5, 0.0]);
    assert_eq!(tell(EventKind::Control { controller: WHEEL, value: 0.25 }), [-0.5, 0.25]);
    assert_eq!(tell(EventKind::Control { controller: RESET, value: 0.0 }), [0.0; 2]);
    assert_eq!(tell(EventKind::PitchBend(f32::NAN)), [0.0; 2]);
    assert_eq!(tell(EventKind::PitchBend(5.0)), [1.0, 0.0]);
    assert_eq!(telemetry.wheels(2), [0.0; 2], "another channel's");
    writer.reset();
    assert_eq!(telemetry.wheels(3), [0.0; 2]);
}

#[test]
fn keys_and_programs_are_kept_by_channel() {
    let (telemetry, mut writer) = telemetry(48_000.0);
    let mut tell = |kind| writer.note_event(&Event { frame: 0, channel: 3, kind });
    [0, 63, 64, 127].into_iter().for_each(|key| tell(EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None }));
    tell(EventKind::NoteOff { key: 63, velocity: 0.5, id: None });
    assert_eq!(telemetry.keys(3), 1 | 1 << 64 | 1 << 127);
    assert_eq!((telemetry.keys(2), telemetry.program(3)), (0, None));
    for number in [7, 0, 255] {
        tell(EventKind::Program(number));
        assert_eq!(telemetry.program(3), Some(number));
    }
    let notes = Notes { id: None, channel: Some(3), key: Some(64) };
    tell(EventKind::Release { notes, velocity: 0.5 });
    assert_eq!(telemetry.keys(3), 1 | 1 << 127);
    tell(EventKind::Silence { notes: Notes { key: Some(0), channel: Some(4), id: None } });
    assert_eq!(telemetry.keys(3), 1 | 1 << 127, "of another channel");
    tell(EventKind::Control { controller: ALL_NOTES_OFF, value: 0.0 });
    assert_eq!(telemetry.keys(3), 0);
    let [one, other] = [1, 2].map(NoteId::new);
    for id in [one, other] {
        tell(EventKind::NoteOn { key: 9, detune: 0.0, velocity: 1.0, id });
    }
    tell(EventKind::NoteOff { key: 9, velocity: 0.5, id: one });
    assert_eq!(telemetry.keys(3), 1 << 9, "another note is on the key");
    tell(EventKind::Release { notes: Notes { id: one, channel: None, key: None }, velocity: 0.5 });
    assert_eq!(telemetry.keys(3), 1 << 9);
    tell(EventKind::Release { notes: Notes { id: other, channel: None, key: None }, velocity: 0.5 });
    assert_eq!(telemetry.keys(3), 0, "a note that is ended by its identifier alone");
    tell(EventKind::NoteOn { key: 5, detune: 0.0, velocity: 1.0, id: None });
    writer.reset();
    assert_eq!(telemetry.keys(3), 0);
}

#[test]
fn peaks_and_masses_are_those_of_the_sound_and_only_while_somebody_looks() {
    let (telemetry, mut writer) = telemetry(4_000.0);
    assert!(telemetry.is_silent());
    let mut moved = Snapshot { voices: 2, lowered: 1.5, ..Snapshot::default() };
    moved.masses[63].displacement = -0.5;
    moved.masses[63].energy = 0.25;
    moved.notes[0] = Some(crate::engine::SoundingNote { key: 60, ..Default::default() });
    writer.note_sound(&[0.25, -0.5], &[0.0, 0.125], false, || unreachable!("nobody looks"));
    assert_eq!((telemetry.take_peaks(), telemetry.take_peaks()), ([0.5, 0.125], [0.0, 0.0]));
    assert_eq!((telemetry.snapshot(), telemetry.is_silent()), (Snapshot::default(), false));
    writer.note_sound(&[0.0; 2], &[0.0; 2], false, || moved);
    assert_eq!(telemetry.snapshot(), moved);
    writer.note_sound(&[0.0; 99], &[0.0; 99], true, || unreachable!("within a fortieth of a second"));
    assert!(telemetry.is_silent());
    writer.note_sound(&[0.0; 1], &[0.0; 1], true, Snapshot::default);
    assert_eq!(telemetry.snapshot(), Snapshot::default());
}
