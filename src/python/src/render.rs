//! Renders notes and songs into arrays.

use crate::failure::{check_signals, raised, told, warn};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use sprung::internals::files::{Inputs, Output, Target, to_wav};
use sprung::internals::request::Request;
use sprung::io::{SampleFormat, sound_file};
use std::io::Seek;
use std::time::{Duration, Instant};

/// Time between two checks for Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(50);

/// A request with these options, each a name and a value as text.
pub(crate) fn request(options: &[(String, String)]) -> PyResult<Request> {
    let mut request = Request::default();
    for (name, value) in options {
        request.set(name, value).map_err(|message| told(format!("{name}: {message}")))?;
    }
    Ok(request)
}

/// Renders what the options describe. Returns an array of frames by channels, and the sample rate.
#[pyfunction]
pub(crate) fn render<'py>(
    py: Python<'py>,
    options: Vec<(String, String)>,
) -> PyResult<(Bound<'py, PyArray2<f32>>, u32)> {
    let mut request = request(&options)?;
    // Floats, as the engine computes them: an array needs no rounding.
    request.bits = SampleFormat::Float32;
    let mut warnings = Vec::new();
    let rendered = py.detach(|| rendered(&request, &mut |warning| warnings.push(warning.to_owned())));
    warn(py, &warnings)?;
    let sound = rendered.map_err(raised)?;
    let (frames, channels) = (sound.frames(), sound.channels.len());
    let samples = (0..frames).flat_map(|frame| sound.channels.iter().map(move |channel| channel[frame])).collect();
    let array = Array2::from_shape_vec((frames, channels), samples).map_err(|error| told(error.to_string()))?;
    Ok((array.into_pyarray(py), sound.sample_rate))
}

/// Renders through the same file format as the command, so that levels and mixing are equal to the bit.
fn rendered(request: &Request, warn: &mut dyn FnMut(&str)) -> sprung::Result<sound_file::Recording> {
    let folder = tempfile::tempdir().map_err(|source| sprung::Error::io("the temporary folder", source))?;
    let mut inputs = Inputs::default();
    let prepared = request.prepare(&mut inputs, warn)?;
    let target = Target::Path(folder.path().join("sound.wav"));
    let mut output = Output::create(&target, false, &inputs)?;
    let mut looked = Instant::now();
    to_wav(&prepared.job(), &prepared.delivery, &mut output, |_| {
        if looked.elapsed() < PATIENCE {
            return Ok(());
        }
        looked = Instant::now();
        check_signals()
    })?;
    let stream = output.stream();
    let file = stream.rewind().and_then(|()| stream.try_clone());
    let file = file.map_err(|source| sprung::Error::io("the temporary file", source))?;
    sound_file::read(file, "the rendered sound")
}
