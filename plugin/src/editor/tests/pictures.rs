//! Pictures of the window, compared with those in `tests/pictures`.
//!
//! `SPRUNG_BLESS_PICTURES=1` accepts the present pictures. Such a run fails, so that nobody accepts by mistake.

use super::fake_host::FakeHost;
use super::renderer::Renderer;
use crate::editor::theme::layout::Layout;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::{Face, Past, Window};
use crate::params::SprungParams;
use crate::state::State;
use egui::{Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{Rgba, RgbaImage};
use sprung::internals::library::Library;
use sprung::preset::Playable;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest accepted difference in a channel of a pixel, before pictures are stored: CPUs round glyphs differently.
const TOLERANCE: u8 = 3;
/// Steps of the colours in stored pictures, which makes their files smaller.
pub(super) const STEP: u8 = 4;

/// A window in a fake host.
pub(super) struct Stage {
    pub(super) params: Arc<SprungParams>,
    pub(super) host: Arc<FakeHost>,
    pub(super) harness: Harness<'static>,
    /// The user's library.
    pub(super) folder: tempfile::TempDir,
    past: Past,
}

impl Stage {
    /// Closes the window, and opens one again.
    pub(super) fn reopened(self, meanwhile: impl FnOnce(&SprungParams)) -> Self {
        let Self { params, host, harness, folder, past } = self;
        drop(harness);
        meanwhile(&params);
        let harness = open(&params, &host, folder.path(), &past, None, (SIZE, 1.0));
        Self { params, host, harness, folder, past }
    }
}

/// A window with a factory sound that shows all of it.
pub(super) fn stage(sound: &str, size: [u32; 2], scale: f32, theme: Theme) -> Stage {
    facing(Face::Sound, sound, size, scale, theme)
}

/// A window with a factory sound.
pub(super) fn facing(face: Face, sound: &str, size: [u32; 2], scale: f32, theme: Theme) -> Stage {
    facing_on(SprungParams::default(), face, sound, (size, scale), theme)
}

/// The window of an instrument or effect with a factory sound.
pub(super) fn facing_on(
    params: SprungParams,
    face: Face,
    sound: &str,
    (size, scale): ([u32; 2], f32),
    theme: Theme,
) -> Stage {
    let (params, host) = (Arc::new(params), Arc::new(FakeHost::default()));
    let State { seed, mut view, .. } = State::default();
    view.theme = theme;
    params.load(params.suited(State::new(Playable::find(sound).unwrap(), seed, view)).into());
    let (folder, past) = (tempfile::tempdir().unwrap(), Past::default());
    let harness = open(&params, &host, folder.path(), &past, Some(face), (size, scale));
    Stage { params, host, harness, folder, past }
}

fn open(
    params: &Arc<SprungParams>,
    host: &Arc<FakeHost>,
    library: &Path,
    past: &Past,
    face: Option<Face>,
    (size, scale): ([u32; 2], f32),
) -> Harness<'static> {
    let mut window = Window::new(params.clone(), Some(Library::at(library)), past.clone());
    let context = host.context();
    window.open(context.clone());
    face.into_iter().for_each(|face| window.turn_to(face));
    let shown = params.clone();
    let mut harness = Harness::builder()
        .with_size(vec2(size[0] as f32, size[1] as f32))
        .with_pixels_per_point(scale)
        .with_step_dt(1.0 / 60.0)
        .renderer(Renderer::default())
        .build_ui(move |ui| {
            // What a real window is cleared with.
            let ground = shown.view().theme.palette().ground;
            ui.painter().rect_filled(ui.ctx().content_rect(), 0.0, ground);
            // Two things with one identity would be seen in a picture.
            ui.ctx().options_mut(|options| options.warn_on_id_clash = true);
            window.contents(ui, &context);
        });
    harness.run_steps(3);
    harness
}

/// Compares a picture with the accepted one, or accepts it.
#[track_caller]
pub(super) fn compare(name: &str, harness: &mut Harness) {
    harness.check_accessibility();
    let found = harness.render().unwrap();
    check(name, found);
}

/// Like [`compare`], for a picture that is stored exactly, since real windows are compared with it.
#[track_caller]
pub(super) fn compare_exactly(name: &str, harness: &mut Harness) {
    harness.check_accessibility();
    check_in_steps(name, harness.render().unwrap(), 1);
}

