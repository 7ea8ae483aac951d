//! The host's own menu of a parameter, opened from the window's: CLAP's context-menu extension and VST3's handler.

use crate::host::Instance;
use crate::process::wait_until;
use crate::screen::Onlooker;
use crate::vst3_host::{Frame, Module, Vst3};
use crate::window::{Editor, Parent, on_a_screen};
use sprung::params::Param;
use std::process::ExitCode;
use vst3::ComWrapper;
use vst3::Steinberg::IPlugFrame;

/// The knob of the decay in the window as it opens.
const KNOB: [i16; 2] = [593, 527];
/// Where the menu's entries may be below the pointer that opened it.
const ENTRIES: std::ops::Range<i16> = 30..180;

pub(crate) fn opens_in_a_clap_host() {
    drop(on_a_screen("menu-clap"));
}

pub(crate) fn opens_in_a_vst3_host() {
    drop(on_a_screen("menu-vst3"));
}

/// Runs in the processes that these tests start.
pub(crate) fn work(name: &str) -> ExitCode {
    if name == "menu-clap" {
        in_clap()
    } else {
        in_vst3()
    }
    ExitCode::SUCCESS
}

fn in_clap() {
    let parent = Parent::new();
    let mut instance = Instance::new();
    let expected = instance.id(Param::Decay).get();
    let editor = Editor::open(&mut instance, &parent);
    editor.wait_until_drawn(&mut instance);
    let mut last = 0;
    let (parameter, place) = until_one_opens(&parent.onlooker, &mut last, || {
        instance.run_callbacks();
        instance.menus().pop()
    });
    assert_eq!(parameter, expected);
    is_near(place, last);
    editor.close(&mut instance);
}

fn in_vst3() {
    let onlooker = Onlooker::new(None);
    let window = onlooker.make_window();
    let plugin = Vst3::new(&Module::open());
    let mut known = (0..).map_while(|index| plugin.parameter(index));
    let (expected, _) = known.find(|(_, title)| title == Param::Decay.info().name).unwrap();
    let frame = ComWrapper::new(Frame::default());
    let view = plugin.open_window(&frame.to_com_ptr::<IPlugFrame>().unwrap(), window);
    wait_until("a picture", || {
        frame.turn(10);
        onlooker.sees_a_picture(1_100, 700)
    });
    let mut last = 0;
    let (parameter, place) = until_one_opens(&onlooker, &mut last, || {
        frame.turn(10);
        plugin.menus().pop()
    });
    assert_eq!(parameter, expected);
    is_near(place, last);
    view.close();
}

/// Opens the window's menu of a knob again and again, and clicks further up each time, until `opened` returns what the
/// host was asked for. `last` becomes the height of the last click.
fn until_one_opens<T>(onlooker: &Onlooker, last: &mut i16, mut opened: impl FnMut() -> Option<T>) -> T {
    const ESCAPE: u8 = 9;
    let [x, y] = KNOB;
    let mut heights = ENTRIES.rev().step_by(9).cycle();
    let mut found = None;
    wait_until("the host's menu", || {
        *last = y + heights.next().unwrap();
        onlooker.press_key(ESCAPE);
        onlooker.hover(KNOB);
        onlooker.click_secondary(KNOB);
        std::thread::sleep(std::time::Duration::from_millis(200));
        onlooker.drag_slowly([x + 30, *last], [x + 30, *last]);
        std::thread::sleep(std::time::Duration::from_millis(100));
        found = opened();
        found.is_some()
    });
    found.unwrap()
}

/// Checks that the host was asked to open its menu where the entry is that was clicked.
fn is_near([x, y]: [i32; 2], clicked: i16) {
    let near = |found: i32, expected: i16| (found - i32::from(expected)).abs() < 40;
    assert!(near(x, KNOB[0]) && near(y, clicked), "[{x}, {y}] for a click at {clicked}");
}
