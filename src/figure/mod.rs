//! Figures as SVG text or PNG bytes from the same drawing code, with a font that is part of the crate, and HTML pages.

pub(crate) mod colour;
pub(crate) mod envelope;
pub(crate) mod page;
pub(crate) mod panel;

use crate::error::{Error, Result};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::sync::Once;

/// A part of a figure.
pub(crate) type Area<B> = DrawingArea<B, Shift>;
/// A result of drawing on backend `B`.
pub(crate) type Drawn<B> = std::result::Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Something that can be drawn.
pub trait Picture {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);
    /// Draws on a white area of that size.
    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B>;
}

/// Name under which the figures' font is registered. An SVG is shown in the reader's own font with this generic name.
const FONT: &str = "monospace";

/// Text style of `size` pixels.
pub(crate) fn text(size: i32) -> TextStyle<'static> {
    static READY: Once = Once::new();
    READY.call_once(|| {
        let registered = plotters::style::register_font(FONT, FontStyle::Normal, epaint_default_fonts::HACK_REGULAR);
        assert!(registered.is_ok(), "the embedded font is a font");
    });
    TextStyle::from((FONT, size).into_font()).color(&colour::INK)
}

/// The picture as an SVG document.
pub fn svg(picture: &impl Picture) -> Result<String> {
    let mut document = String::new();
    drawn(picture, &SVGBackend::with_string(&mut document, picture.size()).into_drawing_area())?;
    Ok(document)
}

/// The picture's pixels: rows of red, green, blue.
pub(crate) fn rgb(picture: &impl Picture) -> Result<Vec<u8>> {
    let (width, height) = picture.size();
    let mut pixels = vec![0; width as usize * height as usize * 3];
    drawn(picture, &BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area())?;
    Ok(pixels)
}

/// The picture as a PNG file.
pub fn png(picture: &impl Picture) -> Result<Vec<u8>> {
    let pixels = rgb(picture)?;
    let (width, height) = picture.size();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels));
    written.map_err(|error| Error::format("figure", error.to_string()))?;
    Ok(bytes)
}

fn drawn<B: DrawingBackend>(picture: &impl Picture, area: &Area<B>) -> Result<()> {
    let result = area.fill(&WHITE).and_then(|()| picture.draw(area)).and_then(|()| area.present());
    result.map_err(|error| Error::format("figure", error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Cross;

    impl Picture for Cross {
        fn size(&self) -> (u32, u32) {
            (60, 40)
        }
        fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
            area.draw_text("x", &text(30), (20, 5))
        }
    }

    #[test]
    fn one_drawing_serves_both_formats() {
        let document = svg(&Cross).unwrap();
        assert!(document.starts_with("<svg") && document.contains("monospace") && document.contains("</svg>"));
        let bytes = png(&Cross).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, rgb(&Cross).unwrap());
        let dark = pixels.chunks(3).filter(|pixel| pixel[1] < 100).count();
        assert!((20..600).contains(&dark), "a letter is drawn: {dark} dark pixels");
    }
}
