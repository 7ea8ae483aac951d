//! The page that a window opens with: the body large, what moves it, what it is and stands on, and the few knobs that matter.

mod hands;
mod movers;
pub(super) mod stage;
mod things;

use crate::editor::body::offer::offer_pad;
use crate::editor::body::view::{BodyView, velocity};
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::motion::sources;
use crate::editor::pages::sections::ADDED;
use crate::editor::routes::Ring;
use crate::editor::routes::list::effects;
use crate::editor::theme::{CELL_HEIGHT, CELL_WIDTH, GAP, KNOB, PADDING, RADIUS, SMALL, TITLE_HEIGHT};
use crate::editor::widgets::text::line;
use crate::editor::widgets::{knob, outline};
use crate::link::Link;
use egui::{Align2, Rect, ScrollArea, Sense, Ui, UiBuilder, vec2};
use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::patch::routes::Source;
use sprung_picture::play::ESSENTIALS;

/// The smallest height of a page with titles and tiles: 330 for the tiles of bodies and materials, and the rest for knobs and gaps.
const TALL: f32 = 472.0;
/// Width of the columns beside the body, on a page that is tall and on one that is not.
const SIDES: [[f32; 2]; 2] = [[126.0, 170.0], [100.0, 130.0]];
/// Width of a knob's face on a page that is tall: half as wide again as elsewhere, since hands go there first.
const LARGE: f32 = 1.5 * KNOB;
/// Heights of the row with the spaces, and of the line about the body above it.
const FOOT: f32 = 22.0;
const CAPTION: f32 = 18.0;

/// What players move most, to be dragged to these knobs or, by way of a tab, to any.
const SOURCES: [Source; 6] =
    [Source::Velocity, Source::Pressure, Source::Wheel, Source::Lfo1, Source::Envelope1, Source::Random];

/// The title of the essential knobs, beside which these sources stand.
const ESSENTIAL: &str = "ESSENTIALS";

/// The state of the page.
#[derive(Default)]
pub(super) struct PlayPage {
    body: BodyView,
    things: things::Things,
    audition: Audition,
    /// Whether a note has sounded, so that nobody has to be told how to play one.
    was_played: bool,
}

impl PlayPage {
    /// Drops the user's action, and releases the held key.
    pub(super) fn leave(&mut self, controls: &mut Controls) {
        self.body.cancel(controls);
        self.release(controls.params.link());
    }

    /// Releases the held key.
    pub(super) fn release(&mut self, link: &Link) {
        self.audition.release(link);
    }

    /// Shows the page for the energies of the modes. Returns why a body could not be made, if it could not.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: &Shown,
        energies: &[f32],
        controls: &mut Controls,
    ) -> Option<String> {
        let is_tall = rect.height() >= TALL;
        let (title, side) = if is_tall { (TITLE_HEIGHT, LARGE) } else { (0.0, KNOB) };
        let stage = rect.with_max_y(rect.bottom() - cell_height(side) - title - 2.0 * PADDING - GAP);
        let (now, link) = (ui.input(|input| input.time), controls.params.link());
        self.audition.follow_time(now, link);
        self.was_played |= !controls.notes.is_empty();
        controls.palette.paint_panel(ui.painter(), stage);
        let [left, right] = SIDES[usize::from(!is_tall)];
        let inner = stage.shrink(PADDING);
        let foot = inner.with_min_y(inner.bottom() - FOOT);
        // Below the picture, not on it, stands what is written.
        let floor = stage.with_max_y(foot.top() - CAPTION);
        let middle = inner.with_min_x(inner.left() + left + GAP).with_max_x(inner.right() - right - GAP);
        stage::paint_floor(ui.painter(), floor, middle, controls);
        let caption = self.stand(ui, middle.with_max_y(floor.bottom()), shown, energies, controls);
        let under = middle.with_min_y(floor.bottom()).with_max_y(foot.top());
        line(ui.painter(), under, Align2::CENTER_CENTER, &caption, SMALL, controls.palette.muted);
        let mut message = None;
        if shown.preset().is_some() {
            let at = inner.with_max_x(inner.left() + left);
            let is_moved = movers::show(ui, at, is_tall, controls);
            let at = inner.with_min_x(inner.right() - right);
            let changed = self.things.show(ui, at, is_tall, shown, controls);
            if is_moved || changed.is_some() {
                self.audition.strike(shown.guide().home, VELOCITY, now, link);
            }
            message = changed.and_then(Result::err);
        } else {
            offer_pad(ui, inner.with_min_x(inner.right() - right), shown, controls);
        }
        let spaces = stage::show_spaces(ui, foot, controls);
        if shown.preset().is_some() {
            hands::show(ui, foot.with_min_x(spaces + GAP), &shown.patch().routes, controls);
        }
        self.audition.request_end(ui);
        knobs(ui, rect.with_min_y(stage.bottom() + GAP), [title, side], shown, controls);
        message
    }

    /// Shows the body, which can be struck. Returns what is said of it.
    fn stand(&mut self, ui: &Ui, middle: Rect, shown: &Shown, energies: &[f32], controls: &mut Controls) -> String {
        let palette = controls.palette;
        let rect = middle.shrink2(vec2(6.0, 4.0));
        // A body without places sounds wherever it is clicked. The place that can be dragged lies over this.
        let response = ui.interact(middle, egui::Id::unique("stage"), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Strike"));
        let is_struck = response.clicked();
        outline(ui, &response, middle, RADIUS, palette);
        let caption = self.body.show(ui, (rect, true), shown, energies, &mut self.audition, controls);
        if is_struck {
            let now = ui.input(|input| input.time);
            self.audition.strike(shown.guide().home, velocity(ui), now, controls.params.link());
        }
        match (shown.preset(), self.was_played) {
            (None, _) => "A kit: each key has a body of its own. A click strikes this one.".to_owned(),
            _ if !self.body.has_place(shown, controls) => format!("Strike it anywhere: {caption}."),
            (_, false) => "Click where it is to be struck.".to_owned(),
            (_, true) => caption,
        }
    }
}

