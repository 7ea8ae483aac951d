//! How pads move and glow while they sound: by the energies of their modes where these are known, or else by velocity and time.

use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::loaded::Loaded;
use egui::{Pos2, Rect, vec2};
use sprung::engine::SoundingNote;
use sprung::preset::Preset;
use sprung_picture::{BodyShape, Figure, Form, Swing, small_figure};
use std::cell::OnceCell;
use std::sync::Arc;

/// Seconds after which a note whose energy is not known no longer shines, and in which its body comes to rest.
const FADE: f32 = 1.2;
const REST: f32 = 0.3;
/// The picture in which motions are kept; in another they are as large as that is.
const UNIT: Rect = Rect { min: Pos2::ZERO, max: Pos2::new(100.0, 100.0) };

/// The bodies of the kit's sounds, made anew only when these change.
#[derive(Default)]
pub(super) struct Bodies {
    loaded: Option<Arc<Loaded>>,
    sounds: Vec<(String, Preset)>,
    figures: Vec<Figure>,
    /// With the shapes of their modes, which take long: only of those that were struck or chosen.
    shapes: Vec<OnceCell<BodyShape>>,
}

impl Bodies {
    /// Reads the sounds again if they are others.
    pub(super) fn follow(&mut self, shown: &Shown) {
        let sounds = shown.kit().map_or(&[][..], |kit| &kit.sounds);
        let is_known = self.loaded.as_ref().is_some_and(|loaded| Arc::ptr_eq(loaded, shown.loaded()));
        if !is_known && self.sounds != sounds {
            let of =
                |(_, preset): &(String, Preset)| small_figure(&preset.patch.modes, preset.guide.family, &preset.tags);
            (self.sounds, self.figures) = (sounds.to_vec(), sounds.iter().map(of).collect());
            self.shapes = sounds.iter().map(|_| OnceCell::new()).collect();
        }
        self.loaded = Some(shown.loaded().clone());
    }

    /// The body of a sound as a small picture.
    pub(super) fn figure(&self, sound: usize) -> Option<&Figure> {
        self.figures.get(sound)
    }

    /// The body of a sound with the shapes of its modes.
    pub(super) fn shape(&self, sound: usize) -> Option<&BodyShape> {
        let (_, preset) = self.sounds.get(sound)?;
        let of = || {
            let mut shape = BodyShape::of(&preset.patch.modes, preset.guide.family, &preset.tags);
            // What it stands in is the same in a large picture.
            shape.figure.drum = self.figure(sound).and_then(|figure| figure.drum);
            shape
        };
        Some(self.shapes.get(sound)?.get_or_init(of))
    }
}

/// A kit as it is shown, and its chosen pad.
pub(super) struct About<'a> {
    pub(super) shown: &'a Shown,
    pub(super) bodies: &'a Bodies,
    pub(super) live: &'a Live,
    /// The key of the chosen pad, and whether a click on another one swaps the two.
    pub(super) key: u8,
    pub(super) is_swapping: bool,
}

/// A pad that sounds.
pub(super) struct Sounding {
    key: u8,
    swing: Swing,
    energies: Vec<f32>,
    /// The greatest amplitude since the pad was at rest.
    greatest: f32,
    /// How strongly it sounds: as a share of that, or by velocity and time.
    pub(super) strength: f32,
    /// The displacements of the points of its body's shape, in [`UNIT`].
    moved: Vec<f32>,
}

impl Sounding {
    fn of(key: u8) -> Self {
        let (swing, energies, moved) = (Swing::default(), Vec::new(), Vec::new());
        Self { key, swing, energies, greatest: 0.0, strength: 0.0, moved }
    }

    /// Follows a note, whose energies are known if it is the newest one.
    fn follow(&mut self, note: &SoundingNote, energies: Option<&[f32]>, seconds: f32) {
        let total = energies.map_or(0.0, |energies| energies.iter().sum::<f32>().max(0.0).sqrt());
        let left = (1.0 - note.age / FADE).max(0.0);
        self.strength = note.velocity * left * left;
        match energies.filter(|_| total > 0.0) {
            Some(energies) => {
                self.greatest = self.greatest.max(total);
                self.strength = (0.3 + 0.7 * note.velocity) * total / self.greatest;
                energies.clone_into(&mut self.energies);
            }
            None => {
                let falls = (1.0 - seconds / REST).max(0.0);
                self.energies.iter_mut().for_each(|energy| *energy *= falls);
            }
        }
        self.strength = self.strength.clamp(0.0, 1.0);
    }

    /// The displacements of all points of a body of this form, in a picture of this size.
    pub(super) fn displacements(&self, form: Form, rect: Rect) -> Vec<f32> {
        let scale = form.reach(rect) / form.reach(UNIT);
        self.moved.iter().map(|moved| moved * scale).collect()
    }

    /// Those of a figure with fewer points.
    pub(super) fn displacements_of(&self, figure: &Figure, shape: &BodyShape, rect: Rect) -> Vec<f32> {
        if shape.figure.form != figure.form || self.moved.len() != shape.figure.points.len() {
            return Vec::new();
        }
        let all = self.displacements(figure.form, rect);
        let ([columns, rows], [many, long]) = (figure.grid, shape.figure.grid);
        let near = |place: usize, few: usize, many: usize| (place * (many - 1) + (few - 1) / 2) / (few - 1).max(1);
        let point = |number: usize| near(number / columns, rows, long) * many + near(number % columns, columns, many);
        (0..columns * rows).map(|number| all[point(number)]).collect()
    }
}

/// The pads that sound.
#[derive(Default)]
pub(super) struct Live(Vec<Sounding>);

impl Live {
    /// Follows the sounding notes. The energies are those of the modes of the newest note's sound.
    pub(super) fn follow(&mut self, bodies: &Bodies, shown: &Shown, energies: &[f32], controls: &Controls) {
        let kit = &shown.loaded().kit;
        self.0.retain(|pad| controls.notes.iter().any(|note| note.key == pad.key));
        let seconds = (!controls.params.view().less_motion).then_some(controls.seconds);
        for (place, note) in controls.notes.iter().enumerate() {
            let is_again = controls.notes[..place].iter().any(|newer| newer.key == note.key);
            let Some(pad) = kit.pad(note.key).filter(|_| !is_again) else { continue };
            let known = self.0.iter().position(|other| other.key == note.key).unwrap_or_else(|| {
                self.0.push(Sounding::of(note.key));
                self.0.len() - 1
            });
            let sounding = &mut self.0[known];
            sounding.follow(note, Some(energies).filter(|_| place == 0), controls.seconds);
            if !sounding.energies.is_empty()
                && let Some(shape) = bodies.shape(pad.sound)
            {
                sounding.moved = sounding.swing.advance(seconds, shape, &sounding.energies, UNIT);
            }
        }
    }

    /// What sounds on a key.
    pub(super) fn of(&self, key: u8) -> Option<&Sounding> {
        self.0.iter().find(|pad| pad.key == key)
    }
}

/// A picture as wide as twice its height at most, in the middle of a place.
pub(super) fn place(rect: Rect) -> Rect {
    Rect::from_center_size(rect.center(), vec2(rect.width().min(2.0 * rect.height()), rect.height()))
}
