//! The size of the window through its openings: what hosts are told, and what is on the screen, at every zoom and scale.

use crate::host::Instance;
use crate::patches::enclosed;
use crate::process::wait_until;
use crate::screen::{Onlooker, Screen};
use crate::vst3_host::{Frame, Module, View, Vst3};
use crate::window::{Editor, Parent, on_this_screen};
use sprung::preset::Preset;
use sprung_picture::Palette;
use std::process::ExitCode;
use std::time::Duration;
use vst3::ComWrapper;
use vst3::Steinberg::IPlugFrame;

/// Large enough for the largest window of these tests.
const SCREEN: [u32; 2] = [2_600, 1_640];
/// How often a window is opened at each zoom, a third of it at each scale.
const OPENINGS: usize = 30;
const ZOOMS: [u32; 3] = [100, 150, 200];
const SCALES: [Option<f64>; 3] = [None, Some(1.5), Some(2.0)];
/// Size of the stored window at 100 %.
const SMALL: [u32; 2] = [640, 400];
/// Size of a new window.
const NEW: [u32; 2] = [1_100, 700];
/// The button of the menu in a new window, and entries of it.
const VIEW: [i16; 2] = [935, 23];
const ENTRY_100: [i16; 2] = [976, 78];
const ENTRY_150: [i16; 2] = [976, 124];
const ENTRY_200: [i16; 2] = [976, 170];
/// The space around the panels, and the corner by which the window is resized, at 100 %.
const MARGIN: f64 = 8.0;
const CORNER: f64 = 20.0;

pub(crate) fn every_opening_is_whole_at_every_zoom_and_scale_in_clap() {
    drop(on_this_screen(&Screen::of(SCREEN), "sizes-clap"));
}

pub(crate) fn every_opening_is_whole_at_every_zoom_and_scale_in_vst3() {
    drop(on_this_screen(&Screen::of(SCREEN), "sizes-vst3"));
}

pub(crate) fn a_zoom_that_is_chosen_stays_in_clap() {
    drop(on_this_screen(&Screen::of(SCREEN), "zooms-clap"));
}

pub(crate) fn a_zoom_that_is_chosen_stays_in_vst3() {
    drop(on_this_screen(&Screen::of(SCREEN), "zooms-vst3"));
}

pub(crate) fn a_screen_with_dense_dots_has_a_whole_window() {
    let screen = Screen::of(SCREEN);
    Onlooker::new(Some(&screen.display)).set_resources("Xft.dpi:\t192\n");
    drop(on_this_screen(&screen, "dots"));
}

/// Runs in the processes that these tests start.
pub(crate) fn work(name: &str) -> ExitCode {
    let parent = Parent::new();
    match name {
        "sizes-clap" => every(|size, zoom| Box::new(Clap::new(&parent, size, zoom))),
        "sizes-vst3" => every(|size, zoom| Box::new(OwnVst3::new(&parent, size, zoom))),
        "zooms-clap" => chosen(Box::new(Clap::new(&parent, NEW, 100))),
        "zooms-vst3" => chosen(Box::new(OwnVst3::new(&parent, NEW, 100))),
        _ => dense(&parent),
    }
    ExitCode::SUCCESS
}

/// A host with an instance of the plugin and at most one window.
trait Host {
    /// Opens the window; a host that has a scale tells it.
    fn open(&mut self, scale: Option<f64>);
    fn close(&mut self);
    /// Width and height as the host is told.
    fn reported(&mut self) -> [u32; 2];
    /// Does what the plugin has asked for. Returns the size if it asked for one.
    fn turn(&mut self) -> Option<[u32; 2]>;
    /// From now on, the host refuses to resize its window.
    fn refuse_sizes(&mut self);
    /// Saves the state and loads it into a new instance in place of this one.
    fn reopen_project(&mut self);
    fn parent(&self) -> &Parent;
}

/// The state with a window of this size and zoom.
fn state(size: [u32; 2], zoom: u32) -> Vec<u8> {
    let preset = Preset::find("Marimba").unwrap().to_toml();
    let own = serde_json::json!({ "format": 1, "preset": preset, "seed": 0, "window": size, "zoom": zoom });
    enclosed(&own.to_string())
}

struct Clap<'a> {
    parent: &'a Parent,
    instance: Instance,
    editor: Option<Editor<'a>>,
    is_slow: bool,
    refuses_sizes: bool,
}

