//! A terminal interface for playing: it shows the sounding masses, lists presets and parameters, and turns keys into notes.

mod app;
mod desk;
mod draw;
mod input;
mod keyboard;
mod layout;
mod lists;
mod masses;
mod saving;
#[cfg(test)]
mod tests;

use app::App;
use ratatui::crossterm::event::{
    self, DisableMouseCapture, EnableMouseCapture, Event, KeyboardEnhancementFlags, PopKeyboardEnhancementFlags,
};
use ratatui::crossterm::{event::PushKeyboardEnhancementFlags, execute, terminal};
use sprung::{Error, Result};
use std::io::stdout;
use std::time::{Duration, Instant};

pub(crate) use desk::{Desk, MakeKit};

/// Time between two frames of the screen. A computer key may wait this long for effects other than its note.
const FRAME: Duration = Duration::from_millis(33);

/// Shows the view until the user leaves it or `stop` returns true. `poll` is called regularly and returns messages to
/// show.
///
/// # Errors
/// [`Error::Io`] if the terminal cannot be used.
pub(crate) fn run(desk: Desk, mut stop: impl FnMut() -> bool, mut poll: impl FnMut() -> Vec<String>) -> Result<()> {
    let failed = |source| Error::io("terminal", source);
    let mut app = App::new(desk);
    let mut screen = ratatui::try_init().map_err(failed)?;
    let releases = terminal::supports_keyboard_enhancement().unwrap_or(false);
    if releases {
        let flags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES | KeyboardEnhancementFlags::REPORT_EVENT_TYPES;
        app.keyboard.releases = execute!(stdout(), PushKeyboardEnhancementFlags(flags)).is_ok();
    }
    // Without a mouse, everything can still be done by keys.
    let modes = Modes { releases, mouse: execute!(stdout(), EnableMouseCapture).is_ok() };
    let result = show(&mut app, &mut screen, &mut stop, &mut poll).map_err(failed);
    drop(modes);
    ratatui::restore();
    result
}

/// Terminal modes that were switched on. Dropping this switches them off again, also after a panic.
struct Modes {
    releases: bool,
    mouse: bool,
}

impl Drop for Modes {
    fn drop(&mut self) {
        if self.releases {
            let _ = execute!(stdout(), PopKeyboardEnhancementFlags);
        }
        if self.mouse {
            let _ = execute!(stdout(), DisableMouseCapture);
        }
    }
}

fn show(
    app: &mut App,
    screen: &mut ratatui::DefaultTerminal,
    stop: &mut impl FnMut() -> bool,
    poll: &mut impl FnMut() -> Vec<String>,
) -> std::io::Result<()> {
    let mut draw_at = Instant::now();
    while !app.quit && !stop() {
        let now = Instant::now();
        if now >= draw_at {
            draw_at = now + FRAME;
            poll().into_iter().for_each(|line| app.tell(line));
            app.tick(now);
            screen.draw(|frame| {
                app.fit(frame.area());
                draw::draw(app, frame);
            })?;
        }
        if event::poll(draw_at.saturating_duration_since(Instant::now()))? {
            match event::read()? {
                Event::Key(key) => app.key(key, Instant::now()),
                Event::Mouse(mouse) => app.mouse(mouse),
                _ => {}
            }
        }
    }
    Ok(())
}
