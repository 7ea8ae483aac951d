//! The status line: the thing under the pointer, the last message, and the state of the engine.

use crate::editor::controls::{Hint, Said};
use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::text::{line, width};
use egui::{Align2, Id, Popup, PopupAnchor, Rect, Role, Sense, Tooltip, Ui, WidgetInfo, pos2};
use sprung::internals::display::Telemetry;
use sprung::internals::text::counted;
use std::time::Duration;

/// How often the load is computed, in seconds.
const INTERVAL: f64 = 0.5;
/// Seconds for which the pointer rests before a hint is shown at it, its distance from there, and its largest width.
const REST: f32 = 0.7;
const OFFSET: f32 = 14.0;
const WIDEST: f32 = 300.0;
/// Seconds for which it stays what was done.
const STAYS: f64 = 8.0;
/// Space between the title of a hint and its help.
const TITLE_GAP: f32 = 10.0;

/// The load of the audio thread over the last half second.
#[derive(Default)]
pub(super) struct Load {
    /// Time of the last computation, with the frames played and the seconds spent until then.
    last: Option<(f64, u64, f64)>,
    share: Option<f64>,
}

impl Load {
    /// The share of the time during which the audio thread is busy; none if it plays nothing, or has not been observed
    /// long enough.
    pub(super) fn share(&mut self, now: f64, telemetry: &Telemetry, sample_rate: u32) -> Option<f64> {
        if let Some((time, _, _)) = self.last
            && (time..time + INTERVAL).contains(&now)
        {
            return self.share;
        }
        let load = telemetry.load();
        let busy = load.mean_share * load.frames as f64;
        self.share = self.last.and_then(|(_, frames, before)| {
            let played = load.frames.checked_sub(frames).filter(|played| *played > 0 && sample_rate > 0)?;
            Some(((busy - before) / played as f64).max(0.0))
        });
        self.last = Some((now, load.frames, busy));
        self.share
    }
}

/// The state of the engine as text.
pub(super) fn engine(voices: u32, load: Option<f64>, sample_rate: u32) -> String {
    match sample_rate {
        0 => "audio is off".to_owned(),
        rate => {
            let load = load.map_or(String::new(), |load| format!("   {:.1} % CPU", load * 100.0));
            format!("{}{load}   {} kHz", counted(voices as usize, "voice"), f64::from(rate) / 1000.0)
        }
    }
}

/// A message if the last state that was loaded was not understood completely: the first complaint, and the number of
/// the others.
pub(super) fn summary(complaints: &[String]) -> Option<String> {
    let [first, rest @ ..] = complaints else { return None };
    let rest = if rest.is_empty() { String::new() } else { format!(" (and {} more)", rest.len()) };
    Some(format!("Not all of the project’s state was understood: {first}{rest}"))
}

/// The line. What was done stays for a while, what went wrong until the next message; a hint hides it while the pointer is over the widget, but only
/// once the pointer has moved: what a click or a key has led to must be seen where the pointer rests.
#[derive(Default)]
pub(super) struct StatusLine {
    message: Option<Said>,
    /// When the message was first shown since it was last said.
    since: Option<f64>,
    is_unread: bool,
}

impl StatusLine {
    /// The message has been said, perhaps again: its time begins anew.
    pub(super) fn restart(&mut self) {
        self.since = None;
    }

    /// Shows the line, with `rest` where there is nothing else to say. Returns whether the message has stayed long enough.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (hint, rest): (Option<&Hint>, &str),
        message: &Said,
        right: &str,
        palette: &Palette,
    ) -> bool {
        let now = ui.input(|input| input.time);
        let has_moved = ui.input(|input| input.pointer.delta() != egui::Vec2::ZERO || input.pointer.any_pressed());
        self.is_unread &= !has_moved;
        if self.message.as_ref() != Some(message) {
            (self.message, self.since) = (Some(message.clone()), None);
            self.is_unread = !text_of(message).is_empty();
        }
        let hint = hint.filter(|_| !self.is_unread);
        paint(ui, rect, (hint, rest), message, right, palette);
        if let Some(hint) = hint {
            show_tooltip(ui, hint);
        }
        let left = *self.since.get_or_insert(now) + STAYS - now;
        // What went wrong may last.
        let goes = message.as_ref().is_ok_and(|text| !text.is_empty());
        if goes && left > 0.0 {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(left));
        }
        goes && left <= 0.0
    }
}

/// Shows a hint at the pointer, where it is looked for, once that has rested without a click: it hides what is there.
fn show_tooltip(ui: &Ui, Hint { title, help }: &Hint) {
    let (rested, is_used, is_down) = ui.input(|input| {
        let pointer = &input.pointer;
        let rested = pointer.time_since_last_movement();
        let used = pointer.time_since_last_click().min(input.time_since_last_scroll());
        (rested, used <= rested, pointer.any_down())
    });
    // What was clicked or turned has shown what it does, and is not to be covered.
    if is_used {
        return;
    }
    if rested < REST {
        ui.ctx().request_repaint_after(Duration::from_secs_f32(REST - rested));
    } else if !is_down && !Popup::is_any_open(ui.ctx()) && !ui.ctx().egui_wants_keyboard_input() {
        // egui keeps the size of what it showed under an id: another hint would be broken to that width.
        let id = Id::unique(("hint", title.as_str()));
        let tip = Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id, PopupAnchor::Pointer).gap(OFFSET);
        tip.width(WIDEST).show(|ui| {
            ui.strong(title);
            if !help.is_empty() {
                ui.label(help);
            }
        });
    }
}

