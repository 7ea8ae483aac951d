//! `cargo xtask setup`: installs what the test suite needs on the system.

use crate::python;
use crate::shell::{has_standard_library, succeeds};
use crate::steps::{CHECKED, Suite};
use crate::wine;
use std::path::Path;
use std::process::Command;

/// How to find out whether something is installed.
enum Probe {
    /// A program that answers to `--version`.
    Program(&'static str),
    /// A program that answers to `-V`.
    ShortProgram(&'static str),
    /// A program in one of the folders of `PATH`.
    OnPath(&'static str),
    /// A file with this path.
    File(&'static str),
    /// A library that pkg-config knows.
    Library(&'static str),
    /// A library that the system's loader can find.
    Shared(&'static str),
    /// A driver of the graphics library.
    Driver(&'static str),
    /// Python modules, by their import names.
    Modules(&'static str),
}

/// Something that the suite needs besides Rust and its crates.
struct Requirement {
    probe: Probe,
    /// Debian package that contains it.
    package: &'static str,
    why: &'static str,
    /// The shortest suite that needs it.
    suite: Suite,
}

const WINDOW: &str = "the plugin's window loads it";
const DAWDREAMER: &str = "dawdreamer loads it";
const RECORDINGS: &str = "recordings of real instruments, to which presets are fitted";
const WINDOWS: &str = "runs what is built for Windows";
const SCREEN_READER: &str = "a bus on which the plugin's window is read as by a screen reader";

const REQUIREMENTS: &[Requirement] = &[
    Requirement {
        probe: Probe::Program("c++"),
        package: "g++",
        why: "compiles the original listing, which the classic coefficients are compared with",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Program("chromium"),
        package: "chromium",
        why: "opens the lab's reports and clicks in them",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Program("pkg-config"),
        package: "pkg-config",
        why: "finds the sound libraries that `sprung play` and the program are built with",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Library("alsa"),
        package: "libasound2-dev",
        why: "sound cards and MIDI ports, for `sprung play` and the program",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Library("jack"),
        package: "libjack-jackd2-dev",
        why: "JACK servers, for `sprung play` and the program",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Program("jackd"),
        package: "jackd2",
        why: "a sound server without a sound card, to play live notes on",
        suite: Suite::All,
    },
    Requirement {
        probe: Probe::ShortProgram("tmux"),
        package: "tmux",
        why: "a terminal to drive the view of sprung play in",
        suite: Suite::All,
    },
    Requirement {
        probe: Probe::Program("cc"),
        package: "gcc",
        why: "compiles the probe that watches the plugin's audio thread",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::OnPath("Xvfb"),
        package: "xvfb",
        why: "a screen that nobody looks at, for the plugin's window",
        suite: Suite::All,
    },
    Requirement { probe: Probe::Shared("libEGL.so.1"), package: "libegl1", why: WINDOW, suite: Suite::All },
    Requirement { probe: Probe::Shared("libX11-xcb.so.1"), package: "libx11-xcb1", why: WINDOW, suite: Suite::All },
    Requirement {
        probe: Probe::Shared("libxkbcommon-x11.so.0"),
        package: "libxkbcommon-x11-0",
        why: WINDOW,
        suite: Suite::All,
    },
    Requirement {
        probe: Probe::Driver("swrast_dri.so"),
        package: "libgl1-mesa-dri",
        why: "draws the plugin's window without a graphics card",
        suite: Suite::All,
    },
    Requirement { probe: Probe::OnPath("dbus-daemon"), package: "dbus", why: SCREEN_READER, suite: Suite::All },
    Requirement {
        probe: Probe::File("/usr/libexec/at-spi-bus-launcher"),
        package: "at-spi2-core",
        why: SCREEN_READER,
        suite: Suite::All,
    },
    Requirement {
        probe: Probe::Modules("ensurepip, venv"),
        package: "python3-venv",
        why: "pedalboard and dawdreamer, VST3 hosts that Python drives",
        suite: Suite::Commit,
    },
    Requirement { probe: Probe::Shared("libGL.so.1"), package: "libgl1", why: DAWDREAMER, suite: Suite::Commit },
    Requirement {
        probe: Probe::Shared("libglib-2.0.so.0"),
        package: "libglib2.0-0",
        why: DAWDREAMER,
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Shared("libatomic.so.1"),
        package: "libatomic1",
        why: "pedalboard loads it",
        suite: Suite::Commit,
    },
    Requirement {
        probe: Probe::Program("valgrind"),
        package: "valgrind",
        why: "counts instructions, so that speed is watched on busy machines",
        suite: Suite::All,
    },
    Requirement {
        probe: Probe::OnPath("openbox"),
        package: "openbox",
        why: "gives the focus to windows in Wine",
        suite: Suite::All,
    },
    Requirement { probe: Probe::Program("wine"), package: "wine", why: WINDOWS, suite: Suite::All },
    Requirement { probe: Probe::File("/usr/lib/wine/wine64"), package: "wine64", why: WINDOWS, suite: Suite::All },
    Requirement {
        probe: Probe::Program("x86_64-w64-mingw32-gcc"),
        package: "gcc-mingw-w64-x86-64-posix",
        why: "links programs for Windows",
        suite: Suite::All,
    },
    Requirement { probe: Probe::OnPath("fluidsynth"), package: "fluidsynth", why: RECORDINGS, suite: Suite::All },
    Requirement {
        probe: Probe::File("/usr/share/sounds/sf2/FluidR3_GM.sf2"),
        package: "fluid-soundfont-gm",
        why: RECORDINGS,
        suite: Suite::All,
    },
    Requirement {
        probe: Probe::File("/usr/share/hydrogen/data/drumkits/ForzeeStereo/drumkit.xml"),
        package: "hydrogen-drumkits",
        why: RECORDINGS,
        suite: Suite::All,
    },
];

/// Components of the Rust toolchain, each with the cargo command that it provides.
const COMPONENTS: [(&str, &str); 2] = [("rustfmt", "fmt"), ("clippy", "clippy")];

impl Requirement {
    fn is_met(&self) -> bool {
        match self.probe {
            Probe::Program(program) => succeeds(program, &["--version"]),
            Probe::ShortProgram(program) => succeeds(program, &["-V"]),
            Probe::OnPath(program) => std::env::var_os("PATH")
                .is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join(program).is_file())),
            Probe::File(path) => Path::new(path).is_file(),
            Probe::Library(library) => succeeds("pkg-config", &["--exists", library]),
            Probe::Shared(library) => Command::new("/sbin/ldconfig")
                .arg("-p")
                .output()
                .is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains(&format!("{library} "))),
            Probe::Driver(driver) => {
                let has_it = |folder: std::fs::DirEntry| folder.path().join("dri").join(driver).is_file();
                Path::new("/usr/lib").read_dir().is_ok_and(|mut folders| folders.any(|folder| folder.is_ok_and(has_it)))
            }
            Probe::Modules(modules) => succeeds("python3", &["-c", &format!("import {modules}")]),
        }
    }
}

/// Installs what a suite needs, or tells the user how to install it.
pub(crate) fn run(suite: Suite) -> Result<(), String> {
    let mut problems = Vec::new();
    for (component, command) in COMPONENTS {
        if !succeeds("cargo", &[command, "--version"]) {
            println!("missing: {component}, a component of the Rust toolchain");
            if !succeeds("rustup", &["component", "add", component]) {
                problems.push(format!("install it with: rustup component add {component}"));
            }
        }
    }
    if suite == Suite::All {
        for target in CHECKED.into_iter().chain([wine::TARGET]) {
            if !has_standard_library(target, None) && !succeeds("rustup", &["target", "add", target]) {
                problems.push(format!("install it with: rustup target add {target}"));
            }
        }
        if !succeeds("cargo", &["hack", "--version"]) && !succeeds("cargo", &["install", "--locked", "cargo-hack"]) {
            problems.push("install it with: cargo install --locked cargo-hack".to_owned());
        }
    }
    // They are Debian's packages. Elsewhere the tests that need them are left out.
    let is_missing = |requirement: &&Requirement| {
        cfg!(target_os = "linux")
            && (requirement.suite == Suite::Commit || suite == Suite::All)
            && !requirement.is_met()
    };
    let missing: Vec<&Requirement> = REQUIREMENTS.iter().filter(is_missing).collect();
    for Requirement { package, why, .. } in &missing {
        println!("missing: {package}: {why}");
    }
    if !missing.is_empty() {
        let packages: Vec<&str> = missing.iter().map(|requirement| requirement.package).collect();
        let installed = install(&packages);
        problems.extend(missing.iter().filter(|requirement| !requirement.is_met()).map(
            |Requirement { package, .. }| match &installed {
                Ok(()) => format!("{package} is installed, but what it should bring is not there"),
                Err(by_hand) => format!("{package} is missing; {by_hand}"),
            },
        ));
    }
    problems.extend(python::install().err());
    if problems.is_empty() {
        println!("all that the tests need is there");
        return Ok(());
    }
    Err(problems.join("\n"))
}

/// Installs Debian packages if this needs no password.
fn install(packages: &[&str]) -> Result<(), String> {
    let by_hand = format!("install with: sudo apt-get install {}", packages.join(" "));
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0");
    let prefix: &[&str] = match (is_root, succeeds("sudo", &["-n", "true"])) {
        (true, _) => &[],
        (false, true) => &["sudo", "-n"],
        (false, false) => return Err(by_hand),
    };
    let apt = |arguments: &[&str]| {
        let words = [prefix, &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "--yes"], arguments].concat();
        Command::new(words[0]).args(&words[1..]).status().is_ok_and(|status| status.success())
    };
    let install = [&["install", "--no-install-recommends"], packages].concat();
    if apt(&["update"]) && apt(&install) { Ok(()) } else { Err(by_hand) }
}
