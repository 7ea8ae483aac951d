//! The lab: its motions beside SciPy's, and its pages in a browser.

mod browser;
mod reference;
mod report;
