//! Edits of the window's size: it opens with the scale that the host has told before, and gives up a size that the host refuses.

use super::edit::{Edit, INNER, VIEW, edit};

const EDITOR: &str = "src/editor.rs";
const SIZING: &str = "src/platform/x11/sizing.rs";

/// The library below the wrapper's window, on X11.
pub(super) const WINDOW: &[Edit] = &[
    // A window knew the host's scale but began in its size at 100 %. When the host told the scale again, it was the same,
    // and the window stayed too small for its contents.
    edit(
        SIZING,
        "let initial_scale_factor = scaling.unwrap_or(1.0);",
        "let initial_scale_factor = scaling.or(settings.fallback_scale_factor).unwrap_or(1.0);",
    ),
    // The host's thread, which limits the sizes that a host proposes, went on with the old scale.
    edit(
        SIZING,
        "        let new_physical_size = current_logical_size.to_physical(scale);
",
        "        let new_physical_size = current_logical_size.to_physical(scale);
        shared.main_thread_shared.sizing.set_scaling_factor(scale);
",
    ),
];

/// The interface of the editor, in nice-plug-core.
pub(super) const INTERFACE: &[Edit] = &[edit(
    EDITOR,
    "    /// Called when the provided track information has changed.
    ///
    /// Generally you will want",
    "    /// Called when the host has told its scale factor, which may be before the editor is spawned: from
    /// then on, [`Editor::size()`] is at that scale.
    fn scale_factor_suggested(&self, _scale_factor: f64) {}

    /// Called when the provided track information has changed.
    ///
    /// Generally you will want",
)];

pub(super) const EDITS: &[Edit] = &[
    // VST3 hosts tell their scale, ask for the size, and only then open the window. Without a window, the scale was refused
    // and forgotten. A scale of zero was taken.
    edit(
        VIEW,
        "if !scale_factor.is_finite() || !scale_factor.is_sign_positive() {
            return kResultFalse;
        }
",
        "if !scale_factor.is_finite() || scale_factor <= 0.0 {
            return kResultFalse;
        }
        let Some(editor) = self.editor.upgrade() else {
            return kResultFalse;
        };
        editor.lock().scale_factor_suggested(scale_factor as f64);
        self.fallback_scale_factor.store(Some(scale_factor));
",
    ),
    edit(
        VIEW,
        "                self.fallback_scale_factor.store(Some(scale_factor));
                kResultOk
            }
        } else {
            kResultFalse
        }
",
        "                kResultOk
            }
        } else {
            kResultOk
        }
",
    ),
    // A window asks for a size when it has it already. If a VST3 host refused, the window stayed larger than the host's own.
    edit(
        VIEW,
        "    fallback_scale_factor: AtomicCell<Option<f32>>,
}
",
        "    fallback_scale_factor: AtomicCell<Option<f32>>,

    /// The size of the host's own window, as far as the host has asked or told.
    pub(super) host_size: AtomicCell<Option<NativeSize<u32>>>,
}
",
    ),
    edit(
        VIEW,
        "            fallback_scale_factor: AtomicCell::new(None),
",
        "            fallback_scale_factor: AtomicCell::new(None),
            host_size: AtomicCell::new(None),
",
    ),
    edit(
        VIEW,
        "        let editor_size = editor.lock().size();
",
        "        let editor_size = editor.lock().size();
        self.host_size.store(Some(editor_size));
",
    ),
    edit(
        VIEW,
        "                crate::nice_error!(\"Failed to resize window to {:?}: {}\", size, e);
                kResultFalse
            } else {
                kResultOk
",
        "                crate::nice_error!(\"Failed to resize window to {:?}: {}\", size, e);
                kResultFalse
            } else {
                self.host_size.store(Some(size));
                kResultOk
",
    ),
    edit(
        INNER,
        "                        let _success = WrapperView::request_resize(
                            &self.plug_view.read().clone().unwrap(),
                            size,
                            scale_factor,
                        );
",
        "                        let view = self.plug_view.read().clone().unwrap();
                        let before = view.host_size.load();
                        if !WrapperView::request_resize(&view, size, scale_factor)
                            && let Some(before) = before
                            && let Some(editor_window) = self.open_window()
                            && let Err(e) = nice_plug_core::editor::EditorHandle::set_size(
                                &editor_window.handle,
                                before,
                                &editor_window.window,
                            )
                        {
                            crate::nice_error!(\"Failed to give up a size: {}\", e);
                        }
",
    ),
];
