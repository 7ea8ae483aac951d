//! What the pictures of sections show, as points: forces, friction, flow, pitch, gains, as far as the knobs make them.
//!
//! Time and whatever else runs to the right does so from 0 to 1; values are from −1 to 1, or from 0 to 1.

use egui::{Vec2, vec2};
use sprung::internals::curves;
use sprung::params::{Choice as _, MalletPulse, NoiseDecay, PARAMS, Param, ParamInfo, Rattle, Shape, Soundbox, Valve};
use sprung::sound::contact_time;
use sprung::units::{db_from_gain, ratio_from_semitones, semitones_from_ratio};
use std::f32::consts::TAU;
use std::f64::consts::{LN_2, LOG2_10};

/// Number of points of a curve.
const POINTS: usize = 40;
/// The duration that a mallet's picture shows, in seconds: longer contacts are cut off.
const CONTACT: f64 = 0.012;
/// Exponent of a mallet's mass in its contact time, by Hertz's law.
const MASS_POWER: f64 = 0.4;
/// The highest pressure in the picture of a valve, the greatest bend of a jet in half widths, and the time that a loose mass is
/// watched, in seconds.
const PRESSURE: f64 = 2.0;
const BEND: f64 = 6.0;
const FLIGHT: f64 = 0.1;
/// How many halvings a fall by 60 dB has.
const HALVINGS: f64 = 3.0 * LOG2_10;
/// The gain in dB at the edges of the picture of a soundbox.
const LOUDEST: f64 = 24.0;
/// Fixed example values for LFO shapes with random values.
const CHANCE: [f32; 4] = [0.5, -0.8, 0.9, -0.3];

/// What is drawn of a section.
pub(super) struct Outline {
    pub(super) lines: Vec<Vec<Vec2>>,
    /// Places on the lines that the knobs set.
    pub(super) marks: Vec<Vec2>,
    /// Whether 0 is in the middle of the picture, and not at its foot.
    pub(super) is_around: bool,
    /// Whether the lines are those around areas.
    pub(super) is_filled: bool,
    /// What runs to the right and up.
    pub(super) caption: String,
}

fn above(line: Vec<Vec2>, caption: impl Into<String>) -> Outline {
    Outline { lines: vec![line], marks: Vec::new(), is_around: false, is_filled: false, caption: caption.into() }
}

fn around(line: Vec<Vec2>, caption: impl Into<String>) -> Outline {
    Outline { is_around: true, ..above(line, caption) }
}

