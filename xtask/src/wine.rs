//! Wine, which runs programs for Windows on Linux, without a screen.

use crate::files::make_folder_of;
use crate::shell::{root, run_to_end, succeeds};
use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Command;

/// Windows as it is built for and run here, by the compiler's name.
pub(crate) const TARGET: &str = "x86_64-pc-windows-gnu";

/// The variable with the program by which cargo runs programs for it.
const RUNNER: &str = "CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUNNER";

/// Compiles what Wine lacks, and links programs for Windows.
const COMPILER: &str = "x86_64-w64-mingw32-gcc";

/// A folder with an installation of Windows of its own.
pub(crate) struct Prefix(PathBuf);

impl Prefix {
    /// The one in which all tests run.
    pub(crate) fn of_tests() -> Result<Self, String> {
        Self::at(root().join("target/wine/tests"))
    }

    /// Opens the prefix in a folder, or makes it. The error says what is missing and how to install it.
    pub(crate) fn at(folder: PathBuf) -> Result<Self, String> {
        let library = folder.join("drive_c/windows/system32/bcryptprimitives.dll");
        let prefix = Self(folder);
        if library.is_file() {
            return Ok(prefix);
        }
        for (program, packages) in [("wine", "wine wine64"), (COMPILER, "gcc-mingw-w64-x86-64-posix")] {
            if !succeeds(program, &["--version"]) {
                return Err(format!("there is no {program}; install it with: sudo apt-get install {packages}"));
            }
        }
        println!("making {}, which takes a minute", prefix.0.display());
        // Wine makes only the last folder of the path.
        make_folder_of(&prefix.0)?;
        let mut boot = prefix.command("wineboot");
        run_to_end(boot.arg("-i"), "wine wineboot -i")?;
        // Windows are made, since threads send messages through them, but shown nowhere.
        let mut driver = prefix.command("reg");
        driver.args(["add", r"HKCU\Software\Wine\Drivers", "/v", "Graphics", "/d", "null", "/f"]);
        run_to_end(&mut driver, "wine reg add")?;
        let mut compile = Command::new(COMPILER);
        compile.args(["-Wall", "-Werror", "-O2", "-shared", "-s", "-o"]).arg(library);
        run_to_end(compile.arg(root().join("plugin/tests/windows/bcryptprimitives.c")).arg("-ladvapi32"), COMPILER)?;
        Ok(prefix)
    }

    /// A command that runs a program for Windows.
    pub(crate) fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new("wine");
        self.lend(command.arg(program));
        command
    }

    /// Lets a command of cargo run what it builds for Windows.
    pub(crate) fn lend_to_cargo(&self, command: &mut Command) {
        self.lend(command);
        // Without the variable in what it starts: tests that start programs as cargo does must not start Wine within Wine.
        command.env(RUNNER, format!("env -u {RUNNER} wine"));
    }

    /// Waits until all programs in it have ended.
    pub(crate) fn wait(&self) -> Result<(), String> {
        let mut server = Command::new("wineserver");
        self.lend(server.arg("-w"));
        run_to_end(&mut server, "wineserver -w")
    }

    fn lend(&self, command: &mut Command) {
        command.env("WINEPREFIX", &self.0).env("WINEDEBUG", "-all").env_remove("DISPLAY");
        // Wine would put shortcuts into the menus of this system.
        command.env("WINEDLLOVERRIDES", "winemenubuilder.exe=d");
    }
}
