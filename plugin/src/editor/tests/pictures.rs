//! Pictures of the window, compared with those in `tests/pictures`.
//!
//! `SPRUNG_BLESS_PICTURES=1` accepts the present ones. A run that accepts fails, so that nobody accepts by mistake.

use super::fake_host::FakeHost;
use super::renderer::Renderer;
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use crate::editor::window::Window;
use crate::params::SprungParams;
use crate::state::State;
use egui::vec2;
use egui_kittest::Harness;
use image::RgbaImage;
use sprung::preset::Playable;
use sprung::preset::library::Library;
use std::path::PathBuf;
use std::sync::Arc;

/// How far a channel of a pixel may be from the accepted picture, since CPUs round glyphs differently.
const TOLERANCE: u8 = 3;

/// A window in a fake host.
pub(super) struct Stage {
    pub(super) params: Arc<SprungParams>,
    pub(super) host: Arc<FakeHost>,
    pub(super) harness: Harness<'static>,
    /// The user's library.
    pub(super) folder: tempfile::TempDir,
}

/// A window with a factory sound.
pub(super) fn stage(sound: &str, size: [u32; 2], scale: f32, theme: Theme) -> Stage {
    let (params, host) = (Arc::new(SprungParams::default()), Arc::new(FakeHost::default()));
    let State { seed, mut view, .. } = State::default();
    view.theme = theme;
    params.load(State::new(Playable::find(sound).unwrap(), seed, view).into());
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::new(params.clone(), Some(Library::at(folder.path())));
    let context = host.context();
    window.open(context.clone());
    let mut harness = Harness::builder()
        .with_size(vec2(size[0] as f32, size[1] as f32))
        .with_pixels_per_point(scale)
        .with_step_dt(1.0 / 60.0)
        .renderer(Renderer::default())
        .build_ui(move |ui| window.contents(ui, &context));
    harness.run_steps(3);
    Stage { params, host, harness, folder }
}

/// Compares a picture with the accepted one, or accepts it.
#[track_caller]
pub(super) fn compare(name: &str, harness: &mut Harness) {
    harness.check_accessibility();
    let found = harness.render().unwrap();
    let file = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pictures")).join(format!("{name}.png"));
    if std::env::var_os("SPRUNG_BLESS_PICTURES").is_some() {
        found.save(&file).unwrap();
        println!("blessed {name}");
        return;
    }
    let actual = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../target/pictures");
    std::fs::create_dir_all(&actual).unwrap();
    found.save(actual.join(format!("{name}.png"))).unwrap();
    let accepted = image::open(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).into_rgba8();
    let differing = differing(&found, &accepted);
    assert_eq!(differing, 0, "{name}: see target/pictures; `cargo xtask bless pictures` accepts the present pictures");
}

/// How many pixels differ.
fn differing(one: &RgbaImage, other: &RgbaImage) -> usize {
    assert_eq!(one.dimensions(), other.dimensions());
    let differs = |(one, other): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        one.0.iter().zip(other.0).any(|(one, other)| one.abs_diff(other) > TOLERANCE)
    };
    one.pixels().zip(other.pixels()).filter(|pair| differs(*pair)).count()
}

#[test]
fn pictures_of_every_page_are_as_accepted() {
    for (page, name) in crate::editor::sections::pages().enumerate() {
        let mut stage = stage("Church Bell", SIZE, 1.0, Theme::Dark);
        use egui_kittest::kittest::Queryable as _;
        stage.harness.get_by_role_and_label(egui::Role::Tab, name).click();
        stage.harness.run_steps(3);
        compare(&format!("page-{page}"), &mut stage.harness);
    }
    finish();
}

#[test]
fn pictures_of_every_theme_and_scale_are_as_accepted() {
    for theme in Theme::ALL {
        for (name, size, scale) in [("", SIZE, 1.0), ("-twice", SIZE, 2.0), ("-least", LEAST_SIZE, 1.0)] {
            compare(&format!("{}{name}", theme.id()), &mut stage("Marimba", size, scale, theme).harness);
        }
    }
    finish();
}

/// Fails if pictures were accepted.
pub(super) fn finish() {
    assert!(std::env::var_os("SPRUNG_BLESS_PICTURES").is_none(), "pictures were accepted: run the tests again");
}
