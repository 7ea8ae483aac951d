//! The tuning that a command uses: Scala's files, given with `--scale` and `--keymap`.

use sprung::internals::request::TuningRequest;
use std::path::PathBuf;

/// How the keys are tuned.
#[derive(Clone, clap::Args)]
pub(super) struct TuningArgs {
    /// Scala scale (.scl) to tune the keys to. Without --keymap, degree 0 is on C4 (key 60), every key is the next
    /// degree, and A4 (key 69) keeps the frequency that the parameter `tuning` gives it
    #[arg(long, value_name = "FILE.scl")]
    scale: Option<PathBuf>,
    /// Scala keyboard mapping (.kbm): which key plays which degree of the scale, which are silent, and the frequency of
    /// one of them, in place of the parameter `tuning`
    #[arg(long, value_name = "FILE.kbm", requires = "scale")]
    keymap: Option<PathBuf>,
}

impl TuningArgs {
    pub(super) fn request(&self) -> TuningRequest {
        TuningRequest { scale: self.scale.clone(), keymap: self.keymap.clone() }
    }
}
