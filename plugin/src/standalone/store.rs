//! The files in which the program keeps its state and its choice of devices between runs.

use crate::devices::Chosen;
use crate::params::SprungParams;
use crate::state::State;
use sprung::internals::files::{Inputs, Output, Target};
use std::ffi::OsString;
use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of the file.
const NAME: &str = "standalone.json";

/// The file of the state; none if the system names no folder for it.
pub(super) struct Store {
    file: Option<PathBuf>,
    /// Whether this program may write the files: no other program does, and nothing in them would be lost.
    may_write: bool,
    /// The state in the file, if it was read completely or written by this program.
    last: Option<State>,
    /// An open lock file, which tells other programs that this one writes the state.
    lock: Option<File>,
}

impl Store {
    /// The files of this user.
    pub(super) fn of_user() -> Self {
        let file = folder(&|name| std::env::var_os(name)).map(|folder| folder.join(NAME));
        Self { file, may_write: true, last: None, lock: None }
    }

    /// Loads the state of the last run. Returns a message for the user. A file that is not understood completely is set
    /// aside, so that nothing in it is lost.
    pub(super) fn restore(&mut self, params: &SprungParams) -> Option<String> {
        let file = self.file.clone()?;
        let is_taken = self.claim(&file);
        self.may_write = !is_taken;
        let taken = "another Sprung is open and keeps its state: what is changed in this one is not kept".to_owned();
        let message = self.read(&file, params);
        match message {
            Some(message) if is_taken => Some(format!("{taken}; {message}")),
            message => message.or(is_taken.then_some(taken)),
        }
    }

    /// Claims the file. Returns whether another program has claimed it.
    fn claim(&mut self, file: &Path) -> bool {
        let open = || {
            std::fs::create_dir_all(file.parent()?).ok()?;
            File::options().create(true).truncate(false).write(true).open(file.with_extension("lock")).ok()
        };
        // If the folder cannot be written or locked, saving the state reports the problem.
        let Some(lock) = open() else { return false };
        let is_taken = matches!(lock.try_lock(), Err(TryLockError::WouldBlock));
        self.lock = Some(lock);
        is_taken
    }

    fn read(&mut self, file: &Path, params: &SprungParams) -> Option<String> {
        let text = match std::fs::read(file) {
            Ok(bytes) => String::from_utf8(bytes).map_err(|_| "not a state of Sprung: it is not text".to_owned()),
            Err(error) if error.kind() == ErrorKind::NotFound => return None,
            Err(error) => {
                // A file that cannot be read must not be overwritten.
                self.may_write = false;
                let stays = "it stays as it is, and what is changed now is not kept";
                return Some(format!("{}: cannot be read: {error}; {stays}", file.display()));
            }
        };
        let complaint = match text.and_then(|text| State::parse(&text)) {
            Ok(read) => {
                let complaint = (!read.complaints.is_empty()).then(|| read.complaints.join("; "));
                params.load(read);
                self.last = complaint.is_none().then(|| params.state());
                complaint?
            }
            Err(complaint) => complaint,
        };
        Some(self.not_understood(file, &complaint))
    }

    /// Sets a file aside that is not understood, if this program may. Returns a message for the user.
    fn not_understood(&mut self, file: &Path, complaint: &str) -> String {
        if !self.may_write {
            return format!("{}: {complaint}", file.display());
        }
        let aside = match set_aside(file) {
            Ok(aside) => format!("it is kept as {}", aside.display()),
            Err(error) => {
                // A file that cannot be moved must not be overwritten.
                self.may_write = false;
                format!("it stays, and nothing else is kept this time: {error}")
            }
        };
        format!("{}: {complaint}; {aside}", file.display())
    }

    /// Writes the state if it has changed since the last time.
    pub(super) fn save_if_changed(&mut self, params: &Arc<SprungParams>) -> Result<(), String> {
        if self.last.as_ref() == Some(&params.state()) { Ok(()) } else { self.save(params) }
    }

    /// Writes the state. The file is replaced only when the new one is completely on disk.
    pub(super) fn save(&mut self, params: &SprungParams) -> Result<(), String> {
        let Some(file) = self.file.as_ref().filter(|_| self.may_write) else { return Ok(()) };
        let state = params.state();
        write(file, &state.to_json()).map_err(|error| format!("the state cannot be kept: {error}"))?;
        self.last = Some(state);
        Ok(())
    }

