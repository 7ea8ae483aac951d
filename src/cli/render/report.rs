//! What `sprung render` says when it is done.

use crate::cli::{complain, complain_lines, print};
use serde_json::json;
use sprung::Result;
use sprung::io::{SampleFormat, Target};
use sprung::render::Report;

pub(super) fn tell(report: &Report, target: &Target, as_json: bool) -> Result<()> {
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
                "the limiter lowered the sound by up to {:.1} dB, for {:.2} s in all; avoid it with a lower \
                 --set gain=…, or switch it off with --set limiter=off",
                report.limiter_reduction_db, report.limiter_seconds
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

fn summary(report: &Report, target: &Target) -> String {
    let level = |value: Option<f64>, unit: &str| value.map_or(String::new(), |value| format!(", {value:.1} {unit}"));
    format!(
        "{}: {:.3} s (tail {:.3} s) at {} Hz{}{}, at most {} voices, {:.0}x real time",
        target.name(),
        report.seconds,
        report.tail_seconds,
        report.format.sample_rate,
        if report.peak_dbfs.is_some() { level(report.peak_dbfs, "dBFS peak") } else { ", silent".to_owned() },
        level(report.lufs, "LUFS"),
        report.voices_used,
        report.realtime_factor,
    )
}

/// The report under the names of [`Report`]'s fields: `voices_used`, too, is added up over channels.
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
        "gain_db": report.gain_db,
        "clipped_samples": report.clipped,
        "voices_used": report.voices_used,
        "limiter_reduction_db": report.limiter_reduction_db,
        "limiter_seconds": report.limiter_seconds,
        "realtime_factor": report.realtime_factor,
    })
}
