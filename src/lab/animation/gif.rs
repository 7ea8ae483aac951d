//! The animation as a GIF: each frame is drawn as a figure, and only its changed rectangle is stored.

use super::{Animation, Track, coils, share};
use crate::error::{Error, Result};
use crate::figure::colour::{GRID, INK, series};
use crate::figure::{Area, Drawn, Picture, text};
use crate::text::number::short;
use ::gif::{Encoder, Frame, Repeat};
use plotters::prelude::*;
use std::borrow::Cow;
use std::collections::HashMap;

const ROW: i32 = 64;
const HEAD: i32 = 30;
const WIDTH: u32 = 780;
const WALL: i32 = 196;
const TRACK: (f64, f64) = (236.0, 640.0);
const PLANE: (i32, i32) = (700, 56);
/// Number of shades from each colour to white, for smooth edges.
const SHADES: usize = 24;

/// One frame of the animation, as a figure.
struct Scene<'a> {
    animation: &'a Animation,
    frame: usize,
}

impl Picture for Scene<'_> {
    fn size(&self) -> (u32, u32) {
        (WIDTH, (HEAD + ROW * self.animation.tracks.len() as i32 + 4) as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        area.draw_text(&format!("steps of {} s", short(self.animation.h)), &text(13), (10, 8))?;
        area.draw_text("position over velocity", &text(13), (WIDTH as i32 - 180, 8))?;
        for (n, track) in self.animation.tracks.iter().enumerate() {
            self.row(area, track, HEAD + ROW * n as i32 + ROW / 2)?;
        }
        Ok(())
    }
}

impl Scene<'_> {
    fn row<B: DrawingBackend>(&self, area: &Area<B>, track: &Track, y: i32) -> Drawn<B> {
        let colour = track.series.map_or(INK, |n| series(n).0);
        area.draw_text(track.title, &text(13), (8, y - 7))?;
        area.draw(&PathElement::new([(WALL, y - 20), (WALL, y + 20)], INK.stroke_width(2)))?;
        let state = track.frames.get(self.frame).copied().unwrap_or_default();
        let (place, inside) = self.animation.place(state.x);
        let x = (TRACK.0 + place * (TRACK.1 - TRACK.0)).round() as i32;
        let spring: Vec<(i32, i32)> = coils(f64::from(x - 12 - WALL), 8.0)
            .iter()
            .map(|(along, side)| (WALL + along.round() as i32, y + *side as i32))
            .collect();
        area.draw(&PathElement::new(spring, RGBColor(138, 138, 148).stroke_width(1)))?;
        let shade = if inside { colour } else { faded(colour, 0.6) };
        area.draw(&Rectangle::new([(x - 12, y - 12), (x + 12, y + 12)], shade.filled()))?;

        let (left, size) = PLANE;
        let top = y - size / 2;
        area.draw(&Rectangle::new([(left, top), (left + size, top + size)], GRID.stroke_width(1)))?;
        let point = |x: f64, v: f64| {
            let ((right, a), (up, b)) = (share(v, &self.animation.v), share(x, &self.animation.x));
            let along = |share: f64| (share * f64::from(size)).round() as i32;
            ((left + along(right), top + size - along(up)), a && b)
        };
        let trail: Vec<(i32, i32)> =
            track.path.iter().map(|s| point(s.x, s.v)).take_while(|(_, inside)| *inside).map(|(p, _)| p).collect();
        area.draw(&PathElement::new(trail, faded(colour, 0.5).stroke_width(1)))?;
        let (dot, inside) = point(state.x, state.v);
        area.draw(&Circle::new(dot, 4, if inside { colour } else { faded(colour, 0.6) }.filled()))
    }
}

/// A colour mixed with white.
fn faded(RGBColor(r, g, b): RGBColor, white: f64) -> RGBColor {
    let mix = |channel: u8| (f64::from(channel) * (1.0 - white) + 255.0 * white).round() as u8;
    RGBColor(mix(r), mix(g), mix(b))
}

/// Makes the GIF file. It repeats forever.
pub fn gif(animation: &Animation) -> Result<Vec<u8>> {
    let failed = |error: ::gif::EncodingError| Error::format("animation", error.to_string());
    let (width, height) = Scene { animation, frame: 0 }.size();
    let mut palette = Palette::new();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width as u16, height as u16, &palette.bytes()).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let mut previous: Vec<u8> = Vec::new();
    let mut shown = 0_u64;
    for frame in 0..animation.len() {
        let pixels = palette.indexed(&crate::figure::rgb(&Scene { animation, frame })?);
        // Delays are whole hundredths of a second. Each frame ends at a rounded total time, so errors do not add up.
        let until = ((frame + 1) as f64 * 100.0 / animation.rate).round() as u64;
        let (left, top, w, h) = changed(&previous, &pixels, width as usize);
        let mut part = Vec::with_capacity(w * h);
        for y in top..top + h {
            part.extend_from_slice(&pixels[y * width as usize + left..][..w]);
        }
        encoder
            .write_frame(&Frame {
                // The format's maximum duration of a frame is 655.35 s.
                delay: u16::try_from(until - shown).unwrap_or(u16::MAX),
                left: left as u16,
                top: top as u16,
                width: w as u16,
                height: h as u16,
                buffer: Cow::Owned(part),
                ..Frame::default()
            })
            .map_err(failed)?;
        (previous, shown) = (pixels, until);
    }
    drop(encoder);
    Ok(bytes)
}