    /// The choice of devices of the last run, and a message for the user.
    pub(super) fn saved_devices(&mut self) -> (Chosen, Option<String>) {
        let Some(file) = self.devices_file() else { return Default::default() };
        match std::fs::read(&file) {
            Ok(bytes) => match serde_json::from_slice(&bytes) {
                Ok(chosen) => (chosen, None),
                Err(error) => {
                    (Chosen::default(), Some(self.not_understood(&file, &format!("no choice of devices: {error}"))))
                }
            },
            Err(error) if error.kind() == ErrorKind::NotFound => Default::default(),
            Err(error) => {
                self.may_write = false;
                (Chosen::default(), Some(format!("{}: cannot be read: {error}", file.display())))
            }
        }
    }

    /// Writes the choice of devices.
    pub(super) fn save_devices(&self, chosen: &Chosen) -> Result<(), String> {
        let Some(file) = self.devices_file().filter(|_| self.may_write) else { return Ok(()) };
        let written = serde_json::to_string(chosen).map_err(|error| error.to_string());
        let written = written.and_then(|text| write(&file, &(text + "\n")).map_err(|error| error.to_string()));
        written.map_err(|error| format!("the choice of devices cannot be kept: {error}"))
    }

    /// The file of the choice of devices, beside that of the state. It is separate, since the state has the same form
    /// as in a host's project.
    fn devices_file(&self) -> Option<PathBuf> {
        self.file.as_ref().map(|file| file.with_file_name("devices.json"))
    }
}

/// Writes a file. An old one is replaced only when the new one is completely on disk.
fn write(file: &Path, text: &str) -> sprung::Result<()> {
    let failed = |error| sprung::Error::io(file.display().to_string(), error);
    file.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(failed)?;
    let mut output = Output::create(&Target::new(file), true, &Inputs::default())?;
    output.stream().write_all(text.as_bytes()).map_err(failed)?;
    output.commit()
}

/// Renames a file to a name that is not in use, and returns the new name.
fn set_aside(file: &Path) -> std::io::Result<PathBuf> {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let mut number = 1;
    loop {
        let aside = file.with_file_name(format!("{name}.not-understood-{number}.json"));
        // A hard link fails if the name is in use; renaming would replace that file.
        match std::fs::hard_link(file, &aside) {
            Ok(()) => return std::fs::remove_file(file).map(|()| aside),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
            Err(error) => return Err(error),
        }
    }
}

