//! The host's parameters, made from the engine's table, and the rest of an instance's shared state.

#![allow(unsafe_code, reason = "the wrapper takes parameters as pointers")]

mod knob;

use crate::callback::Callback;
use crate::editor::host::extent::Extent;
use crate::link::Link;
use crate::loaded::{Loaded, Slot};
use crate::lock::lock;
use crate::marks::{Mark, Marks};
use crate::state::{self, EditedPad, Read, State, VIEW, View};
use nice_plug::prelude::*;
use nice_plug_core::params::internals::ParamPtr;
use sprung::internals::learned::{Controllers, Learned};
use sprung::internals::library::Library;
use sprung::params::{PARAM_COUNT, PARAMS, ParamInfo};
use sprung::preset::Playable;
use sprung::sound::Collector;
use std::array::from_fn;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard};

pub(crate) use knob::Knob;

/// The data that the audio thread reads at once.
pub(crate) struct Look {
    pub(crate) positions: [f32; PARAM_COUNT],
    /// Offsets of the knobs by modulation of the whole instrument.
    pub(crate) offsets: [f32; PARAM_COUNT],
    /// The sound, if a new one was loaded.
    pub(crate) new_sound: Option<Arc<Loaded>>,
}

/// State that the audio thread does not use, behind a mutex.
struct Locked {
    /// The preset or kit as it was loaded.
    playable: Playable,
    /// The pad to which the preset can be put back.
    pad: Option<EditedPad>,
    /// Size, zoom and theme of the window.
    view: View,
    /// The parts of the last state that were not understood, one line each.
    complaints: Arc<[String]>,
    /// The sound that was loaded last; the slot has it too.
    loaded: Arc<Loaded>,
    /// All sounds that the audio thread may still refer to, including the last one.
    may_sound: Collector<Loaded>,
    /// How many states the host has loaded, and whether the last one is a sound from a file.
    loads: u64,
    is_from_file: bool,
    /// The names of a kit's pads, by key.
    note_names: NoteNames,
}

/// Names of keys, in the order of the keys.
type NoteNames = Arc<[(u8, String)]>;

/// The state that the threads of one instance share: parameters, the loaded sound, and the rest.
pub(crate) struct SprungParams {
    knobs: Vec<Knob>,
    slot: Slot,
    link: Link,
    extent: Extent,
    /// Whether a sound that is chosen is driven by incoming sound: [`State::driven`].
    is_effect: bool,
    /// Whether the host saves or loads a preset, which has no window.
    is_for_preset: AtomicBool,
    callback: Callback,
    marks: Marks,
    learned: Arc<Learned>,
    /// Locked while something is loaded or the whole state is read; never by the audio thread.
    locked: Mutex<Locked>,
}

impl Default for SprungParams {
    fn default() -> Self {
        Self::of(State::default(), false)
    }
}

impl SprungParams {
    /// The parameters of a new instance of the instrument.
    pub(crate) fn of_instrument() -> Self {
        Self::of(State::inviting(), false)
    }

    /// The parameters of the effect.
    pub(crate) fn of_effect() -> Self {
        Self::of(State::default().driven(), true)
    }

    fn of(state: State, is_effect: bool) -> Self {
        let loaded = Arc::new(state.loaded());
        let State { playable, pad, positions, view, .. } = state;
        let note_names = note_names(&playable);
        let knobs = PARAMS.iter().zip(positions).map(|(info, position)| Knob::new(info, position)).collect();
        let may_sound = Collector::default();
        may_sound.keep(&loaded);
        let complaints = Arc::new([]);
        let locked = Locked {
            playable,
            pad,
            view,
            complaints,
            loaded: loaded.clone(),
            may_sound,
            loads: 0,
            is_from_file: false,
            note_names,
        };
        Self {
            knobs,
            slot: Slot::new(loaded),
            link: Link::default(),
            extent: Extent::default(),
            is_effect,
            is_for_preset: AtomicBool::new(false),
            callback: Callback::default(),
            marks: Marks::default(),
            learned: Arc::default(),
            locked: Mutex::new(locked),
        }
    }

    /// The same with the controllers that all instances in a host share, as they are kept for the user.
    pub(crate) fn of_host(self) -> Self {
        static SHARED: LazyLock<Arc<Learned>> = LazyLock::new(|| {
            let learned = Learned::default();
            if let Err(error) = read_controllers(&learned, Library::of_user().as_ref()) {
                nice_warn!("no controller moves a parameter: {error}");
            }
            Arc::new(learned)
        });
        Self { learned: SHARED.clone(), ..self }
    }

    /// Reads again which controllers move parameters, since other programs may have changed it. If it is not understood, what was
    /// known before holds on.
    pub(crate) fn read_controllers(&self, library: Option<&Library>) -> sprung::Result<()> {
        read_controllers(&self.learned, library)
    }

    /// The controllers that move parameters.
    pub(crate) fn learned(&self) -> &Learned {
        &self.learned
    }

