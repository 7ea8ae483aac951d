//! A virtual screen: its windows and pixels, and a simulated user who moves the mouse and closes windows.

use std::collections::BTreeSet;
use std::ffi::CStr;
use std::io::BufRead as _;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::damage::{ConnectionExt as _, ReportLevel};
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _, CreateWindowAux, EventMask, ImageFormat,
    InputFocus, MapState, PropMode, WindowClass,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// Libraries that the plugin's window loads when it opens.
const LIBRARIES: [&CStr; 3] = [c"libEGL.so.1", c"libX11-xcb.so.1", c"libxkbcommon-x11.so.0"];

/// The program or library that is missing on this machine for a window on a virtual screen.
pub(crate) fn missing() -> Option<String> {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    if !std::env::split_paths(&paths).any(|folder| folder.join("Xvfb").is_file()) {
        return Some("Xvfb".to_owned());
    }
    let missing = LIBRARIES.into_iter().find(|library| !loads(library))?;
    Some(missing.to_string_lossy().into_owned())
}

/// Whether a system library can be loaded.
#[allow(unsafe_code)]
fn loads(library: &CStr) -> bool {
    // SAFETY: these libraries' constructors do nothing that matters here; the handle is closed once.
    unsafe {
        let handle = libc::dlopen(library.as_ptr(), libc::RTLD_LAZY | libc::RTLD_LOCAL);
        !handle.is_null() && libc::dlclose(handle) == 0
    }
}

/// A running X server with a virtual screen.
pub(crate) struct Screen {
    server: Child,
    /// Value for the environment variable `DISPLAY`.
    pub(crate) display: String,
}

impl Screen {
    /// Starts Xvfb on a free display.
    pub(crate) fn new() -> Self {
        Self::of([1_280, 800])
    }

    /// As [`Screen::new`], with this width and height.
    pub(crate) fn of([width, height]: [u32; 2]) -> Self {
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                &format!("{width}x{height}x24"),
                "+extension",
                "GLX",
                "-nolisten",
                "tcp",
                "-noreset",
            ])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let stdout = server.stdout.take().expect("stdout is piped");
        std::io::BufReader::new(stdout).read_line(&mut number).unwrap();
        Self { server, display: format!(":{}", number.trim()) }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Atoms that a window manager creates.
const NAMES: &str = "WM_CHANGE_STATE WM_DELETE_WINDOW WM_PROTOCOLS WM_TAKE_FOCUS UTF8_STRING XdndAware \
    _KDE_NET_WM_WINDOW_TYPE_OVERRIDE _MOTIF_WM_HINTS _NET_ACTIVE_WINDOW _NET_FRAME_EXTENTS \
    _NET_SUPPORTED _NET_WM_ACTION_CLOSE _NET_WM_ACTION_FULLSCREEN _NET_WM_ACTION_MINIMIZE \
    _NET_WM_ACTION_RESIZE _NET_WM_ALLOWED_ACTIONS _NET_WM_ICON _NET_WM_MOVERESIZE _NET_WM_NAME \
    _NET_WM_PID _NET_WM_PING _NET_WM_STATE _NET_WM_STATE_ABOVE _NET_WM_STATE_FULLSCREEN \
    _NET_WM_STATE_HIDDEN _NET_WM_STATE_MAXIMIZED_HORZ _NET_WM_STATE_MAXIMIZED_VERT \
    _NET_WM_STATE_SKIP_TASKBAR _NET_WM_USER_TIME _NET_WM_WINDOW_TYPE _NET_WM_WINDOW_TYPE_COMBO \
    _NET_WM_WINDOW_TYPE_NORMAL _NET_WORKAREA _XEMBED _XEMBED_INFO";

/// A simulated user of the screen.
pub(crate) struct Onlooker {
    connection: RustConnection,
    root: u32,
}

impl Onlooker {
    /// A user of the screen with this name, or of the one in `DISPLAY`.
    pub(crate) fn new(display: Option<&str>) -> Self {
        let (connection, screen) = x11rb::connect(display).expect("there is an X server");
        let root = connection.setup().roots[screen].root;
        Self { connection, root }
    }

    /// Creates the atoms of a window manager: some toolkits expect them and exit if they are missing.
    pub(crate) fn stand_in_for_a_window_manager(&self) {
        for name in NAMES.split_whitespace() {
            self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap();
        }
    }

    /// Creates a window for the plugin's window, in the upper left corner.
    pub(crate) fn make_window(&self) -> u32 {
        let window = self.connection.generate_id().unwrap();
        let visual = self.connection.setup().roots[0].root_visual;
        let aux = CreateWindowAux::new().background_pixel(0x00FF_00FF);
        self.connection
            .create_window(24, window, self.root, 0, 0, 1_200, 760, 0, WindowClass::INPUT_OUTPUT, visual, &aux)
            .unwrap();
        self.connection.map_window(window).unwrap();
        self.connection.flush().unwrap();
        window
    }