/// The words of a message.
fn text_of(message: &Said) -> &str {
    let (Ok(text) | Err(text)) = message;
    text
}

/// Paints the line.
fn paint(ui: &Ui, rect: Rect, (hint, rest): (Option<&Hint>, &str), said: &Said, right: &str, palette: &Palette) {
    let (painter, message) = (ui.painter(), text_of(said));
    let right_width = width(painter, right, SMALL);
    line(painter, rect, Align2::RIGHT_CENTER, right, SMALL, palette.muted);
    let left = rect.with_max_x(rect.right() - right_width - 16.0);
    if !message.is_empty() {
        // Screen readers read a message even if a hint hides it.
        let response = ui.interact(left, Id::unique("message"), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, message));
        if hint.is_none() && width(painter, message, SMALL) > left.width() {
            response.on_hover_text(message);
        }
    }
    match hint {
        Some(Hint { title, help }) => {
            let title = line(painter, left, Align2::LEFT_CENTER, title, SMALL, palette.text);
            let rest = Rect::from_min_max(pos2(title.right() + TITLE_GAP, left.top()), left.max);
            line(painter, rest, Align2::LEFT_CENTER, help, SMALL, palette.muted);
        }
        None if message.is_empty() => {
            line(painter, left, Align2::LEFT_CENTER, rest, SMALL, palette.muted);
        }
        None => {
            // The colour of warnings is for what went wrong.
            let colour = if said.is_ok() { palette.text } else { palette.warning };
            line(painter, left, Align2::LEFT_CENTER, message, SMALL, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::theme::Theme;
    use sprung::internals::display::TelemetryWriter;
    use std::sync::Arc;

    #[test]
    fn the_load_is_that_of_the_last_half_second() {
        let telemetry = Arc::new(Telemetry::default());
        let writer = TelemetryWriter::new(telemetry.clone(), 48_000.0);
        let mut load = Load::default();
        assert_eq!(load.share(0.0, &telemetry, 48_000), None);
        writer.note_block(480, Duration::from_millis(5));
        assert_eq!(load.share(0.4, &telemetry, 48_000), None, "not yet");
        let share = load.share(0.5, &telemetry, 48_000).unwrap();
        assert!((share - 0.5).abs() < 1e-6, "{share}");
        writer.note_block(480, Duration::from_millis(1));
        assert_eq!(load.share(0.9, &telemetry, 48_000), Some(share));
        assert!((load.share(1.0, &telemetry, 48_000).unwrap() - 0.1).abs() < 1e-6);
        assert_eq!(load.share(2.0, &telemetry, 48_000), None, "nothing was played");
    }

    #[test]
    fn only_what_went_wrong_has_the_colour_of_warnings() {
        let palette = Theme::Dark.palette();
        let context = egui::Context::default();
        for (said, colour) in [(Ok("saved"), palette.text), (Err("refused"), palette.warning)] {
            let said = said.map(str::to_owned).map_err(str::to_owned);
            let mut output = context
                .run_ui(egui::RawInput::default(), |ui| paint(ui, ui.max_rect(), (None, ""), &said, "", palette));
            let words = text_of(&said);
            let is_it = |shape: &egui::epaint::ClippedShape| matches!(&shape.shape, egui::Shape::Text(text) if text.galley.text() == words && text.fallback_color == colour);
            assert!(output.shapes.iter().any(is_it), "{words}");
            output.textures_delta.clear();
        }
    }

    #[test]
    fn what_was_done_goes_and_what_went_wrong_stays() {
        let (context, palette) = (egui::Context::default(), Theme::Dark.palette());
        let (done, wrong) = (Ok("saved".to_owned()), Err("refused".to_owned()));
        let mut line = StatusLine::default();
        let has_stayed = |line: &mut StatusLine, said: &Said, time: f64| {
            let mut stayed = false;
            let input = egui::RawInput { time: Some(time), ..Default::default() };
            let show = |ui: &mut Ui| stayed = line.show(ui, ui.max_rect(), (None, ""), said, "", palette);
            context.run_ui(input, show).textures_delta.clear();
            stayed
        };
        assert!(!has_stayed(&mut line, &done, 1.0) && !has_stayed(&mut line, &done, 8.9));
        line.restart();
        assert!(!has_stayed(&mut line, &done, 9.0) && !has_stayed(&mut line, &done, 16.9), "it was said again");
        assert!(has_stayed(&mut line, &done, 17.0));
        assert!(!has_stayed(&mut line, &wrong, 18.0) && !has_stayed(&mut line, &wrong, 100.0), "it may last");
        assert!(!has_stayed(&mut line, &Ok(String::new()), 101.0) && !has_stayed(&mut line, &Ok(String::new()), 200.0));
    }

    #[test]
    fn complaints_are_summed_up_in_a_line() {
        let lines = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(summary(&[]), None);
        assert_eq!(summary(&lines[..1]).as_deref(), Some("Not all of the project’s state was understood: a"));
        assert!(summary(&lines).unwrap().ends_with(": a (and 2 more)"));
    }
}
