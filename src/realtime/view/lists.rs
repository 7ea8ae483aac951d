//! Draws the list of presets and the list of parameters.

use super::app::{App, List, Typing};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, List as Rows, ListState};

/// Draws the list that is shown, with its search text in the title.
pub(super) fn draw(app: &App, frame: &mut Frame, area: Rect) {
    let title = match (app.list, &app.typing, app.search()) {
        (_, Typing::Search, search) => format!(" /{search}▏"),
        (List::Presets, _, "") => " Presets ".to_owned(),
        (List::Parameters, _, "") => " Parameters ".to_owned(),
        (_, _, search) => format!(" /{search} "),
    };
    let block = Block::bordered().title(title).border_style(Style::new().dark_gray());
    let width = usize::from(area.width.saturating_sub(2));
    let rows: Vec<Line> = match app.list {
        List::Presets => presets(app),
        List::Parameters => parameters(app, width),
    };
    let rows = Rows::new(rows).block(block).highlight_style(Style::new().add_modifier(Modifier::REVERSED));
    let mut state = ListState::default().with_selected(app.selected());
    frame.render_stateful_widget(rows, area, &mut state);
}

fn presets(app: &App) -> Vec<Line<'static>> {
    let row = |(number, preset): (usize, &'static crate::preset::Preset)| {
        let mark = if preset.name == app.playing().name { "▸" } else { " " };
        Line::from(vec![
            Span::raw(format!("{mark}{number:3} {}", preset.name)),
            Span::raw(format!("  {}", preset.tags.join(" "))).dark_gray(),
        ])
    };
    app.presets().into_iter().map(row).collect()
}

fn parameters(app: &App, width: usize) -> Vec<Line<'static>> {
    let row = |(index, info): (usize, &'static crate::params::ParamInfo)| {
        let current = app.playing().values.get(info.param);
        let value = match &app.typing {
            Typing::Value(text) if app.selected() == Some(index) => format!("{text}▏"),
            _ => info.format(current),
        };
        let room = width.saturating_sub(value.chars().count() + 1);
        let name: String = info.name.chars().take(room).collect();
        let value = Span::raw(value);
        let value = if current == info.default { value.dark_gray() } else { value.yellow() };
        Line::from(vec![Span::raw(format!("{name:room$} ")), value])
    };
    app.parameters().into_iter().enumerate().map(row).collect()
}
