//! The report that `sprung render` prints.

use crate::terminal::{complain, complain_lines, counted, print};
use serde_json::json;
use sprung::Result;
use sprung::internals::files::Target;
use sprung::io::SampleFormat;
use sprung::render::Report;

/// Tells what came of a rendering whose mix had this gain.
pub(super) fn tell(report: &Report, target: &Target, mix_gain_db: f64, as_json: bool) -> Result<()> {
    if report.clipped > 0 {
        complain(
            "warning",
            format_args!(
                "{} samples clipped; lower the level with --normalize peak=-1 or --gain-db, or keep it with --bits 32f",
                report.clipped
            ),
        );
    }
    if report.limiter_reduction_db > 0.0 && !as_json {
        complain(
            "note",
            format_args!(
                "the limiter lowered the sound by up to {:.1} dB, for {:.2} s in all; avoid it with --mix-gain-db {}, which \
                 keeps the balance, or switch it off with --set limiter=off",
                report.limiter_reduction_db,
                report.limiter_seconds,
                gain_without_limiter(report, mix_gain_db)
            ),
        );
    }
    if report.non_finite > 0 {
        complain(
            "warning",
            format_args!(
                "{} samples are infinite or not a number, which is a defect of the synthesizer",
                report.non_finite
            ),
        );
    }
    match (as_json, target) {
        (true, Target::Path(_)) => print(&format!("{:#}\n", to_json(report, target))),
        (true, Target::Stdout) => {
            complain_lines(&format!("{:#}\n", to_json(report, target)));
            Ok(())
        }
        (false, _) => {
            complain_lines(&format!("{}\n", summary(report, target)));
            Ok(())
        }
    }
}

/// The gain of the mix in dB, to a tenth, at which the limiter has nothing to do. Its ceiling is below the level at which it
/// begins, so a mix that is lower by what it took away stays below that level.
fn gain_without_limiter(report: &Report, mix_gain_db: f64) -> f64 {
    (((mix_gain_db - report.limiter_reduction_db) * 10.0).floor() / 10.0).max(-120.0)
}

fn summary(report: &Report, target: &Target) -> String {
    let level = |value: Option<f64>, unit: &str| value.map_or(String::new(), |value| format!(", {value:.1} {unit}"));
    format!(
        "{}: {:.3} s (tail {:.3} s) at {} Hz{}{}, at most {} at once, {:.0}x real time",
        target.name(),
        report.seconds,
        report.tail_seconds,
        report.format.sample_rate,
        match report.peak_dbfs {
            None if report.non_finite == 0 => ", silent".to_owned(),
            peak => level(peak, "dBFS peak"),
        },
        level(report.lufs, "LUFS"),
        counted(report.voices_used, "note"),
        report.realtime_factor,
    )
}

/// The report as JSON, mostly with the names of [`Report`]'s fields; `voices_used` is the sum over all channels. For silence, the levels are null and
/// `non_finite_samples` is 0.
fn to_json(report: &Report, target: &Target) -> serde_json::Value {
    json!({
        "output": target.name(),
        "sample_rate": report.format.sample_rate,
        "channels": report.format.channels,
        "bits": report.format.samples.bits(),
        "float": report.format.samples == SampleFormat::Float32,
        "frames": report.frames,
        "seconds": report.seconds,
        "tail_seconds": report.tail_seconds,
        "peak_dbfs": report.peak_dbfs,
        "rms_dbfs": report.rms_dbfs,
        "lufs": report.lufs,
        "non_finite_samples": report.non_finite,
        "gain_db": report.gain_db,
        "clipped_samples": report.clipped,
        "voices_used": report.voices_used,
        "limiter_reduction_db": report.limiter_reduction_db,
        "limiter_seconds": report.limiter_seconds,
        "realtime_factor": report.realtime_factor,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::io::WavFormat;

    #[test]
    fn silence_and_samples_that_are_not_finite_are_told_apart() {
        let format = WavFormat { sample_rate: 48_000, channels: 2, samples: SampleFormat::Int24 };
        let report = |non_finite| Report {
            format,
            frames: 1,
            seconds: 1.0,
            tail_seconds: 0.0,
            peak_dbfs: None,
            rms_dbfs: None,
            lufs: None,
            non_finite,
            gain_db: 0.0,
            clipped: 0,
            voices_used: 1,
            limiter_reduction_db: 0.0,
            limiter_seconds: 0.0,
            realtime_factor: 1.0,
        };
        for (non_finite, silent) in [(0, true), (7, false)] {
            let json = to_json(&report(non_finite), &Target::Stdout);
            assert_eq!((&json["peak_dbfs"], &json["non_finite_samples"]), (&json!(null), &json!(non_finite)));
            assert_eq!(summary(&report(non_finite), &Target::Stdout).contains("silent"), silent);
        }
    }
}
