//! The dimensions of a body, from which its pitch follows.

/// The dimensions of a body. [`super::Model`] explains what each number means for each model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Length of a string, bar, tube, or of a plate's side; diameter of a round body. In metres.
    pub length: f64,
    /// Thickness of a bar, plate, head or wall; diameter of a string or of a bore. In metres.
    pub thickness: f64,
    /// Tension: of a string in N, of a head in N/m.
    pub tension: f64,
}

impl Size {
    /// A string of half a metre: the starting values in files and on knobs.
    pub(crate) const DEFAULT: Size = Size { length: 0.5, thickness: 1e-3, tension: 1000.0 };
}
