//! The real window's pixels, drawn by OpenGL, compared with an accepted picture that was drawn without OpenGL.

use crate::host::Instance;
use crate::patches::enclosed;
use crate::process::scratch;
use crate::window::{Editor, Parent, on_a_screen};
use image::RgbImage;
use sprung::preset::Preset;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How far a channel of a pixel may be from the accepted picture, which is stored exactly: OpenGL rounds differently.
const TOLERANCE: u8 = 3;

/// How many pixels may differ by more: pixels on the edges of shapes, where a sample may lie just inside or just outside.
const HANDFUL: usize = 24;

/// Size of the corner by which the window is resized: the wrapper draws it, and the picture does not have it.
const CORNER: u32 = 20;

pub(crate) fn the_real_window_has_the_pixels_of_the_accepted_picture() {
    print!("{}", on_a_screen("window-pixels"));
}

/// Runs in the process that the test starts.
pub(crate) fn work() -> ExitCode {
    let accepted = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures/play-dark.png");
    let accepted = image::open(&accepted).unwrap_or_else(|error| panic!("{}: {error}", accepted.display())).into_rgb8();
    let (width, height) = accepted.dimensions();
    let parent = Parent::new();
    // Nothing may be under the pointer.
    parent.onlooker.point([1_279, 799]);
    let mut instance = Instance::new();
    let preset = Preset::find("Church Bell").unwrap().to_toml();
    let own = serde_json::json!({ "format": 1, "preset": preset, "seed": 0, "window": [width, height] });
    assert!(instance.load(&enclosed(&own.to_string())));
    let editor = Editor::open(&mut instance, &parent);
    let start = Instant::now();
    let (mut found, mut differing) = (accepted.clone(), vec![]);
    while start.elapsed() < Duration::from_secs(30) {
        instance.run_callbacks();
        found = picture(&parent, width, height);
        differing = difference(&found, &accepted);
        if differing.len() <= HANDFUL {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    editor.close(&mut instance);
    let file = scratch("window.png");
    found.save(&file).unwrap();
    let most = differing.iter().map(|[_, _, by]| by).max().unwrap_or(&0);
    let report = format!("{} of {} pixels differ, by {most} at most", differing.len(), width * height);
    let first: Vec<_> = differing.iter().take(40).collect();
    assert!(differing.len() <= HANDFUL, "{report}: see {}; the first: {first:?}", file.display());
    println!("by more than {TOLERANCE}: {report}; {differing:?}");
    println!("how far they are from the picture, and how many: {:?}", counts(&found, &accepted));
    ExitCode::SUCCESS
}

fn picture(parent: &Parent, width: u32, height: u32) -> RgbImage {
    let pixels = parent.onlooker.pixels(width, height).into_iter().flat_map(|[blue, green, red]| [red, green, blue]);
    RgbImage::from_raw(width, height, pixels.collect()).expect("as many pixels as were asked for")
}

/// How many pixels differ by how much.
fn counts(one: &RgbImage, other: &RgbImage) -> BTreeMap<u8, u32> {
    let mut counts = BTreeMap::new();
    for (one, other) in one.pixels().zip(other.pixels()) {
        let by = one.0.iter().zip(other.0).map(|(one, other)| one.abs_diff(other)).max();
        *counts.entry(by.unwrap_or(0)).or_default() += 1;
    }
    counts
}

/// The pixels that differ by more than the tolerance: column, row and by how much.
fn difference(one: &RgbImage, other: &RgbImage) -> Vec<[u32; 3]> {
    let (width, height) = one.dimensions();
    let pairs = one.enumerate_pixels().zip(other.pixels());
    let by = pairs.map(|((x, y, one), other)| {
        let by = one.0.iter().zip(other.0).map(|(one, other)| one.abs_diff(other)).max();
        [x, y, by.unwrap_or(0).into()]
    });
    let is_corner = |x: u32, y: u32| x + CORNER >= width && y + CORNER >= height;
    by.filter(|[x, y, by]| *by > u32::from(TOLERANCE) && !is_corner(*x, *y)).collect()
}
