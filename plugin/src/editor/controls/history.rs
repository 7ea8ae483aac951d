//! Undo and redo: the states before and after each action of the user's, by name.

use super::files;
use super::gestures::{Gestures, load};
use crate::params::SprungParams;
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use sprung::params::{PARAM_COUNT, PARAMS, Values};
use sprung::preset::Playable;
use std::time::{Duration, Instant};

/// How many steps can be undone.
const STEPS: usize = 100;

/// Turns of one knob that follow each other within this time, by wheel or arrow keys, are one step.
const PAUSE: Duration = Duration::from_millis(700);

/// A state, with the name of the action before or after it.
struct Step {
    name: String,
    state: State,
    /// The knobs that the action moved. Others are left where they are by then, since a host or a controller may have moved them.
    moved: Vec<usize>,
    /// Whether the action replaced the sound by the other one of the two versions.
    swaps: bool,
    /// See [`History::is_changed`].
    is_changed: bool,
}

/// The steps that can be undone and redone.
#[derive(Default)]
pub(crate) struct History {
    /// The states before each step, the last one at the end.
    undo: Vec<Step>,
    /// The states after each step that was undone, the next one at the end.
    redo: Vec<Step>,
    /// The state before the action in progress.
    open: Option<State>,
    /// The knob that was turned last, and when.
    turned: Option<(usize, Instant)>,
    is_changed: bool,
    /// The name of the sound that was chosen last, until somebody has looked.
    chosen: Option<String>,
    /// The name of the changed sound in whose place one was loaded, until somebody has looked.
    lost: Option<String>,
    trial: Trial,
}

/// What has been done since one began to try sounds.
#[derive(Default)]
struct Trial {
    /// How many steps lead here from what there was then; below zero, how many were undone.
    steps: isize,
    /// Whether the last step is a sound that was tried: the next one takes its place.
    goes_on: bool,
}

impl History {
    /// No steps yet, of a sound that came with a project or from the run before.
    pub(crate) fn of_loaded(is_changed: bool) -> Self {
        Self { is_changed, ..Self::default() }
    }

    /// Keeps the state before an action of the user's begins. It becomes a step only at [`History::end`].
    pub(crate) fn begin(&mut self, params: &SprungParams) {
        if self.open.is_none() {
            self.open = Some(params.state());
        }
    }

    /// Drops the action in progress: it becomes no step.
    pub(crate) fn cancel(&mut self) {
        self.open = None;
    }

    /// Ends the action in progress: it becomes a step if it has changed anything.
    pub(crate) fn end(&mut self, name: impl Into<String>, params: &SprungParams) {
        self.end_step(name.into(), false, true, params, |_| true);
    }

    /// Like [`History::end`], after an action that can only have moved these knobs.
    pub(crate) fn end_of(&mut self, moved: &[usize], name: String, params: &SprungParams) {
        self.end_step(name, false, true, params, |index| moved.contains(&index));
    }

    /// Like [`History::end_of`], after a turn by wheel or key, which goes on with one just before.
    pub(crate) fn end_of_turn(&mut self, index: usize, name: String, params: &SprungParams) {
        let before = self.turned.take();
        let goes_on = before.is_some_and(|(knob, then)| knob == index && then.elapsed() < PAUSE);
        match self.undo.last_mut().filter(|step| goes_on && step.moved == [index]) {
            Some(step) => {
                (step.name, self.open) = (name, None);
                self.redo.clear();
            }
            None => self.end_of(&[index], name, params),
        }
        self.turned = Some((index, Instant::now()));
    }

    /// Loads a sound as one step.
    pub(crate) fn load(&mut self, playable: Playable, params: &SprungParams, host: &GuiContext) {
        self.note_lost(params);
        self.load_as(playable.name().to_owned(), playable, params, host);
    }

