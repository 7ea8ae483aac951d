//! Patches, and the lists of presets and parameters.

use crate::failure::{Error, raised, told};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprung::internals::files::Inputs;
use sprung::internals::library::{Catalogue, Library, Listed};
use sprung::internals::request::playable;
use sprung::internals::request::quantity::decimal;
use sprung::params::{PARAMS, Param, Unit};
use sprung::preset::{Playable, Preset};
use std::ffi::OsStr;
use std::sync::Arc;

/// A preset's values, modes and routes.
#[pyclass(name = "NativePatch")]
pub(crate) struct NativePatch(Preset);

fn param(id: &str) -> PyResult<Param> {
    Param::from_id(id).ok_or_else(|| {
        let near = sprung::internals::nearest(id, PARAMS.iter().map(|info| info.id));
        let near = near.map_or(String::new(), |near| format!("; the nearest is {near}"));
        PyAttributeError::new_err(format!("there is no parameter ‘{id}’{near}"))
    })
}

#[pymethods]
impl NativePatch {
    /// Loads the factory preset, the user's own preset, or the preset file of this name.
    #[new]
    fn new(name: &str) -> PyResult<Self> {
        match playable(OsStr::new(name), &mut Inputs::default()).map_err(raised)? {
            Playable::Preset(preset) => Ok(Self(preset)),
            Playable::Kit(kit) => Err(told(format!("‘{}’ is a kit: expected a preset", kit.name))),
        }
    }

    /// Reads a preset's text.
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        Preset::parse(text, "the text").map(Self).map_err(raised)
    }

    /// The preset's file as text.
    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// The name.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[setter]
    fn set_name(&mut self, name: String) -> PyResult<()> {
        if name.trim().is_empty() {
            return Err(Error::new_err("name: expected a text that is not empty"));
        }
        self.0.name = name;
        Ok(())
    }

    /// The comment.
    #[getter]
    fn comment(&self) -> &str {
        &self.0.comment
    }

    /// The value of a parameter in its unit; choices by their name.
    fn value<'py>(&self, py: Python<'py>, id: &str) -> PyResult<Bound<'py, PyAny>> {
        let param = param(id)?;
        let (info, value) = (param.info(), self.0.patch.get(param));
        match info.unit {
            Unit::Choice => Ok(info.format(value).into_pyobject(py)?.into_any()),
            _ => Ok(decimal(value).into_pyobject(py)?.into_any()),
        }
    }

    /// The value of a parameter with its unit.
    fn text(&self, id: &str) -> PyResult<String> {
        let param = param(id)?;
        Ok(param.info().format(self.0.patch.get(param)))
    }

    /// Sets a parameter from text, with or without a unit.
    fn set(&mut self, id: &str, value: &str) -> PyResult<()> {
        let param = param(id)?;
        let value = param.info().parse(value).map_err(|message| told(format!("{id}: {message}")))?;
        self.0.patch.set(param, value);
        Ok(())
    }

    /// The modes: ratio, level, decay, strike, pan.
    fn modes(&self) -> Vec<[f64; 5]> {
        let modes = self.0.patch.modes.as_slice().iter();
        modes.map(|mode| [mode.ratio, mode.level, mode.decay, mode.strike, mode.pan].map(f64::from)).collect()
    }
}

/// The presets and kits of the factory, and the user's own.
#[pyfunction]
pub(crate) fn presets(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let entry = |listed: &Arc<Listed>| {
        let entry = PyDict::new(py);
        entry.set_item("name", listed.name())?;
        entry.set_item("family", listed.family_name())?;
        entry.set_item("tags", listed.tags())?;
        entry.set_item("comment", listed.playable.comment())?;
        entry.set_item("details", listed.playable.details())?;
        Ok(entry)
    };
    Catalogue::read(Library::of_user().as_ref()).sounds.iter().map(entry).collect()
}

/// The table of parameters.
#[pyfunction]
pub(crate) fn params(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let entry = |info: &sprung::params::ParamInfo| {
        let entry = PyDict::new(py);
        entry.set_item("id", info.id)?;
        entry.set_item("name", info.name)?;
        entry.set_item("unit", info.unit.symbol())?;
        entry.set_item("min", decimal(info.min))?;
        entry.set_item("max", decimal(info.max))?;
        entry.set_item("default", decimal(info.default))?;
        entry.set_item("choices", info.choices)?;
        entry.set_item("help", info.help)?;
        Ok(entry)
    };
    PARAMS.iter().map(entry).collect()
}
