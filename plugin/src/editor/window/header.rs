//! The top of the window: the sound's name, the buttons for it, and its level.

use super::meter::{self, Level};
use super::variation::{self, Variation, VariationRequest};
use crate::editor::body::face;
use crate::editor::controls::{Controls, Hint};
use crate::editor::host::extent;
use crate::editor::routes::carry;
use crate::editor::theme::{BRAND, GAP, SMALL, TEXT, Theme, ZOOMS, paint_panel};
use crate::editor::widgets::buttons::{Look, button, tab};
use crate::editor::widgets::star;
use crate::editor::widgets::text::{line, width};
use crate::state::View;
use egui::{Align2, Id, Popup, PopupCloseBehavior, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use nice_plug_core::context::PluginApi;
use sprung_picture::Figure;
use std::collections::BTreeSet;

/// Width of the button that puts a sound back to its pad.
const PUT: f32 = 58.0;
/// Widths of the body before the name, of the star behind its tags, and of the dice.
const BODY: f32 = 28.0;
const STAR: f32 = 20.0;
const DICE: f32 = 30.0;
/// Least width of a window that has dice.
const LEAST_WIDTH_WITH_DICE: f32 = 1000.0;

/// What the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::editor) enum Face {
    /// The body, to play.
    #[default]
    Play,
    /// What the sound is made of: modes, pictures, parameters.
    Sound,
    /// What moves: sources, routes, curves.
    Motion,
    /// The pads of a kit.
    Kit,
}

/// The faces with their names and what they are for.
const FACES: [(Face, &str, &str); 4] = [
    (Face::Play, "Play", "The body, what moves it, and the few knobs that matter."),
    (Face::Sound, "Sound", "What the sound is made of: its modes, moving pictures, its parameters, and tuning."),
    (Face::Motion, "Motion", "What moves what: sources to be dragged to knobs, routes, envelopes and oscillators."),
    (Face::Kit, "Kit", "Sounds on pads: drag them there, and set pitch, level, place, choke group and output."),
];

/// A request of the user's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Request {
    /// Show this face.
    Show(Face),
    /// Load and play the sound at this distance in the browser's list.
    Step(isize),
    /// Put the sound back to its pad.
    PutBack,
    /// Close the browser, and bring back what there was before sounds were tried.
    GiveUp,
    /// Make the sound a favourite, or no favourite any more.
    Star,
    Browse,
    Save,
    Undo,
    Redo,
    /// Switch to the other one of the two versions of the sound.
    Swap,
    /// Replace the other version by a copy of this one.
    Copy,
    Zoom(u32),
    Theme(Theme),
    /// Whether bodies are to stand still.
    LessMotion(bool),
    /// The manual's page about what is shown.
    Manual,
    /// The page of the program's devices.
    Devices,
    Variation(VariationRequest),
}

/// The contents of the header.
pub(super) struct Header<'a> {
    pub(super) name: &'a str,
    pub(super) words: &'a str,
    /// The sound's body.
    pub(super) figure: &'a Figure,
    pub(super) is_favourite: bool,
    /// The pad from which the sound was taken, in words.
    pub(super) pad: Option<&'a str>,
    pub(super) is_changed: bool,
    pub(super) is_browsing: bool,
    /// The face that is shown, if no other page covers it.
    pub(super) face: Option<Face>,
    /// Whether the second version is shown.
    pub(super) is_b: bool,
    /// Whether the two versions differ.
    pub(super) versions_differ: bool,
    pub(super) view: View,
    /// Width and height of the screen at 100 %, if they are known.
    pub(super) screen: Option<[f64; 2]>,
    /// Sections that variations leave as they are.
    pub(super) locked: &'a BTreeSet<&'static str>,
    /// Levels of left and right.
    pub(super) levels: [Level; 2],
    /// By how many decibels the limiter lowers the sound.
    pub(super) lowered: f32,
}