    fn load_as(&mut self, name: String, playable: Playable, params: &SprungParams, host: &GuiContext) {
        self.begin(params);
        self.chosen = Some(playable.name().to_owned());
        files::load(playable, params, host);
        // In the place of a pad's sound, it is a change of the kit, of which nothing is lost.
        let is_changed = params.pad().is_some();
        self.lost.take_if(|_| is_changed);
        self.end_step(name, false, is_changed, params, |_| true);
        self.is_changed = is_changed;
    }

    /// Begins to try sounds: what there is now is what [`History::trial`] leads back to.
    pub(crate) fn begin_trial(&mut self) {
        self.trial = Trial::default();
    }

    /// How many steps are to be undone, or below zero to be done again, to come back to what there was when the trial began.
    pub(crate) fn trial(&self) -> isize {
        self.trial.steps
    }

    /// Loads a sound to hear it. Those that are tried in a row are one step, from the sound before them to the last one.
    pub(crate) fn try_out(&mut self, playable: Playable, params: &SprungParams, host: &GuiContext) {
        self.note_lost(params);
        let mut from = params.name();
        if let Some(step) = self.trial.goes_on.then(|| self.undo.pop()).flatten() {
            self.trial.steps -= 1;
            from = step.state.playable.name().to_owned();
            (self.open, self.is_changed) = (Some(step.state), step.is_changed);
        }
        let (steps, name) = (self.trial.steps, format!("{from} → {}", playable.name()));
        self.load_as(name, playable, params, host);
        self.trial.goes_on = self.trial.steps > steps;
    }

    /// Loads a sound that is in no file yet, as one step of this name.
    pub(crate) fn load_new(&mut self, name: String, sound: Playable, params: &SprungParams, host: &GuiContext) {
        self.begin(params);
        self.note_lost(params);
        files::load(sound, params, host);
        self.end(name, params);
    }

    fn note_lost(&mut self, params: &SprungParams) {
        let kit = || params.pad().map(|pad| pad.kit.name.clone());
        self.lost = self.is_changed.then(|| kit().unwrap_or_else(|| params.name()));
    }

    /// The name of the sound that was loaded since the last call.
    pub(crate) fn take_chosen(&mut self) -> Option<String> {
        self.chosen.take()
    }

    /// A message if a sound that was changed and not saved has been replaced since the last call.
    pub(crate) fn take_lost(&mut self) -> Option<String> {
        self.lost.take().map(|name| format!("‘{name}’ was not saved: Undo brings it back"))
    }

    /// Like [`History::end`], after the sound was replaced by the other one of the two versions, which may be changed.
    pub(crate) fn end_swap(&mut self, name: &str, is_changed: bool, params: &SprungParams) {
        self.end_step(name.to_owned(), true, is_changed, params, |_| true);
    }

    /// The sound was saved as it is. That of a pad is a part of a kit, which was not.
    pub(crate) fn saved(&mut self, params: &SprungParams) {
        self.begin_trial();
        if params.pad().is_some() {
            return;
        }
        self.undo.iter_mut().chain(&mut self.redo).for_each(|step| step.is_changed = true);
        (self.is_changed, self.turned) = (false, None);
    }

    /// Whether the sound, or the kit whose pad is edited, differs from what was loaded or saved; after a project or a restart, from all that
    /// is kept.
    pub(crate) fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// Like [`History::end`], after a sound was taken from a kit's pad or put back, which loses no change.
    pub(crate) fn end_of_pad(&mut self, name: String, is_changed: bool, params: &SprungParams) {
        self.end_step(name, false, is_changed, params, |_| true);
    }

