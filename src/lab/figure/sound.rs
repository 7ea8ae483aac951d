//! Draws the waveform of each method, and the time at which the limiter first acted.

use super::super::sound::Sound;
use super::stroke;
use crate::figure::envelope::envelope;
use crate::figure::panel::{Axis, Panel, Stroke, line};
use crate::figure::{Area, Drawn, Picture, colour, text};
use plotters::prelude::*;

/// The figure of some sounds.
pub struct SoundFigure<'a> {
    /// One strip for each sound.
    pub sounds: &'a [Sound],
    /// Sample rate in Hz.
    pub sample_rate: f64,
    /// Title of the figure, which describes the note.
    pub title: &'a str,
}

/// Number of pixel columns of a waveform.
const COLUMNS: usize = 1000;

impl Picture for SoundFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1200, 60 + 130 * self.sounds.len() as u32 + 40)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        area.draw_text(self.title, &text(20), (20, 12))?;
        let (_, body) = area.split_vertically(50);
        let strips = body.split_evenly((self.sounds.len().max(1), 1));
        for (n, (sound, strip)) in self.sounds.iter().zip(&strips).enumerate() {
            let seconds = sound.samples.len() as f64 / self.sample_rate;
            let held = sound.limited.map_or(String::new(), |t| {
                format!(": explodes, limited from {t:.3} s on (by {:.0} dB)", sound.reduction_db)
            });
            let title = format!("{}{held}", sound.method.title());
            let last = n + 1 == self.sounds.len();
            let x_label = if last { "time / s" } else { "" };
            let panel = Panel {
                x: Axis::linear(0.0..seconds, x_label),
                y: Axis::linear(-1.0..1.0, "amplitude"),
                title: &title,
            };
            let mut chart = panel.draw(strip)?;
            let colour = stroke(sound.method).colour;
            line(
                &mut chart,
                &envelope(&sound.samples, self.sample_rate, COLUMNS),
                Stroke { colour, width: 1, dashed: false },
            )?;
            if let Some(t) = sound.limited {
                line(&mut chart, &[(t, -1.0), (t, 1.0)], Stroke { colour: colour::INK, width: 2, dashed: true })?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::method::Method;
    use crate::lab::sound::listen;

    #[test]
    fn explosions_are_told_in_the_figure() {
        let sounds: Vec<Sound> = [Method::ExplicitEuler, Method::SynthExact]
            .into_iter()
            .map(|method| listen(method, 440.0, 1.0, 0.5, 48_000.0).unwrap())
            .collect();
        let figure = SoundFigure { sounds: &sounds, sample_rate: 48_000.0, title: "440 Hz" };
        let document = crate::figure::svg(&figure).unwrap();
        assert_eq!(document.matches("explodes, limited from").count(), 1);
    }
}
