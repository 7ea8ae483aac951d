//! The size of the window in the pixels that hosts count, before it opens and while it is open.

#[cfg(target_os = "linux")]
use super::x11;
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
}

/// The factor between the window's contents at 100 % and at this zoom, as egui has it.
pub(crate) fn factor(view: View) -> f32 {
    view.zoom as f32 / 100.0
}

impl Extent {
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
        *self.known() = Known { open: Some(physical), scale: Some(scale_factor) };
    }

    pub(crate) fn is_open(&self) -> bool {
        self.known().open.is_some()
    }

    /// The window is closed.
    pub(crate) fn close(&self) {
        self.known().open = None;
    }

    /// The size as the host counts it: that of the open window, or the one in which a window with this view will open.
    pub(crate) fn size(&self, view: View) -> NativeSize<u32> {
        let known = self.known();
        let [width, height] = view.size.map(|side| f64::from(side) * f64::from(factor(view)));
        match known.open {
            Some(open) => NativeSize::from_size(Size::Physical(open), known.scale.unwrap_or(1.0)),
            None => {
                let scale = of_screen().or(known.scale).unwrap_or(1.0);
                NativeSize::from_size(Size::Logical(LogicalSize { width, height }), scale)
            }
        }
    }
}

/// The scale that the screen says of itself.
fn of_screen() -> Option<f64> {
    #[cfg(target_os = "linux")]
    return x11::scale();
    #[cfg(not(target_os = "linux"))]
    None
}
