//! `cargo xtask dist`: makes the downloads in `dist`: an archive, an installer, a wheel for Python, and checksums.

mod licences;
mod macos;
mod made;
mod sign;
mod trial;

use crate::bundle;
use crate::files::{copy, remove, replace, write};
use crate::patch;
use crate::python;
use crate::sha256;
use crate::shell::{cargo, root, run_to_end, succeeds};
use crate::symbols;
use crate::system::{Profile, System};
use made::{Made, beside};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What to make, beside the archive.
pub(crate) struct Options {
    /// Leave the plugin out.
    pub(crate) no_plugin: bool,
    /// Make a wheel for Python as well.
    pub(crate) wheel: bool,
    /// Install the packages, and render with what was installed.
    pub(crate) trial: bool,
    /// The system to make it for.
    pub(crate) system: System,
}

/// Completions by shell, with the names of their files.
const COMPLETIONS: [(&str, &str); 4] =
    [("bash", "sprung.bash"), ("zsh", "_sprung"), ("fish", "sprung.fish"), ("powershell", "sprung.ps1")];

/// Makes all files for which the tools are installed, reports those left out, and tries the files if that is requested.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let system = &options.system;
    let folder = system.folder().join("dist");
    remove(&folder)?;
    let stage = stage(&folder, options)?;
    let (mut made, mut left_out) = (vec![archive(&stage, system)?], Vec::new());
    let installer = match system.name {
        "windows" => installer(&stage, options)?,
        "macos" => macos::package(&stage)?,
        _ if *system == System::own() => debian_package(&folder)?,
        _ => Made::Nothing("the Debian package: it is made where the command is built".to_owned()),
    };
    let wheel = options.wheel.then(|| wheel(&folder, system)).transpose()?;
    for file in [Some(installer), wheel].into_iter().flatten() {
        match file {
            Made::File(file) => made.push(file),
            Made::Nothing(reason) => left_out.push(reason),
        }
    }
    if *system == System::own() {
        package_for_crates_io()?;
    }
    let sums = made.iter().map(|file| checksum(file)).collect::<Result<String, String>>()?;
    write(&folder.join("SHA256SUMS"), &sums)?;
    print!("{sums}");
    left_out.iter().for_each(|message| println!("left out: {message}"));
    if options.trial {
        trial::run(&folder, &made, system)?;
    }
    Ok(())
}

/// The folder that is packed: `sprung-VERSION-CPU-SYSTEM`.
fn stage(folder: &Path, options: &Options) -> Result<PathBuf, String> {
    let (system, version) = (&options.system, env!("CARGO_PKG_VERSION"));
    let stage = folder.join(format!("sprung-{version}-{}-{}", system.architecture, system.name));
    let is_linux = system.name == "linux";
    // On Linux, what plays needs libraries of the system's, which not every system has.
    let features = if is_linux { "" } else { "--features play" };
    let build = format!("rustc --package sprung-cli --bin sprung {features}");
    let command = program(system, &build, "sprung", &stage)?;
    let run = |arguments: &[&str]| {
        let output = system.command(&command)?.args(arguments).output().map_err(|error| error.to_string())?;
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.success() { Ok(output.stdout) } else { Err(format!("sprung {}: {said}", arguments.join(" "))) }
    };
    if system.name != "windows" {
        run(&["man", &stage.join("man/man1").to_string_lossy()])?;
    }
    for (shell, file) in COMPLETIONS {
        let script = run(&["completions", shell])?;
        write(&stage.join("completions").join(file), &String::from_utf8_lossy(&script))?;
    }
    for file in ["README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root().join(file), &stage.join(file))?;
    }
    copy(&root().join("assets/manual"), &stage.join("manual"))?;
    let mut manifests = vec!["src/cli/Cargo.toml"];
    if !options.no_plugin {
        let bundles = bundle::run(system, Profile::Release)?;
        for format in bundle::Format::ALL {
            copy(&bundles.join(format.file_name()), &stage.join(format.file_name()))?;
        }
        if !is_linux {
            patch::run()?;
            let build = "rustc --manifest-path plugin/Cargo.toml --features standalone --bin sprung-standalone";
            program(system, build, "sprung-standalone", &stage)?;
        }
        manifests.push("plugin/Cargo.toml");
    }
    write(&stage.join("LICENSES-OF-CRATES.txt"), &licences::of_crates(&manifests)?)?;
    if !is_linux {
        let code = ["sprung", "sprung-standalone"].map(|name| stage.join("bin").join(system.program(name)));
        let bundles = bundle::Format::ALL.map(|format| stage.join(format.signed(system)));
        let code: Vec<&Path> = code.iter().chain(&bundles).map(|path| &**path).filter(|path| path.exists()).collect();
        sign::run(sign::CODE, &code)?;
    }
    // The Debian package names its files, so they need one place that does not depend on version and machine.
    replace(&folder.join("stage"), |aside| copy(&stage, aside))?;
    Ok(stage)
}

