//! What is drawn of a sounding body: its form, the shapes of its modes, and its surface in a light from the left above.
//!
//! The plugin's window paints it with egui, the page in a browser on a canvas.

mod bar;
mod drum;
mod figure;
mod form;
mod lathe;
mod light;
mod mesh;
mod nodal;
mod origin;
mod outline;
mod picture;
pub mod play;
mod second;
mod shape;
mod swing;
mod tube;
mod view;

pub use figure::{Drum, Figure};
pub use form::Form;
pub use light::tint;
pub use origin::{Origin, model_name, with_article};
pub use picture::{Ink, Picture, Pose};
pub use shape::{BodyShape, or_suggested, small_figure, suggested_body};
pub use swing::Swing;

/// How far from the body a click still touches it, in pixels.
pub const REACH: f32 = 26.0;
