//! The form of the suite: where its sections begin, and the harmony of a bar.

/// First beats of the sections, and the end.
pub(super) const OPENING: f64 = 0.0;
pub(super) const DANCE: f64 = 16.0;
pub(super) const TUTTI: f64 = 64.0;
pub(super) const ECHO: f64 = 92.0;
pub(super) const END: f64 = 104.0;

/// The harmony of a bar: the bass note, and a voicing of five notes around middle C, from low to high.
pub(super) type Chord = (u8, [u8; 5]);

/// The bars of a section with their first beats.
pub(super) fn bars(at: f64, chords: &'static [Chord]) -> impl Iterator<Item = (f64, &'static Chord)> {
    chords.iter().enumerate().map(move |(bar, chord)| (at + bar as f64 * 4.0, chord))
}