/// Builds a program and copies it to where it is packed.
fn program(system: &System, build: &str, name: &str, stage: &Path) -> Result<PathBuf, String> {
    let file = system.program(name);
    let built = system.build(build, Profile::Release, &file)?;
    symbols::check(&built)?;
    let packed = stage.join("bin").join(file);
    copy(&built, &packed)?;
    Ok(packed)
}

/// Packs the folder in the way of its system.
fn archive(stage: &Path, system: &System) -> Result<PathBuf, String> {
    let ending = if system.name == "windows" { "zip" } else { "tar.gz" };
    let path = beside(stage, ending);
    let mut pack = Command::new(python::PROGRAM);
    run_to_end(pack.arg(root().join("xtask/src/dist/pack.py")).arg(stage).arg(&path), "pack.py")?;
    Ok(path)
}

/// An installer for Windows, by NSIS.
fn installer(stage: &Path, options: &Options) -> Result<Made, String> {
    if options.system.architecture != "x86_64" {
        return Ok(Made::Nothing("the installer: NSIS makes it for x86_64 alone".to_owned()));
    }
    if !succeeds("makensis", &["-VERSION"]) {
        return Ok(Made::Nothing("the installer: there is no makensis; install nsis".to_owned()));
    }
    let path = beside(stage, "exe");
    let define = |name: &str, value: &Path| format!("-D{name}={}", value.display());
    let mut make = Command::new("makensis");
    make.args(["-V2", "-INPUTCHARSET", "UTF8", &format!("-DVERSION={}", env!("CARGO_PKG_VERSION"))]);
    make.args([define("STAGE", stage), define("OUT", &path)]);
    make.args((!options.no_plugin).then_some("-DPLUGIN"));
    run_to_end(make.arg(root().join("xtask/src/dist/installer.nsi")), "makensis")?;
    sign::run(sign::CODE, &[&path])?;
    Ok(Made::File(path))
}

/// A Debian package of the command, made by cargo-deb from `package.metadata.deb` in `Cargo.toml`.
fn debian_package(folder: &Path) -> Result<Made, String> {
    let variable = |name: &str| std::env::var(name).ok().filter(|value| !value.trim().is_empty());
    let Some(address) = variable("DEBEMAIL") else {
        return Ok(Made::Nothing(
            "the Debian package: it needs its maintainer’s address; set DEBEMAIL, such as: \
            DEBEMAIL=name@example.org cargo xtask dist"
                .to_owned(),
        ));
    };
    let maintainer = maintainer(&address, variable("DEBFULLNAME").as_deref())?;
    let tools = root().join("target/tools");
    let own = tools.join("bin/cargo-deb");
    let program = if own.is_file() { own } else { PathBuf::from("cargo-deb") };
    if !succeeds(&program.to_string_lossy(), &["--version"]) {
        return Ok(Made::Nothing(
            "the Debian package: there is no cargo-deb; install it with: \
            cargo install cargo-deb --root target/tools"
                .to_owned(),
        ));
    }
    let mut command = Command::new(&program);
    command.args([
        "deb",
        "--no-build",
        "--no-strip",
        "--package",
        "sprung-cli",
        "--maintainer",
        &maintainer,
        "--output",
    ]);
    command.arg(folder).current_dir(root());
    run_to_end(&mut command, "cargo-deb")?;
    made_by("cargo-deb", folder, "deb")
}

