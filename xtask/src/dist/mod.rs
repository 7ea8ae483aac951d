//! `cargo xtask dist`: makes the downloads in `target/dist`: an archive, a Debian package, a wheel for Python, and checksums.

mod licences;
mod trial;

use crate::bundle;
use crate::files::{copy, remove, replace, write};
use crate::sha256;
use crate::shell::{cargo, root, run_to_end, succeeds};
use crate::symbols;
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
}

/// The result for a file that needs a tool. If the tool is there but fails, that is an error.
enum Made {
    File(PathBuf),
    /// Not made, because something is missing: what, and how to get it.
    Nothing(String),
}

/// Completions by shell, with the names of their files.
const COMPLETIONS: [(&str, &str); 3] = [("bash", "sprung.bash"), ("zsh", "_sprung"), ("fish", "sprung.fish")];

/// Makes all files for which the tools are installed, reports those left out, and tries the files if that is requested.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let folder = root().join("target/dist");
    remove(&folder)?;
    let stage = stage(&folder, options.no_plugin)?;
    let mut made = vec![archive(&folder, &stage)?];
    let mut left_out = Vec::new();
    match debian_package(&folder)? {
        Made::File(package) => made.push(package),
        Made::Nothing(reason) => left_out.push(reason),
    }
    if options.wheel {
        match wheel(&folder)? {
            Made::File(wheel) => made.push(wheel),
            Made::Nothing(reason) => left_out.push(reason),
        }
    }
    package_for_crates_io()?;
    let sums = made.iter().map(|file| checksum(file)).collect::<Result<String, String>>()?;
    write(&folder.join("SHA256SUMS"), &sums)?;
    print!("{sums}");
    left_out.iter().for_each(|message| println!("left out: {message}"));
    if options.trial {
        trial::run(&folder, &made)?;
    }
    Ok(())
}

/// The folder that is packed: `sprung-VERSION-CPU-SYSTEM`.
fn stage(folder: &Path, no_plugin: bool) -> Result<PathBuf, String> {
    let name = format!("sprung-{}-{}-{}", env!("CARGO_PKG_VERSION"), std::env::consts::ARCH, std::env::consts::OS);
    let stage = folder.join(name);
    // Debug symbols are most of the command's size.
    let build = "rustc --release --package sprung-cli --bin sprung -- -C strip=symbols";
    run_to_end(&mut cargo(build), "the command does not build")?;
    let command = root().join("target/release").join(format!("sprung{}", std::env::consts::EXE_SUFFIX));
    symbols::check(&command)?;
    copy(&command, &stage.join("bin").join(command.file_name().unwrap_or_default()))?;
    run_to_end(Command::new(&command).arg("man").arg(stage.join("man/man1")), "the manual pages")?;
    for (shell, file) in COMPLETIONS {
        let output = Command::new(&command).args(["completions", shell]).output().map_err(|error| error.to_string())?;
        if !output.status.success() {
            return Err(format!("‘sprung completions {shell}’ failed"));
        }
        write(&stage.join("completions").join(file), &String::from_utf8_lossy(&output.stdout))?;
    }
    for file in ["README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root().join(file), &stage.join(file))?;
    }
    copy(&root().join("assets/manual"), &stage.join("manual"))?;
    let mut manifests = vec!["src/cli/Cargo.toml"];
    if !no_plugin {
        let bundles = bundle::run(true)?;
        for format in bundle::Format::ALL {
            copy(&bundles.join(format.file_name()), &stage.join(format.file_name()))?;
        }
        manifests.push("plugin/Cargo.toml");
    }
    write(&stage.join("LICENSES-OF-CRATES.txt"), &licences::of_crates(&manifests)?)?;
    // The Debian package names its files, so they need one place that does not depend on version and machine.
    replace(&folder.join("stage"), |aside| copy(&stage, aside))?;
    Ok(stage)
}

/// Packs the folder.
fn archive(folder: &Path, stage: &Path) -> Result<PathBuf, String> {
    let name = stage.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let path = folder.join(format!("{name}.tar.gz"));
    // The same files give the same archive, as long as the compressor’s version is the same.
    let mut tar = Command::new("tar");
    tar.args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--mtime=@0", "-czf"]).arg(&path);
    run_to_end(tar.arg("-C").arg(folder).arg(&name), "tar")?;
    Ok(path)
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
fn wheel(folder: &Path) -> Result<Made, String> {
    let environment = root().join("target/tools/maturin");
    let program = environment.join("bin/maturin");
    if !program.is_file() {
        let python = environment.join("bin/python");
        let made = succeeds("python3", &["-m", "venv", &environment.to_string_lossy()])
            && succeeds(&python.to_string_lossy(), &["-m", "pip", "install", "--quiet", "maturin>=1.10,<2"]);
        if !made {
            return Ok(Made::Nothing("the wheel: maturin could not be installed (python3-venv, pip)".to_owned()));
        }
    }
    let mut command = Command::new(&program);
    command.args(["build", "--release", "--strip", "--manifest-path", "src/python/Cargo.toml", "--out"]).arg(folder);
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
        &mut cargo("publish --dry-run --allow-dirty --package sprung --package sprung-cli"),
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
