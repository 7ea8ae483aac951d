//! Measured values of recordings of real instruments, with which presets of the same instruments are compared.

use super::octaves::CENTRES;
use std::ops::RangeInclusive;
use std::sync::OnceLock;
use toml::{Table, Value};

/// The values of one instrument, over its recordings at middle and high velocity.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The instrument, with its source.
    pub(crate) name: String,
    /// Presets that are meant to be this instrument.
    pub(crate) presets: Vec<String>,
    /// [`super::high_share`] in dB.
    pub(crate) high_share: RangeInclusive<f64>,
    /// T60 in seconds of each octave; none for octaves without sound.
    pub(crate) t60: [Option<RangeInclusive<f64>>; CENTRES.len()],
}

/// The values of all instruments.
pub(crate) fn all() -> &'static [Recording] {
    const TEXT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/measures/recordings.toml"));
    static ALL: OnceLock<Vec<Recording>> = OnceLock::new();
    ALL.get_or_init(|| read(TEXT).expect("the embedded figures are checked by a test"))
}

/// The values with which a preset is compared; none if there is no such recording.
pub(crate) fn of(preset: &str) -> Option<&'static Recording> {
    all().iter().find(|recording| recording.presets.iter().any(|name| name == preset))
}

fn read(text: &str) -> Option<Vec<Recording>> {
    let table: Table = text.parse().ok()?;
    table.get("recording")?.as_array()?.iter().map(recording).collect()
}

fn recording(value: &Value) -> Option<Recording> {
    let range = |value: &Value| {
        let [from, to] = value.as_array()?.as_slice() else { return None };
        Some(from.as_float()?..=to.as_float()?)
    };
    let names = value.get("presets")?.as_array()?.iter().map(|name| name.as_str().map(str::to_owned));
    let mut t60 = [const { None }; CENTRES.len()];
    for (place, octave) in t60.iter_mut().zip(value.get("t60_s")?.as_array()?) {
        *place = range(octave);
    }
    Some(Recording {
        name: value.get("name")?.as_str()?.to_owned(),
        presets: names.collect::<Option<_>>()?,
        high_share: range(value.get("high_share_db")?)?,
        t60,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::Preset;

    #[test]
    fn figures_are_complete_and_presets_exist() {
        assert!(all().len() > 30);
        for recording in all() {
            assert!(recording.t60.iter().any(Option::is_some), "{}", recording.name);
            for name in &recording.presets {
                assert!(Preset::find(name).is_ok(), "{}: there is no preset ‘{name}’", recording.name);
            }
        }
        assert!(of("Marimba").is_some() && of("init").is_none());
    }
}
