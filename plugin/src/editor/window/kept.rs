//! Whether a sound that came with a project is kept anywhere else.

use crate::editor::kit::edit::whole;
use crate::params::SprungParams;
use crate::state::State;
use sprung::internals::library::Library;
use sprung::preset::Playable;

/// Whether neither the factory nor the user has the sound as it is. One that the host has loaded from a file is kept there. May read
/// the user's files.
pub(super) fn is_nowhere(params: &SprungParams, library: Option<&Library>) -> bool {
    if params.is_from_file() {
        return false;
    }
    let now = params.state();
    let (seed, view, pad, sound) = (now.seed, now.view, now.pad.as_ref().map(|pad| pad.key), whole(now));
    let is_it = |kept: Playable| {
        let kept = params.suited(State::new(kept, seed, view));
        let kept = if let Some(key) = pad { kept.of_pad(key) } else { Some(kept) };
        kept.is_some_and(|kept| whole(kept) == sound)
    };
    // No sound of the user's has the name of one of the factory's.
    let is_kept = match Playable::find(sound.name()) {
        Ok(factorys) => is_it(factorys),
        Err(_) => library.is_some_and(|library| library.called(sound.name()).any(is_it)),
    };
    // Nothing has been made of a plain mass yet.
    !(is_kept || is_it(State::default().playable))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;
    use sprung::preset::{KitPreset, Preset};

    #[test]
    fn what_is_in_no_file_as_it_is_is_kept_nowhere() {
        what_is_kept_nowhere(16);
    }

    #[test]
    #[ignore = "takes several seconds"]
    fn no_sound_of_the_factorys_is_lost() {
        what_is_kept_nowhere(1);
    }

    /// With each `step`-th preset of the factory's, and all kits.
    fn what_is_kept_nowhere(step: usize) {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::at(folder.path());
        for params in [SprungParams::of_instrument(), SprungParams::of_effect()] {
            let is_lost = |state: State| {
                params.load(State::parse(&state.to_json()).unwrap());
                is_nowhere(&params, Some(&library))
            };
            assert!(!is_lost(params.state()), "a new instance");
            let of = |sound: Playable| params.suited(State::new(sound, 0, params.view()));
            let factorys = |name: &str| of(Playable::find(name).unwrap());
            let kits = KitPreset::factory().iter().map(|kit| kit.name.as_str());
            let presets = Preset::factory().iter().map(|preset| preset.name.as_str());
            for name in presets.step_by(step).chain(kits) {
                assert!(!is_lost(factorys(name)), "{name}");
            }
            let Playable::Preset(preset) = factorys("Marimba").playable else { unreachable!() };
            let moved = Preset { patch: preset.patch.clone().with(Param::Decay, 9.0), ..preset.clone() };
            assert!(is_lost(of(Playable::Preset(moved))));
            let own = of(Playable::Preset(Preset { name: "Own".to_owned(), ..preset }));
            assert!(is_lost(own.clone()), "it is in no file");

            // A kit's knobs move all of its sounds.
            let mut kit = factorys("Acoustic Kit");
            kit.playable.rename("Own kit");
            kit.values.set(Param::Decay, 2.0 * kit.values.get(Param::Decay));
            kit.positions[Param::Decay as usize] = Param::Decay.info().normalise(kit.values.get(Param::Decay)) as f32;
            assert!(is_lost(kit.clone()));
            for state in [&own, &kit] {
                library.save(&state.clone().into_sound(), true).unwrap();
                assert!(!is_lost(state.clone()), "{}", state.playable.name());
            }

            // While a pad is edited, it counts with its kit.
            let mut pad = factorys("Acoustic Kit").of_pad(38).unwrap();
            assert!(!is_lost(pad.clone()));
            let Playable::Preset(preset) = &mut pad.playable else { unreachable!() };
            preset.patch.set(Param::Decay, 9.0);
            assert!(is_lost(pad));

            let mut elsewhere = own.playable;
            elsewhere.rename("Another");
            params.load_for_host(elsewhere);
            assert!(!is_nowhere(&params, Some(&library)), "it came from a file");
            std::fs::remove_dir_all(library.presets_folder()).unwrap();
        }
    }
}
