//! `sprung analyze`: splits the recording of a strike into its modes.

use super::interrupt;
use super::progress::Bar;
use super::quantity;
use super::recording::{FigureArgs, read};
use super::terminal::{complain, counted, print};
use serde_json::json;
use sprung::analysis::figure::ModesFigure;
use sprung::analysis::modes::{Analysis, Common, Kind, Mode, Settings, Strike, common, modes};
use sprung::internals::files::Inputs;
use sprung::{Result, figure};
use std::fmt::Write;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung analyze bell.wav
  sprung analyze bell.flac --json
  sprung analyze bell.wav --csv --figure modes.png
  sprung analyze drum-hits.wav --hits --json";

#[derive(clap::Args)]
pub(super) struct Args {
    /// Recording of a strike that rings freely: WAV, AIFF, FLAC, Ogg Vorbis or MP3; - is stdin
    recording: PathBuf,
    /// Take every strike of the recording apart, and tell what they have in common
    #[arg(long)]
    hits: bool,
    /// Most modes of a strike, 1-1000
    #[arg(long, default_value_t = 256, value_name = "N", value_parser = quantity::whole::<u16>(1..=1000))]
    modes: u16,
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print CSV, a line a mode
    #[arg(long)]
    csv: bool,
    #[command(flatten)]
    figure: FigureArgs,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let mut inputs = Inputs::default();
    let (recording, name) = read(&args.recording, &mut inputs)?;
    recording.check_finite(&name)?;
    interrupt::catch(true)?;
    let figure = args.figure.open(&inputs)?;
    let settings = Settings { most_modes: args.modes.into(), all_strikes: args.hits, ..Settings::default() };
    let mut bar = Bar::new();
    let sample_rate = f64::from(recording.sample_rate);
    let found = modes(&recording.channels, sample_rate, &settings, &mut |share| bar.show_share(share));
    drop(bar);
    let found = found.map_err(|error| match error {
        sprung::Error::Value { message, .. } => sprung::Error::format(&name, message),
        other => other,
    })?;
    found.warnings.iter().for_each(|warning| complain("warning", format_args!("{name}: {warning}")));
    if found.strikes_found > found.strikes.len() {
        let more = found.strikes_found - found.strikes.len();
        let (strikes, follow, them) =
            if more == 1 { ("strike", "follows", "it") } else { ("strikes", "follow", "them") };
        let message = format!("{name}: {more} more {strikes} {follow} the first; --hits takes {them} apart, too");
        complain("note", message);
    }
    if let (Some(figure), Some(strike)) = (figure, found.strikes.first()) {
        let title = format!("{name}: {}", counted(strike.modes.len(), "mode"));
        let picture = ModesFigure { title: &title, strike, sample_rate };
        figure.write(|format| match format {
            "png" => figure::png(&picture),
            _ => figure::svg(&picture).map(String::into_bytes),
        })?;
    }
    let shared = if args.hits { common(&found.strikes) } else { Vec::new() };
    print(&match (args.json, args.csv) {
        (true, _) => format!("{:#}\n", to_json(&found, &shared, args.hits)),
        (_, true) => to_csv(&found),
        _ => to_text(&found, &shared),
    })
}

fn mode_json(mode: &Mode) -> serde_json::Value {
    let channels: Vec<_> =
        mode.channels.iter().map(|(level, phase)| json!({"level_db": level, "phase": phase})).collect();
    let mut value = json!({
        "frequency": mode.frequency,
        "t60": mode.t60,
        "level_db": mode.level_db,
        "phase": mode.phase,
        "snr_db": mode.snr_db,
        "uncertainty": {
            "frequency": mode.uncertainty.frequency,
            "t60": mode.uncertainty.t60,
            "level_db": mode.uncertainty.level_db,
            "phase": mode.uncertainty.phase,
        },
    });
    if !channels.is_empty() {
        value["channels"] = channels.into();
    }
    value
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::SplitPair => "split pair",
        Kind::TwoStageDecay => "two-stage decay",
    }
}

