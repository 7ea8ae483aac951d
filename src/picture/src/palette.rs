//! The colours of window and page: gold is what is set and what sounds, blue is modulation, and nothing else has a hue.

use ecolor::Color32;

const fn grey(level: u8) -> Color32 {
    Color32::from_gray(level)
}

const fn rgb(red: u8, green: u8, blue: u8) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// The colours of a theme.
#[derive(Debug)]
pub struct Palette {
    /// Behind the panels.
    pub ground: Color32,
    /// A section or a view.
    pub panel: Color32,
    /// Buttons, fields, the face of a knob.
    pub raised: Color32,
    /// Grids and outlines.
    pub line: Color32,
    /// Outline of panels and buttons where the fill colour alone does not set them apart.
    pub outline: Color32,
    /// Names and other text of the first rank.
    pub text: Color32,
    /// Values, titles, and other text of the second rank.
    pub muted: Color32,
    /// The user's settings and present sound: arcs, energies, held keys.
    pub accent: Color32,
    /// The accent colour for text.
    pub accent_text: Color32,
    /// Text on `accent`.
    pub on_accent: Color32,
    /// Modulation.
    pub modulation: Color32,
    /// Levels up to full scale: of no hue, which is kept for what is set and what is modulated.
    pub level: Color32,
    /// Error messages, and levels above full scale.
    pub warning: Color32,
    /// A white key of a keyboard.
    pub white_key: Color32,
    /// A black one.
    pub black_key: Color32,
    /// Text on a white key.
    pub key_text: Color32,
}

impl Palette {
    /// Light on dark.
    pub const DARK: Self = Self {
        ground: rgb(19, 19, 24),
        panel: rgb(28, 28, 34),
        raised: rgb(41, 41, 49),
        line: rgb(58, 58, 68),
        outline: Color32::TRANSPARENT,
        text: rgb(236, 234, 228),
        muted: rgb(165, 163, 172),
        accent: rgb(227, 179, 65),
        accent_text: rgb(235, 192, 94),
        on_accent: rgb(24, 20, 8),
        modulation: rgb(102, 178, 245),
        level: rgb(216, 213, 204),
        warning: rgb(255, 146, 96),
        white_key: rgb(224, 223, 218),
        black_key: rgb(24, 24, 30),
        key_text: rgb(84, 84, 94),
    };

    /// Dark on light.
    pub const LIGHT: Self = Self {
        ground: rgb(228, 225, 218),
        panel: rgb(246, 244, 239),
        raised: rgb(228, 225, 217),
        line: rgb(195, 191, 180),
        outline: Color32::TRANSPARENT,
        text: rgb(28, 28, 34),
        muted: rgb(85, 84, 92),
        accent: rgb(163, 103, 0),
        accent_text: rgb(118, 72, 0),
        on_accent: grey(255),
        modulation: rgb(26, 108, 190),
        level: rgb(92, 90, 98),
        warning: rgb(166, 44, 8),
        white_key: rgb(253, 252, 250),
        black_key: rgb(52, 52, 60),
        key_text: rgb(96, 95, 104),
    };

    /// For eyes that need more contrast: black, white, and outlines.
    pub const CONTRAST: Self = Self {
        ground: grey(0),
        panel: grey(0),
        raised: grey(38),
        line: grey(138),
        outline: grey(138),
        text: grey(255),
        muted: grey(225),
        accent: rgb(255, 208, 0),
        accent_text: rgb(255, 208, 0),
        on_accent: grey(0),
        modulation: rgb(92, 214, 255),
        level: grey(255),
        warning: rgb(255, 156, 120),
        white_key: grey(255),
        black_key: grey(0),
        key_text: grey(40),
    };

    /// The edge of what is on the ground and empty, such as a meter in silence.
    pub fn empty_edge(&self) -> Color32 {
        self.ground.lerp_to_gamma(self.muted, 0.5)
    }
}