/// The package’s maintainer, `Name <address>`, from what Debian’s tools read as DEBEMAIL and DEBFULLNAME. The address may
/// have a name of its own.
fn maintainer(address: &str, name: Option<&str>) -> Result<String, String> {
    let (own_name, bare) = match address.trim().strip_suffix('>').and_then(|text| text.split_once('<')) {
        Some((own_name, bare)) => (Some(own_name.trim()).filter(|name| !name.is_empty()), bare.trim()),
        None => (None, address.trim()),
    };
    let is_address = bare.split_once('@').is_some_and(|(user, host)| !user.is_empty() && host.contains('.'));
    if !is_address || bare.contains([' ', '<', '>']) {
        return Err(format!("DEBEMAIL is ‘{address}’; it must be an address such as name@example.org"));
    }
    Ok(format!("{} <{bare}>", own_name.or(name.map(str::trim)).unwrap_or("The Sprung authors")))
}

/// A wheel, by maturin in a virtual environment of its own.
fn wheel(folder: &Path, system: &System) -> Result<Made, String> {
    let environment = root().join("target/tools/maturin");
    let program = python::of(&environment, "maturin");
    if !program.is_file() {
        let python = python::of(&environment, "python");
        let made = succeeds(python::PROGRAM, &["-m", "venv", &environment.to_string_lossy()])
            && succeeds(&python.to_string_lossy(), &["-m", "pip", "install", "--quiet", "maturin>=1.10,<2"]);
        if !made {
            return Ok(Made::Nothing("the wheel: maturin could not be installed (python3-venv, pip)".to_owned()));
        }
    }
    let mut command = Command::new(&program);
    command.args(["build", "--release", "--strip", "--manifest-path", "src/python/Cargo.toml", "--out"]).arg(folder);
    command.args(system.triple.iter().flat_map(|triple| ["--target", triple]));
    run_to_end(command.current_dir(root()), "maturin")?;
    made_by("maturin", folder, "whl")
}

/// The file with this ending that a tool has made in a folder, under a name that the tool chose.
fn made_by(tool: &str, folder: &Path, ending: &str) -> Result<Made, String> {
    let files = std::fs::read_dir(folder).map_err(|error| error.to_string())?;
    let mut paths = files.flatten().map(|file| file.path());
    let made = paths.find(|path| path.extension().is_some_and(|found| found == ending));
    made.map(Made::File).ok_or_else(|| format!("{tool} made no .{ending} file"))
}

/// Packs the crate as for crates.io and builds it from the package, without publishing anything.
fn package_for_crates_io() -> Result<(), String> {
    run_to_end(
        &mut cargo("publish --dry-run --allow-dirty --package sprung-fourier --package sprung --package sprung-cli"),
        "cargo publish --dry-run",
    )?;
    // docs.rs builds with these features, as the metadata in Cargo.toml say.
    let mut docs = cargo("doc --package sprung --no-deps --features batch,lab");
    run_to_end(docs.env("RUSTDOCFLAGS", "-D warnings"), "the documentation")
}

/// A line as `sha256sum` writes it.
fn checksum(file: &Path) -> Result<String, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(format!("{}  {}\n", sha256::of(&bytes), file.file_name().unwrap_or_default().to_string_lossy()))
}

#[cfg(test)]
mod tests {
    use super::maintainer;

    #[test]
    fn a_maintainer_has_a_name_and_an_address() {
        for (address, name, expected) in [
            ("a@b.org", None, "The Sprung authors <a@b.org>"),
            ("a@b.org", Some("A B"), "A B <a@b.org>"),
            ("C D <c@d.org>", Some("A B"), "C D <c@d.org>"),
            ("<c@d.org>", Some("A B"), "A B <c@d.org>"),
        ] {
            assert_eq!(maintainer(address, name).as_deref(), Ok(expected));
        }
        for address in ["sprung@localhost", "someone", "@d.org", "C D c@d.org"] {
            assert!(maintainer(address, None).is_err_and(|message| message.contains(address)), "{address}");
        }
    }
}