    /// The value that a parameter's knob shows, without modulation. Real-time safe.
    pub(crate) fn present(&self, info: &ParamInfo) -> f32 {
        info.denormalise(self.knobs[info.param as usize].position().into())
    }

    /// The knobs in the order of the table.
    pub(crate) fn knobs(&self) -> &[Knob] {
        &self.knobs
    }

    /// The channels between the window and the audio thread.
    pub(crate) fn link(&self) -> &Link {
        &self.link
    }

    /// The size of the window in pixels.
    pub(crate) fn extent(&self) -> &Extent {
        &self.extent
    }

    fn locked(&self) -> MutexGuard<'_, Locked> {
        lock(&self.locked)
    }

    /// The name of the preset or kit. Not for the audio thread.
    pub(crate) fn name(&self) -> String {
        self.locked().playable.name().to_owned()
    }

    /// Renames the preset or kit. Not for the audio thread.
    pub(crate) fn rename(&self, name: String) {
        self.locked().playable.rename(name);
    }

    /// Describes the preset or kit as another one is described. Not for the audio thread.
    pub(crate) fn describe_as(&self, other: &Playable) {
        let texts = [other.comment(), other.details()].map(str::to_owned);
        self.locked().playable.describe(other.author().to_owned(), other.tags().to_vec(), texts);
    }

    /// Size, zoom and theme of the window. Not for the audio thread.
    pub(crate) fn view(&self) -> View {
        self.locked().view
    }

    /// Changes size, zoom or theme of the window. Not for the audio thread.
    pub(crate) fn set_view(&self, change: impl FnOnce(&mut View)) {
        change(&mut self.locked().view);
    }

    /// The parts of the last state that were not understood, one line each. Not for the audio thread.
    pub(crate) fn complaints(&self) -> Arc<[String]> {
        self.locked().complaints.clone()
    }

    /// What is to be done on the host's main thread.
    pub(crate) fn callback(&self) -> &Callback {
        &self.callback
    }

    /// The names of a kit's pads, by key; none for a preset. Not for the audio thread.
    pub(crate) fn note_names(&self) -> NoteNames {
        self.locked().note_names.clone()
    }

    /// What the host says of the parameter at a place in the table. Not for the audio thread.
    pub(crate) fn mark_of(&self, index: usize) -> Option<Mark> {
        self.marks.of(index)
    }

    /// Changes what the host says of a parameter, and has the window drawn. Not for the audio thread.
    pub(crate) fn mark(&self, index: usize, change: impl FnOnce(&mut Mark)) {
        self.marks.change(index, change);
        self.link.repaint.request_repaint();
    }

    /// Runs `work`. If it saves or loads a preset, states leave out the window meanwhile. On the main thread.
    pub(crate) fn for_preset<T>(&self, is_preset: bool, work: impl FnOnce() -> T) -> T {
        self.is_for_preset.store(is_preset, Relaxed);
        let result = work();
        self.is_for_preset.store(false, Relaxed);
        result
    }

    /// How many states the host has loaded. Not for the audio thread.
    pub(crate) fn loads(&self) -> u64 {
        self.locked().loads
    }

    /// Whether the state that the host loaded last is a sound from a file. Not for the audio thread.
    pub(crate) fn is_from_file(&self) -> bool {
        self.locked().is_from_file
    }

    fn note_load(&self, is_from_file: bool) {
        let mut locked = self.locked();
        (locked.loads, locked.is_from_file) = (locked.loads + 1, is_from_file);
    }

    /// Loads a sound, its knob positions and the rest at once. Not for the audio thread: it computes the sound, and
    /// frees sounds that are no longer played. Does not notify the host. Returns the loaded sound.
    ///
    /// An open window stays as it is: it must not change under the user's hands when the host steps through sounds or
    /// takes something back.
    pub(crate) fn load(&self, read: Read) -> Arc<Loaded> {
        self.load_over(read, |_, _| true)
    }

    /// The state of a sound that is chosen, as this plugin plays it: in the effect, incoming sound drives it.
    pub(crate) fn suited(&self, state: State) -> State {
        if self.is_effect { state.driven() } else { state }
    }

    /// Loads a preset or kit that the host has chosen; the window begins anew with it. Not for the audio thread.
    pub(crate) fn load_for_host(&self, playable: Playable) {
        let State { seed, view, .. } = self.state();
        self.load(self.suited(State::new(playable, seed, view)).into());
        self.note_load(true);
        self.link.repaint.request_repaint();
    }

    /// Loads what becomes of the present state by a change. Knobs that the change leaves alone stay where they are, also if the host
    /// turns them meanwhile. Returns the loaded sound, or none if the change returns none. Otherwise like [`SprungParams::load`].
    pub(crate) fn change(&self, change: impl FnOnce(State) -> Option<State>) -> Option<Arc<Loaded>> {
        let before = self.state();
        let positions = before.positions;
        let after = change(before)?;
        Some(self.load_over(after.into(), |index, position| position.to_bits() != positions[index].to_bits()))
    }

    /// Like [`SprungParams::load`], for those knobs that `turns` returns true for, by place in the table and wanted position.
    fn load_over(&self, Read { state, complaints }: Read, turns: impl Fn(usize, f32) -> bool) -> Arc<Loaded> {
        let loaded = Arc::new(state.loaded());
        let note_names = note_names(&state.playable);
        let mut locked = self.locked();
        let is_renamed = std::mem::replace(&mut locked.note_names, note_names) != locked.note_names;
        (locked.playable, locked.pad) = (state.playable, state.pad);
        if !self.extent.is_open() && !self.is_for_preset.load(Relaxed) {
            locked.view = state.view;
        }
        locked.complaints = complaints.into();
        locked.loaded = loaded.clone();
        locked.may_sound.keep(&loaded);
        self.slot.put(loaded.clone(), || {
            for (index, (knob, position)) in self.knobs.iter().zip(state.positions).enumerate() {
                if turns(index, position) {
                    knob.turn(position);
                }
            }
        });
        locked.may_sound.collect();
        drop(locked);
        if is_renamed {
            self.callback.tell_new_names();
        }
        loaded
    }

    /// The whole present state. Not for the audio thread.
    pub(crate) fn state(&self) -> State {
        let locked = self.locked();
        let positions: [f32; PARAM_COUNT] = from_fn(|index| self.knobs[index].position());
        let values = locked.loaded.values_at(&positions);
        let mut playable = locked.playable.clone();
        if let Playable::Preset(preset) = &mut playable {
            preset.patch.values = values;
        }
        let pad = locked.pad.clone();
        State { playable, pad, values, positions, seed: locked.loaded.seed, view: locked.view }
    }

    /// The pad to which the preset can be put back, if it was taken from one. Not for the audio thread.
    pub(crate) fn pad(&self) -> Option<EditedPad> {
        self.locked().pad.clone()
    }

    /// Whether a preset is loaded, and no kit. Not for the audio thread.
    pub(crate) fn is_preset(&self) -> bool {
        matches!(self.locked().playable, Playable::Preset(_))
    }

    /// The sound that was loaded last. Not for the audio thread.
    pub(crate) fn loaded(&self) -> Arc<Loaded> {
        self.locked().loaded.clone()
    }

    /// The knob positions, their offsets, and the sound if it differs from `known`. `None` while another thread is
    /// writing. Real-time safe.
    pub(crate) fn look(&self, known: &Arc<Loaded>) -> Option<Look> {
        self.slot.read(|loaded| Look {
            positions: from_fn(|index| self.knobs[index].position()),
            offsets: from_fn(|index| self.knobs[index].offset()),
            new_sound: (!Arc::ptr_eq(known, loaded)).then(|| loaded.clone()),
        })
    }
}

