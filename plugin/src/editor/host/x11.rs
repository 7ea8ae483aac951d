//! The X11 display that the window is on: its focus, its scale, and the window's place.

use nice_plug_egui::baseview::WindowContext;
use raw_window_handle::{HasWindowHandle as _, RawWindowHandle};
use x11rb::CURRENT_TIME;
use x11rb::connection::Connection as _;
use x11rb::protocol::randr::ConnectionExt as _;
use x11rb::protocol::xproto::{ConnectionExt as _, InputFocus};
use x11rb::resource_manager::new_from_default;
use x11rb::rust_connection::RustConnection;

/// A connection to the display of its own, made when it is first needed.
#[derive(Default)]
pub(super) struct Display(Option<RustConnection>);

impl Display {
    fn connection(&mut self) -> Option<&RustConnection> {
        if self.0.is_none() {
            self.0 = Some(x11rb::connect(None).ok()?.0);
        }
        self.0.as_ref()
    }

    /// The window that has the focus; X11: 0 means no window, 1 means the window under the pointer.
    pub(super) fn focused(&mut self) -> Option<u32> {
        Some(self.connection()?.get_input_focus().ok()?.reply().ok()?.focus)
    }

    /// Gives the focus to a visible window. If that is hidden later, the window around it gets the focus.
    pub(super) fn give_focus(&mut self, window: u32) -> Option<()> {
        let connection = self.connection()?;
        connection.set_input_focus(InputFocus::PARENT, window, CURRENT_TIME).ok()?.check().ok()
    }

    /// The window around a window, unless that is the whole screen.
    pub(super) fn parent(&mut self, window: u32) -> Option<u32> {
        let around = self.connection()?.query_tree(window).ok()?.reply().ok()?;
        (around.parent != around.root).then_some(around.parent)
    }

    /// Left, top, right and bottom of a window on the screen, in pixels.
    pub(super) fn bounds(&mut self, window: &WindowContext) -> Option<[f64; 4]> {
        let window = id(window)?;
        let connection = self.connection()?;
        let size = connection.get_geometry(window).ok()?.reply().ok()?;
        let place = connection.translate_coordinates(window, size.root, 0, 0).ok()?.reply().ok()?;
        let [left, top] = [place.dst_x, place.dst_y].map(f64::from);
        Some([left, top, left + f64::from(size.width), top + f64::from(size.height)])
    }
}

/// Width and height of the largest monitor in pixels, and the scale that the screen says of itself, as the library that makes the
/// window reads it.
pub(super) fn screen() -> Option<([u32; 2], Option<f64>)> {
    let (connection, number) = x11rb::connect(None).ok()?;
    let screen = &connection.setup().roots[number];
    let monitors = connection.randr_get_monitors(screen.root, true).ok().and_then(|asked| asked.reply().ok());
    let sizes = monitors.into_iter().flat_map(|found| found.monitors).map(|monitor| [monitor.width, monitor.height]);
    let largest = sizes.max_by_key(|[width, height]| u32::from(*width) * u32::from(*height));
    let size = largest.unwrap_or([screen.width_in_pixels, screen.height_in_pixels]).map(u32::from);
    let density = || new_from_default(&connection).ok()?.get_value::<u32>("Xft.dpi", "").ok()?;
    Some((size, density().map(|density| f64::from(density) / 96.0)))
}

/// The window's X11 id.
pub(super) fn id(window: &WindowContext) -> Option<u32> {
    match window.platform_handle().window_handle().ok()?.as_raw() {
        RawWindowHandle::Xlib(handle) => u32::try_from(handle.window).ok(),
        RawWindowHandle::Xcb(handle) => Some(handle.window.get()),
        _ => None,
    }
}
