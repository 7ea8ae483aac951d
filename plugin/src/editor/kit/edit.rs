//! Changes of a kit: sounds are put on pads, pads are moved, copied, emptied and set.

use crate::editor::controls::Controls;
use crate::editor::controls::gestures::load;
use crate::state::State;
use sprung::preset::{KitPreset, Playable, Preset};
use sprung::sound::Pad;
use sprung::units::note_name;

/// The key of the first pad of a new kit: that of a kick.
pub(super) const FIRST: u8 = 36;

/// Changes the kit as one step that can be undone.
pub(super) fn change(what: String, controls: &mut Controls, edit: impl Fn(&mut KitPreset)) {
    let Some(state) = edited(controls, edit) else { return };
    controls.history.begin(controls.params);
    load(state, controls.params, controls.host);
    controls.history.end(what, controls.params);
}

/// The state with a changed kit; none while a preset is loaded.
pub(super) fn edited(controls: &Controls, edit: impl Fn(&mut KitPreset)) -> Option<State> {
    let state = controls.params.state();
    let Playable::Kit(kit) = &state.playable else { return None };
    let edited = |mut kit: KitPreset| {
        edit(&mut kit);
        leave_out_unused(&mut kit);
        kit
    };
    let kept = edited(kit.clone());
    // Knobs of one sound have its values, those of several move all of them: between the two, sounds take the knobs' values.
    if (kit.sounds.len() == 1) == (kept.sounds.len() == 1) {
        return Some(State { playable: Playable::Kit(kept), ..state });
    }
    let taken = edited(kit.clone().with_values(&state.values));
    Some(State::new(Playable::Kit(taken), state.seed, state.view))
}

/// A kit with one pad that plays a preset.
pub(super) fn kit_of(preset: Preset) -> KitPreset {
    let (name, author) = (format!("{} kit", preset.name), preset.author.clone());
    let mut kit = KitPreset {
        name,
        author,
        tags: vec!["kit".to_owned()],
        comment: String::new(),
        details: String::new(),
        voices: sprung::params::Param::Voices.info().max as u8,
        params: Vec::new(),
        sounds: Vec::new(),
        pads: Vec::new(),
    };
    put(&mut kit, FIRST, &preset);
    kit
}

/// The pad of a key.
pub(super) fn pad(kit: &KitPreset, key: u8) -> Option<&Pad> {
    kit.pads.iter().find(|(own, _)| *own == key).map(|(_, pad)| pad)
}

/// Gives a key this pad, or none.
pub(super) fn set(kit: &mut KitPreset, key: u8, pad: Option<Pad>) {
    kit.pads.retain(|(own, _)| *own != key);
    kit.pads.extend(pad.map(|pad| (key, pad)));
    kit.pads.sort_by_key(|(key, _)| *key);
}

/// Puts a preset on a key, at the pitch of its home key. Place, choke group and output stay those of the pad before.
pub(super) fn put(kit: &mut KitPreset, key: u8, preset: &Preset) {
    let known = kit.sounds.iter().position(|(_, known)| known == preset);
    let sound = known.unwrap_or_else(|| {
        let is_taken = |name: &str| kit.sounds.iter().any(|(other, _)| other == name);
        let numbered = (2..).map(|number| format!("{} {number}", preset.name));
        let name = std::iter::once(preset.name.clone()).chain(numbered).find(|name| !is_taken(name));
        kit.sounds.push((name.unwrap_or_default(), preset.clone()));
        kit.sounds.len() - 1
    });
    let before = pad(kit, key).cloned().unwrap_or(Pad::of(sound));
    let pitch = Some(f64::from(preset.guide.home));
    set(kit, key, Some(Pad { name: String::new(), sound, pitch, gain_db: 0.0, ..before }));
}

/// Lets two keys change their pads.
pub(super) fn swap(kit: &mut KitPreset, [from, to]: [u8; 2]) {
    let [first, second] = [from, to].map(|key| pad(kit, key).cloned());
    set(kit, to, first);
    set(kit, from, second);
}

/// Leaves out the sounds that no pad plays.
fn leave_out_unused(kit: &mut KitPreset) {
    for sound in (0..kit.sounds.len()).rev() {
        if kit.pads.iter().all(|(_, pad)| pad.sound != sound) {
            kit.sounds.remove(sound);
            kit.pads.iter_mut().filter(|(_, pad)| pad.sound > sound).for_each(|(_, pad)| pad.sound -= 1);
        }
    }
}

/// What is on a key, for the name of a step.
pub(super) fn name_of(key: u8) -> String {
    format!("pad {}", note_name(key))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;

    fn preset(name: &str) -> &'static Preset {
        Preset::find(name).unwrap()
    }

    #[test]
    fn pads_are_put_moved_and_emptied_and_no_sound_is_kept_in_vain() {
        let mut kit = kit_of(preset("Kick").clone());
        put(&mut kit, 38, preset("Snare"));
        put(&mut kit, 40, preset("Snare"));
        let mut odd = preset("Snare").clone();
        odd.patch.set(Param::Decay, 0.7);
        put(&mut kit, 42, &odd);
        let names = |kit: &KitPreset| kit.sounds.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&kit), ["Kick", "Snare", "Snare 2"], "a sound that is there is used again");
        let text = kit.to_toml();
        let mut find = |name: &str| Preset::find(name).cloned();
        assert_eq!(Playable::parse(&text, "x", &mut find).unwrap(), Playable::Kit(kit.clone()));
        let on = |kit: &KitPreset, key| pad(kit, key).map(|pad| kit.sounds[pad.sound].0.clone());
        swap(&mut kit, [36, 42]);
        swap(&mut kit, [38, 50]);
        leave_out_unused(&mut kit);
        assert_eq!(
            [36, 38, 40, 42, 50].map(|key| on(&kit, key).unwrap_or_default()),
            ["Snare 2", "", "Snare", "Kick", "Snare"]
        );
        set(&mut kit, 42, None);
        leave_out_unused(&mut kit);
        assert_eq!(
            (names(&kit), on(&kit, 36)),
            (vec!["Snare".to_owned(), "Snare 2".to_owned()], Some("Snare 2".to_owned()))
        );
    }

    #[test]
    fn a_sound_that_takes_anothers_place_keeps_choke_group_place_and_output() {
        let mut kit = kit_of(preset("Kick").clone());
        let old = Pad { name: "A".to_owned(), gain_db: -3.0, pan: 0.5, choke: Some(2), output: 3, ..Pad::of(0) };
        set(&mut kit, FIRST, Some(old));
        put(&mut kit, FIRST, preset("Marimba"));
        let expected = Pad { pitch: Some(60.0), pan: 0.5, choke: Some(2), output: 3, ..Pad::of(1) };
        assert_eq!(pad(&kit, FIRST), Some(&expected));
    }
}
