//! What the body is: its model, material and numbers, and those of a second body and of their joint.

use super::edit::BodyEdit;
use super::numbers::{GROUPS, Number, Part};
use super::offer::{NO_BODY, TAKES, offer, offer_pad, suggestion};
use super::origin::OriginShown;
use super::pick::{BETWEEN, Tiles, discs};
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::theme::{GAP, SMALL};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::Field;
use crate::editor::widgets::number;
use crate::editor::widgets::text::{line, paragraph};
use crate::link::Link;
use egui::{Align2, Id, Rect, Response, ScrollArea, Sense, Ui, UiBuilder, Vec2, pos2, vec2};
use sprung::internals::editor::LINK_KINDS;
use sprung::sound::bodies::{MATERIALS, Model};
use sprung_picture::play::{DISCS, MODELS};
use sprung_picture::{Origin, model_name};

/// Width of the part with model and material as lists, and with pictures of them, if it is so wide and high.
const SIDE: f32 = 188.0;
const PICTURED: [f32; 3] = [340.0, 840.0, 224.0];
/// Height of a row in that part, and width of the names.
const ROW: f32 = 25.0;
const NAMES: f32 = 54.0;
/// Heights of tiles in one line and in two, and of discs, with the gaps after them.
const TILES: [f32; 2] = [36.0, 96.0];
const LINE_OF_DISCS: f32 = 32.0;
/// Height of the title of some numbers.
const TITLE: f32 = 14.0;
/// Size of a number with its name.
const CELL: [f32; 2] = [88.0, number::HEIGHT];
/// Largest width of a number's cell, where there is room.
const WIDEST: f32 = 124.0;
/// Shown in place of a model if there is none.
const NONE: &str = "none";
/// What such a table lacks.
const LACKS: &str = "This sound’s modes are fixed: typed in, or fitted to a recording. Choose a model, and it has a body \
                     instead.";

/// The page's state.
#[derive(Default)]
pub(crate) struct BodyPage {
    part: Part,
    read: OriginShown,
    edit: Option<BodyEdit>,
    audition: Audition,
    tiles: Tiles,
}

impl BodyPage {
    /// Releases the key that is held.
    pub(crate) fn release(&mut self, link: &Link) {
        self.audition.release(link);
    }

    /// Ends what the user is doing with a number.
    pub(crate) fn leave(&mut self, controls: &mut Controls) {
        if let Some(edit) = self.edit.take() {
            // The error was already shown during the drag.
            let _ = edit.end(controls);
        }
    }

