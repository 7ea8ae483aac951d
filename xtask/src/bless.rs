//! `cargo xtask bless`: accepts the present sound of the golden cases, or the present pictures of the window, and verifies it.

use crate::patch;
use crate::shell::{cargo, run_and_read};
use std::process::Command;

const GOLDEN: &str = "test --package sprung --all-features --test golden";

/// The tests that compare pictures of the plugin's window.
const PICTURES: &str = "test --manifest-path plugin/Cargo.toml --lib pictures";

/// Accepts one case or all cases, or with `pictures` those of the plugin's window.
pub(crate) fn run(case: Option<&str>) -> Result<(), String> {
    if case == Some("pictures") {
        patch::run()?;
        let mut blessing = cargo(PICTURES);
        blessing.env("SPRUNG_BLESS_PICTURES", "1").args(["--", "--include-ignored", "--nocapture"]);
        return bless(blessing, cargo(PICTURES));
    }
    let mut blessing = cargo(GOLDEN);
    blessing.env("SPRUNG_BLESS", case.unwrap_or("all"));
    blessing.args(["--", "--exact", "every_case_sounds_as_accepted_in_blocks"]);
    bless(blessing, cargo(GOLDEN))
}

/// Runs tests so that they accept what they find, then again so that they verify it.
fn bless(blessing: Command, mut verifying: Command) -> Result<(), String> {
    // A test run that blesses always fails, so that nobody blesses without noticing.
    let (passed, lines) = run_and_read(blessing)?;
    if passed || !lines.iter().any(|line| line.starts_with("blessed ")) {
        return Err("nothing was blessed".to_owned());
    }
    println!("\nverifying");
    verifying.args(["--", "--include-ignored"]);
    let (verified, _) = run_and_read(verifying)?;
    if verified { Ok(()) } else { Err("blessed, but the tests still fail".to_owned()) }
}
