//! `cargo xtask …`: the project's chores.

mod batch_table;
mod bless;
mod bundle;
mod count;
mod dist;
mod engine;
mod files;
mod install;
mod package;
mod patch;
mod python;
mod setup;
mod sha256;
mod shell;
mod standalone;
mod steps;
mod symbols;
mod test;

use clap::{Parser, Subcommand};
use install::Scope;
use std::process::ExitCode;
use steps::Suite;

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
    Test(Extent),
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
    /// Make what users download: an archive, a Debian package, and their checksums, in target/dist.
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
        Chore::Test(extent) => test::run(extent.suite()),
        Chore::Patch => patch::run().map(drop),
        Chore::Bundle { release } => bundle::run(release).map(drop),
        Chore::Install(place) => install::install(place.scope()),
        Chore::Standalone { arguments } => standalone::run(&arguments),
        Chore::Uninstall(place) => install::uninstall(place.scope()),
        Chore::Bless { case } => bless::run(case.as_deref()),
        Chore::Dist { no_plugin, wheel, trial } => dist::run(&dist::Options { no_plugin, wheel, trial }),
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
