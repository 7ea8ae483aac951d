//! The host's parameters, made from the engine's table, and the rest of an instance's shared state.

#![allow(unsafe_code, reason = "the wrapper takes parameters as pointers and has no safe way to set several at once")]

use crate::callback::Callback;
use crate::editor::host::extent::Extent;
use crate::link::Link;
use crate::loaded::{Loaded, Slot};
use crate::lock::lock;
use crate::marks::{Mark, Marks};
use crate::state::{self, Read, State, VIEW, View};
use nice_plug::prelude::*;
use nice_plug_core::params::InternalParamMut;
use nice_plug_core::params::internals::ParamPtr;
use sprung::params::learned::{Controllers, Learned};
use sprung::params::{Change, PARAM_COUNT, PARAMS, ParamInfo, Unit};
use sprung::preset::Playable;
use sprung::preset::library::Library;
use sprung::sound::Collector;
use std::array::from_fn;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard};

/// A host's parameter.
pub(crate) enum Knob {
    /// The knob's position, 0–1. The wrapper's own curves would not give the engine's values.
    Continuous(FloatParam),
    /// A count, or the index of a choice.
    Stepped(IntParam),
}

impl Knob {
    /// With a position that is also the host’s default; the window resets to the table’s.
    fn new(info: &'static ParamInfo, position: f32) -> Self {
        let smoothed = matches!(info.change, Change::Smoothed(_));
        if matches!(info.unit, Unit::Count | Unit::Choice) {
            let range = IntRange::Linear { min: info.min as i32, max: info.max as i32 };
            let knob = IntParam::new(info.name, info.denormalise(position.into()) as i32, range)
                .with_value_to_string(Arc::new(|value| info.format(value as f32)))
                .with_string_to_value(Arc::new(|text| Some(info.parse(text).ok()? as i32)));
            return Self::Stepped(if smoothed { knob.with_poly_modulation_id(info.param as u32) } else { knob });
        }
        let knob = FloatParam::new(info.name, position, FloatRange::Linear { min: 0.0, max: 1.0 })
            .with_value_to_string(Arc::new(|position| info.format(info.denormalise(f64::from(position)))))
            .with_string_to_value(Arc::new(|text| Some(info.normalise(info.parse(text).ok()?) as f32)));
        Self::Continuous(if smoothed { knob.with_poly_modulation_id(info.param as u32) } else { knob })
    }

    /// The knob's position 0–1, without modulation. Real-time safe.
    pub(crate) fn position(&self) -> f32 {
        match self {
            Self::Continuous(knob) => knob.unmodulated_normalized_value(),
            Self::Stepped(knob) => knob.unmodulated_normalized_value(),
        }
    }

    /// Offset of the knob by modulation of the whole instrument. Real-time safe.
    pub(crate) fn offset(&self) -> f32 {
        // Read the position first, since the wrapper writes it last. If it changes in between, position plus offset is
        // still the new modulated position.
        let position = self.position();
        match self {
            Self::Continuous(knob) => knob.modulated_normalized_value() - position,
            Self::Stepped(knob) => knob.modulated_normalized_value() - position,
        }
    }

    /// The wrapper's name for the parameter.
    pub(crate) fn as_ptr(&self) -> ParamPtr {
        match self {
            Self::Continuous(knob) => knob.as_ptr(),
            Self::Stepped(knob) => knob.as_ptr(),
        }
    }

    /// Sets the knob without telling the host. Real-time safe.
    pub(crate) fn turn(&self, position: f32) {
        match self {
            Self::Continuous(knob) => turn(knob, position, self.offset()),
            Self::Stepped(knob) => turn(knob, position, self.offset()),
        }
    }
}

