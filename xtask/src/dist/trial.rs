//! Installs the files that `dist` made into empty places, and compares their renders with those of the command here.

use crate::files::remove;
use crate::sha256;
use crate::shell::{root, run_to_end, succeeds};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Arguments of the command for the render that is compared, to standard output.
const RENDER: [&str; 9] = ["render", "--preset", "Marimba", "--note", "C4", "--bits", "32f", "-o", "-"];

/// The same from Python: the SHA-256 of the interleaved samples.
const PYTHON: &str = "import hashlib, sprung; print(hashlib.sha256(sprung.render('Marimba', ['C4']).astype('<f4').tobytes()).hexdigest())";

/// Tries each file that it knows how to install.
pub(super) fn run(folder: &Path, made: &[PathBuf]) -> Result<(), String> {
    let here = rendered(&mut Command::new(root().join("target/release/sprung")))?;
    for file in made {
        match file.extension().and_then(|ending| ending.to_str()) {
            Some("gz") => archive(folder, file, &here)?,
            Some("deb") => debian_package(folder, file, &here)?,
            Some("whl") => wheel(folder, file, &here)?,
            _ => continue,
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
fn archive(folder: &Path, file: &Path, here: &[u8]) -> Result<(), String> {
    let place = folder.join("unpacked");
    std::fs::create_dir_all(&place).map_err(|error| format!("{}: {error}", place.display()))?;
    run_to_end(Command::new("tar").arg("-xzf").arg(file).arg("-C").arg(&place), "tar")?;
    let name = file.file_name().unwrap_or_default().to_string_lossy().replace(".tar.gz", "");
    let found = rendered(&mut Command::new(place.join(name).join("bin/sprung")))?;
    remove(&place)?;
    same(&found, here)
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
    run_to_end(Command::new("python3").args(["-m", "venv"]).arg(&environment), "python3 -m venv")?;
    let python = environment.join("bin/python");
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