/// Height of a cell whose knob's face is so wide.
fn cell_height(side: f32) -> f32 {
    CELL_HEIGHT - KNOB + side
}

/// Shows the macros that have names, the essential knobs and the gain, with a title so high and faces so wide.
fn knobs(ui: &mut Ui, rect: Rect, [title, side]: [f32; 2], shown: &Shown, controls: &mut Controls) {
    let palette = controls.palette;
    palette.paint_panel(ui.painter(), rect);
    // Each sound of a kit has others.
    let named = |info: &&'static ParamInfo| shown.preset().is_some() && shown.guide().macro_name(info.id).is_some();
    let macros: Vec<(&'static ParamInfo, String)> = PARAMS
        .iter()
        .filter(named)
        .map(|info| (info, shown.guide().macro_name(info.id).unwrap_or_default().to_owned()))
        .collect();
    let has_space = controls.value(Param::Space.info()) > 0.0;
    let matters = |param: &Param| has_space || !matches!(param, Param::SpaceMix | Param::SpaceSize);
    let essentials = ESSENTIALS.into_iter().filter(|(param, _)| matters(param));
    let essentials = essentials.map(|(param, name)| (param.info(), name.to_owned()));
    let gain = (Param::Gain.info(), "Gain".to_owned());
    // In a kit, apart from those that are the kit's own.
    let (added, essentials): (Vec<_>, Vec<_>) = essentials.partition(|(info, _)| controls.own(info).is_some());
    let (added, output) =
        if added.is_empty() { (added, vec![gain]) } else { ([added, vec![gain]].concat(), Vec::new()) };
    let groups = [("MACROS", macros), (ADDED, added), (ESSENTIAL, essentials), ("OUTPUT", output)];
    let count: usize = groups.iter().map(|(_, knobs)| knobs.len()).sum();
    let spaces = groups.iter().filter(|(_, knobs)| !knobs.is_empty()).count().saturating_sub(1) as f32;
    let inside = rect.shrink(PADDING);
    let room = inside.width() - spaces * 2.0 * GAP;
    let width = (room / count as f32).floor().clamp(CELL_WIDTH[0], CELL_WIDTH[1] + 12.0);
    // What is left over stands between the groups, so that the last ends at the right.
    let gap = (2.0 * GAP + (room - count as f32 * width).max(0.0) / spaces.max(1.0)).floor();
    let mut inner = ui.new_child(UiBuilder::new().id_salt("play knobs").max_rect(inside));
    ScrollArea::horizontal().id_salt("play").auto_shrink(false).show(&mut inner, |ui| {
        let size = vec2(count as f32 * width + spaces * gap, inside.height());
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        let mut corner = area.min;
        for (name, knobs) in groups.into_iter().filter(|(_, knobs)| !knobs.is_empty()) {
            if title > 0.0 {
                let place = Rect::from_min_size(corner, vec2(knobs.len() as f32 * width, title - 4.0));
                let named = line(ui.painter(), place, Align2::LEFT_CENTER, name, SMALL, palette.muted);
                if name == ESSENTIAL && shown.preset().is_some() {
                    let place = place.with_min_x(named.right() + 2.0 * GAP).with_max_x(place.right() + gap - GAP);
                    sources::show_line(ui, place, &SOURCES, shown, controls);
                }
            }
            for (info, name) in knobs {
                let cell = Rect::from_min_size(corner + vec2(0.0, title), vec2(width, cell_height(side) - 4.0));
                let ring = Ring::of(info, &shown.patch().routes, controls);
                knob::show(ui, (cell.shrink2(vec2(1.0, 0.0)), side), info, &name, &ring, controls);
                if ui.rect_contains_pointer(cell)
                    && let Some(effects) = effects(info, shown.patch(), controls)
                {
                    *controls.hint = Hint::new(format!("{name} {}", controls.text(info)), format!("It {effects}."));
                }
                corner.x += width;
            }
            corner.x += gap;
        }
    });
}
