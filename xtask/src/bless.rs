//! `cargo xtask bless`: accepts the present sound of the golden cases, then verifies it.

use crate::shell::{cargo, run_and_read};

const GOLDEN: &str = "test --package sprung --all-features --test golden";

/// Accepts one case, or all cases.
pub(crate) fn run(case: Option<&str>) -> Result<(), String> {
    let mut blessing = cargo(GOLDEN);
    blessing.env("SPRUNG_BLESS", case.unwrap_or("all"));
    blessing.args(["--", "--exact", "every_case_sounds_as_accepted_at_every_block_size"]);
    // A test run that blesses always fails, so that nobody blesses without noticing.
    let (passed, lines) = run_and_read(blessing)?;
    if passed || !lines.iter().any(|line| line.starts_with("blessed ")) {
        return Err("nothing was blessed".to_owned());
    }
    println!("\nverifying");
    let (verified, _) = run_and_read(cargo(GOLDEN))?;
    if verified { Ok(()) } else { Err("blessed, but the golden tests still fail".to_owned()) }
}
