//! Draws the masses on their springs.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use sprung::engine::Snapshot;
use sprung::units::db_from_gain;

/// Energy in dB at which a mass is drawn darkest.
const DARKEST: f64 = -60.0;

/// Draws a mass for each of the first modes: its amplitude to both sides, and its energy as brightness. Its present
/// position would mean nothing, since it swings many times between two frames of the screen.
pub(super) fn draw(snapshot: &Snapshot, modes: usize, frame: &mut Frame, area: Rect) {
    if area.is_empty() || modes == 0 {
        return;
    }
    let shown = modes.min(usize::from(area.width));
    let rest = f32::from(area.height - 1) / 2.0;
    let buffer = frame.buffer_mut();
    for (m, mass) in snapshot.masses.iter().enumerate().take(shown) {
        let x = area.x + ((2 * m + 1) * usize::from(area.width) / (2 * shown)) as u16;
        let amplitude = libm::sqrtf(mass.energy);
        let level = (db_from_gain(f64::from(amplitude)) / -DARKEST + 1.0).clamp(0.0, 1.0);
        // The cube root makes small swings visible.
        let swing = libm::cbrtf(amplitude.min(1.0)) * rest;
        let (top, bottom) = ((rest - swing).round() as u16, (rest + swing).round() as u16);
        let light = (70.0 + 185.0 * level) as u8;
        let colour = Color::Rgb(light, (light as f64 * (0.75 - 0.35 * level)) as u8, 70);
        for y in top..=bottom {
            let symbol = match (y == top || y == bottom, level > 0.0) {
                (true, true) => "●",
                (true, false) => "○",
                (false, _) => "│",
            };
            buffer[(x, area.y + y)].set_symbol(symbol).set_style(Style::new().fg(colour));
        }
    }
}