    /// The body or joint whose numbers are shown, by its name on the way of the sound.
    pub(crate) fn chosen(&self) -> &'static str {
        match self.part {
            Part::First => "Body",
            Part::Second => "Body 2",
            Part::Joint => "Joint",
        }
    }

    /// Turns to a body or joint by that name.
    pub(crate) fn turn_to(&mut self, name: &str) {
        self.part = match name {
            "Body 2" => Part::Second,
            "Joint" => Part::Joint,
            _ => Part::First,
        };
    }

    /// Shows what the body of a preset may be and be made of, as pictures, if there is room for them above something so high. Returns
    /// where they end, and a message.
    pub(crate) fn strips(
        &mut self,
        ui: &Ui,
        rect: Rect,
        below: f32,
        shown: &Shown,
        controls: &mut Controls,
    ) -> (f32, Option<String>) {
        let (now, link) = (ui.input(|input| input.time), controls.params.link());
        self.audition.follow_time(now, link);
        self.audition.request_end(ui);
        let end = rect.top() + TILES[0] + LINE_OF_DISCS;
        if shown.preset().is_none() || rect.bottom() - end < below {
            return (rect.top(), None);
        }
        let origin = self.read.get(shown);
        let picked = self.things(ui, rect, (TILES[0], Part::First), &origin, shown, controls);
        (end, picked.and_then(|picked| self.make(ui, &origin, picked, shown, controls)))
    }

    /// Shows models and materials as pictures, the models in a line or two of this height. Returns the changed body and the name of the
    /// undo step.
    fn things(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (height, part): (f32, Part),
        origin: &Origin,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<(Origin, String)> {
        let (body, mut picked) = (part.body(origin), None);
        let rows = if height > TILES[0] { 2 } else { 1 };
        let columns = MODELS.len().div_ceil(rows);
        let size = vec2(rect.width() / columns as f32, height / rows as f32) - Vec2::splat(BETWEEN);
        let now = (body.map(|body| &body.model), false);
        if let Some(id) = self.tiles.show_all(ui, (rect.min, size, columns), now, controls) {
            let changed = origin.with_model(part == Part::Second, Model::find(id));
            picked = Some((changed, format!("model {}", model_name(id))));
        }
        if part != Part::First && body.is_none() {
            return picked;
        }
        let size = vec2(rect.width() / DISCS.len() as f32, LINE_OF_DISCS);
        // A table of modes has no material: to choose one is to make it the body as which it is drawn.
        let mut made = if part == Part::First { suggestion(origin, shown).1 } else { origin.clone() };
        let help = if body.is_some() { "Make it of this material." } else { TAKES };
        let now = (body.map(|body| body.material.id), false, help);
        let corner = rect.min + vec2(0.0, height);
        if let Some(id) = discs(ui, (corner, size, DISCS.len()), now, controls)
            && let Some(material) = MATERIALS.iter().find(|material| material.id == id)
            && let Some(body) = part.body_mut(&mut made)
        {
            body.material = *material;
            picked = Some((made, format!("material {id}")));
        }
        picked
    }

    /// Makes the sound from another body, and strikes it. Returns a message.
    fn make(
        &mut self,
        ui: &Ui,
        origin: &Origin,
        (changed, what): (Origin, String),
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<String> {
        self.leave(controls);
        let message = BodyEdit::make(origin, changed, what, shown.loaded(), controls).err();
        let now = ui.input(|input| input.time);
        self.audition.strike(shown.guide().home, VELOCITY, now, controls.params.link());
        message
    }

    /// Shows the page. Returns a message.
    pub(crate) fn show(&mut self, ui: &mut Ui, rect: Rect, shown: &Shown, controls: &mut Controls) -> Option<String> {
        if shown.preset().is_none() {
            offer_pad(ui, rect, shown, controls);
            return None;
        }
        if self.edit.as_ref().is_some_and(|edit| !edit.is_of(shown.loaded())) {
            self.edit = None;
            controls.history.cancel();
        }
        let (now, link) = (ui.input(|input| input.time), controls.params.link());
        self.audition.follow_time(now, link);
        self.audition.request_end(ui);
        let origin = self.origin(shown);
        if origin.pair().is_none() && self.part == Part::Joint || origin == Origin::Table {
            self.part = Part::First;
        }
        let [wide, least_width, least_height] = PICTURED;
        let is_pictured = rect.width() >= least_width && rect.height() >= least_height;
        let side = rect.with_max_x(rect.left() + if is_pictured { wide } else { SIDE });
        let rest = rect.with_min_x(side.right() + 2.0 * GAP);
        let mut picked = self.side(ui, side, is_pictured, &origin, controls);
        if is_pictured && self.part != Part::Joint {
            let below = side.with_min_y(side.top() + 3.0 * ROW + GAP);
            picked = self.things(ui, below, (TILES[1], self.part), &origin, shown, controls).or(picked);
        }
        if origin == Origin::Table {
            picked = offer(ui, rest, LACKS, (&origin, shown), controls).or(picked);
        }
        if let Some(picked) = picked {
            return self.make(ui, &origin, picked, shown, controls);
        }
        if origin == Origin::Table { None } else { self.numbers(ui, rest, &origin, shown, controls) }
    }

    /// The body to show: while a number is dragged, the one that is being changed.
    fn origin(&mut self, shown: &Shown) -> Origin {
        if let Some(edit) = &self.edit {
            return edit.origin().clone();
        }
        self.read.get(shown)
    }

    /// Shows which body is edited, its model and its material. Returns the changed body and the name of the undo step.
    fn side(
        &mut self,
        ui: &Ui,
        rect: Rect,
        is_pictured: bool,
        origin: &Origin,
        controls: &mut Controls,
    ) -> Option<(Origin, String)> {
        // All four rows are within a small window too.
        let tall = ROW.min((rect.height() + 4.0) / 4.0);
        let row = |place: usize| {
            Rect::from_min_size(rect.min + vec2(0.0, place as f32 * tall), vec2(rect.width(), tall - 4.0))
        };
        let palette = controls.palette;
        let parts = [("First", Part::First), ("Second", Part::Second), ("Joint", Part::Joint)];
        for (place, (name, part)) in parts.into_iter().enumerate() {
            let width = (rect.width() - 8.0) / 3.0;
            let at =
                Rect::from_min_size(row(0).min + vec2(place as f32 * (width + 4.0), 0.0), vec2(width, row(0).height()));
            let is_there =
                part == Part::First || origin.pair().is_some() || part == Part::Second && *origin != Origin::Table;
            let look = match (is_there, part == self.part) {
                (false, _) => Look::Disabled,
                (true, true) => Look::On,
                (true, false) => Look::Off,
            };
            if button(ui, at, name, &format!("{name} body").replace("Joint body", "Joint of the bodies"), look, palette)
                .clicked()
            {
                self.part = part;
            }
        }
        let field = |place: usize, title: &str, value: &str, names: &[String]| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            line(
                ui.painter(),
                row(place).with_max_x(rect.left() + NAMES),
                Align2::LEFT_CENTER,
                title,
                SMALL,
                palette.muted,
            );
            let name = format!("{title} of the body");
            let field = Field { id: Id::unique(("body", title)), name: &name, value, is_default: true };
            field.show(ui, row(place).with_min_x(rect.left() + NAMES), &names, palette).1
        };
        if let Some(pair) = origin.pair().filter(|_| self.part == Part::Joint) {
            let names: Vec<String> = LINK_KINDS.iter().map(|(kind, _)| (*kind).to_owned()).collect();
            let same = |link: &_| std::mem::discriminant(link) == std::mem::discriminant(&pair.link);
            let now = LINK_KINDS.iter().find(|(_, link)| same(link)).map_or("", |(kind, _)| *kind);
            let picked = field(1, "Kind", now, &names)?;
            let (kind, link) = LINK_KINDS[picked];
            return Some((origin.linked(link), format!("joint {kind}")));
        }
        let body = self.part.body(origin);
        let is_first = self.part == Part::First;
        let none = if is_first { NO_BODY } else { NONE };
        let first = if is_first { None } else { Some(NONE.to_owned()) };
        let models = first.into_iter().chain(Model::ALL.iter().map(|(id, _)| model_name(id)));
        let names: Vec<String> = models.collect();
        let now = body.map_or(none.to_owned(), |body| model_name(body.model.id()));
        if let Some(picked) = field(1, "Model", &now, &names) {
            let model = Model::ALL.iter().find(|(id, _)| model_name(id) == names[picked]).map(|(_, model)| model);
            return Some((origin.with_model(!is_first, model), format!("model {}", names[picked])));
        }
        let body = body?;
        let names: Vec<String> = MATERIALS.iter().map(|material| material.id.replace('_', " ")).collect();
        if let Some(picked) = field(2, "Material", &body.material.id.replace('_', " "), &names) {
            let mut changed = origin.clone();
            self.part.body_mut(&mut changed)?.material = MATERIALS[picked];
            return Some((changed, format!("material {}", names[picked])));
        }
        if origin.pair().is_some() {
            let look = if body.follows_key { Look::On } else { Look::Off };
            let at = if is_pictured {
                Rect::from_min_size(pos2(rect.left(), rect.bottom() - tall), row(0).size())
            } else {
                row(3)
            };
            if button(ui, at, "Follows the keys", "The body follows the keys", look, palette).clicked() {
                let mut changed = origin.clone();
                let body = self.part.body_mut(&mut changed)?;
                body.follows_key = !body.follows_key;
                let what = if body.follows_key { "body follows the keys" } else { "body keeps its pitch" };
                return Some((changed, what.to_owned()));
            }
        }
        None
    }

    /// Shows the numbers. Returns a message.
    fn numbers(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        origin: &Origin,
        shown: &Shown,
        controls: &mut Controls,
    ) -> Option<String> {
        let numbers = self.part.numbers(origin);
        if numbers.is_empty() {
            let text = "One body sounds. Choose a model, and a second one stands beside it; their joint says how they act on each other.";
            paragraph(ui.painter(), rect, text, SMALL, controls.palette.muted);
            return None;
        }
        let rows = (((rect.height() - TITLE) / CELL[1]) as usize).max(1);
        let of = |title: &str| numbers.iter().filter(|number| number.group() == title).collect::<Vec<_>>();
        let groups: Vec<(&str, Vec<&Number>)> = GROUPS.into_iter().map(|title| (title, of(title))).collect();
        let across = |count: usize| count.div_ceil(rows) as f32;
        let columns: f32 = groups.iter().map(|(_, numbers)| across(numbers.len())).sum();
        let (mut is_held, mut is_dragged) = (false, false);
        let mut inner = ui.new_child(UiBuilder::new().id_salt("body numbers").max_rect(rect));
        ScrollArea::horizontal().auto_shrink(false).show(&mut inner, |ui| {
            let cell = vec2((rect.width() / columns).clamp(CELL[0], WIDEST).floor(), CELL[1]);
            let (area, _) = ui.allocate_exact_size(vec2(columns * cell.x, rect.height()), Sense::hover());
            let mut left = area.left();
            for (title, numbers) in groups {
                let head = Rect::from_min_size(pos2(left, area.top()), vec2(across(numbers.len()) * cell.x, TITLE));
                left = head.right();
                if !numbers.is_empty() {
                    line(ui.painter(), head, Align2::LEFT_CENTER, title, SMALL, controls.palette.text);
                }
                for (place, number) in numbers.into_iter().enumerate() {
                    let corner = head.left_bottom() + vec2((place / rows) as f32, (place % rows) as f32) * cell;
                    let (response, value) = show(ui, Rect::from_min_size(corner, cell), number, controls);
                    is_dragged |= response.dragged();
                    is_held |= is_dragged || response.has_focus();
                    if response.changed() && value != number.value {
                        let mut changed = self.edit.as_ref().map_or(origin, BodyEdit::origin).clone();
                        self.part.set(&mut changed, number.name, value);
                        let what = format!("{} {}", number.about()[0], number.written(value));
                        let edit = self.edit.get_or_insert_with(|| BodyEdit::begin(origin, shown.loaded(), controls));
                        edit.change(changed, what);
                    }
                }
            }
        });
        let edit = self.edit.as_mut()?;
        let now = ui.input(|input| input.time);
        let was_due = edit.is_due();
        let message = edit.write(now, controls).err();
        let (home, link) = (shown.guide().home, controls.params.link());
        if is_dragged {
            self.audition.repeat(home, now, link);
        } else if was_due && !edit.is_due() {
            self.audition.strike(home, VELOCITY, now, link);
        }
        if is_held {
            if is_dragged || edit.is_due() {
                ui.ctx().request_repaint();
            }
            return message;
        }
        message.or(self.edit.take().and_then(|edit| edit.end(controls).err()))
    }
}

/// Shows a number. Returns its new value.
fn show(ui: &mut Ui, cell: Rect, number: &Number, controls: &mut Controls) -> (Response, f64) {
    let [title, help] = number.about();
    let field = number::Number {
        title,
        help,
        value: number.value,
        range: number.range,
        speed: number.speed(),
        is_whole: number.is_whole(),
        written: &|value| number.written(value),
        read: &|text| number.read(text),
    };
    field.show(ui, cell, controls)
}