impl<'a> Clap<'a> {
    fn new(parent: &'a Parent, size: [u32; 2], zoom: u32) -> Self {
        let mut instance = Instance::new();
        assert!(instance.load(&state(size, zoom)));
        Self { parent, instance, editor: None, is_slow: false, refuses_sizes: false }
    }
}

impl Host for Clap<'_> {
    fn open(&mut self, scale: Option<f64>) {
        // Every second host is slow: the window wants to draw before it is shown.
        self.is_slow = !self.is_slow;
        let pause = Duration::from_millis(if self.is_slow { 60 } else { 0 });
        self.editor = Some(Editor::open_at(scale, pause, &mut self.instance, self.parent));
    }

    fn close(&mut self) {
        self.editor.take().unwrap().close(&mut self.instance);
    }

    fn reported(&mut self) -> [u32; 2] {
        self.editor.as_ref().unwrap().size(&mut self.instance)
    }

    fn turn(&mut self) -> Option<[u32; 2]> {
        self.instance.run_callbacks();
        let size = self.instance.requested_size()?;
        if !self.refuses_sizes {
            self.parent.onlooker.resize(self.parent.window, size);
        }
        Some(size)
    }

    fn refuse_sizes(&mut self) {
        self.refuses_sizes = true;
        self.instance.refuse_sizes();
    }

    fn reopen_project(&mut self) {
        let state = self.instance.save();
        self.instance = Instance::new();
        assert!(self.instance.load(&state));
    }

    fn parent(&self) -> &Parent {
        self.parent
    }
}

struct OwnVst3<'a> {
    parent: &'a Parent,
    module: Module,
    plugin: Vst3,
    frame: ComWrapper<Frame>,
    view: Option<View>,
    refuses_sizes: bool,
}

impl<'a> OwnVst3<'a> {
    fn new(parent: &'a Parent, size: [u32; 2], zoom: u32) -> Self {
        let module = Module::open();
        let plugin = Vst3::new(&module);
        // A CLAP host's state begins with its length.
        assert!(plugin.load(&state(size, zoom)[8..]));
        let frame = ComWrapper::new(Frame::default());
        Self { parent, module, plugin, frame, view: None, refuses_sizes: false }
    }
}

impl Host for OwnVst3<'_> {
    fn open(&mut self, scale: Option<f64>) {
        let view = self.plugin.view();
        if let Some(scale) = scale {
            view.set_scale(scale as f32);
        }
        self.parent.onlooker.resize(self.parent.window, view.size());
        view.attach(&self.frame.to_com_ptr::<IPlugFrame>().unwrap(), self.parent.window);
        self.view = Some(view);
    }

    fn close(&mut self) {
        self.view.take().unwrap().close();
    }

    fn reported(&mut self) -> [u32; 2] {
        self.view.as_ref().unwrap().size()
    }

    fn turn(&mut self) -> Option<[u32; 2]> {
        self.frame.turn(10);
        let size = self.frame.requested_size()?;
        if !self.refuses_sizes {
            self.parent.onlooker.resize(self.parent.window, size);
        }
        Some(size)
    }

    fn refuse_sizes(&mut self) {
        self.refuses_sizes = true;
        self.frame.refuse_sizes();
    }

    fn reopen_project(&mut self) {
        let state = self.plugin.save();
        self.plugin = Vst3::new(&self.module);
        assert!(self.plugin.load(&state));
    }

    fn parent(&self) -> &Parent {
        self.parent
    }
}

/// Opens windows that were stored, each several times.
fn every<'a>(host: impl Fn([u32; 2], u32) -> Box<dyn Host + 'a>) {
    for zoom in ZOOMS {
        for scale in SCALES {
            let mut host = host(SMALL, zoom);
            let factor = f64::from(zoom) / 100.0 * scale.unwrap_or(1.0);
            for opening in 0..OPENINGS / SCALES.len() {
                host.open(scale);
                is_whole(
                    host.as_mut(),
                    scaled(SMALL, factor),
                    factor,
                    &format!("zoom {zoom}, scale {scale:?}, opening {opening}"),
                );
                host.close();
            }
        }
    }
}

