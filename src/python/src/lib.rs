//! The native module of the Python package `sprung`.

mod batch;
mod failure;
mod patch;
mod recordings;
mod render;

use pyo3::prelude::*;

/// The native functions and classes behind `sprung/__init__.py`.
#[pymodule]
mod _sprung {
    #[pymodule_export]
    use crate::batch::batch;
    #[pymodule_export]
    use crate::failure::{Error, Locked};
    #[pymodule_export]
    use crate::patch::{NativePatch, params, presets};
    #[pymodule_export]
    use crate::recordings::{analyze, diff, fit};
    #[pymodule_export]
    use crate::render::render;
}
