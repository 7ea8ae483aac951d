//! The window as a screen reader finds it: AccessKit's tree over AT-SPI, on a session bus of the test's own.

use crate::host::Instance;
use crate::patches::patch_in;
use crate::process::{command, succeeds, wait_until};
use crate::screen::Screen;
use crate::window::{Editor, Parent};
use sprung::params::Param;
use std::io::BufRead as _;
use std::path::Path;
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::Duration;
use zbus::blocking::{Connection, Proxy, connection, proxy};
use zbus::proxy::CacheProperties;
use zbus::zvariant::OwnedObjectPath;

/// The program that starts the bus of screen readers.
const LAUNCHER: &str = "/usr/libexec/at-spi-bus-launcher";
/// Numbers of AT-SPI's roles.
const COMBO_BOX: u32 = 11;
const SLIDER: u32 = 51;
const PAGE_TAB: u32 = 37;
const TOGGLE_BUTTON: u32 = 62;
const ENTRY: u32 = 79;
const ACCESSIBLE: &str = "org.a11y.atspi.Accessible";
/// Longest time that a request may take.
const PATIENCE: Duration = Duration::from_secs(10);
/// Number of times that the library is loaded, its window opened and read, and the library closed.
const TIMES: usize = 5;

/// The program that these tests need besides a screen and that is missing here.
pub(crate) fn missing() -> Option<String> {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    if !std::env::split_paths(&paths).any(|folder| folder.join("dbus-daemon").is_file()) {
        return Some("dbus-daemon".to_owned());
    }
    (!Path::new(LAUNCHER).is_file()).then(|| LAUNCHER.to_owned())
}

/// A session bus without a session, and a home of its own, so that the desktop's settings stay as they are.
struct Session {
    daemon: Child,
    address: String,
    _home: tempfile::TempDir,
}

impl Session {
    fn new(screen: &Screen) -> Self {
        let home = tempfile::tempdir().unwrap();
        let mut daemon = Command::new("dbus-daemon");
        // Its children, which talk to screen readers, have the same environment.
        daemon.env("HOME", home.path()).env("XDG_RUNTIME_DIR", home.path()).env("GSETTINGS_BACKEND", "memory");
        daemon.env_remove("AT_SPI_BUS_ADDRESS");
        daemon.args(["--session", "--nofork", "--print-address=1"]).env("DISPLAY", &screen.display);
        let mut daemon = daemon.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("dbus-daemon starts");
        let mut address = String::new();
        let stdout = daemon.stdout.take().expect("stdout is piped");
        std::io::BufReader::new(stdout).read_line(&mut address).unwrap();
        assert!(!address.trim().is_empty(), "dbus-daemon has told no address");
        Self { daemon, address: address.trim().to_owned(), _home: home }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = self.daemon.kill();
        let _ = self.daemon.wait();
    }
}

pub(crate) fn it_reads_and_turns_knobs_and_the_library_can_be_closed() {
    let screen = Screen::new();
    let session = Session::new(&screen);
    let mut command = command("screen-reader");
    command.env("DISPLAY", &screen.display).env("DBUS_SESSION_BUS_ADDRESS", &session.address);
    print!("{}", succeeds(command));
}

/// A widget: the connection that has it, and its path there.
type Node = (String, OwnedObjectPath);

/// A screen reader.
struct Reader {
    bus: Connection,
}

impl Reader {
    /// Switches accessibility on for the session, and connects to its bus.
    fn new() -> zbus::Result<Self> {
        let session = connection::Builder::session()?.method_timeout(PATIENCE).build()?;
        let status = Proxy::new(&session, "org.a11y.Bus", "/org/a11y/bus", "org.a11y.Status")?;
        status.set_property("IsEnabled", true)?;
        let address: String =
            Proxy::new(&session, "org.a11y.Bus", "/org/a11y/bus", "org.a11y.Bus")?.call("GetAddress", &())?;
        Ok(Self { bus: connection::Builder::address(address.as_str())?.method_timeout(PATIENCE).build()? })
    }

