//! Handles keys and the mouse.

use super::app::{App, List, Press, Typing};
use super::layout::key_at;
use ratatui::crossterm::event::{
    KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};
use ratatui::layout::Position;
use sprung::preset::Playable;
use std::time::Instant;

impl App {
    /// Handles a key of the computer's keyboard.
    pub(super) fn key(&mut self, event: KeyEvent, now: Instant) {
        if event.kind == KeyEventKind::Release {
            if let KeyCode::Char(character) = event.code {
                self.keyboard.release(character);
            }
            return;
        }
        if event.modifiers.contains(KeyModifiers::CONTROL) {
            match event.code {
                KeyCode::Char('c' | 'q') => self.quit = true,
                KeyCode::Char('s') if self.typing == Typing::Nothing => {
                    self.help = false;
                    self.type_name();
                }
                _ => {}
            }
            return;
        }
        if self.help {
            self.help = false;
        } else if self.typing == Typing::Nothing {
            self.command(event, now);
        } else {
            self.type_key(event.code);
        }
    }

    fn command(&mut self, event: KeyEvent, now: Instant) {
        let fine = event.modifiers.contains(KeyModifiers::SHIFT);
        match event.code {
            KeyCode::Char(character) if self.keyboard.press(character, self.channel, now) => {}
            KeyCode::Char('?') => self.help = true,
            KeyCode::Char('/') => {
                self.show_all();
                self.typing = Typing::Search;
            }
            KeyCode::Char('[') => self.keyboard.octave = (self.keyboard.octave - 1).max(0),
            KeyCode::Char(']') => self.keyboard.octave = (self.keyboard.octave + 1).min(8),
            KeyCode::Char('-') => self.keyboard.velocity = (self.keyboard.velocity - 8).max(1),
            KeyCode::Char('=' | '+') => self.keyboard.velocity = (self.keyboard.velocity + 8).min(127),
            KeyCode::Char('<' | ',') => self.channel = (self.channel + 15) % 16,
            KeyCode::Char('>' | '.') => self.channel = (self.channel + 1) % 16,
            KeyCode::Char(' ') => self.keyboard.panic(),
            KeyCode::Tab | KeyCode::BackTab => self.turn_list(),
            KeyCode::Char('W') => self.type_name(),
            KeyCode::Up => self.select(-1),
            KeyCode::Down => self.select(1),
            KeyCode::PageUp => self.select(-10),
            KeyCode::PageDown => self.select(10),
            KeyCode::Left => self.nudge(-1, fine),
            KeyCode::Right => self.nudge(1, fine),
            KeyCode::Enter => self.open(),
            KeyCode::Backspace => self.reset(),
            KeyCode::Esc => self.show_all(),
            _ => {}
        }
    }

    fn type_key(&mut self, code: KeyCode) {
        let is_search = self.typing == Typing::Search;
        let text = match &mut self.typing {
            Typing::Value(text) | Typing::Name(text) => text,
            _ => &mut self.search[self.list as usize],
        };
        match code {
            KeyCode::Char(character) => text.push(character),
            KeyCode::Backspace => drop(text.pop()),
            KeyCode::Up => self.select(-1),
            KeyCode::Down => self.select(1),
            KeyCode::Esc => {
                self.typing = Typing::Nothing;
                if is_search {
                    self.show_all();
                }
            }
            KeyCode::Enter => {
                self.typing = match std::mem::replace(&mut self.typing, Typing::Nothing) {
                    Typing::Value(text) => {
                        self.enter_value(&text);
                        Typing::Nothing
                    }
                    Typing::Name(text) => self.save(&text).map_or(Typing::Nothing, Typing::Name),
                    _ => Typing::Nothing,
                }
            }
            _ => {}
        }
        if is_search && matches!(code, KeyCode::Char(_) | KeyCode::Backspace) {
            self.select_best();
        }
    }

    /// Begins to type the name to save under. A factory sound's name gets “My” in front; a name given by the user
    /// stays.
    fn type_name(&mut self) {
        self.replace = None;
        let name = &self.playing().name;
        let is_taken = Playable::find(name).is_ok();
        self.typing = Typing::Name(if is_taken { format!("My {name}") } else { name.clone() });
    }

    /// Handles the mouse: keys of the piano play; a click selects a row, and a click on a selected row loads the sound
    /// or begins to type the value; dragging a parameter's row changes its value.
    pub(super) fn mouse(&mut self, event: MouseEvent) {
        let at = Position::new(event.column, event.row);
        let (rows, piano) = (self.layout.rows(), self.layout.piano);
        let key = key_at(piano, self.keyboard.lowest(), at);
        match event.kind {
            MouseEventKind::Down(MouseButton::Left) => {
                self.help = false;
                self.press = None;
                self.keyboard.point(self.channel, key);
                if self.layout.list.contains(at) {
                    // Text being typed belongs to the row that was selected; a search stays.
                    if self.typing != Typing::Search {
                        self.typing = Typing::Nothing;
                    }
                    match at.y.checked_sub(rows.y) {
                        Some(row) if rows.contains(at) => {
                            let again = self.point(row.into());
                            self.press = again.map(|again| Press { column: at.x, again, moved: false });
                        }
                        Some(_) => {}
                        None => self.turn_list(),
                    }
                }
            }
            MouseEventKind::Drag(MouseButton::Left) => match self.press {
                Some(Press { column, again, .. }) if column != at.x => {
                    self.nudge(i32::from(at.x) - i32::from(column), event.modifiers.contains(KeyModifiers::SHIFT));
                    self.press = Some(Press { column: at.x, again, moved: true });
                }
                Some(_) => {}
                None => self.keyboard.point(self.channel, key),
            },
            MouseEventKind::Up(MouseButton::Left) => {
                self.keyboard.point(self.channel, None);
                if let Some(Press { again: true, moved: false, .. }) = self.press.take() {
                    self.open();
                }
            }
            MouseEventKind::ScrollUp if self.layout.list.contains(at) => self.select(-3),
            MouseEventKind::ScrollDown if self.layout.list.contains(at) => self.select(3),
            _ => {}
        }
    }

    /// Loads the selected sound, or begins to type the selected parameter's value.
    fn open(&mut self) {
        match self.list {
            List::Sounds => self.load(),
            List::Parameters => self.typing = Typing::Value(String::new()),
        }
    }
}
