//! Checks that every factory preset measures like an instrument, and sounds like its name.

mod hands;
mod played;
mod promises;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use sprung::internals::measures::preset::{Measure, SYNTHESIS, measure};
use sprung::params::Param;
use sprung::preset::{Family, Guide, Preset};
use sprung::units::note_name;

/// The measures of a preset that are outside their wanted range.
fn off(preset: &Preset) -> Vec<String> {
    let measures = measure(preset).expect("the meters work");
    let text = |measure: &Measure| {
        let Measure { name, unit, value, wanted, note } = measure;
        format!("{}: {name} {:.2} {unit}, wanted {wanted:?} {note}", preset.name, value.unwrap_or(f64::NAN))
    };
    measures.iter().filter(|measure| !measure.is_kept()).map(text).collect()
}

/// All factory presets but `init`, which is only a starting point for one's own sounds.
fn whole_bank() -> Vec<&'static Preset> {
    Preset::factory().iter().filter(|preset| preset.name != "init").collect()
}

#[test]
fn every_sixteenth_preset_measures_like_an_instrument() {
    measured(whole_bank().into_iter().step_by(16).collect());
}

#[test]
#[ignore = "takes minutes"]
fn every_preset_measures_like_an_instrument() {
    measured(whole_bank());
}

fn measured(presets: Vec<&Preset>) {
    let broken: Vec<String> = presets.par_iter().flat_map(|preset| off(preset)).collect();
    assert!(broken.is_empty(), "{} measures are off:\n{}", broken.len(), broken.join("\n"));
}

#[test]
fn a_spoilt_preset_is_noticed() {
    let marimba = Preset::find("Marimba").unwrap();
    for (param, value, name) in [
        (Param::Gain, -30.0, "loudness"),
        (Param::NoiseLevel, -60.0, "attack flatness"),
        (Param::Decay, 20.0, "T60 against a recording"),
    ] {
        let spoilt = Preset { patch: marimba.patch.clone().with(param, value), ..marimba.clone() };
        let off = off(&spoilt);
        assert!(off.iter().any(|line| line.contains(name)), "{param:?}: {off:?}");
    }
}

#[test]
fn a_sound_is_at_home_within_its_keys_and_its_phrase_is_there_too() {
    for preset in whole_bank() {
        let Guide { lowest, highest, home, phrase, .. } = &preset.guide;
        assert!(lowest <= home && home <= highest, "{}", preset.name);
        for note in phrase.as_ref().expect("each has a phrase").notes() {
            let name = note_name(note.key);
            assert!((*lowest..=*highest).contains(&note.key), "{}: {name} of its phrase is outside", preset.name);
        }
    }
}

#[test]
fn families_are_as_large_as_a_bank_needs() {
    let of = |family: Family| whole_bank().iter().filter(|preset| preset.guide.family == Some(family)).count();
    for family in Family::ALL {
        assert!(of(*family) >= 2, "{family}: {}", of(*family));
    }
    assert!(whole_bank().len() >= 128);
    let synthetic = whole_bank().iter().filter(|preset| preset.tags.iter().any(|tag| tag == SYNTHESIS)).count();
    assert!(
        synthetic * 3 < whole_bank().len(),
        "{synthetic} of {} are exempt from what instruments measure",
        whole_bank().len()
    );
}
