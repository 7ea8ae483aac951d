//! Changes of a kit: sounds are put on pads, pads are moved, copied, emptied and set.

use crate::editor::controls::Controls;
use crate::editor::controls::gestures::{self, load};
use crate::editor::controls::history::History;
use crate::params::SprungParams;
use crate::state::{EditedPad, State};
use nice_plug_core::context::gui::GuiContext;
use sprung::internals::editor::with_ending;
use sprung::params::Param;
use sprung::preset::{KitPreset, Playable, Preset};
use sprung::sound::Pad;
use sprung::units::note_name;

/// What comes of editing a pad.
pub(in crate::editor) const EDITS: &str =
    "Opens the sound alone, to change it; Put back, beside its name, returns it to its pad. Effects stay the kit’s.";
/// The key of the first pad of a new kit, that of a kick, and of the second, that of a snare.
pub(super) const FIRST: u8 = 36;
pub(super) const SECOND: u8 = 38;

/// Changes the kit as one step that can be undone.
pub(super) fn change(what: String, controls: &mut Controls, edit: impl FnOnce(&mut KitPreset)) {
    controls.history.begin(controls.params);
    gestures::change(controls.params, controls.host, |state| edited(state, edit));
    controls.history.end(what, controls.params);
}

/// Loads the sound of a kit's pad alone, as it is heard, to be edited and put back, as one step.
pub(in crate::editor) fn take(key: u8, controls: &mut Controls) {
    let Some(state) = controls.params.state().of_pad(key) else { return };
    let is_changed = controls.history.is_changed();
    controls.release();
    controls.history.begin(controls.params);
    load(state, controls.params, controls.host);
    controls.history.end_of_pad(format!("edit {}", name_of(key)), is_changed, controls.params);
}

/// The sound of a state as a whole: a pad's, while it is edited, back on its kit.
pub(in crate::editor) fn whole(state: State) -> Playable {
    let State { playable: Playable::Preset(preset), pad: Some(EditedPad { key, kit }), .. } = &state else {
        return state.into_sound();
    };
    let mut whole = (**kit).clone();
    give(&mut whole, *key, preset);
    Playable::Kit(whole)
}

/// Loads the kit from which the sound was taken, with the sound as it is now on its pad, as one step. Returns the pad's key.
pub(in crate::editor) fn put_back(history: &mut History, params: &SprungParams, host: &GuiContext) -> Option<u8> {
    let state = params.state();
    let EditedPad { key, kit } = state.pad.clone()?;
    let (seed, view, after) = (state.seed, state.view, whole(state));
    let is_same = matches!(&after, Playable::Kit(after) if *after == *kit);
    let is_changed = history.is_changed() || !is_same;
    history.begin(params);
    load(State::new(after, seed, view), params, host);
    history.end_of_pad(format!("{} put back", name_of(key)), is_changed, params);
    Some(key)
}

/// Gives the pad of a key another sound, and leaves the pad as it is. Pads that shared its sound keep that.
fn give(kit: &mut KitPreset, key: u8, preset: &Preset) {
    let Some(before) = pad(kit, key).cloned() else { return };
    let is_shared = kit.pads.iter().any(|(other, pad)| *other != key && pad.sound == before.sound);
    match kit.sounds.get_mut(before.sound).filter(|_| !is_shared) {
        Some((_, sound)) => *sound = preset.clone(),
        None => {
            let sound = place_of(kit, preset);
            set(kit, key, Some(Pad { sound, ..before }));
        }
    }
    number_by_use(kit);
    // A single sound brings its effects with it.
    if kit.sounds.len() == 1 {
        *kit = kit.clone().with_values(&preset.patch.values);
    }
}

/// The state with a changed kit; none while a preset is loaded.
pub(super) fn edited(state: State, edit: impl FnOnce(&mut KitPreset)) -> Option<State> {
    let Playable::Kit(kit) = &state.playable else { return None };
    // The knobs of one sound have its values, those of several move all: from one to several, it takes them with it.
    let was_single = kit.sounds.len() == 1;
    let before = if was_single { kit.clone().with_values(&state.values) } else { kit.clone() };
    let mut after = before.clone();
    edit(&mut after);
    number_by_use(&mut after);
    let is_single = after.sounds.len() == 1;
    let is_other = was_single && is_single && before.sounds != after.sounds;
    if is_other {
        // Another sound has its own effects.
        after.params = kit.params.clone();
    }
    if was_single == is_single && !is_other {
        return Some(State { playable: Playable::Kit(after), ..state });
    }
    let after = if is_single && !was_single { after.with_moves(&state.values) } else { after };
    Some(State::new(Playable::Kit(after), state.seed, state.view))
}

