//! The size of the window in the pixels that hosts count, before it opens and while it is open.

#[cfg(target_os = "linux")]
use super::x11;
use crate::editor::theme::{LEAST_SIZE, ZOOM_RANGE};
use crate::lock::lock;
use crate::state::View;
use nice_plug_core::editor::dpi::{LogicalSize, NativeSize, PhysicalSize, Size};
use nice_plug_egui::baseview::WindowSize;
use std::sync::{Mutex, MutexGuard};

/// What is known of the window's size, by the editor and by its window.
#[derive(Default)]
pub(crate) struct Extent(Mutex<Known>);

#[derive(Default)]
struct Known {
    /// The size of the open window.
    open: Option<PhysicalSize<u32>>,
    /// The scale that the host has told, or else that of the last window. If the screen says one itself, that comes first.
    scale: Option<f64>,
    /// The screen, as it was when the window began to open.
    screen: Option<Screen>,
}

/// What the system says of its largest screen.
#[derive(Clone, Copy, Default)]
struct Screen {
    /// Width and height in pixels.
    size: Option<[u32; 2]>,
    scale: Option<f64>,
}

/// The factor between the window's contents at 100 % and at this zoom, as egui has it.
pub(crate) fn factor(view: View) -> f32 {
    view.zoom as f32 / 100.0
}

/// The view with the greatest zoom up to its own at which the smallest window fits on a screen of this size in points, and with
/// the greatest size up to its own that fits there.
pub(crate) fn fitted(mut view: View, screen: Option<[f64; 2]>) -> View {
    let Some(screen) = screen else { return view };
    let most = |place: usize| (100.0 * screen[place] / f64::from(LEAST_SIZE[place])) as u32;
    view.zoom = view.zoom.min(most(0)).min(most(1)).max(ZOOM_RANGE[0]);
    let factor = f64::from(factor(view));
    for (side, most) in view.size.iter_mut().zip(screen) {
        *side = (*side).min((most / factor) as u32);
    }
    view
}

impl Extent {
    /// Width and height of the screen in points, if they are known.
    pub(crate) fn screen(&self) -> Option<[f64; 2]> {
        let seen = self.seen();
        self.in_points(seen)
    }

    fn in_points(&self, Screen { size, scale }: Screen) -> Option<[f64; 2]> {
        let scale = scale.or(self.known().scale).unwrap_or(1.0);
        size.map(|size| size.map(|side| f64::from(side) / scale))
    }

    /// A window begins to open: until it is closed, the screen counts as it is now.
    pub(crate) fn look(&self) {
        // The system may be slow to answer.
        let screen = of_screen();
        self.known().screen = Some(screen);
    }

    fn seen(&self) -> Screen {
        let kept = self.known().screen;
        kept.unwrap_or_else(of_screen)
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        lock(&self.0)
    }

    /// The host has told this scale. Returns the scale with which a window opens, if one is known.
    pub(crate) fn set_scale(&self, scale: Option<f64>) -> Option<f64> {
        let mut known = self.known();
        known.scale = scale.or(known.scale);
        known.scale
    }

    /// The window is open in this size, without zoom.
    pub(crate) fn set(&self, WindowSize { physical, scale_factor, .. }: WindowSize) {
        let mut known = self.known();
        (known.open, known.scale) = (Some(physical), Some(scale_factor));
    }

    pub(crate) fn is_open(&self) -> bool {
        self.known().open.is_some()
    }

    /// The window is closed.
    pub(crate) fn close(&self) {
        let mut known = self.known();
        (known.open, known.screen) = (None, None);
    }

    /// The size as the host counts it: that of the open window, or the one in which a window with this view will open, as far as it
    /// fits on the screen.
    pub(crate) fn size(&self, view: View) -> NativeSize<u32> {
        let (open, scale) = {
            let known = self.known();
            (known.open, known.scale)
        };
        if let Some(open) = open {
            return NativeSize::from_size(Size::Physical(open), scale.unwrap_or(1.0));
        }
        let screen = self.seen();
        let view = fitted(view, self.in_points(screen));
        let [width, height] = view.size.map(|side| f64::from(side) * f64::from(factor(view)));
        let scale = screen.scale.or(scale).unwrap_or(1.0);
        NativeSize::from_size(Size::Logical(LogicalSize { width, height }), scale)
    }
}

/// Asks the system for its largest screen.
fn of_screen() -> Screen {
    #[cfg(target_os = "linux")]
    return x11::screen().map_or_else(Screen::default, |(size, scale)| Screen { size: Some(size), scale });
    #[cfg(not(target_os = "linux"))]
    Screen::default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::VIEW;

    #[test]
    fn a_window_is_never_larger_than_the_screen() {
        let zoomed = |zoom, screen| {
            let View { zoom, size, .. } = fitted(View { zoom, ..VIEW }, screen);
            (zoom, size)
        };
        let small = Screen { size: Some([1280, 800]), scale: None };
        let extent = Extent(Mutex::new(Known { screen: Some(small), ..Known::default() }));
        let told = extent.size(View { zoom: 300, ..VIEW });
        assert_eq!((told.width, told.height), (1280, 800), "what a host is told");
        extent.close();
        assert!(extent.known().screen.is_none(), "it may be another one the next time");
        assert_eq!(zoomed(300, None), (300, VIEW.size));
        assert_eq!(zoomed(200, Some([2560.0, 1440.0])), (200, [1100, 700]));
        assert_eq!(zoomed(300, Some([2560.0, 1440.0])), (300, [853, 480]));
        assert_eq!(zoomed(300, Some([1280.0, 800.0])), (200, [640, 400]));
        assert_eq!(zoomed(300, Some([100.0, 100.0])).0, ZOOM_RANGE[0], "some zoom remains");
    }
}
