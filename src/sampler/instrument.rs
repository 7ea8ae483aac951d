//! The files that samplers read: SFZ (<https://sfzformat.com>) and DecentSampler (<https://www.decentsamples.com>).

use super::list::Line;
use super::plan::{Part, Plan, Take, Zone};
use super::release::HELD;
use std::fmt::Write;

/// Times of SFZ’s envelope in which a fall by 60 dB takes 1: it falls by e⁹ in its time, 78 dB, in sfizz.
const FALL_TIMES: f64 = 9.0 / std::f64::consts::LN_10 / 3.0;

/// The most by which the level of a region is raised, in dB.
const MOST_VOLUME: f64 = 48.0;

/// Seconds in which a released note goes over into the sample of its release.
const CROSSFADE: f64 = 0.02;

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
        let strike = match take.part {
            Part::Strike(strike) => strike,
            Part::Release => {
                // The sample was let go after some time, in which its level has fallen too.
                let fall = line.fall.unwrap_or(0.0);
                _ = writeln!(text, "trigger=release loop_mode=one_shot ampeg_attack={:.4}", 0.5 * CROSSFADE);
                _ = writeln!(text, "rt_decay={fall:.3} volume={:.3}", (fall * HELD).min(MOST_VOLUME));
                continue;
            }
        };
        if zone.strikes > 1 {
            _ = writeln!(text, "seq_length={} seq_position={}", zone.strikes, strike + 1);
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
            let release = if zone.has_releases { CROSSFADE } else { FALL_TIMES * release };
            _ = writeln!(text, "ampeg_release={release:.4}");
        }
        if zone.choke > 0 {
            _ = writeln!(text, "group={0} off_by={0} off_mode=fast", zone.choke);
        }
    }
    text
}

/// The text of a DecentSampler preset. It has no samples of releases, which it would play as loud however long a key was held.
pub(super) fn decent_sampler(plan: &Plan, lines: &[Line]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<DecentSampler minVersion=\"1.0.0\">\n".to_owned();
    text += "  <groups ampVelTrack=\"0\" attack=\"0\">\n";
    for Region { zone, take, line, velocities: [low, high] } in regions(plan, lines) {
        let Part::Strike(strike) = take.part else { continue };
        let mode = if zone.strikes > 1 { "round_robin" } else { "always" };
        _ = write!(text, "    <group seqMode=\"{mode}\" seqLength=\"{}\"", zone.strikes);
        _ = write!(text, " release=\"{:.4}\"", line.release.unwrap_or(60.0));
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
        _ = write!(text, " pitchKeyTrack=\"{}\" seqPosition=\"{}\"", zone.tracking / 100.0, strike + 1);
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
