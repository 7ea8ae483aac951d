//! The fonts of the window.

use egui::{Context, FontDefinitions, FontFamily};

/// Adds the code font as a fallback for characters that the text font does not have: arrows, Greek, Cyrillic.
pub(super) fn install(context: &Context) {
    let mut fonts = FontDefinitions::default();
    if let Some(names) = fonts.families.get_mut(&FontFamily::Proportional) {
        names.push("Hack".to_owned());
    }
    context.set_fonts(fonts);
}
