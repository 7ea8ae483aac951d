//! The page that a window opens with: the body large, what moves it, what it is and stands on, and the few knobs that matter.

mod hands;
mod knobs;
mod movers;
pub(super) mod stage;
mod things;

use crate::editor::body::offer::offer_pad;
use crate::editor::body::view::{BodyView, velocity};
use crate::editor::controls::Controls;
use crate::editor::controls::shown::Shown;
use crate::editor::keyboard::audition::{Audition, VELOCITY};
use crate::editor::motion::sources;
use crate::editor::theme::{GAP, KNOB, PADDING, RADIUS, SMALL, TITLE_HEIGHT, paint_panel};
use crate::editor::widgets::outline;
use crate::editor::widgets::text::line;
use crate::link::Link;
use egui::{Align2, Rect, Sense, Ui, vec2};

/// The smallest height of a page with titles and tiles: 354 for those of bodies and materials with the button below them, 22 for the foot,
/// and the rest for knobs and gaps.
const TALL: f32 = 519.0;
/// Width of the columns beside the body, on a page that is tall and on one that is not.
const SIDES: [[f32; 2]; 2] = [[126.0, 170.0], [100.0, 130.0]];
/// Width of a knob's face on a page that is tall: half as wide again as elsewhere, since hands go there first.
const LARGE: f32 = 1.5 * KNOB;
/// Heights of the row with the spaces, and of the line about the body above it.
const FOOT: f32 = 22.0;
const CAPTION: f32 = 18.0;

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

    /// Shows the page for the energies of the modes, and the level of all that sounds from 0 to 1. Returns why a body could not be made,
    /// if it could not.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: &Shown,
        (energies, level): (&[f32], f32),
        controls: &mut Controls,
    ) -> Option<String> {
        let is_tall = rect.height() >= TALL;
        let (title, side) = if is_tall { (TITLE_HEIGHT, LARGE) } else { (0.0, KNOB) };
        let stage = rect.with_max_y(rect.bottom() - knobs::cell_height(side) - title - 2.0 * PADDING - GAP);
        let (now, link) = (ui.input(|input| input.time), controls.params.link());
        self.audition.follow_time(now, link);
        self.was_played |= !controls.notes.is_empty();
        paint_panel(ui.painter(), stage, controls.palette);
        let [left, right] = SIDES[usize::from(!is_tall)];
        let inner = stage.shrink(PADDING);
        let foot = inner.with_min_y(inner.bottom() - FOOT);
        // Below the picture, not on it, stands what is written.
        let floor = stage.with_max_y(foot.top() - CAPTION);
        let middle = inner.with_min_x(inner.left() + left + GAP).with_max_x(inner.right() - right - GAP);
        let ground = stage::floor(floor, middle, controls);
        stage::paint(&ground, ui.painter(), level, controls);
        let caption = self.stand(ui, middle.with_max_y(floor.bottom()), shown, energies, controls);
        let under = middle.with_min_y(floor.bottom()).with_max_y(foot.top());
        let routes = &shown.patch().routes;
        // In a small window sources stand in the place of what they do, which comes here once everybody knows how to play.
        if is_tall || shown.preset().is_none() || !self.was_played {
            line(ui.painter(), under, Align2::CENTER_CENTER, &caption, SMALL, controls.palette.muted);
        } else {
            hands::show(ui, under, Align2::CENTER_CENTER, routes, controls);
        }
        let touched = stage::touch(&ground, ui, self.body.bounds(), controls);
        if touched.is_dragged {
            self.audition.repeat(shown.guide().home, now, link);
        } else if touched.is_clicked {
            self.audition.strike(shown.guide().home, velocity(ui), now, link);
        }
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
        let (spaces, is_other) = stage::show_spaces(ui, foot, controls);
        if is_other {
            self.audition.strike(shown.guide().home, VELOCITY, now, link);
        }
        let beside = foot.with_min_x(spaces + GAP);
        match (shown.preset().is_some(), is_tall) {
            (false, _) => {}
            (true, true) => hands::show(ui, beside, Align2::RIGHT_CENTER, routes, controls),
            (true, false) => sources::show_line(ui, beside, &knobs::SOURCES, shown, controls),
        }
        self.audition.request_end(ui);
        knobs::show(ui, rect.with_min_y(stage.bottom() + GAP), [title, side], shown, controls);
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