/// A kit with one pad that plays a preset.
pub(super) fn kit_of(preset: Preset) -> KitPreset {
    let (name, author) = (with_ending(&preset.name, " kit"), preset.author.clone());
    let mut kit = KitPreset {
        name,
        author,
        tags: vec!["kit".to_owned()],
        comment: String::new(),
        details: String::new(),
        voices: Param::Voices.info().max as u8,
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
    let sound = place_of(kit, preset);
    let before = pad(kit, key).cloned().unwrap_or(Pad::of(sound));
    let pitch = Some(f64::from(preset.guide.home));
    set(kit, key, Some(Pad { name: String::new(), sound, pitch, gain_db: 0.0, ..before }));
}

/// The place of a preset among the kit's sounds. One that is not there yet is added under a name of its own.
fn place_of(kit: &mut KitPreset, preset: &Preset) -> usize {
    let known = kit.sounds.iter().position(|(_, known)| known == preset);
    known.unwrap_or_else(|| {
        let is_taken = |name: &str| kit.sounds.iter().any(|(other, _)| other == name);
        let numbered = (2..).map(|number| format!("{} {number}", preset.name));
        let name = std::iter::once(preset.name.clone()).chain(numbered).find(|name| !is_taken(name));
        kit.sounds.push((name.unwrap_or_default(), preset.clone()));
        kit.sounds.len() - 1
    })
}

/// The pad of a key, to be put on another: its pitch stays.
fn taken(kit: &KitPreset, key: u8) -> Option<Pad> {
    pad(kit, key).map(|pad| Pad { pitch: pad.pitch.or(Some(key.into())), ..pad.clone() })
}

/// Lets two keys change their pads.
pub(super) fn swap(kit: &mut KitPreset, [from, to]: [u8; 2]) {
    let [first, second] = [from, to].map(|key| taken(kit, key));
    set(kit, to, first);
    set(kit, from, second);
}

/// Puts a copy of a pad on another key, if there is a pad.
pub(super) fn copy(kit: &mut KitPreset, [from, to]: [u8; 2]) {
    if let Some(pad) = taken(kit, from) {
        set(kit, to, Some(pad));
    }
}

/// Puts the sounds in the order in which pads use them, as a kit's file does, without those that none plays.
fn number_by_use(kit: &mut KitPreset) {
    let mut before: Vec<_> = std::mem::take(&mut kit.sounds).into_iter().map(Some).collect();
    let mut places = vec![0; before.len()];
    for (_, pad) in &mut kit.pads {
        if let Some(sound) = before.get_mut(pad.sound).and_then(Option::take) {
            places[pad.sound] = kit.sounds.len();
            kit.sounds.push(sound);
        }
        pad.sound = places[pad.sound];
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
        let on = |kit: &KitPreset, key| pad(kit, key).map(|pad| kit.sounds[pad.sound].0.clone()).unwrap_or_default();
        swap(&mut kit, [36, 42]);
        swap(&mut kit, [38, 50]);
        number_by_use(&mut kit);
        assert_eq!([36, 38, 40, 42, 50].map(|key| on(&kit, key)), ["Snare 2", "", "Snare", "Kick", "Snare"]);
        assert_eq!(Playable::parse(&kit.to_toml(), "x", &mut find).unwrap(), Playable::Kit(kit.clone()));
        set(&mut kit, 42, None);
        number_by_use(&mut kit);
        assert_eq!((names(&kit), on(&kit, 36)), (vec!["Snare 2".to_owned(), "Snare".to_owned()], "Snare 2".to_owned()));
        // A pad without a pitch of its own keeps that of its key.
        set(&mut kit, 60, Some(Pad::of(0)));
        copy(&mut kit, [60, 62]);
        copy(&mut kit, [1, 62]);
        assert_eq!(pad(&kit, 62).and_then(|pad| pad.pitch), Some(60.0));
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