/// Sets a knob that modulation has moved by `offset`. At the end of the range, the wrapper ignores a new value because
/// the modulated value does not change: then the knob is set without modulation, and the modulation is applied again.
fn turn<P: Param + InternalParamMut>(knob: &P, position: f32, offset: f32)
where
    P::Plain: PartialEq,
{
    // SAFETY: the methods only write atomics of a parameter that is borrowed here. They are marked unsafe because they do
    // not notify the host; callers do that where it is needed.
    unsafe {
        knob._internal_set_normalized_value(position);
        if knob.unmodulated_plain_value() != knob.preview_plain(position) {
            knob._internal_modulate_value(0.0);
            knob._internal_set_normalized_value(position);
            knob._internal_modulate_value(offset);
        }
    }
}

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
    /// Size, zoom and theme of the window.
    view: View,
    /// The parts of the last state that were not understood, one line each.
    complaints: Arc<[String]>,
    /// The sound that was loaded last; the slot has it too.
    loaded: Arc<Loaded>,
    /// All sounds that the audio thread may still refer to, including the last one.
    may_sound: Collector<Loaded>,
    /// How many states the host has loaded.
    loads: u64,
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
    /// Whether sounds are loaded as the effect plays them: [`State::driven`].
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
    /// The parameters of the effect.
    pub(crate) fn of_effect() -> Self {
        Self::of(State::default().driven(), true)
    }

    fn of(state: State, is_effect: bool) -> Self {
        let loaded = Arc::new(state.loaded());
        let State { playable, positions, view, .. } = state;
        let note_names = note_names(&playable);
        let knobs = PARAMS.iter().zip(positions).map(|(info, position)| Knob::new(info, position)).collect();
        let may_sound = Collector::default();
        may_sound.keep(&loaded);
        let complaints = Arc::new([]);
        let locked = Locked { playable, view, complaints, loaded: loaded.clone(), may_sound, loads: 0, note_names };
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
            match Library::of_user().map_or_else(|| Ok(Controllers::new()), |library| library.controllers()) {
                Ok(controllers) => learned.publish(&controllers),
                Err(error) => nice_warn!("no controller moves a parameter: {error}"),
            }
            Arc::new(learned)
        });
        Self { learned: SHARED.clone(), ..self }
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
        match &mut self.locked().playable {
            Playable::Preset(preset) => preset.name = name,
            Playable::Kit(kit) => kit.name = name,
        }
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

    /// Loads a sound, its knob positions and the rest at once. Not for the audio thread: it computes the sound, and
    /// frees sounds that are no longer played. Does not notify the host. Returns the loaded sound.
    ///
    /// An open window stays as it is: it must not change under the user's hands when the host steps through sounds or
    /// takes something back.
    pub(crate) fn load(&self, Read { state, complaints }: Read) -> Arc<Loaded> {
        let state = if self.is_effect { state.driven() } else { state };
        self.load_as_it_is(Read { state, complaints })
    }

    /// Loads a preset or kit that the host has chosen; the window begins anew with it. Not for the audio thread.
    pub(crate) fn load_for_host(&self, playable: Playable) {
        let State { seed, view, .. } = self.state();
        self.load(State::new(playable, seed, view).into());
        self.locked().loads += 1;
        self.link.repaint.request_repaint();
    }

    /// As [`SprungParams::load`], but the effect changes nothing in it.
    fn load_as_it_is(&self, Read { state, complaints }: Read) -> Arc<Loaded> {
        let loaded = Arc::new(state.loaded());
        let note_names = note_names(&state.playable);
        let mut locked = self.locked();
        let is_renamed = std::mem::replace(&mut locked.note_names, note_names) != locked.note_names;
        locked.playable = state.playable;
        if !self.extent.is_open() && !self.is_for_preset.load(Relaxed) {
            locked.view = state.view;
        }
        locked.complaints = complaints.into();
        locked.loaded = loaded.clone();
        locked.may_sound.keep(&loaded);
        self.slot.put(loaded.clone(), || {
            for (knob, position) in self.knobs.iter().zip(state.positions) {
                knob.turn(position);
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
        State { playable, values, positions, seed: locked.loaded.seed, view: locked.view }
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

// SAFETY: the pointers refer to knobs in a vector that is neither changed nor moved while `self` lives.
unsafe impl Params for SprungParams {
    fn param_map(&self) -> Vec<(String, ParamPtr, String)> {
        let pointer = |knob: &Knob| match knob {
            Knob::Continuous(knob) => knob.as_ptr(),
            Knob::Stepped(knob) => knob.as_ptr(),
        };
        let entry = |(info, knob): (&ParamInfo, &Knob)| (info.id.to_owned(), pointer(knob), info.section.to_owned());
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
            if fields.contains_key(state::EFFECT_FIELD) {
                self.load_as_it_is(read);
            } else {
                self.load(read);
            }
            self.locked().loads += 1;
        }
    }
}

#[cfg(test)]
mod tests;
