//! A program from which files are dragged onto another one's window: the source of the XDND protocol, version 5.

use crate::process::wait_until;
use std::path::Path;
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT,
    SelectionNotifyEvent, SelectionRequestEvent, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// The version of the protocol.
const VERSION: u32 = 5;

/// A time of the server, as events of the mouse have it.
const TIME: u32 = 1_000;

/// Something that is dragged.
pub(crate) struct Drag {
    connection: RustConnection,
    /// The source's window.
    window: u32,
    /// The window that it is dragged over.
    target: u32,
    list: String,
    /// Whether the target accepts the files; `None` before it has answered.
    status: Option<bool>,
    /// Whether the target took the dropped files; `None` before it has answered.
    finished: Option<bool>,
}

impl Drag {
    /// Files that are dragged over a window of a screen, or over the one inside it that takes files.
    pub(crate) fn over(display: &str, window: u32, files: &[&Path]) -> Self {
        let (connection, screen) = x11rb::connect(Some(display)).expect("there is an X server");
        let root = connection.setup().roots[screen].root;
        let source = connection.generate_id().unwrap();
        let aux = CreateWindowAux::new();
        connection.create_window(0, source, root, -1, -1, 1, 1, 0, WindowClass::INPUT_ONLY, 0, &aux).unwrap();
        let list = files.iter().map(|file| uri(file) + "\r\n").collect();
        let mut drag = Self { connection, window: source, target: window, list, status: None, finished: None };
        drag.target = drag.aware(window).expect("the window takes what is dropped");
        let selection = drag.atom("XdndSelection");
        drag.connection.set_selection_owner(source, selection, x11rb::CURRENT_TIME).unwrap().check().unwrap();
        drag
    }

    /// Drags to a place of the screen, drops there, and waits until the target has answered. Returns whether it took it.
    #[track_caller]
    pub(crate) fn drop_at(mut self, [x, y]: [u32; 2]) -> bool {
        let [list, copy] = ["text/uri-list", "XdndActionCopy"].map(|name| self.atom(name));
        self.send("XdndEnter", [self.window, VERSION << 24, list, 0, 0]);
        // Like a hand, the drag passes several places.
        for step in 0..4 {
            let place = (x - 3 + step) << 16 | y;
            self.status = None;
            self.send("XdndPosition", [self.window, 0, place, TIME, copy]);
            if step == 0 {
                wait_until("the target says whether it takes it", || {
                    self.answer();
                    self.status.is_some()
                });
                if self.status == Some(false) {
                    self.send("XdndLeave", [self.window, 0, 0, 0, 0]);
                    return false;
                }
            }
        }
        self.send("XdndDrop", [self.window, 0, TIME, 0, 0]);
        wait_until("the target has taken what was dropped", || {
            self.answer();
            self.finished.is_some()
        });
        self.finished == Some(true)
    }

    fn atom(&self, name: &str) -> u32 {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    /// The window, or the first one inside it, that declares that it accepts drops (`XdndAware`).
    fn aware(&self, window: u32) -> Option<u32> {
        let aware = self.atom("XdndAware");
        let found = self.connection.get_property(false, window, aware, AtomEnum::ATOM, 0, 1).unwrap().reply().unwrap();
        if found.value32().and_then(|mut versions| versions.next()).is_some_and(|version| version >= 3) {
            return Some(window);
        }
        let tree = self.connection.query_tree(window).unwrap().reply().unwrap();
        tree.children.into_iter().find_map(|inner| self.aware(inner))
    }

    fn send(&self, kind: &str, data: [u32; 5]) {
        let message = ClientMessageEvent::new(32, self.target, self.atom(kind), data);
        self.connection.send_event(false, self.target, EventMask::NO_EVENT, message).unwrap().check().unwrap();
    }

    /// Answers the target's requests and records its messages.
    fn answer(&mut self) {
        let [status, finished] = ["XdndStatus", "XdndFinished"].map(|name| self.atom(name));
        while let Some(event) = self.connection.poll_for_event().unwrap() {
            match event {
                Event::SelectionRequest(request) => self.hand_over(&request),
                Event::ClientMessage(message) => {
                    let accepts = message.data.as_data32()[1] & 1 == 1;
                    if message.type_ == status {
                        self.status = Some(accepts);
                    } else if message.type_ == finished {
                        self.finished = Some(accepts);
                    }
                }
                _ => {}
            }
        }
    }

    /// Gives the list of files to a window that requests it, and refuses every other format.
    fn hand_over(&self, request: &SelectionRequestEvent) {
        let is_list = request.target == self.atom("text/uri-list");
        let SelectionRequestEvent { requestor, property, target, .. } = *request;
        if is_list {
            let list = self.list.as_bytes();
            self.connection.change_property8(PropMode::REPLACE, requestor, property, target, list).unwrap();
        }
        let notify = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time: request.time,
            requestor,
            selection: request.selection,
            target,
            property: if is_list { property } else { 0 },
        };
        self.connection.send_event(false, requestor, EventMask::NO_EVENT, notify).unwrap().check().unwrap();
    }
}

/// The URI of a file. Bytes other than letters, digits and a few marks are percent-encoded.
fn uri(file: &Path) -> String {
    use std::os::unix::ffi::OsStrExt as _;
    let written = |byte: &u8| match byte {
        b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'/' | b'.' | b'-' | b'_' | b'~' => char::from(*byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    "file://".to_owned() + &file.as_os_str().as_bytes().iter().map(written).collect::<String>()
}