pub(super) fn show(ui: &mut Ui, rect: Rect, header: &Header, controls: &mut Controls) -> Option<Request> {
    let palette = controls.palette;
    let mut request = None;
    let is_narrow = rect.width() < 940.0;
    let mut left = rect.left() + 2.0;
    let mut next = |width: f32| {
        let place = Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height()));
        left = place.right() + 4.0;
        place
    };
    if !is_narrow {
        line(ui.painter(), next(72.0), Align2::LEFT_CENTER, "Sprung", BRAND, palette.accent_text);
    }
    for (face, name, help) in FACES {
        let place = next(width(ui.painter(), name, SMALL + 1.0) + if is_narrow { 6.0 } else { 20.0 });
        let response = tab(ui, place, name, Some(face) == header.face, palette);
        if response.hovered() {
            *controls.hint = Hint::new(name, help);
        }
        if response.clicked() || Some(face) != header.face && carry::dwells(ui, place, controls) {
            request = Some(Request::Show(face));
        }
    }
    let sound = next(if is_narrow { 156.0 } else { 290.0 });
    request = request.or(name_field(ui, sound, header, is_narrow, controls));
    let undo = controls.history.undo_name().map(|name| format!("Undo {name}"));
    let redo = controls.history.redo_name().map(|name| format!("Redo {name}"));
    let enabled = |name: &Option<String>| if name.is_some() { Look::Plain } else { Look::Disabled };
    let on = |is_on: bool| if is_on { Look::On } else { Look::Off };
    let shrunk = |wide: f32| if is_narrow { wide - 8.0 } else { wide };
    let [copies, copy_name] = match (header.versions_differ, header.is_b) {
        (true, false) => ["A → B", "Copy A to B"],
        (true, true) => ["B → A", "Copy B to A"],
        (false, false) => ["A = B", "Copy A to B"],
        (false, true) => ["A = B", "Copy B to A"],
    };
    let copy_help = match header.versions_differ {
        true => "The two versions differ: make the other one a copy of this one.",
        false => "The two versions are alike: there is nothing to copy.",
    };
    let buttons = [
        (
            "Browse",
            "Browse",
            shrunk(58.0),
            on(header.is_browsing),
            Request::Browse,
            "Find another sound, by family, words and favourites.",
        ),
        ("Save", "Save", shrunk(44.0), Look::Plain, Request::Save, "Save this sound under a name."),
        ("Undo", "Undo", shrunk(46.0), enabled(&undo), Request::Undo, "Take the last change back."),
        ("Redo", "Redo", shrunk(46.0), enabled(&redo), Request::Redo, "Make the change again that was taken back."),
        (
            if header.is_b { "B" } else { "A" },
            "A or B",
            26.0,
            on(header.is_b),
            Request::Swap,
            if header.versions_differ {
                "Two versions of the sound, which differ: go to the other one."
            } else {
                "Two versions of the sound, which are alike: go to the other one, and change it."
            },
        ),
        (copies, copy_name, shrunk(46.0), Look::Plain, Request::Copy, copy_help),
    ];
    for (text, name, width, look, wanted, help) in buttons {
        if wanted == Request::Swap && rect.width() >= LEAST_WIDTH_WITH_DICE {
            request = dice(ui, next(DICE), header, controls).or(request);
        }
        let response = button(ui, next(width), text, name, look, palette);
        if response.hovered() {
            let title = match wanted {
                Request::Undo => undo.clone(),
                Request::Redo => redo.clone(),
                _ => None,
            };
            *controls.hint = Hint::new(title.unwrap_or_else(|| name.to_owned()), help);
        }
        if response.clicked() && look != Look::Disabled {
            request = Some(wanted);
        }
    }
    // A host that refuses a larger window leaves little room at a large zoom: the way back stays within reach.
    let view = next(52.0);
    let view = view.translate(vec2((rect.right() - view.right()).min(0.0), 0.0));
    request = request.or(view_menu(ui, view, header, controls));
    let meter = Rect::from_min_max(pos2(left + GAP, rect.top()), rect.max);
    if meter.width() >= 40.0 {
        let meter = meter.with_min_x(meter.left().max(meter.right() - 150.0));
        meter::paint(ui.painter(), meter, header.levels, header.lowered, palette);
        let response = ui.interact(meter, Id::unique("meter"), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, "Level"));
        if response.hovered() {
            *controls.hint = Hint::new("Level", meter::figures(header.levels, header.lowered));
        }
    }
    request
}

