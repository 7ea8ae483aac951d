//! Errors and warnings, with the same messages as the command.

use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use std::cell::Cell;
use std::ffi::CString;

thread_local! {
    /// The exception of a signal handler, on the thread that checked for signals.
    static RAISED: Cell<Option<PyErr>> = const { Cell::new(None) };
}

create_exception!(sprung, Error, PyValueError, "What is wrong, where, and what would be right.");
create_exception!(sprung, Locked, Error, "Another process writes the file.");

/// The exception for an error. For interrupted work, it is the exception that interrupted it.
pub(crate) fn raised(error: sprung::Error) -> PyErr {
    match error {
        sprung::Error::Interrupted => RAISED.take().unwrap_or_else(|| PyKeyboardInterrupt::new_err("interrupted")),
        error @ sprung::Error::Locked { .. } => Locked::new_err(error.to_string()),
        error => Error::new_err(error.to_string()),
    }
}

/// The exception for a message.
pub(crate) fn told(message: String) -> PyErr {
    Error::new_err(message)
}

/// Raises Python's warnings.
pub(crate) fn warn(py: Python<'_>, warnings: &[String]) -> PyResult<()> {
    let category = py.get_type::<PyUserWarning>();
    for warning in warnings {
        // A C string cannot contain a zero.
        let text = CString::new(warning.replace('\0', " ")).unwrap_or_default();
        PyErr::warn(py, &category, &text, 2)?;
    }
    Ok(())
}

/// Checks for Ctrl-C: Python runs its signal handlers only when asked to.
pub(crate) fn check_signals() -> sprung::Result<()> {
    Python::attach(|py| py.check_signals()).map_err(|error| {
        RAISED.set(Some(error));
        sprung::Error::Interrupted
    })
}