/// The folder for the program's state of this user.
fn folder(variable: &dyn Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let folder = |name: &str| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    if cfg!(windows) {
        return Some(folder("LOCALAPPDATA")?.join("Sprung"));
    }
    if cfg!(target_os = "macos") {
        return Some(folder("HOME")?.join("Library/Application Support/Sprung"));
    }
    // XDG Base Directory Specification 0.8: relative paths must be ignored.
    let state = folder("XDG_STATE_HOME").or_else(|| Some(folder("HOME")?.join(".local/state")))?;
    Some(state.join("sprung"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::VIEW;
    use sprung::preset::Playable;

    fn store(folder: &Path) -> Store {
        Store { file: Some(folder.join("sprung").join(NAME)), may_write: true, last: None, lock: None }
    }

    fn marimba() -> Arc<SprungParams> {
        let params = Arc::new(SprungParams::default());
        params.load(State::new(Playable::find("Marimba").unwrap(), 7, VIEW).into());
        params
    }

    #[test]
    fn the_state_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let (params, empty) = (marimba(), SprungParams::default());
        params.set_view(|view| view.zoom = 150);
        assert_eq!(store(folder.path()).restore(&empty), None, "there is nothing yet");
        let mut writer = store(folder.path());
        writer.save_if_changed(&params).unwrap();
        assert_eq!(store(folder.path()).restore(&empty), None);
        assert_eq!(empty.state(), params.state());
        let file = folder.path().join("sprung").join(NAME);
        std::fs::remove_file(&file).unwrap();
        writer.save_if_changed(&params).unwrap();
        assert!(!file.exists(), "what has not changed is not written again");
        params.set_view(|view| view.zoom = 75);
        writer.save_if_changed(&params).unwrap();
        assert!(file.exists());
    }

    #[test]
    fn what_is_not_understood_is_kept_aside_and_said() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("sprung").join(NAME);
        std::fs::create_dir(file.parent().unwrap()).unwrap();
        let newer = marimba().state().to_json().replacen('{', "{\"of_next_year\":1,", 1);
        for (number, text) in [(1, &b"{\"preset\": 1"[..]), (2, b"\xff\xfe"), (3, newer.as_bytes())] {
            std::fs::write(&file, text).unwrap();
            let params = SprungParams::default();
            let message = store(folder.path()).restore(&params).unwrap();
            let aside = file.with_file_name(format!("standalone.not-understood-{number}.json"));
            assert!(message.contains(NAME) && message.contains(aside.to_str().unwrap()), "{message}");
            assert_eq!(std::fs::read(&aside).unwrap(), text, "nothing of it is lost");
            assert!(!file.exists());
            assert_eq!(params.name() == "Marimba", number == 3, "what can be read of a newer state is taken over");
        }
    }

    #[test]
    fn one_program_at_a_time_keeps_its_state() {
        let folder = tempfile::tempdir().unwrap();
        let (mut first, mut second) = (store(folder.path()), store(folder.path()));
        first.save(&marimba()).unwrap();
        assert_eq!(first.restore(&SprungParams::default()), None);
        let params = SprungParams::default();
        let message = second.restore(&params).unwrap();
        assert!(
            message.starts_with("another Sprung is open") && params.name() == "Marimba",
            "it begins with it: {message}"
        );
        let file = folder.path().join("sprung").join(NAME);
        let before = std::fs::read(&file).unwrap();
        second.save(&SprungParams::default()).unwrap();
        let chosen = Chosen { rate: Some(96_000), ..Chosen::default() };
        first.save_devices(&chosen).unwrap();
        assert_eq!(second.saved_devices(), (chosen.clone(), None));
        second.save_devices(&Chosen { rate: Some(44_100), ..Chosen::default() }).unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), before, "and leaves it as it is");
        assert_eq!(first.saved_devices(), (chosen, None));
        drop(first);
        assert_eq!(store(folder.path()).restore(&params), None, "the next one may");
    }

    #[test]
    fn what_cannot_be_read_stays_where_it_is() {
        let folder = tempfile::tempdir().unwrap();
        // A folder of that name can be opened, but not read as a file.
        let file = folder.path().join("sprung").join(NAME);
        std::fs::create_dir_all(&file).unwrap();
        let (mut store, params) = (store(folder.path()), SprungParams::default());
        let message = store.restore(&params).unwrap();
        assert!(message.contains("cannot be read") && !message.contains("kept as"), "{message}");
        store.save(&params).unwrap();
        assert!(file.is_dir());
    }

    #[test]
    fn the_choice_of_devices_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = store(folder.path());
        assert_eq!(store.saved_devices(), (Chosen::default(), None));
        let chosen = Chosen { host: Some("jack".to_owned()), rate: Some(96_000), ..Chosen::default() };
        store.save_devices(&chosen).unwrap();
        assert_eq!(store.saved_devices(), (chosen, None));
        std::fs::write(folder.path().join("sprung/devices.json"), "{\"speed\": 1}").unwrap();
        let (chosen, message) = store.saved_devices();
        assert!(chosen == Chosen::default() && message.is_some_and(|message| message.contains("devices.json")));
        let aside = folder.path().join("sprung/devices.not-understood-1.json");
        assert_eq!(std::fs::read_to_string(aside).unwrap(), "{\"speed\": 1}", "nothing of it is lost");
    }

    #[test]
    fn the_folder_is_that_of_the_system() {
        let find = |variables: &[(&str, &str)]| {
            let variable = |name: &str| variables.iter().find(|(known, _)| *known == name).map(|(_, path)| path.into());
            folder(&variable)
        };
        if cfg!(windows) {
            assert_eq!(find(&[("LOCALAPPDATA", r"C:\h\Local")]), Some(r"C:\h\Local\Sprung".into()));
        } else if cfg!(target_os = "macos") {
            assert_eq!(find(&[("HOME", "/h")]), Some("/h/Library/Application Support/Sprung".into()));
        } else {
            assert_eq!(find(&[("XDG_STATE_HOME", "/s"), ("HOME", "/h")]), Some("/s/sprung".into()));
            assert_eq!(find(&[("XDG_STATE_HOME", "s"), ("HOME", "/h")]), Some("/h/.local/state/sprung".into()));
        }
        assert_eq!(find(&[]), None);
    }
}