    fn end_step(
        &mut self,
        name: String,
        swaps: bool,
        is_changed: bool,
        params: &SprungParams,
        may_move: impl Fn(usize) -> bool,
    ) {
        let Some(state) = self.open.take() else { return };
        let after = params.state();
        let moved: Vec<usize> = moved_between(&state, &after).filter(|index| may_move(*index)).collect();
        let value = |state: &State, index: usize| state.values.get(PARAMS[index].param);
        let is_same = |index: usize| !may_move(index) || value(&state, index) == value(&after, index);
        if moved.is_empty() && (0..PARAM_COUNT).all(is_same) && same_but_for_knobs(&state, &after) {
            return;
        }
        self.turned = None;
        let is_changed = std::mem::replace(&mut self.is_changed, is_changed);
        self.undo.push(Step { name, state, moved, swaps, is_changed });
        self.trial = Trial { steps: self.trial.steps.max(0) + 1, goes_on: false };
        self.redo.clear();
        if self.undo.len() > STEPS {
            self.undo.remove(0);
        }
    }

    /// The name of the step that would be undone.
    pub(crate) fn undo_name(&self) -> Option<&str> {
        self.undo.last().map(|step| step.name.as_str())
    }

    /// The name of the step that would be redone.
    pub(crate) fn redo_name(&self) -> Option<&str> {
        self.redo.last().map(|step| step.name.as_str())
    }

    /// Undoes the last step. Returns whether the two versions change places by this.
    pub(crate) fn undo(&mut self, params: &SprungParams, host: &GuiContext) -> bool {
        (self.turned, self.trial.goes_on) = (None, false);
        self.trial.steps -= isize::from(!self.undo.is_empty());
        go([&mut self.undo, &mut self.redo], &mut self.is_changed, params, host)
    }

    /// Redoes the step that was undone last. Returns whether the two versions change places by this.
    pub(crate) fn redo(&mut self, params: &SprungParams, host: &GuiContext) -> bool {
        (self.turned, self.trial.goes_on) = (None, false);
        self.trial.steps += isize::from(!self.redo.is_empty());
        go([&mut self.redo, &mut self.undo], &mut self.is_changed, params, host)
    }
}

fn go([from, to]: [&mut Vec<Step>; 2], is_changed: &mut bool, params: &SprungParams, host: &GuiContext) -> bool {
    let Some(Step { name, mut state, moved, swaps, is_changed: then }) = from.pop() else { return false };
    let now = params.state();
    let by_others: Vec<usize> = moved_between(&state, &now).filter(|index| !moved.contains(index)).collect();
    for index in by_others {
        state.positions[index] = now.positions[index];
        state.values.set(PARAMS[index].param, now.values.get(PARAMS[index].param));
    }
    to.push(Step { name, state: now, moved, swaps, is_changed: std::mem::replace(is_changed, then) });
    restore(state, params, host);
    swaps
}

/// Restores a state, except the size and colours of the window, and tells the host which knobs have moved.
pub(crate) fn restore(mut state: State, params: &SprungParams, host: &GuiContext) {
    let now = params.state();
    state.view = now.view;
    if same_but_for_knobs(&state, &now) {
        // Sounding notes follow a moved knob; they would not follow if the sound were loaded again.
        let mut gestures = Gestures::default();
        for index in moved_between(&state, &now) {
            gestures.set(params, host, index, state.positions[index]);
        }
        // A loaded value may lie between the positions of a knob, so that setting the position does not restore it.
        if params.state().values == state.values {
            return;
        }
    }
    load(state, params, host);
}

/// The knobs that are elsewhere in the one state than in the other.
fn moved_between(one: &State, other: &State) -> impl Iterator<Item = usize> {
    let pairs = one.positions.iter().zip(&other.positions);
    pairs.enumerate().filter(|(_, (one, other))| one.to_bits() != other.to_bits()).map(|(index, _)| index)
}

/// Whether two states have the same sound and the same name.
pub(crate) fn same_sound(one: &State, other: &State) -> bool {
    one.positions == other.positions && one.values == other.values && same_but_for_knobs(one, other)
}

fn same_but_for_knobs(one: &State, other: &State) -> bool {
    let neutral = |playable: &Playable| {
        let mut playable = playable.clone();
        if let Playable::Preset(preset) = &mut playable {
            preset.patch.values = Values::default();
        }
        playable
    };
    one.seed == other.seed && one.pad == other.pad && neutral(&one.playable) == neutral(&other.playable)
}