/// The names of a kit's pads, by key; none for a preset.
fn note_names(playable: &Playable) -> NoteNames {
    let Playable::Kit(kit) = playable else { return Arc::new([]) };
    let mut names: Vec<_> = kit.pads.iter().map(|(key, pad)| (*key, playable.pad_name(pad).to_owned())).collect();
    names.sort_unstable_by_key(|(key, _)| *key);
    names.into()
}

fn read_controllers(learned: &Learned, library: Option<&Library>) -> sprung::Result<()> {
    learned.publish(&library.map_or_else(|| Ok(Controllers::new()), Library::controllers)?);
    Ok(())
}

// SAFETY: the pointers refer to knobs in a vector that is neither changed nor moved while `self` lives.
unsafe impl Params for SprungParams {
    fn param_map(&self) -> Vec<(String, ParamPtr, String)> {
        let entry = |(info, knob): (&ParamInfo, &Knob)| (info.id.to_owned(), knob.as_ptr(), info.section.to_owned());
        PARAMS.iter().zip(&self.knobs).map(entry).collect()
    }

    fn serialize_fields(&self) -> BTreeMap<String, String> {
        let mut state = self.state();
        if self.is_for_preset.load(Relaxed) {
            state.view = VIEW;
        }
        BTreeMap::from([(state::FIELD.to_owned(), state.to_json())])
    }

    fn deserialize_fields(&self, fields: &BTreeMap<String, String>) {
        // `filter` has already removed data that is not a state.
        if let Some(Ok(read)) = fields.get(state::FIELD).map(|json| State::parse(json)) {
            read.complaints
                .iter()
                .for_each(|complaint| nice_warn!("a state was not understood as a whole: {complaint}"));
            let is_as_played = fields.contains_key(state::EFFECT_FIELD);
            let state = if is_as_played { read.state } else { self.suited(read.state) };
            self.load(Read { state, ..read });
            self.note_load(false);
        }
    }
}

#[cfg(test)]
mod tests;