    /// Creates a window inside another one, beside the plugin's, that receives key events.
    pub(crate) fn make_proxy(&self, parent: u32) -> u32 {
        let window = self.connection.generate_id().unwrap();
        let visual = self.connection.setup().roots[0].root_visual;
        let aux = CreateWindowAux::new().event_mask(EventMask::KEY_PRESS);
        self.connection
            .create_window(24, window, parent, 1_199, 759, 1, 1, 0, WindowClass::INPUT_OUTPUT, visual, &aux)
            .unwrap();
        self.connection.map_window(window).unwrap();
        self.connection.flush().unwrap();
        window
    }

    /// Blue, green and red of each pixel in the upper left corner of the screen.
    pub(crate) fn pixels(&self, width: u32, height: u32) -> Vec<[u8; 3]> {
        let (width, height) = (width as u16, height as u16);
        let request = self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0);
        let image = request.unwrap().reply().expect("the screen can be read");
        image.data.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }

    /// Whether the upper left corner shows more than a few colours.
    pub(crate) fn sees_a_picture(&self, width: u32, height: u32) -> bool {
        self.pixels(width, height).into_iter().collect::<BTreeSet<_>>().len() > 16
    }

    /// Drags the mouse in one step, so that a window may see all of it between two frames.
    pub(crate) fn drag(&self, from: [i16; 2], to: [i16; 2]) {
        self.drag_with_pauses(from, to, Duration::ZERO);
    }

    /// Drags the mouse slowly, as a hand does, so that a window sees each step separately.
    pub(crate) fn drag_slowly(&self, from: [i16; 2], to: [i16; 2]) {
        // A knob follows movement after the press, so press and movement must come in different frames, also on a busy machine.
        self.drag_with_pauses(from, to, Duration::from_millis(80));
    }

    /// Clicks with the right button.
    pub(crate) fn click_secondary(&self, [x, y]: [i16; 2]) {
        const PRESS: u8 = 4;
        const RELEASE: u8 = 5;
        const RIGHT: u8 = 3;
        for kind in [PRESS, RELEASE] {
            self.connection.xtest_fake_input(kind, RIGHT, 0, self.root, x, y, 0).unwrap();
            self.connection.flush().unwrap();
            std::thread::sleep(Duration::from_millis(80));
        }
    }

    fn drag_with_pauses(&self, from: [i16; 2], to: [i16; 2], pause: Duration) {
        const PRESS: u8 = 4;
        const RELEASE: u8 = 5;
        const MOVE: u8 = 6;
        let half = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
        let steps = [(MOVE, 0, from), (PRESS, 1, from), (MOVE, 0, half), (MOVE, 0, to), (RELEASE, 1, to)];
        for (kind, detail, [x, y]) in steps {
            self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).unwrap();
            if !pause.is_zero() {
                self.connection.flush().unwrap();
                std::thread::sleep(pause);
            }
        }
        self.connection.flush().unwrap();
    }

    /// Gives a window the focus.
    pub(crate) fn focus(&self, window: u32) {
        self.connection.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME).unwrap().check().unwrap();
    }

    /// Whether keys go to this window or to one inside it.
    pub(crate) fn has_focus(&self, window: u32) -> bool {
        let mut focused = self.connection.get_input_focus().unwrap().reply().unwrap().focus;
        // Below these numbers are no windows: no focus, or wherever the pointer is.
        while focused > 1 && focused != self.root {
            if focused == window {
                return true;
            }
            let Ok(tree) = self.connection.query_tree(focused).unwrap().reply() else { return false };
            focused = tree.parent;
        }
        false
    }

    /// The largest window inside a window that has none inside it: in a host's window, that of the plugin.
    pub(crate) fn innermost(&self, window: u32) -> u32 {
        let tree = self.connection.query_tree(window).unwrap().reply().unwrap();
        let area = |window: &u32| {
            let size = self.size(*window);
            size[0] * size[1]
        };
        tree.children.into_iter().max_by_key(area).map_or(window, |child| self.innermost(child))
    }

    /// Width and height of a window.
    pub(crate) fn size(&self, window: u32) -> [u32; 2] {
        let geometry = self.connection.get_geometry(window).unwrap().reply();
        geometry.map_or([0, 0], |geometry| [geometry.width.into(), geometry.height.into()])
    }

    /// Where the upper left corner of a window is on the screen.
    pub(crate) fn place(&self, window: u32) -> [i16; 2] {
        let place = self.connection.translate_coordinates(window, self.root, 0, 0).unwrap().reply().unwrap();
        [place.dst_x, place.dst_y]
    }

    /// Changes the size of a window, as a window manager does.
    pub(crate) fn resize(&self, window: u32, [width, height]: [u32; 2]) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.connection.configure_window(window, &size).unwrap().check().unwrap();
    }

    /// Sets the resources of the screen, such as `Xft.dpi`.
    pub(crate) fn set_resources(&self, text: &str) {
        let (property, kind) = (AtomEnum::RESOURCE_MANAGER, AtomEnum::STRING);
        let set = self.connection.change_property8(PropMode::REPLACE, self.root, property, kind, text.as_bytes());
        set.unwrap().check().unwrap();
    }

    /// Presses a key and lets it go, by its number on the keyboard.
    pub(crate) fn press_key(&self, key: u8) {
        self.press_keys(&[key]);
    }

    /// Presses keys in this order, and lets them go in the opposite order.
    pub(crate) fn press_keys(&self, keys: &[u8]) {
        const PRESS: u8 = 2;
        const RELEASE: u8 = 3;
        let (down, up) = (keys.iter().map(|key| (PRESS, key)), keys.iter().rev().map(|key| (RELEASE, key)));
        for (kind, key) in down.chain(up) {
            self.connection.xtest_fake_input(kind, *key, 0, self.root, 0, 0, 0).unwrap();
        }
        self.connection.flush().unwrap();
    }

    /// Whether a window of the host has received this key since the last call.
    pub(crate) fn heard_key(&self, key: u8) -> bool {
        let mut heard = false;
        while let Some(event) = self.connection.poll_for_event().unwrap() {
            heard |= matches!(event, Event::KeyPress(press) if press.detail == key);
        }
        heard
    }

    /// Moves the mouse to a place at once.
    pub(crate) fn point(&self, [x, y]: [i16; 2]) {
        const MOVE: u8 = 6;
        self.connection.xtest_fake_input(MOVE, 0, 0, self.root, x, y, 0).unwrap();
        self.connection.flush().unwrap();
    }

    /// From now on, [`Onlooker::pictures_since`] counts the pictures drawn in a window and in those inside it.
    pub(crate) fn watch(&self, window: u32) -> u32 {
        self.connection.damage_query_version(1, 1).unwrap().reply().expect("the screen tells what is drawn");
        let damage = self.connection.generate_id().unwrap();
        self.connection.damage_create(damage, window, ReportLevel::RAW_RECTANGLES).unwrap().check().unwrap();
        self.pictures_since();
        damage
    }

    /// The number of pictures since the last call.
    pub(crate) fn pictures_since(&self) -> u32 {
        let mut pictures = 0;
        while let Some(event) = self.connection.poll_for_event().unwrap() {
            // Large pictures come in several pieces.
            pictures += u32::from(matches!(event, Event::DamageNotify(drawn) if drawn.area.y == 0));
        }
        pictures
    }

    /// Stops counting.
    pub(crate) fn unwatch(&self, damage: u32) {
        self.connection.damage_destroy(damage).unwrap().check().unwrap();
    }

    /// Moves the mouse about near a place, as a hand does before it clicks.
    pub(crate) fn hover(&self, [x, y]: [i16; 2]) {
        const MOVE: u8 = 6;
        for step in 0..10 {
            self.connection.xtest_fake_input(MOVE, 0, 0, self.root, x - step, y, 0).unwrap();
            self.connection.flush().unwrap();
            std::thread::sleep(Duration::from_millis(60));
        }
    }

    /// Finds the visible window with this title.
    pub(crate) fn find(&self, title: &str) -> Option<u32> {
        let tree = self.connection.query_tree(self.root).unwrap().reply().unwrap();
        tree.children.into_iter().find(|window| {
            // Windows may close during the search.
            let name = self.connection.get_property(false, *window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64);
            let attributes = self.connection.get_window_attributes(*window);
            let is_seen = attributes.unwrap().reply().is_ok_and(|found| found.map_state == MapState::VIEWABLE);
            is_seen && name.unwrap().reply().is_ok_and(|found| found.value == title.as_bytes())
        })
    }

    /// Asks a window to close, as its close button does.
    pub(crate) fn close(&self, window: u32) {
        let atom = |name: &[u8]| self.connection.intern_atom(false, name).unwrap().reply().unwrap().atom;
        let data = [atom(b"WM_DELETE_WINDOW"), 0, 0, 0, 0];
        let message = ClientMessageEvent::new(32, window, atom(b"WM_PROTOCOLS"), data);
        self.connection.send_event(false, window, EventMask::NO_EVENT, message).unwrap();
        self.connection.flush().unwrap();
    }
}
