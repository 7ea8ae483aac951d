//! Draws the list of presets and the list of parameters.

use super::app::{App, List, Typing};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, List as Rows, ListState};
use sprung::internals::library::Listed;
use sprung::internals::text::printable;
use std::sync::Arc;

/// Draws the list that is shown, with its search text in the title.
pub(super) fn draw(app: &App, frame: &mut Frame, area: Rect) {
    let title = match (app.list, &app.typing, app.search()) {
        (_, Typing::Search, search) => format!(" /{search}▏"),
        (List::Sounds, _, "") => " Sounds ".to_owned(),
        (List::Parameters, _, "") => " Parameters ".to_owned(),
        (_, _, search) => format!(" /{search} "),
    };
    let block = Block::bordered().title(title).border_style(Style::new().dark_gray());
    let width = usize::from(area.width.saturating_sub(2));
    let rows: Vec<Line> = match app.list {
        List::Sounds => sounds(app),
        List::Parameters => parameters(app, width),
    };
    let rows = Rows::new(rows).block(block).highlight_style(Style::new().add_modifier(Modifier::REVERSED));
    let mut state = ListState::default().with_offset(app.first()).with_selected(app.selected());
    frame.render_stateful_widget(rows, area, &mut state);
}

fn sounds(app: &App) -> Vec<Line<'static>> {
    let row = |listed: Arc<Listed>| {
        let name = printable(listed.name()).into_owned();
        let mark = if name == app.playing().name { "▸" } else { " " };
        let own = if listed.path.is_some() { "own " } else { "" };
        let tags = printable(&listed.tags().join(" ")).into_owned();
        Line::from(vec![Span::raw(format!("{mark} {name}")), Span::raw(format!("  {own}{tags}")).dark_gray()])
    };
    app.sounds().into_iter().map(row).collect()
}

fn parameters(app: &App, width: usize) -> Vec<Line<'static>> {
    let row = |(index, info): (usize, &'static sprung::params::ParamInfo)| {
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