    fn proxy<'a>(&'a self, (owner, path): &'a Node, interface: &'a str) -> zbus::Result<Proxy<'a>> {
        // AT-SPI's registry does not answer when all properties are asked for at once, as a cache would.
        let builder = proxy::Builder::new(&self.bus).destination(owner.as_str())?.path(path)?.interface(interface)?;
        builder.cache_properties(CacheProperties::No).build()
    }

    /// Role, name and children of a widget.
    fn read(&self, node: &Node) -> zbus::Result<(u32, String, Vec<Node>)> {
        let widget = self.proxy(node, ACCESSIBLE)?;
        Ok((widget.call("GetRole", &())?, widget.get_property("Name")?, widget.call("GetChildren", &())?))
    }

    /// The first widget with this role and name. Widgets that vanish during the search are passed over.
    fn find(&self, role: u32, name: &str) -> Option<Node> {
        let root = OwnedObjectPath::try_from("/org/a11y/atspi/accessible/root").unwrap();
        let mut waiting = vec![("org.a11y.atspi.Registry".to_owned(), root)];
        while let Some(node) = waiting.pop() {
            if let Ok((its_role, its_name, children)) = self.read(&node) {
                if its_role == role && its_name == name {
                    return Some(node);
                }
                waiting.extend(children);
            }
        }
        None
    }
}

/// Runs in the process that the test starts.
pub(crate) fn work() -> ExitCode {
    let reader = Reader::new().expect("a bus for screen readers");
    for _ in 0..TIMES {
        // Opens the library, which the host closes with the instance.
        let mut instance = Instance::new();
        let parent = Parent::new();
        let editor = Editor::open(&mut instance, &parent);
        let finds = |instance: &mut Instance, role: u32, name: &str| {
            let mut found = None;
            wait_until(&format!("a widget named {name}, of the role {role}"), || {
                instance.run_callbacks();
                found = reader.find(role, name);
                found.is_some()
            });
            found.unwrap()
        };
        let act = |node: &Node| {
            reader.proxy(node, "org.a11y.atspi.Action").unwrap().call::<_, _, bool>("DoAction", &(0_i32)).unwrap()
        };
        assert!(act(&finds(&mut instance, PAGE_TAB, "Sound")));
        assert!(act(&finds(&mut instance, PAGE_TAB, "Mallet")));
        let knob = finds(&mut instance, SLIDER, "Mallet hardness");
        let value = reader.proxy(&knob, "org.a11y.atspi.Value").unwrap();
        let range = ["MinimumValue", "MaximumValue"].map(|name| value.get_property::<f64>(name).unwrap());
        assert_eq!(range, [0.0, 100.0]);
        value.set_property("CurrentValue", 12.0).unwrap();
        let described = |node: &Node| reader.proxy(node, ACCESSIBLE).unwrap().get_property::<String>("Description");
        wait_until("the knob tells its value and unit", || {
            instance.run_callbacks();
            described(&knob).is_ok_and(|text| text == "12 %")
        });
        wait_until("the knob turns", || {
            instance.run_callbacks();
            instance.flush(&[]);
            patch_in(&instance.save()).get(Param::MalletHardness) == 12.0
        });
        let component = reader.proxy(&knob, "org.a11y.atspi.Component").unwrap();
        let (left, top, width, height): (i32, i32, i32, i32) = component.call("GetExtents", &(0_u32)).unwrap();
        let is_in_the_window = (0..1_100).contains(&left) && (340..600).contains(&top);
        assert!(is_in_the_window && width > 20 && height > 20, "{left}, {top}: {width} × {height}");
        assert!(act(&finds(&mut instance, PAGE_TAB, "Noise")));
        let choice = finds(&mut instance, COMBO_BOX, "Noise decay");
        assert_eq!(described(&choice).unwrap(), "exponential");
        let browse = finds(&mut instance, TOGGLE_BUTTON, "Browse");
        assert!(act(&browse));
        finds(&mut instance, ENTRY, "Search");
        editor.close(&mut instance);
        wait_until("the window's widgets are gone", || reader.find(ENTRY, "Search").is_none());
        drop(instance);
        // AccessKit's thread runs on, so the library must be there even though it is closed.
        let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
        assert!(maps.contains("Sprung.clap"), "the library was unloaded");
    }
    ExitCode::SUCCESS
}
