//! Sprung for Python: what the package `sprung` calls.

mod batch;
mod failure;
mod patch;
mod recordings;
mod render;

use pyo3::prelude::*;

/// What `sprung/__init__.py` is made of.
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