/// Like [`compare`], for the chosen part of the sound alone; other pictures show the rest.
#[track_caller]
pub(super) fn compare_part(name: &str, harness: &mut Harness) {
    harness.check_accessibility();
    check(name, part_of(&harness.render().unwrap(), 1.0));
}

/// The chosen part in a window's picture.
fn part_of(window: &RgbaImage, scale: f32) -> RgbaImage {
    let size = vec2(window.width() as f32, window.height() as f32) / scale;
    let ends = Layout::of(Rect::from_min_size(Pos2::ZERO, size)).part.y_range();
    let [top, bottom] = [ends.min, ends.max].map(|y| (y * scale) as u32);
    image::imageops::crop_imm(window, 0, top, window.width(), bottom - top).to_image()
}

/// Compares a picture at 200 %, stored at a fraction of its width and height: full-size pictures would take megabytes.
#[track_caller]
fn check_small(name: &str, part: u32, found: &RgbaImage) {
    check(name, image::imageops::thumbnail(found, found.width() / part, found.height() / part));
}

/// Like [`compare`], for a picture that is stored as in [`check_small`].
#[track_caller]
pub(super) fn compare_small(name: &str, part: u32, harness: &mut Harness) {
    harness.check_accessibility();
    check_small(name, part, &harness.render().unwrap());
}

#[track_caller]
fn check(name: &str, found: RgbaImage) {
    check_in_steps(name, found, STEP);
}

/// Compares a picture with the accepted one, which is stored with colours in such steps, or accepts it.
#[track_caller]
fn check_in_steps(name: &str, found: RgbaImage, step: u8) {
    let file = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pictures")).join(format!("{name}.png"));
    if std::env::var_os("SPRUNG_BLESS_PICTURES").is_some() {
        store(&rounded(&found, step), &file);
        println!("blessed {name}");
        return;
    }
    let accepted = image::open(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).into_rgba8();
    let differing = differing(&found, &accepted, step);
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../target/pictures");
    let actual = folder.join(format!("{name}.png"));
    // Not that of a former failure.
    let _ = std::fs::remove_file(&actual);
    if differing > 0 {
        std::fs::create_dir_all(&folder).unwrap();
        found.save(actual).unwrap();
        panic!(
            "{name}: {differing} pixels, see target/pictures; `cargo xtask bless pictures` accepts the present pictures"
        );
    }
}

/// A picture with its colours rounded to steps.
pub(super) fn rounded(picture: &RgbaImage, step: u8) -> RgbaImage {
    let mut picture = picture.clone();
    for Rgba([colours @ .., _]) in picture.pixels_mut() {
        colours.iter_mut().for_each(|level| *level = level.saturating_add(step / 2) / step * step);
    }
    picture
}

/// Stores a picture in a small file.
fn store(picture: &RgbaImage, file: &Path) {
    let rgb = image::DynamicImage::ImageRgba8(picture.clone()).into_rgb8();
    let to = BufWriter::new(File::create(file).unwrap());
    rgb.write_with_encoder(PngEncoder::new_with_quality(to, CompressionType::Best, FilterType::Adaptive)).unwrap();
}

/// The number of pixels in which pictures differ, of which one is stored in such steps.
pub(super) fn differing(one: &RgbaImage, other: &RgbaImage, step: u8) -> usize {
    let tolerance = TOLERANCE + step / 2;
    assert_eq!(one.dimensions(), other.dimensions());
    let differs = |(one, other): (&Rgba<u8>, &Rgba<u8>)| {
        one.0.iter().zip(other.0).any(|(one, other)| one.abs_diff(other) > tolerance)
    };
    one.pixels().zip(other.pixels()).filter(|pair| differs(*pair)).count()
}