/// Chooses zooms in the window's menu; they hold for the next windows and in a project that is opened again.
fn chosen(mut host: Box<dyn Host + '_>) {
    let mut before = 1.0;
    host.open(None);
    is_whole(host.as_mut(), NEW, before, "as new");
    for (entry, factor) in [(ENTRY_150, 1.5), (ENTRY_200, 2.0), (ENTRY_150, 1.5), (ENTRY_100, 1.0)] {
        choose(host.as_mut(), entry, before, factor);
        is_whole(host.as_mut(), scaled(NEW, factor), factor, &format!("{factor} is chosen"));
        for opening in 0..3 {
            host.close();
            if opening == 2 {
                host.reopen_project();
            }
            host.open(None);
            is_whole(host.as_mut(), scaled(NEW, factor), factor, &format!("{factor}, opening {opening}"));
        }
        before = factor;
    }
    // In a host that refuses, the contents are larger, and the window is not.
    host.refuse_sizes();
    choose(host.as_mut(), ENTRY_150, 1.0, 1.5);
    is_whole(host.as_mut(), NEW, 1.5, "refused");
    for opening in 0..3 {
        host.close();
        host.open(None);
        // The size is kept in whole pixels at 100 %.
        is_whole(host.as_mut(), scaled([733, 467], 1.5), 1.5, &format!("refused, opening {opening}"));
    }
    host.close();
}

/// Chooses a zoom in the window's menu; `before` and `after` are the factors of the zooms.
fn choose(host: &mut dyn Host, entry: [i16; 2], before: f64, after: f64) {
    let mut asked = None;
    wait_until(&format!("the host is asked for a window at {after}"), || {
        for place in [VIEW, entry] {
            let place = place.map(|side| (f64::from(side) * before) as i16);
            host.parent().onlooker.hover(place);
            host.parent().onlooker.drag_slowly(place, place);
        }
        std::thread::sleep(Duration::from_millis(200));
        asked = host.turn().or(asked);
        asked == Some(scaled(NEW, after))
    });
}

/// Opens windows on a screen with dense dots: what it says of itself comes before what hosts say.
fn dense(parent: &Parent) {
    let hosts: [Box<dyn Host>; 2] =
        [Box::new(Clap::new(parent, SMALL, 100)), Box::new(OwnVst3::new(parent, SMALL, 100))];
    for mut host in hosts {
        for scale in [None, Some(1.0), Some(2.0), None] {
            host.open(scale);
            is_whole(host.as_mut(), scaled(SMALL, 2.0), 2.0, &format!("a host with {scale:?}"));
            host.close();
        }
    }
}

fn scaled(size: [u32; 2], factor: f64) -> [u32; 2] {
    size.map(|side| (f64::from(side) * factor).round() as u32)
}

/// Waits until the window has this size for the host and on the screen, and all of its contents, at this factor, are inside.
#[track_caller]
fn is_whole(host: &mut dyn Host, expected: [u32; 2], factor: f64, what: &str) {
    // Nothing may be under the pointer.
    host.parent().onlooker.point([SCREEN[0] as i16 - 1, SCREEN[1] as i16 - 1]);
    assert_eq!(host.reported(), expected, "{what}: the size as the host is told");
    wait_until(&format!("{what}: a whole window of {expected:?}"), || {
        host.turn();
        let Parent { onlooker, window, .. } = host.parent();
        onlooker.size(onlooker.innermost(*window)) == expected && ends_with_its_panels(onlooker, expected, factor)
    });
    assert_eq!(host.reported(), expected, "{what}: the size as the host is told afterwards");
}

/// Whether nothing is cut off: beyond the panels, the margins on the right and at the bottom are empty.
fn ends_with_its_panels(onlooker: &Onlooker, [width, height]: [u32; 2], factor: f64) -> bool {
    let pixels = onlooker.pixels(width, height);
    let [red, green, blue, _] = Palette::DARK.ground.to_array();
    let is_ground = |x: u32, y: u32| {
        pixels[(y * width + x) as usize].iter().zip([blue, green, red]).all(|(one, other)| one.abs_diff(other) <= 2)
    };
    let [margin, corner] = [MARGIN, CORNER].map(|length| (length * factor).ceil() as u32);
    // A pixel on an edge may be a mixture.
    let (right, bottom) = (width - margin + 2, height - margin + 2);
    let panels = (0..height).filter(|y| !is_ground(right - 6, *y)).count();
    panels > height as usize / 3
        && (right..width).all(|x| (0..height - corner).all(|y| is_ground(x, y)))
        && (bottom..height).all(|y| (0..width - corner).all(|x| is_ground(x, y)))
}