/// The name of the sound between arrows to the previous and the next one.
fn name_field(ui: &Ui, rect: Rect, header: &Header, is_narrow: bool, controls: &mut Controls) -> Option<Request> {
    let palette = controls.palette;
    paint_panel(ui.painter(), rect, palette);
    let arrow = vec2(24.0, rect.height());
    let previous = Rect::from_min_size(rect.min, arrow);
    let following = Rect::from_min_size(rect.right_top() - vec2(arrow.x, 0.0), arrow);
    let inside =
        Rect::from_min_max(pos2(previous.right() + 4.0, rect.top()), pos2(following.left() - 4.0, rect.bottom()));
    let response = ui.interact(inside, Id::unique("sound"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Sound: {}", header.name)));
    let mut request = response.clicked().then_some(Request::Browse);
    let menu = Popup::context_menu(&response).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    menu.show(|ui| request = request.or(variation::menu(ui, header.locked).map(Request::Variation)));
    let put = Rect::from_min_max(pos2(inside.right() - PUT, rect.top() + 3.0), inside.max - vec2(0.0, 3.0));
    if let Some(pad) = header.pad {
        let response = button(ui, put, "Put back", "Put back", Look::Main, palette);
        if response.hovered() {
            *controls.hint = Hint::new("Put back", format!("Returns this sound to {pad}, and shows the kit."));
        }
        if response.clicked() {
            request = Some(Request::PutBack);
        }
    }
    for (place, text, name, by) in [(previous, "‹", "Previous", -1), (following, "›", "Next", 1)] {
        let step = button(ui, place, text, &format!("{name} sound"), Look::Plain, palette);
        if step.hovered() {
            *controls.hint = Hint::new(name, "Of those that Browse lists: of a family, with some words, or with tags.");
        }
        request = step.clicked().then_some(Request::Step(by)).or(request);
    }
    if response.hovered() {
        *controls.hint = Hint::new(header.name, format!("{}   right click: randomise, mutate, locks", header.words));
    }
    let name = format!("{}{}", header.name, if header.is_changed { " *" } else { "" });
    let mut room = if header.pad.is_some() { inside.with_max_x(put.left() - 4.0) } else { inside };
    if !is_narrow {
        let body = room.with_max_x(room.left() + BODY).shrink2(vec2(0.0, 4.0));
        face::paint_still(ui.painter(), body, header.figure, palette);
        room.min.x = body.right() + 6.0;
    }
    if !is_narrow && header.pad.is_none() {
        let at = room.with_min_x(room.right() - STAR);
        let star = star::show(ui, at, Id::unique("star"), "the loaded sound", header.is_favourite, palette);
        if star.hovered() {
            *controls.hint = Hint::new("Favourite", "Keeps this sound among your favourites.");
        }
        request = star.clicked().then_some(Request::Star).or(request);
        room.max.x = at.left() - 2.0;
    }
    let name = line(ui.painter(), room, Align2::LEFT_CENTER, &name, TEXT + 1.5, palette.text);
    if !is_narrow {
        let rest = room.with_min_x(name.right() + 12.0);
        line(ui.painter(), rest, Align2::RIGHT_CENTER, header.pad.unwrap_or(header.words), SMALL, palette.muted);
    }
    request
}

/// The dice: a click rolls another sound, a right click opens the menu of variations and locks.
fn dice(ui: &Ui, rect: Rect, header: &Header, controls: &mut Controls) -> Option<Request> {
    let palette = controls.palette;
    let response = button(ui, rect, "", "Roll the dice", Look::Plain, palette);
    let at = Rect::from_center_size(rect.center(), vec2(15.0, 15.0));
    let stroke = Stroke::new(1.2, palette.text);
    ui.painter().rect_stroke(at, 3.0, stroke, StrokeKind::Inside);
    for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [0.0, 0.0], [-1.0, 1.0], [1.0, 1.0]] {
        ui.painter().circle_filled(at.center() + 3.4 * vec2(x, y), 1.2, palette.text);
    }
    if response.hovered() {
        let help = "Takes each part from another sound, but for what is locked.   right click: mutate a little, locks";
        *controls.hint = Hint::new("Randomise", help);
    }
    let mut request = None;
    let menu = Popup::context_menu(&response).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    menu.show(|ui| request = variation::menu(ui, header.locked));
    let rolls = response.clicked().then_some(VariationRequest::Vary(Variation::Randomise));
    rolls.or(request).map(Request::Variation)
}

/// The menu of scales, as far as the smallest window at them fits on the screen, themes, motion, and pages about the window itself.
fn view_menu(ui: &Ui, rect: Rect, header: &Header, controls: &mut Controls) -> Option<Request> {
    let (view, is_alone) = (header.view, controls.host.plugin_api() == PluginApi::Standalone);
    let response = button(ui, rect, "≡", "Menu", Look::Plain, controls.palette);
    if response.hovered() {
        *controls.hint =
            Hint::new(format!("Menu   {} %", view.zoom), "Size and colours of the window, and the manual.");
    }
    let mut request = None;
    Popup::menu(&response).show(|ui| {
        ui.set_min_width(120.0);
        let fits = |zoom: &u32| extent::fitted(View { zoom: *zoom, ..view }, header.screen).zoom == *zoom;
        let zooms = ZOOMS.into_iter().filter(fits);
        let zooms = zooms.map(|zoom| (format!("{zoom} %"), zoom == view.zoom, Request::Zoom(zoom))).collect();
        let themes = Theme::ALL.map(|theme| (theme.name().to_owned(), theme == view.theme, Request::Theme(theme)));
        let pages =
            [("Manual", Request::Manual), ("Devices", Request::Devices)].into_iter().take(1 + usize::from(is_alone));
        let pages = pages.map(|(name, request)| (name.to_owned(), false, request)).collect();
        let motion = vec![("Less motion".to_owned(), view.less_motion, Request::LessMotion(!view.less_motion))];
        let groups: [Vec<(String, bool, Request)>; 4] = [zooms, themes.to_vec(), motion, pages];
        for (place, group) in groups.into_iter().enumerate() {
            if place > 0 {
                ui.separator();
            }
            for (name, is_now, wanted) in group {
                if ui.selectable_label(is_now, name).clicked() {
                    request = Some(wanted);
                    ui.close();
                }
            }
        }
    });
    request
}
