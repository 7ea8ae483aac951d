//! Draws the errors of pitch and decay against frequency.

use super::super::method::Method;
use super::super::pitch::{Note, Outcome};
use super::{legend, stroke};
use crate::figure::panel::{Axis, Panel, line};
use crate::figure::{Area, Drawn, Picture, text};
use libm::{ceil, floor, log10};
use plotters::prelude::*;

/// Each method's notes over frequency, all with the same −60 dB time.
pub struct PitchFigure<'a> {
    /// One list per method, in order of frequency.
    pub notes: &'a [Vec<Note>],
    /// Sample rate in Hz.
    pub sample_rate: f64,
}

impl Picture for PitchFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1280, 860)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        let all = || self.notes.iter().flatten();
        let t60 = all().next().map_or(f64::NAN, |note| note.t60);
        let title = format!("Out of tune at {} Hz: a note that decays by 60 dB in {t60} s", self.sample_rate);
        area.draw_text(&title, &text(20), (20, 12))?;
        let (_, body) = area.split_vertically(46);
        let (plots, key) = body.split_horizontally(960);
        let (upper, lower) = plots.split_vertically(440);
        let edge = |pick: fn(f64, f64) -> f64, start: f64| all().map(|note| log10(note.frequency)).fold(start, pick);
        let (low, high) = (edge(f64::min, f64::INFINITY), edge(f64::max, f64::NEG_INFINITY));
        let x = floor(low * 10.0) / 10.0..ceil(high * 10.0) / 10.0;
        let cents = Panel {
            x: Axis::logarithmic(x.clone(), ""),
            y: Axis::linear(-300.0..300.0, "error of pitch / cents"),
            title: "",
        };
        let decay = Panel {
            x: Axis::logarithmic(x, "frequency asked for / Hz"),
            y: Axis::linear(-105.0..105.0, "error of the decay time / %"),
            title: "",
        };
        for (panel, area, value) in
            [(cents, &upper, cents_of as fn(&Note) -> f64), (decay, &lower, decay_of as fn(&Note) -> f64)]
        {
            let mut chart = panel.draw(area)?;
            for notes in self.notes {
                let Some(first) = notes.first() else { continue };
                let points: Vec<_> = notes.iter().map(|note| (log10(note.frequency), value(note))).collect();
                line(&mut chart, &points, stroke(first.method))?;
            }
        }
        let methods = self.notes.iter().filter_map(|notes| notes.first());
        let entries: Vec<_> = methods.map(|note| (stroke(note.method), note.method.title().to_owned())).collect();
        legend(&key, &entries, (16, 40))?;
        let below = 60 + 24 * entries.len() as i32;
        for (n, remark) in
            ["A line ends where the note", "has no pitch any more, and", "has no decay time where", "it grows instead."]
                .iter()
                .enumerate()
        {
            key.draw_text(remark, &text(14), (16, below + 20 * n as i32))?;
        }
        Ok(())
    }
}

fn cents_of(note: &Note) -> f64 {
    match note.outcome {
        Outcome::Decays { cents, .. } | Outcome::Grows { cents, .. } => cents,
        Outcome::Explodes { .. } | Outcome::Dies => f64::NAN,
    }
}

fn decay_of(note: &Note) -> f64 {
    match note.outcome {
        Outcome::Decays { decay_percent, .. } => decay_percent,
        _ => f64::NAN,
    }
}

/// One row per method and note.
pub fn csv<'a>(notes: impl Iterator<Item = &'a Note>) -> String {
    let mut csv = String::from("method,frequency_hz,t60_s,outcome,error_cents,decay_error_percent,growth_db_per_s\n");
    for note in notes {
        let Note { method, frequency, t60, outcome } = note;
        let rest = match outcome {
            Outcome::Decays { cents, decay_percent } => format!("decays,{cents},{decay_percent},"),
            Outcome::Grows { cents, db_per_second } => format!("grows,{cents},,{db_per_second}"),
            Outcome::Explodes { db_per_second } => format!("explodes,,,{db_per_second}"),
            Outcome::Dies => "dies,,,".to_owned(),
        };
        csv += &format!("{},{frequency},{t60},{rest}\n", method.key());
    }
    csv
}

/// The notes of each of `methods` at all `frequencies`.
pub fn notes(methods: &[Method], frequencies: &[f64], t60: f64, sample_rate: f64) -> crate::Result<Vec<Vec<Note>>> {
    let play = |method: &Method| {
        frequencies.iter().map(|frequency| super::super::pitch::play(*method, *frequency, t60, sample_rate)).collect()
    };
    methods.iter().map(play).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::pitch::musical_steps;

    #[test]
    fn notes_are_drawn_and_listed() {
        let methods = [Method::ExplicitEuler, Method::SynthSeed, Method::SynthExact];
        let notes = notes(&methods, &musical_steps(20.0, 20_000.0, 30), 1.0, 48_000.0).unwrap();
        let document = crate::figure::svg(&PitchFigure { notes: &notes, sample_rate: 48_000.0 }).unwrap();
        assert!(document.contains("error of pitch / cents") && document.contains("synth step, seed"));
        let csv = csv(notes.iter().flatten());
        assert_eq!(csv.lines().count(), 91);
        assert!(csv.contains("\nsynth-seed,20000") || csv.contains(",explodes,,,"));
        assert!(csv.lines().any(|row| row.starts_with("explicit-euler,") && row.contains(",grows,")));
    }
}
