//! Draws the view: the layout of the screen, for small and large terminals.

use super::app::{App, Typing};
use super::keyboard::character;
use super::{lists, masses};
use crate::units::db_from_gain;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Paragraph};

/// Lowest level of a meter in dB.
const LOWEST: f64 = -48.0;

const HELP: &str = "\
z s x d c … m   lower octave     q 2 w 3 e … p   upper
[ ]  octave     - =  velocity    , .  MIDI channel
Tab  presets or parameters       ↑ ↓ PgUp PgDn  choose
Enter  load the preset, or type a value (250 ms)
← →  turn (Shift: finely)        Backspace  default
/  search       Esc  all again   Space  silence
Ctrl-C  end                      any key  close this";

pub(super) fn draw(app: &App, frame: &mut Frame) {
    let area = frame.area();
    let piano = if area.height >= 20 { 4 } else { 2 };
    let rows = [Constraint::Length(2), Constraint::Min(1), Constraint::Length(piano), Constraint::Length(1)];
    let [head, middle, keys, foot] = Layout::vertical(rows).areas(area);
    let list = (area.width * 2 / 5).clamp(20, 44);
    let [left, right] = Layout::horizontal([Constraint::Min(1), Constraint::Length(list)]).areas(middle);
    self::head(app, frame, head);
    let block = Block::bordered().title(" Masses ").border_style(Style::new().dark_gray());
    let inside = block.inner(left);
    frame.render_widget(block, left);
    let modes = app.playing().kit.sounds().iter().map(|sound| sound.patch().modes.as_slice().len()).max();
    masses::draw(&app.snapshot, modes.unwrap_or(0), frame, inside);
    lists::draw(app, frame, right);
    self::keys(app, frame, keys);
    self::foot(app, frame, foot);
    if app.help {
        help(frame, area);
    }
}

fn head(app: &App, frame: &mut Frame, area: Rect) {
    let [first, second] = Layout::vertical([Constraint::Length(1), Constraint::Length(1)]).areas(area);
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
    let numbers = Line::from(vec![
        Span::raw(format!("{:3} voices ", app.snapshot.voices)),
        if share > 70.0 { Span::raw(format!("{share:3.0} % ")).red() } else { Span::raw(format!("{share:3.0} % ")) },
        if xruns > 0 { dry.red() } else { dry.dark_gray() },
    ]);
    let room = numbers.width() as u16;
    let columns = [Constraint::Fill(1), Constraint::Length(1), Constraint::Fill(1), Constraint::Length(room + 1)];
    let [left, _, right, rest] = Layout::horizontal(columns).areas(second);
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

/// Draws piano keys from the lowest key of the computer's keyboard on, as many as there is room for.
fn keys(app: &App, frame: &mut Frame, area: Rect) {
    let lowest = app.keyboard.lowest();
    let down = app.status.telemetry().keys(app.channel);
    let black = |key: u8| matches!(key % 12, 1 | 3 | 6 | 8 | 10);
    let upper = area.height / 2;
    let mut x = area.x;
    let mut paint = |x: u16, y: u16, key: u8| {
        let pressed = down >> key & 1 == 1;
        let (fore, back) = match (pressed, black(key)) {
            (true, _) => (Color::Black, Color::Yellow),
            (false, true) => (Color::Gray, Color::Black),
            (false, false) => (Color::Black, Color::White),
        };
        let label = character(key - lowest).unwrap_or(' ');
        let lowest_row = if black(key) { upper } else { area.height };
        let text = if y + 1 == lowest_row { format!("{label} ") } else { "  ".to_owned() };
        if x + 2 <= area.right() {
            frame.buffer_mut().set_string(x, area.y + y, text, Style::new().fg(fore).bg(back));
        }
    };
    for key in (lowest..=(lowest + 28).min(127)).filter(|key| !black(*key)) {
        (0..area.height).for_each(|y| paint(x, y, key));
        x += 3;
    }
    x = area.x;
    for key in lowest..=(lowest + 28).min(127) {
        if black(key) {
            (0..upper).for_each(|y| paint(x.saturating_sub(2), y, key));
        } else {
            x += 3;
        }
    }
}

fn foot(app: &App, frame: &mut Frame, area: Rect) {
    let hint = match &app.typing {
        Typing::Nothing => {
            let name = crate::units::note_name(app.keyboard.lowest());
            format!("z = {name}  velocity {}  ? help  Tab list  / search  Ctrl-C end", app.keyboard.velocity)
        }
        Typing::Search => "type to search, Enter to keep it, Esc to see all".to_owned(),
        Typing::Value(_) => "type a value with its unit, Enter to set it, Esc to leave it".to_owned(),
    };
    let line = match app.message() {
        Some(message) => Line::from(message.to_owned()).yellow(),
        None => Line::from(hint).dark_gray(),
    };
    frame.render_widget(line, area);
}

fn help(frame: &mut Frame, area: Rect) {
    let text = Paragraph::new(HELP).block(Block::bordered().title(" Help "));
    let (width, height) = (58.min(area.width), 9.min(area.height));
    let place = Rect::new((area.width - width) / 2, (area.height - height) / 2, width, height);
    frame.render_widget(Clear, place);
    frame.render_widget(text, place);
}
