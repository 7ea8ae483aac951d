//! The plugin's window inside a host's window: opened, closed, resized, drawn and used, with and without audio.

use crate::host::{Address, Instance, Player, Sent};
use crate::patches::patch_in;
use crate::process::{Stops, command, succeeds, wait_until};
use crate::screen::{Onlooker, Screen};
use clack_extensions::gui::{GuiApiType, GuiConfiguration, GuiSize, PluginGui, Window};
use clack_host::prelude::*;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Number of times that the window is opened and closed.
const TIMES: usize = 50;

pub(crate) fn opens_and_closes_fifty_times() {
    drop(on_a_screen("window"));
}

pub(crate) fn opens_and_closes_while_audio_runs() {
    drop(on_a_screen("window-playing"));
}

pub(crate) fn keys_go_to_the_host_unless_somebody_types() {
    drop(on_a_screen("window-keys"));
}

/// Does a piece of work in a process of its own, with a screen, and returns what it prints.
#[track_caller]
pub(crate) fn on_a_screen(work: &str) -> String {
    on_this_screen(&Screen::new(), work)
}

/// As [`on_a_screen`], on a given screen.
#[track_caller]
pub(crate) fn on_this_screen(screen: &Screen, work: &str) -> String {
    let mut command = command(work);
    command.env("DISPLAY", &screen.display);
    succeeds(command)
}

/// Runs in the processes that these tests start.
pub(crate) fn work(name: &str) -> ExitCode {
    let parent = Parent::new();
    let mut instance = Instance::new();
    if name == "window-keys" {
        host_hears_keys(&mut instance, &parent);
        return ExitCode::SUCCESS;
    }
    if name == "window" {
        open_and_close(&mut instance, &parent);
        return ExitCode::SUCCESS;
    }
    let Player { mut instance, mut audio } = instance.play(48_000.0, 256);
    let stop = AtomicBool::new(false);
    let audio = std::thread::scope(|scope| {
        let stops = Stops(&stop);
        let playing = scope.spawn(|| {
            let mut events = EventBuffer::new();
            let mut note = 0;
            while !stop.load(Ordering::Relaxed) {
                events.clear();
                Sent::On(Address::note(0, 40 + note % 40, note.into()), 0.5).push(0, &mut events);
                note = (note + 1) % 1_000;
                audio.process(&events, 256);
                std::thread::sleep(Duration::from_millis(1));
            }
            audio
        });
        open_and_close(&mut instance, &parent);
        drop(stops);
        playing.join().unwrap()
    });
    Player { instance, audio }.stop();
    ExitCode::SUCCESS
}

/// Opens the window, waits for a picture, uses the mouse, resizes and closes; every second time closes at once.
fn open_and_close(instance: &mut Instance, parent: &Parent) {
    let parameters = instance.parameters();
    turn_something(instance, parent);
    assert!(
        instance.clack.is_active() || instance.flushes() > 0,
        "while nothing processes, the plugin asks for a flush"
    );
    for time in 0..TIMES {
        let editor = Editor::open(instance, parent);
        if time % 2 == 0 {
            editor.wait_until_drawn(instance);
            editor.resize(instance, if time % 4 == 0 { [700, 500] } else { [1_000, 720] });
            (0..20).for_each(|round| editor.touch(round));
        }
        // Changes by another thread or by the host are shown too: state, values, modulation.
        let state = instance.save();
        assert!(instance.load(&state));
        if !instance.clack.is_active() {
            let parameter = &parameters[time % parameters.len()];
            let value = instance.value(parameter.id).unwrap();
            instance.flush(&[Sent::Value(parameter.id, parameter.max - value).at(0)]);
            instance.flush(&[Sent::Value(parameter.id, value).at(0)]);
        }
        instance.run_callbacks();
        editor.close(instance);
    }
}

/// Checks that Space reaches the host before any click, after a click on an empty place and after the browser was closed, but not
/// while words are typed.
fn host_hears_keys(instance: &mut Instance, parent: &Parent) {
    const SPACE: u8 = 65;
    const ESCAPE: u8 = 9;
    let editor = Editor::open(instance, parent);
    editor.wait_until_drawn(instance);
    let onlooker = &parent.onlooker;
    let mut hears = |what: &str, expected: bool| {
        wait_until(what, || {
            instance.run_callbacks();
            onlooker.press_key(SPACE);
            std::thread::sleep(Duration::from_millis(50));
            onlooker.heard_key(SPACE) == expected
        });
    };
    onlooker.focus(parent.proxy);
    hears("Space before anything was clicked", true);
    let empty = [550, 692];
    onlooker.hover(empty);
    onlooker.drag_slowly(empty, empty);
    hears("Space after a click on an empty place", true);
    // Clicks on ‘Browse’: its search field takes the keys at once.
    let browse = [510, 22];
    onlooker.drag_slowly(browse, browse);
    hears("no Space while words are typed", false);
    onlooker.press_key(ESCAPE);
    hears("Space after the browser was closed", true);
    editor.close(instance);
}

