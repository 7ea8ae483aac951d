//! `sprung lab`: methods that integrate a mass on a spring, compared by figures, numbers and sounds.

mod animate;
mod compare;
mod converge;
mod deliver;
mod listen;
mod pitch;
mod stability;
mod system;
mod table;

use clap::Subcommand;
use sprung::Result;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung lab compare -o report.html
  sprung lab compare --methods explicit-euler,rk4,synth-exact --steps 0.05 --csv runs.csv
  sprung lab converge -o orders.svg
  sprung lab pitch --methods synth-seed,synth-exact --frequencies 440,4186 --rate 48000
  sprung lab listen sounds --frequency 440 -o waveforms.png
  sprung lab animate --methods explicit-euler,synth-exact -o masses.gif";

#[derive(clap::Args)]
pub(super) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Trajectories against the truth, phase planes, energies and errors: a report (.html) or a figure (.svg, .png)
    Compare(compare::Args),
    /// Error against step size, with the fitted order of each method
    Converge(converge::Args),
    /// The steps and damping ratios at which each method stays bounded
    Stability(stability::Args),
    /// How out of tune each method plays at a sample rate, and how wrong its decay is
    Pitch(pitch::Args),
    /// Each method as a WAV file
    Listen(listen::Args),
    /// The masses moving side by side, with their phase planes (.svg, .html, .gif)
    Animate(animate::Args),
}

pub(super) fn run(args: &Args) -> Result<()> {
    match &args.command {
        Command::Compare(args) => compare::run(args),
        Command::Converge(args) => converge::run(args),
        Command::Stability(args) => stability::run(args),
        Command::Pitch(args) => pitch::run(args),
        Command::Listen(args) => listen::run(args),
        Command::Animate(args) => animate::run(args),
    }
}