/// Every page in a theme, at both sizes, and at 200 %.
fn pages(theme: Theme) {
    // One window for all pages: most of the time goes into its glyphs.
    for (size, scale, ending) in [(SIZE, 1.0, ""), (LEAST_SIZE, 1.0, "-least"), (SIZE, 2.0, "-twice")] {
        let mut harness = stage("Church Bell", size, scale, theme).harness;
        for (page, name) in crate::editor::pages::parts::names().into_iter().enumerate() {
            harness.get_by_role_and_label(egui::Role::Tab, name).click();
            harness.run_steps(3);
            let picture = format!("page-{page}-{}{ending}", theme.id());
            harness.check_accessibility();
            let found = part_of(&harness.render().unwrap(), scale);
            check_small(&picture, if scale == 1.0 { 1 } else { 4 }, &found);
        }
    }
    finish();
}

#[test]
fn pictures_of_every_dark_page_are_as_accepted() {
    pages(Theme::Dark);
}

#[test]
fn pictures_of_every_light_page_are_as_accepted() {
    pages(Theme::Light);
}

#[test]
fn pictures_of_every_page_of_high_contrast_are_as_accepted() {
    pages(Theme::HighContrast);
}

#[test]
fn pictures_of_parts_that_are_switched_on_are_as_accepted() {
    for (sound, lamps, name) in
        [("Church Bell", &["Tremolo", "Drive", "Space"][..], "parts-behind"), ("Clarinet", &["Bow"], "parts-before")]
    {
        let mut stage = stage(sound, SIZE, 1.0, Theme::Dark);
        for lamp in lamps {
            stage.harness.get_by_role_and_label(egui::Role::CheckBox, lamp).click();
            stage.harness.run_steps(3);
            stage.harness.get_by_role_and_label(egui::Role::Tab, lamp).click();
            stage.harness.run_steps(3);
        }
        compare_small(name, 2, &mut stage.harness);
    }
    finish();
}

#[test]
fn pictures_of_pages_at_other_sizes_and_in_other_colours_are_as_accepted() {
    for theme in [Theme::Light, Theme::HighContrast] {
        for (face, sound, page) in [
            (Face::Play, "Church Bell", "play"),
            (Face::Kit, "Acoustic Kit", "pads"),
            (Face::Motion, "Violin", "motion"),
        ] {
            let name = format!("{page}-{}-twice", theme.id());
            compare_small(&name, 6, &mut facing(face, sound, SIZE, 2.0, theme).harness);
        }
    }
    for theme in Theme::ALL {
        let name = format!("play-bell-{}-least", theme.id());
        compare_small(&name, 2, &mut facing(Face::Play, "Church Bell", LEAST_SIZE, 1.0, theme).harness);
    }
    finish();
}

#[test]
fn pictures_are_small() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pictures");
    let sizes = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().metadata().unwrap().len());
    let bytes: u64 = sizes.sum();
    assert!(bytes < 4_200_000, "{bytes} bytes");
}

#[test]
#[ignore = "takes half a minute"]
fn pictures_of_browser_and_manual_in_every_theme_are_as_accepted() {
    for theme in Theme::ALL {
        for (page, opens) in [("browser", "Browse"), ("manual", "Manual: bodies")] {
            let shown = |size, scale| {
                let mut stage = stage("Marimba", size, scale, theme);
                stage.harness.get_by_label(opens).click();
                stage.harness.run_steps(3);
                stage
            };
            let name = format!("{page}-{}", theme.id());
            compare_small(&format!("{name}-twice"), 6, &mut shown(SIZE, 2.0).harness);
            // The dark ones are compared under other names.
            if theme != Theme::Dark {
                compare(&name, &mut shown(SIZE, 1.0).harness);
                compare(&format!("{name}-least"), &mut shown(LEAST_SIZE, 1.0).harness);
            }
        }
    }
    finish();
}

#[test]
fn pictures_of_every_theme_and_scale_are_as_accepted() {
    for theme in Theme::ALL {
        let shown = |size, scale| stage("Marimba", size, scale, theme).harness;
        compare(theme.id(), &mut shown(SIZE, 1.0));
        compare_small(&format!("{}-twice", theme.id()), 4, &mut shown(SIZE, 2.0));
        compare(&format!("{}-least", theme.id()), &mut shown(LEAST_SIZE, 1.0));
    }
    finish();
}

/// Fails if pictures were accepted.
pub(super) fn finish() {
    assert!(std::env::var_os("SPRUNG_BLESS_PICTURES").is_none(), "pictures were accepted: run the tests again");
}