fn strike_json(strike: &Strike) -> serde_json::Value {
    let onset = |mode: &Mode| {
        let mut value = mode_json(mode);
        value["onset"] = strike.onset.into();
        value
    };
    json!({
        "onset": strike.onset,
        "seconds": strike.seconds,
        "damped": strike.damped,
        "steady": strike.steady.iter().map(|tone| tone.frequency).collect::<Vec<f64>>(),
        "residual_db": strike.residual_db,
        "modes": strike.modes.iter().map(onset).collect::<Vec<_>>(),
        "groups": strike.groups.iter()
            .map(|group| json!({"kind": kind(group.kind), "modes": group.modes}))
            .collect::<Vec<_>>(),
    })
}

/// The first strike's modes; with `hits`, a list of all strikes and the modes that they share.
fn to_json(found: &Analysis, shared: &[Common], hits: bool) -> serde_json::Value {
    if !hits {
        return found.strikes.first().map_or(serde_json::Value::Null, strike_json);
    }
    let one = |mode: &Common| json!({"frequency": mode.frequency, "t60": mode.t60, "levels_db": mode.levels_db});
    json!({
        "hits": found.strikes.iter().map(strike_json).collect::<Vec<_>>(),
        "common": shared.iter().map(one).collect::<Vec<_>>(),
    })
}

fn to_csv(found: &Analysis) -> String {
    let mut text = String::from(
        "hit,onset_s,frequency_hz,t60_s,level_dbfs,phase_rad,snr_db,frequency_deviation_hz,t60_deviation_s,\
         level_deviation_db,phase_deviation_rad\n",
    );
    for (index, strike) in found.strikes.iter().enumerate() {
        for mode in &strike.modes {
            let deviation = mode.uncertainty;
            let numbers = [
                strike.onset,
                mode.frequency,
                mode.t60,
                mode.level_db,
                mode.phase,
                mode.snr_db,
                deviation.frequency,
                deviation.t60,
                deviation.level_db,
                deviation.phase,
            ];
            let cells = numbers.map(|number| number.to_string());
            writeln!(text, "{},{}", index + 1, cells.join(",")).expect("a String takes all");
        }
    }
    text
}

fn to_text(found: &Analysis, shared: &[Common]) -> String {
    let mut text = String::new();
    let mut line = |line: String| writeln!(text, "{line}").expect("a String takes all");
    for strike in &found.strikes {
        line(format!(
            "strike at {:.4} s, {:.2} s of it: {}, {:.1} dB are left",
            strike.onset,
            strike.seconds,
            counted(strike.modes.len(), "mode"),
            strike.residual_db
        ));
        if strike.modes.is_empty() {
            continue;
        }
        line(format!("{:>12}  {:>18}  {:>12}  {:>7}", "frequency", "T60", "level", "SNR"));
        for (place, mode) in strike.modes.iter().enumerate() {
            let group = strike.groups.iter().find(|group| group.modes.contains(&place));
            let group = group.map_or("", |group| kind(group.kind));
            let row = format!(
                "{:>9.3} Hz  {:>18}  {:>7.2} dBFS  {:>4.0} dB  {group}",
                mode.frequency,
                t60(mode.t60, Some(mode.uncertainty.t60)),
                mode.level_db,
                mode.snr_db
            );
            line(row.trim_end().to_owned());
        }
    }
    if !shared.is_empty() {
        line("in common:".to_owned());
    }
    for mode in shared {
        let level = |level: &Option<f64>| level.map_or("–".to_owned(), |level| format!("{level:.1}"));
        let levels: Vec<String> = mode.levels_db.iter().map(level).collect();
        line(format!("{:>9.3} Hz  {:>10}  {} dBFS", mode.frequency, t60(mode.t60, None), levels.join(", ")));
    }
    text
}

/// A T60 with its standard deviation, if it has one.
fn t60(value: f64, deviation: Option<f64>) -> String {
    let text = |value: f64| if value < 1e-3 { format!("{value:.0e}") } else { format!("{value:.3}") };
    match deviation {
        Some(deviation) => format!("{value:>8.4} ± {:<5} s", text(deviation)),
        None => format!("{value:>8.4} s"),
    }
}
