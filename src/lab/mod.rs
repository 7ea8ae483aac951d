//! The spring lab: compares methods that integrate a mass on a spring, in figures, numbers and sound.
//!
//! | module | holds |
//! |---|---|
//! | [`System`], `energy` | the mass, spring, damper and force; energy and Lagrangian |
//! | [`ClosedForm`], `reference` | the exact motion; a fine integration for springs without a closed form |
//! | [`Method`], `amplification` | the methods, one file each; the matrix of one step |
//! | [`trajectory`] | a method run over a period of time, and its error |
//! | [`comparison`], [`convergence`], [`stability`], [`pitch`], [`sound`] | measured behaviour: errors, orders, limits, tuning, audio |
//! | [`figure`], `animation`, `report` | figures, animations and an HTML page |
//!
//! All arithmetic is in `f64`; nothing here is real-time safe, and the instrument does not depend on it.
//!
//! ```
//! use sprung::lab::{Method, State, System, trajectory};
//!
//! let spring = System::linear(1.0, 50.0, 0.0)?;
//! let start = State { x: 0.5, v: 0.0 };
//! let run = trajectory::run(Method::ExplicitEuler, &spring, start, 0.01, 5.0)?;
//! assert!(run.worst_error > 1.0, "it explodes");
//! # Ok::<(), sprung::Error>(())
//! ```

pub(crate) mod amplification;
pub(crate) mod animation;
pub(crate) mod closed_form;
pub mod comparison;
pub mod convergence;
pub(crate) mod energy;
pub mod figure;
pub(crate) mod method;
pub mod pitch;
pub(crate) mod reference;
pub(crate) mod report;
pub mod sound;
pub mod stability;
pub(crate) mod system;
pub mod trajectory;

pub use closed_form::ClosedForm;
pub use method::{Method, Order};
pub use system::{Force, Spring, State, System};