/// What is drawn of the parameters of a section with these values; none if nothing is.
pub(super) fn of(section: &[ParamInfo], value: &dyn Fn(&'static ParamInfo) -> f32) -> Option<Outline> {
    let first = section[0].param;
    let get = |param: Param| f64::from(value(param.info()));
    let share = |param: Param| get(param) / 100.0;
    // A row of the section, counted from its first.
    let row = |place: usize| value(&PARAMS[first as usize + place]);
    Some(match first {
        Param::MalletLevel => {
            let is_impulse = MalletPulse::from_value(value(Param::MalletPulse.info())) == MalletPulse::Impulse;
            let [hardness, mass] = [share(Param::MalletHardness), get(Param::MalletMass)];
            let caption =
                if is_impulse { "force".to_owned() } else { format!("force, {}", time(contact(hardness, mass))) };
            above(mallet(hardness, mass, is_impulse), caption)
        }
        Param::PluckLevel => {
            let hardness = share(Param::PluckHardness);
            above(mallet(hardness, 1.0, false), format!("let go in {}", time(contact(hardness, 1.0))))
        }
        Param::NoiseLevel => {
            let times = [Param::NoiseAttack, Param::NoiseTime, Param::NoiseSpacing].map(get);
            let is_exponential = NoiseDecay::from_value(value(Param::NoiseDecay.info())) == NoiseDecay::Exponential;
            let hits = get(Param::NoiseHits).max(1.0);
            let seconds = times[0] + times[1] + times[2] * (hits - 1.0);
            above(noise(times, is_exponential, hits as u32), format!("force, {}", time(seconds)))
        }
        Param::BowLevel => around(bow(share(Param::BowForce), share(Param::BowSlip)), "friction by slip"),
        Param::BreathLevel => {
            let valve = Valve::from_value(value(Param::BreathValve.info()));
            breath(valve, share(Param::BreathOpening), share(Param::BreathPressure))
        }
        Param::Rattle => match Rattle::from_value(value(Param::Rattle.info())) {
            Rattle::Off => around(swing(), "nothing touches it"),
            Rattle::Edge => edge(share(Param::RattleGap)),
            Rattle::Loose => above(loose(get(Param::RattleRate)), format!("flight, {}", time(FLIGHT))),
        },
        Param::Velocity => above(strike(share(Param::Velocity)), "force by velocity"),
        Param::Tune => {
            let sweep = [Param::Sweep, Param::SweepTime, Param::SweepCurve].map(get);
            pitch(sweep, [Param::Vibrato, Param::VibratoRate, Param::VibratoDelay].map(get))
        }
        Param::Soundbox => {
            let [size, vowel] = [share(Param::SoundboxSize), share(Param::SoundboxVowel)];
            let gain = curves::soundbox(Soundbox::from_value(value(Param::Soundbox.info())), vowel)?;
            around(plotted(3 * POINTS, |x| (gain(hertz(x) * size) / LOUDEST).clamp(-1.0, 1.0)), "gain by frequency")
        }
        Param::StringsLevel => {
            above(decay([Param::StringsLowDecay, Param::StringsHighDecay].map(get)), "T60 by frequency")
        }
        Param::TremoloDepth => {
            tremolo(share(Param::TremoloDepth), get(Param::TremoloRate), share(Param::TremoloStereo))
        }
        Param::Drive => drive(value(Param::Drive.info())),
        Param::ToneLow => {
            around(tone([Param::ToneLow, Param::ToneHigh].map(|param| value(param.info()))), "gain by frequency")
        }
        Param::Gain => output(get(Param::Gain), value(Param::Pan.info())),
        Param::Lfo1Rate | Param::Lfo2Rate | Param::Lfo3Rate => {
            around(oscillator(Shape::from_value(row(2)), row(3) / 100.0), "two rounds")
        }
        _ => return None,
    })
}

/// A time as text.
fn time(seconds: f64) -> String {
    Param::Decay.info().format(seconds as f32)
}

/// Points of a function from 0 to 1.
fn plotted(count: usize, value: impl Fn(f64) -> f64) -> Vec<Vec2> {
    let points = (0..=count).map(|point| point as f64 / count as f64);
    points.map(|x| vec2(x as f32, value(x) as f32)).collect()
}

/// The time of a mallet's contact at full speed, in seconds.
fn contact(hardness: f64, mass: f64) -> f64 {
    contact_time(hardness) * ratio_from_semitones(MASS_POWER * semitones_from_ratio(mass))
}

/// The friction of a bow of some force, against how fast it slips, to both sides.
fn bow(force: f64, width: f64) -> Vec<Vec2> {
    plotted(8 * POINTS, |x| {
        let slip = 2.0 * x - 1.0;
        let sticks = if slip == 0.0 { 0.0 } else { slip.signum() };
        force * sticks * f64::from(curves::friction(width as f32, slip as f32))
    })
}

/// The flow through a valve against the pressure before it, up to `PRESSURE`, with a mark at the pressure that is set; or of a jet into
/// a tube, against its bend.
fn breath(valve: Valve, opening: f64, pressure: f64) -> Outline {
    if valve == Valve::Jet {
        let most = curves::flow(valve, 1.0, BEND);
        let line = plotted(2 * POINTS, |x| curves::flow(valve, opening, BEND * (2.0 * x - 1.0)) / most);
        return above(line, "flow by bend");
    }
    let points = |opening: f64| plotted(2 * POINTS, |x| curves::flow(valve, opening, PRESSURE * x));
    let most = points(1.0).into_iter().map(|point| point.y).fold(0.0, f32::max);
    let line = points(opening).into_iter().map(|point| vec2(point.x, point.y / most)).collect();
    let flow = curves::flow(valve, opening, pressure) as f32 / most;
    let marks = vec![vec2((pressure / PRESSURE) as f32, flow)];
    Outline { marks, ..above(line, "flow by pressure") }
}

/// The swing of a body, twice to and fro.
fn swing() -> Vec<Vec2> {
    plotted(4 * POINTS, |x| Vec2::angled(2.0 * TAU * x as f32).y.into())
}

/// A swing that hits an edge at a share of it; the marks are where.
fn edge(gap: f64) -> Outline {
    let line = swing();
    let is_hit = |pair: &&[Vec2]| pair[0].y < gap as f32 && pair[1].y >= gap as f32;
    let marks = line.windows(2).filter(is_hit).map(|pair| vec2(pair[1].x, gap as f32)).collect();
    let stop = plotted(1, |_| gap);
    Outline { lines: vec![line, stop], marks, ..around(Vec::new(), "swing and edge") }
}

/// The flight of a loose mass that hits so often in a second.
fn loose(rate: f64) -> Vec<Vec2> {
    plotted(16 * POINTS, |x| {
        let share = (x * FLIGHT * rate).fract();
        4.0 * share * (1.0 - share)
    })
}

/// The force of all exciters by velocity, as far as it follows that.
fn strike(follow: f64) -> Vec<Vec2> {
    plotted(POINTS, |velocity| curves::force(velocity as f32, 2.0 * follow))
}

/// The pitch around the note's: a sweep of semitones, time and curve, and a vibrato of cents, rate and delay.
fn pitch([semitones, seconds, curve]: [f64; 3], [cents, rate, delay]: [f64; 3]) -> Outline {
    let (swept, depth) = (semitones != 0.0, cents / 100.0);
    let turns = if depth > 0.0 { delay + 3.0 / rate } else { 0.0 };
    // The sweep takes at most two thirds of the picture; the note's pitch takes the rest.
    let whole = if swept { 1.5 * seconds } else { 0.0 }.max(turns);
    let scale = if swept { (semitones.abs() + depth).max(12.0) } else { depth.max(1.0) };
    let line = plotted(8 * POINTS, |x| {
        let now = x * whole;
        let sweep = if swept && now < seconds { semitones * rest(now / seconds, curve / 100.0) } else { 0.0 };
        let fade = if delay > 0.0 { (now / delay).min(1.0) } else { 1.0 };
        let vibrato =
            if depth > 0.0 { depth * fade * f64::from(Vec2::angled(TAU * (now * rate) as f32).y) } else { 0.0 };
        (sweep + vibrato) / scale
    });
    around(line, if whole > 0.0 { format!("pitch, {}", time(whole)) } else { "pitch".to_owned() })
}

/// A frequency of the pictures in Hz, from 20 Hz on over ten octaves.
fn hertz(x: f64) -> f64 {
    20.0 * ratio_from_semitones(120.0 * x)
}

/// T60 by frequency, by its logarithm between its ends.
fn decay(times: [f64; 2]) -> Vec<Vec2> {
    let info = Param::StringsLowDecay.info();
    plotted(POINTS, |x| info.normalise(curves::decay(times, hertz(x)) as f32))
}

/// The gains of both sides over a second, or ten of a slow motor.
fn tremolo(depth: f64, rate: f64, stereo: f64) -> Outline {
    let seconds = if rate < 1.0 { 10.0 } else { 1.0 };
    let side = |ahead: f64| plotted(8 * POINTS, |x| curves::tremolo(depth, x * seconds * rate + ahead).into());
    let mut lines = vec![side(0.0)];
    if stereo > 0.0 {
        lines.push(side(0.5 * stereo));
    }
    Outline { lines, ..above(Vec::new(), format!("gain, {}", time(seconds))) }
}

/// What comes out by what goes in, beside what passes unchanged.
fn drive(decibels: f32) -> Outline {
    let line = plotted(2 * POINTS, |x| curves::drive(decibels, x as f32).into());
    Outline { lines: vec![line, plotted(1, |x| x)], ..above(Vec::new(), "out by in") }
}

/// The gain by frequency, as a share of the largest.
fn tone(decibels: [f32; 2]) -> Vec<Vec2> {
    plotted(2 * POINTS, |x| curves::tone(decibels, hertz(x)) / f64::from(Param::ToneLow.info().max))
}

/// The levels of both sides, as a bar each.
fn output(gain: f64, pan: f32) -> Outline {
    let sides = curves::pan(0.5 + 0.005 * pan).map(|side| (gain + db_from_gain(side.into())).max(-99.9));
    let bar = |left: f32, db: f64| {
        let level = (Param::Gain.info().normalise(db as f32) as f32).clamp(0.0, 1.0);
        [vec2(left, 0.0), vec2(left, level), vec2(left + 0.2, level), vec2(left + 0.2, 0.0)]
    };
    let lines = [bar(0.2, sides[0]), bar(0.6, sides[1])].map(Vec::from).into();
    let caption = format!("left {:.1}, right {:.1} dB", sides[0], sides[1]);
    Outline { lines, is_filled: true, ..above(Vec::new(), caption) }
}

/// The force of a mallet: `u² (1 − u)²` over its contact, scaled to a peak of 1. The width is proportional to the
/// square root of the contact time, so that short contacts stay visible. For an impulse, which lasts one sample, a
/// vertical line.
fn mallet(hardness: f64, mass: f64, is_impulse: bool) -> Vec<Vec2> {
    if is_impulse {
        return vec![vec2(0.0, 0.0), vec2(0.02, 0.0), vec2(0.02, 1.0), vec2(0.02, 0.0), vec2(1.0, 0.0)];
    }
    let width = (contact(hardness, mass) / CONTACT).sqrt() as f32;
    let force = |share: f32| 16.0 * share * share * (1.0 - share) * (1.0 - share);
    let points = (0..=POINTS).map(|point| point as f32 / POINTS as f32);
    // A contact longer than the picture is cut off.
    let bump = points.map(|share| vec2(share * width, force(share))).filter(|point| point.x < 1.0);
    let end = vec2(1.0, force((1.0 / width).min(1.0)));
    bump.chain([end]).collect()
}

/// The envelope of bursts of noise: the times of attack and decay, the distance between bursts, the kind of decay (an
/// exponential one falls by 60 dB), and the number of bursts.
fn noise([attack, time, spacing]: [f64; 3], is_exponential: bool, hits: u32) -> Vec<Vec2> {
    let total = attack + time + spacing * f64::from(hits - 1);
    let level = |since: f64| {
        let fallen = (since - attack) / time.max(1e-9);
        match fallen {
            ..0.0 => since / attack.max(1e-9),
            1.0.. => 0.0,
            _ if is_exponential => ratio_from_semitones(-12.0 * fallen * HALVINGS),
            _ => (1.0 - fallen) * (1.0 - fallen),
        }
    };
    let count = 4 * POINTS;
    (0..=count)
        .map(|point| {
            let now = total * point as f64 / count as f64;
            let hit = if hits > 1 { ((now / spacing) as u32).min(hits - 1) } else { 0 };
            vec2(point as f32 / count as f32, level(now - f64::from(hit) * spacing) as f32)
        })
        .collect()
}

/// How much of a sweep is left after a share of its time, for a curve from −1 to 1.
fn rest(share: f64, curve: f64) -> f64 {
    let steepness = 8.0 * curve;
    let exp = |power: f64| ratio_from_semitones(12.0 * power / LN_2);
    if steepness.abs() < 1e-3 {
        1.0 - share
    } else {
        (exp(-steepness * share) - exp(-steepness)) / (1.0 - exp(-steepness))
    }
}

/// Two cycles of an LFO; `start` is its phase at the start, in cycles.
fn oscillator(shape: Shape, start: f32) -> Vec<Vec2> {
    let value = |round: usize, phase: f32| match shape {
        Shape::Sine => Vec2::angled(TAU * phase).y,
        Shape::Triangle => 1.0 - (4.0 * if phase < 0.75 { phase } else { phase - 1.0 } - 1.0).abs(),
        Shape::Ramp => 2.0 * phase - 1.0,
        Shape::Square => 1.0_f32.copysign(0.5 - phase),
        Shape::Steps => CHANCE[round % CHANCE.len()],
        Shape::Drift => {
            let [from, to] = [0, 1].map(|next| CHANCE[(round + next) % CHANCE.len()]);
            from + (to - from) * (phase * phase * (3.0 - 2.0 * phase))
        }
    };
    let count = 4 * POINTS;
    (0..=count)
        .map(|point| {
            let cycles = start + 2.0 * point as f32 / count as f32;
            vec2(point as f32 / count as f32, value(cycles as usize, cycles.fract()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sections() -> impl Iterator<Item = &'static [ParamInfo]> {
        PARAMS.chunk_by(|a, b| a.section == b.section)
    }

    #[test]
    fn outlines_stay_in_their_picture_whatever_the_knobs_say() {
        for section in sections() {
            for position in [0.0, 0.3, 0.5, 0.77, 1.0] {
                let Some(outline) = of(section, &|info| info.denormalise(position)) else { continue };
                let name = section[0].section;
                let least = if outline.is_around { -1.001 } else { -0.001 };
                for point in outline.lines.iter().flatten().chain(&outline.marks) {
                    assert!((-0.001..=1.001).contains(&point.x), "{name} {position}: {point}");
                    assert!((least..=1.001).contains(&point.y), "{name} {position}: {point}");
                }
                let goes_on = |line: &Vec<Vec2>| line.windows(2).all(|pair| pair[0].x <= pair[1].x);
                assert!(outline.lines.iter().all(goes_on) && !outline.caption.is_empty(), "{name} {position}");
            }
        }
    }

    #[test]
    fn outlines_follow_their_values() {
        let width = |hardness| {
            mallet(hardness, 1.0, false).iter().filter(|point| point.y > 0.0).map(|point| point.x).fold(0.0, f32::max)
        };
        assert!(width(0.2) > 2.0 * width(0.8), "a hard mallet touches shortly");
        let peaks =
            |hits| noise([0.0, 0.1, 0.05], true, hits).windows(2).filter(|pair| pair[1].y > pair[0].y + 0.3).count();
        assert_eq!((peaks(1), peaks(3)), (0, 2));
        let sweep = |curve| pitch([24.0, 0.2, curve], [0.0, 5.0, 0.0]).lines[0].clone();
        assert_eq!(sweep(50.0)[0].y, 1.0);
        assert!(sweep(100.0)[80].y < sweep(-100.0)[80].y, "it falls fast and settles slowly");
        let vibrato = pitch([0.0; 3], [50.0, 5.0, 1.0]).lines[0].clone();
        assert!(vibrato[10].y.abs() < 0.1 && vibrato.iter().any(|point| point.y > 0.45), "it fades in");
        assert!(breath(Valve::Reed, 1.0, 1.2).marks[0].y == 0.0, "the reed is closed");
        assert_eq!(edge(0.2).marks.len(), 2);
        assert_eq!(tremolo(1.0, 5.0, 1.0).lines.len(), 2);
    }
}
