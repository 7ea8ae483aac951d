//! `sprung lab pitch`.

use super::super::quantity;
use super::deliver::{Files, drawn};
use super::system::MethodArgs;
use super::table::{aligned, row};
use sprung::Result;
use sprung::internals::lab::pitch::{csv, notes};
use sprung::internals::text::short;
use sprung::lab::figure::PitchFigure;
use sprung::lab::pitch::{Note, Outcome, musical_steps};

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct Args {
    #[command(flatten)]
    methods: MethodArgs,
    /// Sample rate in Hz (48000, 44.1k)
    #[arg(long, default_value = "48000", value_name = "HZ", value_parser = quantity::hertz)]
    rate: f64,
    /// Times in which the note decays by 60 dB, in s (inf: never), separated by commas; the figure shows the first
    #[arg(long, default_value = "1,0.1", value_delimiter = ',', value_name = "S,…")]
    t60: Vec<f64>,
    /// Frequencies of the table in Hz, below half the sample rate, separated by commas
    #[arg(long, default_value = "27.5,110,440,1760,4186,8000,12000,16000", value_delimiter = ',', value_name = "HZ,…",
        value_parser = quantity::hertz)]
    frequencies: Vec<f64>,
    #[command(flatten)]
    files: Files,
}

/// Number of points of a curve.
const POINTS: usize = 300;

pub(super) fn run(args: &Args) -> Result<()> {
    let methods = args.methods.named()?;
    let deliveries = args.files.open(&["svg", "png"])?;
    let curve = musical_steps(20.0_f64.min(args.rate / 100.0), 0.499 * args.rate, POINTS);
    let mut text = String::new();
    let mut curves = Vec::new();
    let mut listed: Vec<Note> = Vec::new();
    for t60 in &args.t60 {
        let notes_of_table = notes(&methods, &args.frequencies, *t60, args.rate)?;
        text += &format!("At {} Hz, decay by 60 dB in {t60} s: error of the pitch in cents\n", args.rate);
        text += &table(args, &notes_of_table, cents);
        text += "\nand of the decay time in %\n";
        text += &table(args, &notes_of_table, decay);
        text.push('\n');
        listed.extend(notes_of_table.into_iter().flatten());
        curves.push(notes(&methods, &curve, *t60, args.rate)?);
    }
    listed.extend(curves.iter().flatten().flatten());
    let first = curves.first().map_or(&[][..], Vec::as_slice);
    let figure = PitchFigure { notes: first, sample_rate: args.rate };
    deliveries.finish(|format| drawn(&figure, format), |out| out.write_all(csv(listed.iter()).as_bytes()), &text)
}

fn table(args: &Args, notes: &[Vec<Note>], word: fn(&Note) -> String) -> String {
    let mut heads = row(["method"]);
    heads.extend(args.frequencies.iter().map(|frequency| format!("{} Hz", short(*frequency))));
    let mut rows = vec![heads];
    for notes in notes {
        let key = notes.first().map_or("", |note| note.method.key());
        rows.push(std::iter::once(key.to_owned()).chain(notes.iter().map(word)).collect());
    }
    aligned(&rows)
}

fn cents(note: &Note) -> String {
    match note.outcome {
        Outcome::Decays { cents, .. } | Outcome::Grows { cents, .. } => signed(cents),
        Outcome::Explodes { .. } => "explodes".to_owned(),
        Outcome::Dies => "dies".to_owned(),
    }
}

fn decay(note: &Note) -> String {
    match note.outcome {
        Outcome::Decays { decay_percent, .. } => signed(decay_percent),
        Outcome::Grows { .. } => "grows".to_owned(),
        Outcome::Explodes { .. } => "explodes".to_owned(),
        Outcome::Dies => "dies".to_owned(),
    }
}

/// A number with one decimal and its sign; 0 if it rounds to 0.
fn signed(value: f64) -> String {
    if value.abs() < 0.05 { "0".to_owned() } else { format!("{value:+.1}").replace('-', "−") }
}
