//! Draws the view, on small and large terminals.

use super::app::{App, Typing};
use super::keyboard::character;
use super::layout::{self, Layout, is_black};
use super::{lists, masses};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout as Split, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Paragraph};
use sprung::units::db_from_gain;

/// Lowest level of a meter in dB.
const LOWEST: f64 = -48.0;

/// Lines of at most 36 characters, so that they fit a terminal of 40 columns.
const HELP: &[&str] = &[
    "z s x … m      lower octave",
    "q 2 w … p      upper octave",
    "[ ]  - =       octave, velocity",
    ", .            MIDI channel",
    "Space          silence",
    "Tab            sounds or parameters",
    "↑ ↓ PgUp PgDn  choose",
    "Enter          load, or type a value",
    "← →            turn; Shift: finely",
    "Backspace      default",
    "/  Esc         search, all again",
    "W  Ctrl-S      save under a name",
    "Mouse          play, choose, drag",
    "ms             from a key to its sound",
    "xruns, late    of the device, of us",
    "Ctrl-C         end",
];

pub(super) fn draw(app: &App, frame: &mut Frame) {
    let Layout { head, masses: left, list, piano, foot } = app.layout;
    self::head(app, frame, head);
    let block = Block::bordered().title(" Masses ").border_style(Style::new().dark_gray());
    let inside = block.inner(left);
    frame.render_widget(block, left);
    let modes = app.playing().kit.sounds().iter().map(|sound| sound.patch().modes.as_slice().len()).max();
    masses::draw(&app.snapshot, modes.unwrap_or(0), frame, inside);
    lists::draw(app, frame, list);
    self::keys(app, frame, piano);
    self::foot(app, frame, foot);
    if app.help {
        help(frame, frame.area());
    }
}

fn head(app: &App, frame: &mut Frame, area: Rect) {
    let [first, second] = Split::vertical([Constraint::Length(1), Constraint::Length(1)]).areas(area);
    let xruns = app.status.xruns();
    let dry = Span::raw(format!("{xruns} xruns"));
    let title = Line::from(vec![
        Span::raw(" Sprung ").bold().reversed(),
        Span::raw(format!(" {} ", app.playing().name)).yellow().bold(),
        Span::raw(format!("ch {} ", app.channel + 1)),
        Span::raw(&app.device).dark_gray(),
    ]);
    frame.render_widget(title, first);
    let share = 100.0 * app.load.recent_share;
    let late = app.load.late_blocks;
    let mut numbers = Line::from(vec![
        Span::raw(format!("{:3} voices ", app.snapshot.voices)),
        Span::raw(format!("{:.0} ms ", 1000.0 * app.status.delay())),
        if share > 70.0 { Span::raw(format!("{share:3.0} % ")).red() } else { Span::raw(format!("{share:3.0} % ")) },
        if xruns > 0 { dry.red() } else { dry.dark_gray() },
    ]);
    if late > 0 {
        numbers.push_span(Span::raw(format!(" {late} late")).red());
    }
    let room = numbers.width() as u16;
    let columns = [Constraint::Fill(1), Constraint::Length(1), Constraint::Fill(1), Constraint::Length(room + 1)];
    let [left, _, right, rest] = Split::horizontal(columns).areas(second);
    meter("L", app.peaks[0], frame, left);
    meter("R", app.peaks[1], frame, right);
    frame.render_widget(numbers.right_aligned(), rest);
}

fn meter(name: &str, peak: f32, frame: &mut Frame, area: Rect) {
    let db = db_from_gain(f64::from(peak));
    let numbered = area.width >= 16;
    let width = f64::from(area.width.saturating_sub(if numbered { 8 } else { 2 }));
    let filled = ((db - LOWEST) / -LOWEST * width).clamp(0.0, width) as usize;
    let bar = Span::raw("█".repeat(filled));
    let bar = if db > 0.0 {
        bar.red()
    } else if db > -6.0 {
        bar.yellow()
    } else {
        bar.green()
    };
    let number = match numbered {
        true if db > -100.0 => format!(" {db:5.1}"),
        true => "    -∞".to_owned(),
        false => String::new(),
    };
    let rest = Span::raw("·".repeat(width as usize - filled)).dark_gray();
    frame.render_widget(Line::from(vec![Span::raw(format!("{name} ")), bar, rest, Span::raw(number)]), area);
}

fn keys(app: &App, frame: &mut Frame, area: Rect) {
    let lowest = app.keyboard.lowest();
    let down = app.status.telemetry().keys(app.channel);
    for (key, rect) in layout::keys(area, lowest) {
        let (fore, back) = match (down >> key & 1 == 1, is_black(key)) {
            (true, _) => (Color::Black, Color::Yellow),
            (false, true) => (Color::Gray, Color::Black),
            (false, false) => (Color::Black, Color::White),
        };
        let label = character(key - lowest).unwrap_or(' ');
        for y in rect.top()..rect.bottom() {
            let text = if y + 1 == rect.bottom() { format!("{label} ") } else { "  ".to_owned() };
            frame.buffer_mut().set_string(rect.x, y, text, Style::new().fg(fore).bg(back));
        }
    }
}

fn foot(app: &App, frame: &mut Frame, area: Rect) {
    let hint = match &app.typing {
        Typing::Nothing => {
            let name = sprung::units::note_name(app.keyboard.lowest());
            format!("z = {name}  velocity {}  ? help  Tab list  / search  Ctrl-C end", app.keyboard.velocity)
        }
        Typing::Search => "type to search, Enter to keep it, Esc to see all".to_owned(),
        Typing::Value(_) => "type a value with its unit, Enter to set it, Esc to leave it".to_owned(),
        Typing::Name(name) if app.replace.as_ref() == Some(name) => {
            format!("save as: {name}▏ exists: Enter writes over it, Esc leaves it")
        }
        Typing::Name(name) => format!("save as: {name}▏ {}", app.message().unwrap_or_default()),
    };
    let line = match app.message() {
        Some(message) if !matches!(app.typing, Typing::Name(_)) => Line::from(message.to_owned()).yellow(),
        _ => Line::from(hint).dark_gray(),
    };
    frame.render_widget(line, area);
}

/// Draws the help in one column; on wide and low screens in two.
fn help(frame: &mut Frame, area: Rect) {
    let rows =
        if usize::from(area.height) < HELP.len() + 2 && area.width >= 78 { HELP.len().div_ceil(2) } else { HELP.len() };
    let right = |row: usize| HELP.get(rows + row).copied().unwrap_or_default();
    let lines: Vec<Line> =
        HELP[..rows].iter().enumerate().map(|(row, left)| format!("{left:38}{}", right(row)).into()).collect();
    let width = if rows < HELP.len() { 78 } else { 40 };
    let (width, height) = (width.min(area.width), (rows as u16 + 2).min(area.height));
    let place = Rect::new((area.width - width) / 2, (area.height - height) / 2, width, height);
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(" Help: any key closes it ")), place);
}
