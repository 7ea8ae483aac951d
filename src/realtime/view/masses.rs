//! Draws the masses on their springs.

use crate::engine::Snapshot;
use crate::units::db_from_gain;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};

/// Energy in dB at which a mass is drawn darkest.
const DARKEST: f64 = -60.0;

/// Draws a mass for each of the first modes: its height shows the displacement, its brightness the energy.
pub(super) fn draw(snapshot: &Snapshot, modes: usize, frame: &mut Frame, area: Rect) {
    if area.is_empty() || modes == 0 {
        return;
    }
    let shown = modes.min(usize::from(area.width));
    let rest = f32::from(area.height - 1) / 2.0;
    let buffer = frame.buffer_mut();
    for (m, mass) in snapshot.masses.iter().enumerate().take(shown) {
        let x = area.x + ((2 * m + 1) * usize::from(area.width) / (2 * shown)) as u16;
        let level = (db_from_gain(f64::from(mass.energy).sqrt()) / -DARKEST + 1.0).clamp(0.0, 1.0);
        // The cube root makes small displacements visible.
        let height = libm::cbrtf(mass.displacement.clamp(-1.0, 1.0));
        let row = (rest - height * rest).round() as u16;
        let light = (70.0 + 185.0 * level) as u8;
        let spring = Style::new().fg(Color::Rgb(60, 60, 70));
        for y in 0..row {
            buffer[(x, area.y + y)].set_symbol(if y % 2 == 0 { "╲" } else { "╱" }).set_style(spring);
        }
        let symbol = if level > 0.0 { "●" } else { "○" };
        let colour = Color::Rgb(light, (light as f64 * (0.75 - 0.35 * level)) as u8, 70);
        buffer[(x, area.y + row)].set_symbol(symbol).set_style(Style::new().fg(colour));
    }
}
