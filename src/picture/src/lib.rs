//! What is drawn of a sounding body, what moves it and what it stands on, and in which colours.
//!
//! The plugin's window paints it with egui, the page in a browser on a canvas.

mod bar;
mod drum;
mod figure;
mod floor;
mod form;
mod glyph;
mod lathe;
mod light;
mod mesh;
mod nodal;
mod origin;
mod outline;
mod palette;
mod picture;
pub mod play;
mod second;
mod shape;
mod swing;
mod tube;
mod view;

pub use figure::{Drum, Figure};
pub use floor::Floor;
pub use form::Form;
pub use glyph::Glyph;
pub use light::tint;
pub use origin::{Origin, model_name, with_article};
pub use palette::Palette;
pub use picture::{Ink, Picture, Pose};
pub use shape::{BodyShape, or_suggested, small_figure, suggested_body};
pub use swing::Swing;

/// How far from the body a click still touches it, in pixels.
pub const REACH: f32 = 26.0;