/// Drags the mouse across the window, line by line, until a value has changed.
fn turn_something(instance: &mut Instance, parent: &Parent) {
    let before = patch_in(&instance.save());
    let editor = Editor::open(instance, parent);
    editor.wait_until_drawn(instance);
    let mut y = 60;
    wait_until("a drag that changes a value", || {
        y = if y < 560 { y + 13 } else { 60 };
        parent.onlooker.drag_slowly([300, y], [420, y]);
        instance.run_callbacks();
        if !instance.clack.is_active() {
            instance.flush(&[]);
        }
        patch_in(&instance.save()) != before
    });
    editor.close(instance);
}

/// A window of the host that contains the plugin's window.
pub(crate) struct Parent {
    pub(crate) onlooker: Onlooker,
    pub(crate) window: u32,
    /// A window for the host's keys beside the plugin's, as JUCE has one.
    proxy: u32,
}

impl Parent {
    /// A window on the screen given by `DISPLAY`.
    pub(crate) fn new() -> Self {
        let onlooker = Onlooker::new(None);
        let window = onlooker.make_window();
        let proxy = onlooker.make_proxy(window);
        Self { onlooker, window, proxy }
    }
}

/// The plugin's window while it is open.
pub(crate) struct Editor<'a> {
    parent: &'a Parent,
    gui: PluginGui,
}

impl<'a> Editor<'a> {
    /// Opens the window in the same way as a host.
    pub(crate) fn open(instance: &mut Instance, parent: &'a Parent) -> Self {
        Self::open_at(None, Duration::ZERO, instance, parent)
    }

    /// As [`Editor::open`]; a host that has a scale tells it, makes its own window as large as the plugin says, and waits
    /// before it shows the plugin's.
    #[allow(unsafe_code)]
    pub(crate) fn open_at(scale: Option<f64>, pause: Duration, instance: &mut Instance, parent: &'a Parent) -> Self {
        let handle = instance.clack.plugin_handle();
        let gui: PluginGui = handle.get_extension().expect("there is a window");
        let configuration = GuiConfiguration { api_type: GuiApiType::X11, is_floating: false };
        assert!(gui.is_api_supported(&handle, configuration));
        gui.create(&handle, configuration).expect("the window can be made");
        if let Some(scale) = scale {
            gui.set_scale(&handle, scale).expect("it takes a scale");
        }
        let size = gui.get_size(&handle).expect("it has a size");
        parent.onlooker.resize(parent.window, [size.width, size.height]);
        assert!((100..4_000).contains(&size.width) && (100..4_000).contains(&size.height), "{size:?}");
        // SAFETY: the parent outlives the editor, which borrows it.
        unsafe { gui.set_parent(&handle, Window::from_x11_handle(parent.window.into())) }.expect("it takes a parent");
        // Longer than the plugin's timer takes, as in a busy host: the window wants to draw before it is shown.
        std::thread::sleep(pause);
        // Not every plugin needs this call, but no plugin may fail because of it.
        let _ = gui.show(&handle);
        Self { parent, gui }
    }

    /// Closes the window.
    pub(crate) fn close(self, instance: &mut Instance) {
        let handle = instance.clack.plugin_handle();
        let _ = self.gui.hide(&handle);
        self.gui.destroy(&handle);
    }

    /// Width and height as the host is told.
    pub(crate) fn size(&self, instance: &mut Instance) -> [u32; 2] {
        let size = self.gui.get_size(&instance.clack.plugin_handle()).expect("it has a size");
        [size.width, size.height]
    }

    /// Waits for a picture with more than one colour.
    pub(crate) fn wait_until_drawn(&self, instance: &mut Instance) {
        let [width, height] = self.size(instance);
        wait_until("a picture", || {
            instance.run_callbacks();
            self.parent.onlooker.sees_a_picture(width, height)
        });
    }

    fn resize(&self, instance: &mut Instance, [width, height]: [u32; 2]) {
        let handle = instance.clack.plugin_handle();
        assert!(self.gui.can_resize(&handle));
        let wanted = GuiSize { width, height };
        let size = self.gui.adjust_size(&handle, wanted).unwrap_or(wanted);
        self.gui.set_size(&handle, size).expect("it can be resized");
        let found = self.gui.get_size(&handle).unwrap();
        assert_eq!((found.width, found.height), (size.width, size.height));
    }

    /// Drags the mouse across the window, along a different line in each round.
    pub(crate) fn touch(&self, round: usize) {
        let y = 60 + (round * 37 % 400) as i16;
        self.parent.onlooker.drag([200, y], [200 + (round * 53 % 300) as i16, y]);
    }
}
