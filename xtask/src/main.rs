//! `cargo xtask …`: the project's chores.

mod bench_table;
mod bless;
mod bundle;
mod callgrind;
mod figures;
mod files;
mod install;
mod level;
mod measure;
mod patch;
mod python;
mod setup;
mod shell;
mod skipped;
mod songs;
mod test;

use clap::{Parser, Subcommand};
use install::Scope;
use std::process::ExitCode;

/// The project's chores.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Find what the test suite needs on this system, and install it where that is possible.
    Setup,
    /// Run the whole test suite, setup included.
    Test {
        /// Fail if a test is skipped that any machine can run. So it is wherever the environment variable CI is set.
        #[arg(long)]
        strict: bool,
    },
    /// Put the plugin's wrapper, with our corrections, where cargo finds it in the folder `plugin`. Other chores do it too.
    Patch,
    /// Build the plugin and put Sprung.clap and Sprung.vst3 into target/bundled.
    Bundle {
        /// Optimised, as it is to be played.
        #[arg(long)]
        release: bool,
    },
    /// Build the plugin for release and copy it to where DAWs look.
    Install(Place),
    /// Remove what `install` has copied.
    Uninstall(Place),
    /// Accept what the golden cases sound like now, and verify.
    Bless {
        /// Only this case; `pictures` for what the plugin's window looks like.
        case: Option<String>,
    },
    /// Draw the README's picture of the demo song to assets/demo.png.
    Figures,
    /// Run the benches and the peers, and write their tables into benches/README.md.
    BenchTable {
        /// Run nothing: write what was measured the last time.
        #[arg(long)]
        again: bool,
    },
    /// Count the instructions of the kernels and of silence; fail if they have grown by 5 %.
    Callgrind {
        /// Keep what is counted.
        #[arg(long)]
        accept: bool,
    },
    /// What `callgrind` counts.
    #[command(hide = true)]
    CallgrindWork { name: String, rounds: usize },
    /// Measure how loud the factory's presets are, and propose gains that bring them to one loudness.
    Level {
        /// Write the gains into the presets' files.
        #[arg(long)]
        write: bool,
    },
    /// Measure the factory's presets and write the results to assets/measures/results.md.
    Measure,
    /// Write the demo songs to assets/midi.
    Songs {
        /// Write nothing; fail if the files are not what would be written.
        #[arg(long)]
        check: bool,
    },
}

#[derive(clap::Args)]
struct Place {
    /// For this user alone (the default).
    #[arg(long)]
    user: bool,
    /// For all users; needs an administrator's rights.
    #[arg(long, conflicts_with = "user")]
    system: bool,
}

impl Place {
    fn scope(&self) -> Scope {
        if self.system { Scope::System } else { Scope::User }
    }
}

fn main() -> ExitCode {
    let result = match Arguments::parse().chore {
        Chore::Setup => setup::run(),
        Chore::Test { strict } => test::run(strict || skipped::in_ci()),
        Chore::Patch => patch::run().map(drop),
        Chore::Bundle { release } => bundle::run(release).map(drop),
        Chore::Install(place) => install::install(place.scope()),
        Chore::Uninstall(place) => install::uninstall(place.scope()),
        Chore::Bless { case } => bless::run(case.as_deref()),
        Chore::Figures => figures::run(),
        Chore::BenchTable { again } => bench_table::run(again),
        Chore::Callgrind { accept } => callgrind::run(accept).map(|_| ()),
        Chore::CallgrindWork { name, rounds } => callgrind::work(&name, rounds),
        Chore::Level { write } => level::run(write),
        Chore::Measure => measure::run(),
        Chore::Songs { check } => songs::run(check),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
