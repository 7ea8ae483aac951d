//! The window's colours, sizes and fonts, in one table.

pub(super) mod layout;
#[cfg(test)]
mod tests;

use egui::style::Selection;
use egui::{
    Color32, Context, CornerRadius, FontDefinitions, FontFamily, FontId, Painter, Rect, Stroke, StrokeKind, TextStyle,
    Visuals,
};
pub(super) use sprung_picture::Palette;

/// Paints the ground of a panel.
pub(super) fn paint_panel(painter: &Painter, rect: Rect, palette: &Palette) {
    painter.rect(rect, RADIUS, palette.panel, Stroke::new(1.0, palette.outline), StrokeKind::Inside);
}

/// A set of colours for the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Theme {
    #[default]
    Dark,
    Light,
    HighContrast,
}

impl Theme {
    pub(crate) const ALL: [Self; 3] = [Self::Dark, Self::Light, Self::HighContrast];

    /// The name in a saved state.
    pub(crate) fn id(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
            Self::HighContrast => "high-contrast",
        }
    }

    /// The name as shown to the user.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Dark => "Dark",
            Self::Light => "Light",
            Self::HighContrast => "High contrast",
        }
    }

    pub(super) fn palette(self) -> &'static Palette {
        match self {
            Self::Dark => &Palette::DARK,
            Self::Light => &Palette::LIGHT,
            Self::HighContrast => &Palette::CONTRAST,
        }
    }

    /// Sets the colours and texts of egui's own widgets: menus, text fields, scroll bars, tooltips.
    pub(super) fn apply(self, context: &Context) {
        let palette = self.palette();
        let mut visuals = if self == Self::Light { Visuals::light() } else { Visuals::dark() };
        // The ground is there already: the renderer clears with it, which costs less than to paint it.
        visuals.panel_fill = Color32::TRANSPARENT;
        visuals.window_fill = palette.panel;
        visuals.window_stroke = Stroke::new(1.0, palette.line);
        visuals.extreme_bg_color = palette.raised;
        visuals.text_edit_bg_color = Some(palette.raised);
        visuals.selection = Selection { bg_fill: palette.accent, stroke: Stroke::new(1.0, palette.on_accent) };
        visuals.weak_text_color = Some(palette.muted);
        visuals.window_corner_radius = CornerRadius::same(RADIUS);
        visuals.menu_corner_radius = CornerRadius::same(RADIUS);
        let states = &mut visuals.widgets;
        for state in [
            &mut states.noninteractive,
            &mut states.inactive,
            &mut states.hovered,
            &mut states.active,
            &mut states.open,
        ] {
            state.fg_stroke = Stroke::new(1.0, palette.text);
            state.bg_stroke = Stroke::new(1.0, palette.line);
            state.bg_fill = palette.raised;
            state.weak_bg_fill = palette.raised;
            state.corner_radius = CornerRadius::same(3);
            state.expansion = 0.0;
        }
        for state in [&mut visuals.widgets.hovered, &mut visuals.widgets.active] {
            state.bg_stroke = Stroke::new(1.0, palette.muted);
        }
        context.set_theme(if self == Self::Light { egui::Theme::Light } else { egui::Theme::Dark });
        context.all_styles_mut(|style| {
            style.visuals = visuals.clone();
            for text in [TextStyle::Body, TextStyle::Button, TextStyle::Small] {
                style.text_styles.insert(text, font(TEXT));
            }
            style.interaction.selectable_labels = false;
            // A wheel has one direction, and a page that can be scrolled has one.
            style.always_scroll_the_only_direction = true;
            style.interaction.tooltip_delay = 0.6;
            // A list that goes on says so before the pointer is over it.
            style.spacing.scroll.dormant_handle_opacity = style.spacing.scroll.active_handle_opacity;
        });
    }
}

/// Size of a new window at 100 %.
pub(crate) const SIZE: [u32; 2] = [1100, 700];
/// Smallest width and height, at 100 %, at which the window can be used.
pub(crate) const LEAST_SIZE: [u32; 2] = [640, 400];
/// Smallest and largest scale in per cent.
pub(crate) const ZOOM_RANGE: [u32; 2] = [75, 300];
/// Scales that the window offers, in per cent.
pub(super) const ZOOMS: [u32; 7] = [75, 100, 125, 150, 175, 200, 300];

/// Space between panels, and around them.
pub(super) const GAP: f32 = 8.0;
/// Space inside a panel.
pub(super) const PADDING: f32 = 8.0;
/// Radius of the corners of panels.
pub(super) const RADIUS: u8 = 5;
pub(super) const HEADER_HEIGHT: f32 = 30.0;
pub(super) const TITLE_HEIGHT: f32 = 20.0;
/// Height of the way of the sound without pictures: three parts, one below the other. With pictures it is a share of the page's height
/// between two ends.
pub(super) const PATH_HEIGHT: f32 = 58.0;
pub(super) const PICTURED_PATH: (f32, [f32; 2]) = (0.376, [184.0, 280.0]);
/// Height of the line of sources below what is shown of the sound's chosen part.
pub(super) const RAIL_HEIGHT: f32 = 22.0;
pub(super) const STATUS_HEIGHT: f32 = 18.0;
/// Diameter of a knob.
pub(super) const KNOB: f32 = 34.0;
/// Height of a knob with its name and value.
pub(super) const CELL_HEIGHT: f32 = 66.0;
/// Smallest and largest width of a knob's cell.
pub(super) const CELL_WIDTH: [f32; 2] = [47.0, 74.0];

/// Sizes of text.
pub(super) const TEXT: f32 = 12.5;
pub(super) const SMALL: f32 = 11.0;
pub(super) const BRAND: f32 = 19.0;

/// Adds the code font as a fallback for characters that the text font does not have: arrows, Greek, Cyrillic.
pub(super) fn install_fonts(context: &Context) {
    let mut fonts = FontDefinitions::default();
    if let Some(names) = fonts.families.get_mut(&FontFamily::Proportional) {
        names.push("Hack".to_owned());
    }
    context.set_fonts(fonts);
}

/// The font for text of this size.
pub(super) fn font(size: f32) -> FontId {
    FontId::new(size, FontFamily::Proportional)
}