/// The smallest rectangle that contains all changed pixels, as left, top, width and height; at least one pixel.
fn changed(before: &[u8], after: &[u8], width: usize) -> (usize, usize, usize, usize) {
    if before.len() != after.len() {
        return (0, 0, width, after.len() / width);
    }
    let different = (0..after.len()).filter(|n| before[*n] != after[*n]);
    let (left, right, top, bottom) = different.fold((width, 0, usize::MAX, 0), |(left, right, top, bottom), n| {
        (left.min(n % width), right.max(n % width), top.min(n / width), bottom.max(n / width))
    });
    if left == width { (0, 0, 1, 1) } else { (left, top, right - left + 1, bottom - top + 1) }
}

/// Every colour of the figures, in shades down to white.
struct Palette {
    colours: Vec<[u8; 3]>,
    found: HashMap<[u8; 3], u8>,
}

impl Palette {
    fn new() -> Self {
        let mut colours = vec![[255, 255, 255]];
        for base in [INK, GRID, RGBColor(138, 138, 148)].into_iter().chain((0..6).map(|n| series(n).0)) {
            for shade in 0..SHADES {
                let RGBColor(r, g, b) = faded(base, shade as f64 / SHADES as f64);
                colours.push([r, g, b]);
            }
        }
        Self { colours, found: HashMap::new() }
    }

    fn bytes(&self) -> Vec<u8> {
        self.colours.concat()
    }

    /// The nearest colour of each pixel.
    fn indexed(&mut self, rgb: &[u8]) -> Vec<u8> {
        let distance = |a: &[u8; 3], b: &[u8; 3]| -> i32 {
            a.iter().zip(b).map(|(a, b)| (i32::from(*a) - i32::from(*b)).pow(2)).sum()
        };
        rgb.chunks_exact(3)
            .map(|pixel| {
                let pixel = [pixel[0], pixel[1], pixel[2]];
                *self.found.entry(pixel).or_insert_with(|| {
                    let nearest = self.colours.iter().enumerate().min_by_key(|(_, colour)| distance(colour, &pixel));
                    nearest.map_or(0, |(index, _)| index as u8)
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::comparison;
    use super::*;

    /// Number of frames, sum of their delays, and how many of them are narrower than the picture.
    fn read(animation: &Animation) -> (usize, u64, usize) {
        let bytes = gif(animation).unwrap();
        let mut options = ::gif::DecodeOptions::new();
        options.set_color_output(::gif::ColorOutput::Indexed);
        let mut reader = options.read_info(&bytes[..]).unwrap();
        let (mut frames, mut delay, mut partial) = (0, 0, 0);
        while let Some(frame) = reader.read_next_frame().unwrap() {
            frames += 1;
            delay += u64::from(frame.delay);
            partial += usize::from(u32::from(frame.width) < WIDTH);
        }
        (frames, delay, partial)
    }

    #[test]
    fn frames_can_be_read_back_and_last_as_long_as_the_motion() {
        let mut animation = Animation::new(&comparison(), 12.0).unwrap();
        assert_eq!(read(&animation), (12, 100, 11));
        animation.rate = 0.01;
        assert_eq!(read(&animation).1, 120_000, "twenty minutes");
    }

    #[test]
    fn only_what_changes_is_stored() {
        let mut after = vec![0; 40];
        assert_eq!(changed(&[], &after, 10), (0, 0, 10, 4));
        assert_eq!(changed(&after.clone(), &after, 10), (0, 0, 1, 1));
        after[13] = 1;
        after[28] = 1;
        assert_eq!(changed(&[0; 40], &after, 10), (3, 1, 6, 2));
    }

    #[test]
    fn the_palette_fits_and_holds_the_colours() {
        let mut palette = Palette::new();
        assert!(palette.colours.len() <= 256);
        let index = palette.indexed(&[0, 114, 178, 255, 255, 255]);
        assert_eq!(palette.colours[usize::from(index[0])], [0, 114, 178]);
        assert_eq!(index[1], 0);
    }
}
