//! Edits of the library between the window and egui: files that are dropped, more keys, and a window without the focus.

use super::edit::{Edit, edit};

const WINDOW: &str = "src/window.rs";
const TRANSLATE: &str = "src/translate.rs";

pub(super) const EDITS: &[Edit] = &[
    // The window's library reports files that are dragged and dropped. This library ignored them.
    edit(
        WINDOW,
        "                    egui_input.events.push(egui::Event::PointerGone);
                }
                _ => do_repaint = false,
",
        "                    egui_input.events.push(egui::Event::PointerGone);
                }
                baseview::MouseEvent::DragDropped { data: baseview::DropData::Files(paths), .. } => {
                    for path in paths {
                        egui_input.dropped_files.push(std::sync::Arc::new(DroppedPath(path.clone())));
                    }
                }
                _ => do_repaint = false,
",
    ),
    // The source of a drag is told that the window accepts files.
    edit(
        WINDOW,
        "        match &event {
            baseview::Event::Keyboard(_) => {
",
        "        match &event {
            baseview::Event::Mouse(
                baseview::MouseEvent::DragEntered { data: baseview::DropData::Files(_), .. }
                | baseview::MouseEvent::DragMoved { data: baseview::DropData::Files(_), .. }
                | baseview::MouseEvent::DragDropped { data: baseview::DropData::Files(_), .. },
            ) => EventStatus::AcceptDrop(baseview::DropEffect::Copy),
            baseview::Event::Keyboard(_) => {
",
    ),
    // A click asks for the focus. If that fails, nothing can be typed, but everything else works; a panic, however, would end the
    // host, since on Windows the system calls this code.
    edit(WINDOW, "            self.window.focus().unwrap();\n", "            let _ = self.window.focus();\n"),
    edit(WINDOW, "                    self.window.focus()?;\n", "                    let _ = self.window.focus();\n"),
    // Not translated were: `/` (search), `[` `]` (octave), `+` `-` `=` (zoom), F1 (manual), F2 (rename a macro), and all letters with
    // Shift.
    edit(
        TRANSLATE,
        "            'z' => Key::Z,
",
        "            'z' => Key::Z,
            '/' => Key::Slash,
            '[' => Key::OpenBracket,
            ']' => Key::CloseBracket,
            '+' => Key::Plus,
            '-' => Key::Minus,
            '=' => Key::Equals,
",
    ),
    edit(
        TRANSLATE,
        "        K::Named(NamedKey::PageDown) => Key::PageDown,
",
        "        K::Named(NamedKey::PageDown) => Key::PageDown,
        K::Named(NamedKey::F1) => Key::F1,
        K::Named(NamedKey::F2) => Key::F2,
",
    ),
    edit(TRANSLATE, "match s.chars().next()? {", "match s.chars().next()?.to_ascii_lowercase() {"),
    edit(
        WINDOW,
        "fn is_cut_command(",
        "/// A file that was dropped on the window.
#[derive(Debug)]
struct DroppedPath(std::path::PathBuf);

impl egui::DroppedFile for DroppedPath {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn is_cut_command(",
    ),
];
