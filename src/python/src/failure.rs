//! Errors and warnings, with the messages of the command.

use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use std::cell::Cell;
use std::ffi::CString;

thread_local! {
    /// What a signal's handler raised, on the thread that asked.
    static RAISED: Cell<Option<PyErr>> = const { Cell::new(None) };
}

create_exception!(sprung, Error, PyValueError, "What is wrong, where, and what would be right.");
create_exception!(sprung, Locked, Error, "Another process writes the file.");

/// The exception for an error. Interrupted work raises what interrupted it.
pub(crate) fn raised(error: sprung::Error) -> PyErr {
    match error {
        sprung::Error::Interrupted => RAISED.take().unwrap_or_else(|| PyKeyboardInterrupt::new_err("interrupted")),
        error @ sprung::Error::Locked { .. } => Locked::new_err(error.to_string()),
        error => Error::new_err(error.to_string()),
    }
}

/// As [`raised`], for a message.
pub(crate) fn told(message: String) -> PyErr {
    Error::new_err(message)
}

/// Raises Python's warnings.
pub(crate) fn warn(py: Python<'_>, warnings: &[String]) -> PyResult<()> {
    let category = py.get_type::<PyUserWarning>();
    for warning in warnings {
        // A text with a zero in it is none that C knows.
        let text = CString::new(warning.replace('\0', " ")).unwrap_or_default();
        PyErr::warn(py, &category, &text, 2)?;
    }
    Ok(())
}

/// Looks whether Ctrl-C was pressed, which Python notices only when it is asked.
pub(crate) fn check_signals() -> sprung::Result<()> {
    Python::attach(|py| py.check_signals()).map_err(|error| {
        RAISED.set(Some(error));
        sprung::Error::Interrupted
    })
}
