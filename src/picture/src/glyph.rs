//! Little pictures of what moves a body, in a square from 0 to 1.

use sprung::params::Param;

/// A line through points of the square.
type Line = &'static [[f32; 2]];

/// A picture of lines and dots.
#[derive(Clone, Copy, Debug)]
pub struct Glyph {
    /// What acts, in a strong line.
    pub lines: &'static [Line],
    /// What belongs to it, in a thin line.
    pub thin: &'static [Line],
    /// What it acts on, in a thin line of less weight.
    pub touched: &'static [Line],
    /// Centres of dots, and their radius as a share of the square's side.
    pub dots: (&'static [[f32; 2]], f32),
}

impl Glyph {
    const NONE: Self = Self { lines: &[], thin: &[], touched: &[], dots: (&[], 0.0) };

    /// The picture of the exciter whose level this parameter is.
    pub fn of(level: Param) -> Self {
        match level {
            Param::MalletLevel => {
                Self { lines: &[&[[0.0, 1.0], [0.7, 0.3]]], dots: (&[[0.74, 0.26]], 0.2), ..Self::NONE }
            }
            Param::PluckLevel => Self {
                lines: &[&[[0.15, 0.1], [0.85, 0.1], [0.5, 0.75], [0.15, 0.1]]],
                touched: &[&[[0.0, 0.95], [1.0, 0.95]]],
                ..Self::NONE
            },
            Param::NoiseLevel => Self {
                dots: (
                    &[[0.1, 0.5], [0.25, 0.2], [0.35, 0.75], [0.5, 0.45], [0.62, 0.15], [0.7, 0.8], [0.9, 0.4]],
                    0.06,
                ),
                ..Self::NONE
            },
            Param::BowLevel => Self {
                lines: &[&[[0.0, 0.9], [0.2, 0.45], [0.6, 0.2], [1.0, 0.1]]],
                thin: &[&[[0.0, 0.9], [1.0, 0.1]]],
                ..Self::NONE
            },
            Param::BreathLevel => Self {
                lines: &[&[[1.0, 0.2], [0.35, 0.2], [0.0, 0.75], [1.0, 0.75]]],
                touched: &[&[[0.05, 0.9], [0.5, 0.9]]],
                ..Self::NONE
            },
            _ => Self {
                lines: &[&[
                    [0.0, 0.5],
                    [0.2, 0.5],
                    [0.3, 0.1],
                    [0.45, 0.9],
                    [0.6, 0.2],
                    [0.7, 0.6],
                    [0.8, 0.5],
                    [1.0, 0.5],
                ]],
                ..Self::NONE
            },
        }
    }
}
