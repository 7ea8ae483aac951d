//! `cargo xtask web`: a static page that plays Sprung in a browser, in `target/web`.

mod check;
mod midi;
mod page;
mod serve;

use crate::engine::cross::Target;
use crate::files::{copy, replace};
use crate::shell::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What to do beside building the page.
pub(crate) struct Options<'a> {
    /// The compiler for WebAssembly, in place of the present toolchain's.
    pub(crate) rustc: Option<&'a Path>,
    /// Serve the page at this port until the program is ended.
    pub(crate) serve: Option<u16>,
    /// Try it in Chromium and measure.
    pub(crate) check: bool,
    /// Take the picture for the README.
    pub(crate) picture: Option<&'a Path>,
}

/// Builds the page, and serves or checks it.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let folder = build(options.rustc)?;
    if options.check || options.picture.is_some() {
        let (port, listener) = serve::listen(0)?;
        let served = folder.clone();
        std::thread::spawn(move || serve::run(&listener, &served));
        check::run(&format!("http://127.0.0.1:{port}/"), options.check, options.picture)?;
    }
    if let Some(port) = options.serve {
        let (port, listener) = serve::listen(port)?;
        println!("http://127.0.0.1:{port}/ (end with Ctrl-C)");
        serve::run(&listener, &folder);
    }
    Ok(())
}

/// Builds the module, with the vector instructions that browsers have had since 2023, and puts it beside the page’s files.
/// Returns the folder, which any web server can serve.
fn build(rustc: Option<&Path>) -> Result<PathBuf, String> {
    let mut build = Target::WasmSimd.cargo("build --release --manifest-path src/web/Cargo.toml", rustc)?;
    if !build.status().map_err(|error| format!("cargo: {error}"))?.success() {
        return Err("src/web does not build".to_owned());
    }
    let (module, folder) = (Target::WasmSimd.folder().join("sprung_web.wasm"), root().join("target/web"));
    replace(&folder, |aside| {
        copy(&root().join("src/web/page"), aside)?;
        copy(&module, &aside.join("sprung.wasm"))
    })?;
    let files = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let paths: Vec<PathBuf> = files.flatten().map(|file| file.path()).collect();
    let plain: u64 = paths.iter().filter_map(|path| path.metadata().ok()).map(|about| about.len()).sum();
    let compressed =
        compressed(&paths).map_or(String::new(), |bytes| format!(", {:.1} MB compressed", megabytes(bytes)));
    println!("{}: {:.1} MB in all{compressed}", folder.display(), megabytes(plain));
    Ok(folder)
}

fn megabytes(bytes: u64) -> f64 {
    bytes as f64 / 1e6
}

/// Number of bytes that a web server sends if it compresses each file; `None` without gzip.
fn compressed(paths: &[PathBuf]) -> Option<u64> {
    let sent = |path: &PathBuf| {
        let output = Command::new("gzip").args(["-9", "--stdout"]).arg(path).output().ok()?;
        output.status.success().then_some(output.stdout.len() as u64)
    };
    paths.iter().map(sent).sum()
}
