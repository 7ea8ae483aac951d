//! The lab's figures.

mod comparison;
pub(crate) mod convergence;
pub(crate) mod pitch;
mod sound;
pub(crate) mod stability;

pub use comparison::ComparisonFigure;
pub use convergence::ConvergenceFigure;
pub use pitch::PitchFigure;
pub use sound::SoundFigure;
pub use stability::{Region, StabilityFigure};

use super::method::Method;
use crate::figure::panel::Stroke;
use crate::figure::{Area, Drawn, colour, text};
use plotters::prelude::*;

/// The stroke of a method, the same in every figure.
fn stroke(method: Method) -> Stroke {
    let index = Method::ALL.iter().position(|other| *other == method).unwrap_or(0);
    let (colour, dashed) = colour::series(index);
    Stroke { colour, width: 2, dashed }
}

/// Draws the strokes with their names, one below the other.
fn legend<B: DrawingBackend>(area: &Area<B>, entries: &[(Stroke, String)], (x, y): (i32, i32)) -> Drawn<B> {
    for (n, (stroke, label)) in entries.iter().enumerate() {
        let y = y + 24 * n as i32;
        let style = stroke.colour.stroke_width(stroke.width);
        let dashes = if stroke.dashed { vec![(0, 9), (14, 23), (28, 37)] } else { vec![(0, 37)] };
        for (from, to) in dashes {
            area.draw(&PathElement::new([(x + from, y), (x + to, y)], style))?;
        }
        area.draw_text(label, &text(14), (x + 46, y - 8))?;
    }
    Ok(())
}
