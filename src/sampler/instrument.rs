//! The files that samplers read: SFZ (<https://sfzformat.com>) and DecentSampler (<https://www.decentsamples.com>).

use super::list::Line;
use super::plan::{Plan, Take, Zone};
use std::fmt::Write;

/// A sample with its zone and velocities.
struct Region<'a> {
    zone: &'a Zone,
    take: &'a Take,
    line: &'a Line,
    velocities: [u8; 2],
}

fn regions<'a>(plan: &'a Plan, lines: &'a [Line]) -> impl Iterator<Item = Region<'a>> {
    plan.takes.iter().zip(lines).map(|(take, line)| {
        let layer = &plan.layers[take.layer];
        Region { zone: &plan.zones[take.zone], take, line, velocities: [*layer.start(), *layer.end()] }
    })
}

/// The text of an SFZ file. Samples carry their own levels, so velocity does not change them further.
pub(super) fn sfz(plan: &Plan, lines: &[Line], name: &str) -> String {
    let name = crate::text::printable(name);
    let mut text = format!("// {name}, sampled by sprung {}\n\n<global>\namp_veltrack=0\n", env!("CARGO_PKG_VERSION"));
    for Region { zone, take, line, velocities: [low, high] } in regions(plan, lines) {
        let (keys, file) = (&zone.keys, &line.file);
        _ = write!(text, "\n<region>\nsample={file}\nlokey={} hikey={}", keys.start(), keys.end());
        _ = write!(text, " pitch_keycenter={} lovel={low} hivel={high}", zone.key);
        if zone.tracking != 100.0 {
            _ = write!(text, " pitch_keytrack={}", zone.tracking);
        }
        text.push('\n');
        if plan.strikes > 1 {
            _ = writeln!(text, "seq_length={} seq_position={}", plan.strikes, take.strike + 1);
        }
        match (line.looped, line.release) {
            // The last frame of a loop belongs to it.
            (Some([start, end]), _) => {
                _ = writeln!(text, "loop_mode=loop_continuous loop_start={start} loop_end={}", end - 1)
            }
            (None, None) => text += "loop_mode=one_shot\n",
            (None, Some(_)) => text += "loop_mode=no_loop\n",
        }
        if let Some(release) = line.release {
            _ = writeln!(text, "ampeg_release={release:.4}");
        }
        if zone.choke > 0 {
            _ = writeln!(text, "group={0} off_by={0} off_mode=fast", zone.choke);
        }
    }
    text
}

/// The text of a DecentSampler preset.
pub(super) fn decent_sampler(plan: &Plan, lines: &[Line]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<DecentSampler minVersion=\"1.0.0\">\n".to_owned();
    let mode = if plan.strikes > 1 { "round_robin" } else { "always" };
    _ = writeln!(text, "  <groups ampVelTrack=\"0\" attack=\"0\" seqMode=\"{mode}\" seqLength=\"{}\">", plan.strikes);
    for Region { zone, take, line, velocities: [low, high] } in regions(plan, lines) {
        _ = write!(text, "    <group release=\"{:.4}\"", line.release.unwrap_or(60.0));
        if zone.choke > 0 {
            _ = write!(text, " tags=\"choke{0}\" silencedByTags=\"choke{0}\" silencingMode=\"fast\"", zone.choke);
        }
        _ = write!(text, ">\n      <sample path=\"{}\" rootNote=\"{}\"", line.file, zone.key);
        _ = write!(
            text,
            " loNote=\"{}\" hiNote=\"{}\" loVel=\"{low}\" hiVel=\"{high}\"",
            zone.keys.start(),
            zone.keys.end()
        );
        _ = write!(text, " pitchKeyTrack=\"{}\" seqPosition=\"{}\"", zone.tracking / 100.0, take.strike + 1);
        match line.looped {
            Some([start, end]) => {
                _ = write!(text, " loopEnabled=\"true\" loopStart=\"{start}\" loopEnd=\"{}\"", end - 1);
            }
            None => text += " loopEnabled=\"false\"",
        }
        text += "/>\n    </group>\n";
    }
    text + "  </groups>\n</DecentSampler>\n"
}
