//! Installs the files that `dist` made into empty places, and compares their renders with those of the command here.

use crate::files::remove;
use crate::python;
use crate::sha256;
use crate::shell::{cargo, run_to_end, succeeds};
use crate::system::{Profile, System};
use crate::wine::{Prefix, TARGET};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Arguments of the command for the render that is compared, to standard output.
const RENDER: [&str; 9] = ["render", "--preset", "Marimba", "--note", "C4", "--bits", "32f", "-o", "-"];

/// The same from Python: the SHA-256 of the interleaved samples.
const PYTHON: &str = "import hashlib, sprung; print(hashlib.sha256(sprung.render('Marimba', ['C4']).astype('<f4').tobytes()).hexdigest())";

/// Tries each file that it knows how to install.
pub(super) fn run(folder: &Path, made: &[PathBuf], system: &System) -> Result<(), String> {
    // The bits of another system are compared with those of this one, which are the same in every profile.
    let own = System::own();
    let command = match *system == own {
        true => folder.join("stage/bin").join(own.program("sprung")),
        false => own.build("rustc --package sprung-cli --bin sprung", Profile::Debug, &own.program("sprung"))?,
    };
    let here = rendered(&mut Command::new(command))?;
    for file in made {
        match file.extension().and_then(|ending| ending.to_str()) {
            Some("gz" | "zip") => archive(folder, file, &here, system)?,
            Some("deb") => debian_package(folder, file, &here)?,
            Some("exe") if !cfg!(windows) => installer(folder, file, &here)?,
            Some("whl") if *system == own => wheel(folder, file, &here)?,
            _ => {
                println!("{}: not tried", file.display());
                continue;
            }
        }
        println!("{}: installed, and renders the same samples", file.display());
    }
    Ok(())
}

/// The WAV that a command writes.
fn rendered(command: &mut Command) -> Result<Vec<u8>, String> {
    let output = command.args(RENDER).output().map_err(|error| error.to_string())?;
    if output.status.success() { Ok(output.stdout) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

fn same(found: &[u8], here: &[u8]) -> Result<(), String> {
    if found == here { Ok(()) } else { Err("what was installed renders other samples".to_owned()) }
}

/// Unpacks the archive and runs its command.
fn archive(folder: &Path, file: &Path, here: &[u8], system: &System) -> Result<(), String> {
    let place = folder.join("unpacked");
    std::fs::create_dir_all(&place).map_err(|error| format!("{}: {error}", place.display()))?;
    let mut unpack = Command::new(python::PROGRAM);
    unpack.args(["-c", "import shutil, sys; shutil.unpack_archive(*sys.argv[1:])"]).arg(file).arg(&place);
    run_to_end(&mut unpack, "unpack_archive")?;
    let name = file.file_name().unwrap_or_default().to_string_lossy().replace(".tar.gz", "").replace(".zip", "");
    let found = rendered(&mut system.command(&place.join(name).join("bin").join(system.program("sprung")))?)?;
    remove(&place)?;
    same(&found, here)
}

/// Installs the plugin and the command for Windows into a new prefix of Wine, uses them from there, and removes them.
fn installer(folder: &Path, file: &Path, here: &[u8]) -> Result<(), String> {
    let place = folder.join("prefix");
    let prefix = Prefix::at(place.clone())?;
    run_to_end(prefix.command(file).arg("/S"), "the installer")?;
    prefix.wait()?;
    // Windows' own shell finds the command on the search path.
    same(&rendered(prefix.command("cmd").args(["/c", "sprung"]))?, here)?;
    let common = r"C:\Program Files\Common Files";
    if place.join("drive_c/Program Files/Common Files/CLAP/Sprung.clap").is_file() {
        for tests in ["bits_of_the_command", "vst3_state"] {
            let mut hosts = cargo("test --manifest-path plugin/Cargo.toml --test hosts --target");
            hosts.args([TARGET, "--", tests]).env("SPRUNG_BUNDLES", common);
            prefix.lend_to_cargo(&mut hosts);
            run_to_end(&mut hosts, "the plugin in hosts, from the folders in which they look")?;
        }
    }
    run_to_end(prefix.command(r"C:\Program Files\Sprung\uninstall.exe").arg("/S"), "the uninstaller")?;
    prefix.wait()?;
    let left = left_of_sprung(&place)?;
    if !left.is_empty() {
        return Err(format!("the uninstaller has left {}", left.join(", ")));
    }
    remove(&place).map(drop)
}

/// The files in a prefix, and the files of its registry, that still name Sprung.
fn left_of_sprung(prefix: &Path) -> Result<Vec<String>, String> {
    let (mut left, mut folders) = (Vec::new(), vec![prefix.join("drive_c")]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?.flatten() {
            let path = entry.path();
            if entry.file_name().to_string_lossy().to_lowercase().contains("sprung") {
                left.push(path.display().to_string());
            }
            // Links lead out of the prefix.
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(path);
            }
        }
    }
    let registry = prefix.join("system.reg");
    let text = std::fs::read(&registry).map_err(|error| format!("{}: {error}", registry.display()))?;
    if String::from_utf8_lossy(&text).contains("Sprung") {
        left.push(registry.display().to_string());
    }
    Ok(left)
}

/// Installs the package into a system that has nothing but Debian’s essential packages. Needs an administrator’s rights.
fn debian_package(folder: &Path, file: &Path, here: &[u8]) -> Result<(), String> {
    if !succeeds("debootstrap", &["--version"]) {
        return Err("there is no debootstrap; install it with: sudo apt-get install debootstrap".to_owned());
    }
    let system = folder.join("chroot");
    let mut make = Command::new("debootstrap");
    make.args(["--variant=minbase", "stable"]).arg(&system).arg("http://deb.debian.org/debian");
    run_to_end(&mut make, "debootstrap")?;
    let package = system.join("sprung.deb");
    std::fs::copy(file, &package).map_err(|error| format!("{}: {error}", package.display()))?;
    let inside = |arguments: &[&str]| {
        let mut command = Command::new("chroot");
        command.arg(&system).args(arguments);
        command
    };
    run_to_end(&mut inside(&["dpkg", "--install", "/sprung.deb"]), "dpkg")?;
    let found = rendered(&mut inside(&["sprung"]))?;
    remove(&system)?;
    same(&found, here)
}

/// Installs the wheel into an empty virtual environment.
fn wheel(folder: &Path, file: &Path, here: &[u8]) -> Result<(), String> {
    let environment = folder.join("venv");
    run_to_end(Command::new(python::PROGRAM).args(["-m", "venv"]).arg(&environment), "python3 -m venv")?;
    let python = python::of(&environment, "python");
    let mut install = Command::new(&python);
    run_to_end(install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).arg(file), "pip")?;
    let output = Command::new(&python).args(["-c", PYTHON]).output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    remove(&environment)?;
    let data = here.windows(4).position(|four| four == b"data").ok_or("the WAV has no data")? + 8;
    let expected = sha256::of(&here[data..]);
    let found = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    if found == expected { Ok(()) } else { Err(format!("the wheel renders {found}, the command {expected}")) }
}
