//! The animated PNG in README: two keys are struck on a bell, which rings down.

use super::pictures::{STEP, differing, facing, finish, rounded};
use super::sounding::Band;
use crate::editor::theme::{SIZE, Theme};
use crate::editor::window::Face;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder as _, RgbaImage};
use png::{BitDepth, BlendOp, ColorType, Compression, Encoder, Filter};
use std::fs::File;
use std::io::{BufReader, BufWriter};

const PLACE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/bell.png");
/// Frames of the animation, frames per second, and passes of the window per frame.
const FRAMES: usize = 28;
const PER_SECOND: usize = 10;
const PASSES: usize = 60 / PER_SECOND;
/// The frame at which the second key is struck.
const SECOND: usize = 10;
/// Largest size of the file.
const MOST_BYTES: u64 = 1_500_000;

/// Plays the scene; `draw` is given the number of each frame.
fn play(mut draw: impl FnMut(usize, &mut Band)) {
    let mut band = Band::of(facing(Face::Play, "Church Bell", SIZE, 1.0, Theme::Dark));
    band.passes(2);
    for frame in 0..FRAMES {
        match frame {
            1 => band.strike(&[60]),
            SECOND => band.strike(&[67]),
            _ => {}
        }
        band.passes(PASSES);
        draw(frame, &mut band);
    }
}

fn picture(band: &mut Band) -> RgbaImage {
    rounded(&band.stage.harness.render().unwrap(), STEP)
}

/// The changed part of a frame: its place, and its pixels; unchanged pixels are transparent.
fn change(before: &RgbaImage, now: &RgbaImage) -> ((u32, u32), RgbaImage) {
    let changed = |x: u32, y: u32| before.get_pixel(x, y) != now.get_pixel(x, y);
    let places: Vec<(u32, u32)> =
        now.enumerate_pixels().filter(|(x, y, _)| changed(*x, *y)).map(|(x, y, _)| (x, y)).collect();
    let (Some(left), Some(top)) = (places.iter().map(|at| at.0).min(), places.iter().map(|at| at.1).min()) else {
        return ((0, 0), RgbaImage::new(1, 1));
    };
    let (right, bottom) = places.iter().fold((left, top), |(x, y), at| (x.max(at.0), y.max(at.1)));
    let mut part = RgbaImage::new(right - left + 1, bottom - top + 1);
    for (x, y) in places {
        part.put_pixel(x - left, y - top, *now.get_pixel(x, y));
    }
    ((left, top), part)
}

/// Stores the scene.
fn store() {
    let file = BufWriter::new(File::create(PLACE).unwrap());
    let mut encoder = Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_animated(FRAMES as u32, 0).unwrap();
    encoder.set_frame_delay(1, PER_SECOND as u16).unwrap();
    let mut writer = encoder.write_header().unwrap();
    let mut before: Option<RgbaImage> = None;
    play(|_, band| {
        let now = picture(band);
        let ((x, y), part) = before.as_ref().map_or_else(|| ((0, 0), now.clone()), |before| change(before, &now));
        if before.is_some() {
            writer.set_blend_op(BlendOp::Over).unwrap();
            writer.reset_frame_position().unwrap();
            writer.set_frame_dimension(part.width(), part.height()).unwrap();
            writer.set_frame_position(x, y).unwrap();
        }
        writer.write_image_data(part.as_raw()).unwrap();
        before = Some(now);
    });
    writer.finish().unwrap();
}

#[test]
fn pictures_of_a_bell_that_rings_down_are_as_accepted() {
    if std::env::var_os("SPRUNG_BLESS_PICTURES").is_some() {
        store();
        println!("blessed {PLACE}");
        finish();
    }
    let size = std::fs::metadata(PLACE).unwrap().len();
    assert!(size <= MOST_BYTES, "{size} bytes");
    let decoder = PngDecoder::new(BufReader::new(File::open(PLACE).unwrap())).unwrap();
    let accepted = decoder.apng().unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(accepted.len(), FRAMES);
    // At rest, while one key and then both sound, and at the end.
    let compared = [0, SECOND - 1, SECOND + 1, FRAMES - 1];
    play(|frame, band| {
        if compared.contains(&frame) {
            let found = differing(&picture(band), accepted[frame].buffer(), STEP);
            assert_eq!(found, 0, "frame {frame}: `cargo xtask bless pictures` accepts the present pictures");
        }
    });
    let moves = accepted.windows(2).filter(|pair| differing(pair[0].buffer(), pair[1].buffer(), STEP) > 0).count();
    assert!(moves > FRAMES / 2, "{moves} frames move");
}
