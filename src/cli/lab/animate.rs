//! `sprung lab animate`.

use super::deliver::Files;
use super::system::{MethodArgs, SystemArgs};
use sprung::internals::lab::animation::{Animation, gif, svg};
use sprung::lab::comparison::{Comparison, Setup};
use sprung::{Error, Result};

#[derive(clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    methods: MethodArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// How long the masses move, in s
    #[arg(long, default_value_t = 5.0, value_name = "S", allow_negative_numbers = true)]
    end: f64,
    /// Step in s
    #[arg(long, default_value_t = 0.05, value_name = "S", allow_negative_numbers = true)]
    step: f64,
    /// Frames per second, more than 0 and at most 50
    #[arg(long, default_value_t = 15.0, value_name = "N", allow_negative_numbers = true)]
    fps: f64,
    #[command(flatten)]
    files: Files,
}

pub(super) fn run(args: &Args) -> Result<()> {
    if !(args.step > 0.0 && args.step.is_finite()) {
        return Err(Error::value("--step", format!("must be longer than 0 s, got {}", args.step)));
    }
    let (system, start) = args.system.build()?;
    let steps = vec![args.step];
    let methods = args.methods.for_system(&system, &steps)?;
    let deliveries = args.files.open(&["svg", "html", "gif"])?;
    let comparison = Comparison::new(Setup { system, start, end: args.end, steps, methods })?;
    let animation = Animation::new(&comparison, args.fps)?;
    let figure = |format: &str| match format {
        "gif" => gif::gif(&animation),
        "html" => Ok(svg::html(&animation).into_bytes()),
        _ => Ok(svg::svg(&animation).into_bytes()),
    };
    let text = format!("{} masses, {} frames at {} per second\n", animation.tracks.len(), animation.len(), args.fps);
    deliveries.finish(figure, |out| out.write_all(csv(&animation).as_bytes()), &text)
}

/// One row for each mass and frame.
fn csv(animation: &Animation) -> String {
    let mut csv = String::from("mass,t_s,x_m,v_m_per_s\n");
    for track in &animation.tracks {
        for (n, state) in track.frames.iter().enumerate() {
            csv += &format!("\"{}\",{},{},{}\n", track.title, n as f64 / animation.rate, state.x, state.v);
        }
    }
    csv
}
