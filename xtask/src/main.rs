//! `cargo xtask …`: the project's chores.

mod batch_table;
mod bless;
mod bundle;
mod count;
mod dist;
mod engine;
mod files;
mod install;
mod notes;
mod package;
mod patch;
mod python;
mod setup;
mod sha256;
mod shell;
mod standalone;
mod steps;
mod symbols;
mod system;
mod test;
mod wine;

use clap::{Parser, Subcommand};
use install::Scope;
use std::process::ExitCode;
use steps::Suite;
use system::{Profile, System};

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
    Setup(Extent),
    /// Run the tests that protect every commit, setup included.
    Test {
        #[command(flatten)]
        extent: Extent,
        /// Only steps whose name contains this, such as Windows
        only: Option<String>,
    },
    /// Put the plugin's wrapper, with our corrections, where the manifests in plugin/wrapper have their sources. Other chores do it too.
    Patch,
    /// Build the plugin and put Sprung.clap and Sprung.vst3 into target/bundled, for another system into target/TRIPLE/bundled.
    Bundle {
        /// Optimised, as it is to be played.
        #[arg(long)]
        release: bool,
        #[command(flatten)]
        target: Target,
    },
    /// Build the plugin for release and copy it to where DAWs look.
    Install(Place),
    /// Build the plugin's window as a program with a sound device of its own, and run it.
    Standalone {
        /// Arguments of the program; --help lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Remove what `install` has copied.
    Uninstall(Place),
    /// Accept what the golden cases sound like now, and verify.
    Bless {
        /// Only this case; `pictures` for what the plugin's window looks like.
        case: Option<String>,
    },
    /// Make what users download, in target/dist: an archive, an installer, and their checksums.
    Dist {
        /// Leave the plugin out.
        #[arg(long)]
        no_plugin: bool,
        /// Make a wheel for Python as well.
        #[arg(long)]
        wheel: bool,
        /// Install what was made into an empty system and an empty virtual environment, and render with it.
        #[arg(long = "try")]
        trial: bool,
        #[command(flatten)]
        target: Target,
    },
    /// Print what the changelog says of a version, for its release.
    Notes {
        /// Such as 0.1.0.
        version: String,
    },
    /// Time `sprung batch` beside Python's plugin hosts on the same notes, and print a table of it.
    BatchTable {
        /// Sounds of a second each.
        #[arg(long, default_value_t = 2000, value_parser = clap::value_parser!(u32).range(20..))]
        sounds: u32,
    },
    #[command(flatten)]
    Engine(engine::Chore),
}

#[derive(clap::Args)]
struct Extent {
    /// Everything, also what takes long or waits for time to pass.
    #[arg(long)]
    all: bool,
}

impl Extent {
    fn suite(&self) -> Suite {
        if self.all { Suite::All } else { Suite::Commit }
    }
}

#[derive(clap::Args)]
struct Target {
    /// The system to build for, as the compiler calls it, such as x86_64-pc-windows-gnu, or universal2-apple-darwin for both
    /// CPUs of Apple's [default: this one]
    #[arg(long, value_name = "TRIPLE")]
    target: Option<String>,
}

impl Target {
    fn system(&self) -> Result<System, String> {
        System::of(self.target.as_deref())
    }
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
        Chore::Setup(extent) => setup::run(extent.suite()),
        Chore::Test { extent, only } => test::run(extent.suite(), only.as_deref().unwrap_or_default()),
        Chore::Patch => patch::run().map(drop),
        Chore::Bundle { release, target } => {
            let profile = if release { Profile::Release } else { Profile::Debug };
            target.system().and_then(|system| bundle::run(&system, profile)).map(drop)
        }
        Chore::Install(place) => install::install(place.scope()),
        Chore::Standalone { arguments } => standalone::run(&arguments),
        Chore::Uninstall(place) => install::uninstall(place.scope()),
        Chore::Bless { case } => bless::run(case.as_deref()),
        Chore::Dist { no_plugin, wheel, trial, target } => {
            target.system().and_then(|system| dist::run(&dist::Options { no_plugin, wheel, trial, system }))
        }
        Chore::Notes { version } => notes::run(&version),
        Chore::BatchTable { sounds } => batch_table::run(sounds),
        Chore::Engine(chore) => engine::run(&chore),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
