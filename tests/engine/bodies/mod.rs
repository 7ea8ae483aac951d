//! Bodies and their modes as computed by SciPy: the numbers in `scipy_reference.csv`.

use sprung::internals::editor::FIELDS;
use sprung::sound::bodies::{Body, Model};

pub(crate) const NUMBERS: &str = include_str!("scipy_reference.csv");

/// One line: a mode of a body with these values.
pub(crate) struct Line {
    pub(crate) model: String,
    pub(crate) set: String,
    pub(crate) place: usize,
    pub(crate) ratio: f64,
    pub(crate) product: f64,
    pub(crate) t60: f64,
    pub(crate) tolerance: f64,
}

fn read(line: &str) -> Line {
    let cells: Vec<&str> = line.split(',').collect();
    let [model, set, place, ratio, product, t60, tolerance] = cells[..] else { panic!("{line}: 7 cells") };
    let number = |cell: &str| cell.parse().expect("a number");
    Line {
        model: model.to_owned(),
        set: set.to_owned(),
        place: place.parse().expect("a place"),
        ratio: number(ratio),
        product: number(product),
        t60: number(t60),
        tolerance: number(tolerance),
    }
}

/// All lines; the lines of one body are adjacent.
pub(crate) fn lines() -> Vec<Line> {
    NUMBERS.lines().filter(|line| !line.starts_with('#')).skip(1).map(read).collect()
}

/// The lines of each body.
pub(crate) fn groups(lines: &[Line]) -> impl Iterator<Item = &[Line]> {
    lines.chunk_by(|a, b| (&a.model, &a.set) == (&b.model, &b.set))
}

pub(crate) fn body(model: &str, set: &str) -> Body {
    let mut body = Body::new(Model::find(model).expect("a model").clone());
    for (name, value) in set.split(';').filter_map(|pair| pair.split_once('=')) {
        let field = FIELDS.iter().find(|field| field.name == name).expect("a field");
        (field.set)(&mut body, value.parse().expect("a number"));
    }
    body
}
