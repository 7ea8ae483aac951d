//! One case: patch, sample rate and events, decoded from bytes, so that a random generator and a fuzzer can create it.
//!
//! Five bytes of header, then records of five bytes each. Every string of bytes is a valid case, and so is a case after
//! removing some of its records. This makes failing cases easy to shrink.

use sprung::engine::{Event, EventKind, Expression, NoteId, Notes};
use sprung::params::{Choice as _, Limiter, PARAMS, Param};
use sprung::patch::routes::{MAX_ROUTES, Response, Route, Source, amount_param};
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

/// Length in bytes of the header and of each record.
pub(crate) const RECORD: usize = 5;
/// Longest case, in frames.
pub(crate) const MAX_FRAMES: u32 = 1 << 16;
/// Maximum number of events of a case.
const MAX_EVENTS: usize = 2048;

/// The sound, the settings and the events that are played.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// Sample rate in Hz.
    pub(crate) sample_rate: f64,
    pub(crate) seed: u64,
    /// One synth on sixteen channels, or an ensemble of sixteen synths.
    pub(crate) ensemble: bool,
    /// Whether the synth plays on sixteen outputs beside the main one.
    pub(crate) outputs: bool,
    pub(crate) patch: Patch,
    /// The patches that program changes select from (ensemble only).
    pub(crate) programs: Vec<Patch>,
    /// Frames per block.
    pub(crate) block: usize,
    /// In order of their frames, which are counted from the start.
    pub(crate) events: Vec<Event>,
    pub(crate) frames: usize,
}

/// The kind of a record. Its byte is the index in [`Kind::ALL`], modulo the length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A mode of the patch.
    Mode,
    /// A parameter of the patch.
    Set,
    NoteOn,
    NoteOff,
    /// Several note-ons at equal intervals.
    Roll,
    Bend,
    ChannelPressure,
    PolyPressure,
    Control,
    /// A registered parameter: bend range, tuning, MPE zone.
    Registered,
    Express,
    Param,
    Modulate,
    Release,
    Silence,
    Tempo,
    Choke,
    Program,
    /// A route of the patch and its amount.
    Route,
    Nudge,
}

impl Kind {
    /// Every kind. Kept cases depend on the order, so new kinds must be added at the end.
    pub(crate) const ALL: [Kind; 20] = [
        Kind::Mode,
        Kind::Set,
        Kind::NoteOn,
        Kind::NoteOff,
        Kind::Roll,
        Kind::Bend,
        Kind::ChannelPressure,
        Kind::PolyPressure,
        Kind::Control,
        Kind::Registered,
        Kind::Express,
        Kind::Param,
        Kind::Modulate,
        Kind::Release,
        Kind::Silence,
        Kind::Tempo,
        Kind::Choke,
        Kind::Program,
        Kind::Route,
        Kind::Nudge,
    ];
}

/// The parameters in the order of their numbers in kept cases. New ones are added at the end; one that was removed is replaced by
/// another. The limiter is missing, because it would hide sounds above the bound.
pub(crate) const PARAM_IDS: &str = "mallet_pulse mallet_hardness mallet_hardness pluck_position noise_level noise_time velocity decay \
    release note_off decay decay_tilt tilt stretch width coefficients tune fine tuning key_track sweep sweep_time \
    sweep_curve sweep vibrato vibrato_rate vibrato_delay vibrato_sync glide bend_range vibrato \
    vibrato damper release voices mode choke gain pan \
    lfo1_rate lfo1_sync lfo1_shape lfo1_phase lfo1_fade lfo1_scope lfo2_rate lfo2_sync lfo2_shape lfo2_phase \
    lfo2_fade lfo2_scope lfo3_rate lfo3_sync lfo3_shape lfo3_phase lfo3_fade lfo3_scope \
    envelope1_delay envelope1_attack envelope1_hold envelope1_decay envelope1_sustain envelope1_release \
    envelope1_curve envelope2_delay envelope2_attack envelope2_hold envelope2_decay envelope2_sustain \
    envelope2_release envelope2_curve macro1 macro2 macro3 macro4 macro5 macro6 macro7 macro8 \
    route1 route2 route3 route4 route5 route6 route7 route8 route9 route10 route11 route12 route13 route14 route15 \
    route16 glide_when glide_by priority unison unison_detune unison_spread unison_phase \
    mallet_level pluck_level pluck_hardness pluck_width noise_reach noise_decay noise_attack noise_colour noise_hits \
    noise_spacing mallet_velocity pluck_velocity noise_velocity mallet_mass mallet_speed mallet_key vary_position \
    vary_hardness vary_modes bow_level bow_force bow_position bow_slip bow_velocity input_level \
    tension bloom bloom_time touch touch_position noise_held breath_level breath_pressure breath_valve breath_opening \
    breath_lip breath_noise breath_attack breath_tongue rattle rattle_gap rattle_mass rattle_rate rattle_hardness \
    rattle_position colour drift_level drift_pitch drift_rate breath_steepening";

/// Destinations of routes: the parameters that move pitch and damping and those of the modulation itself, but none on
/// which the bound depends. New ones must be added at the end.
const DESTINATIONS: [Param; 29] = [
    Param::Tune,
    Param::Fine,
    Param::Decay,
    Param::Release,
    Param::Vibrato,
    Param::VibratoRate,
    Param::Vibrato,
    Param::Vibrato,
    Param::Damper,
    Param::BendRange,
    Param::Sweep,
    Param::SweepTime,
    Param::SweepCurve,
    Param::MalletHardness,
    Param::DecayTilt,
    Param::Decay,
    Param::Lfo1Rate,
    Param::Lfo2Rate,
    Param::Lfo3Rate,
    Param::Route2,
    Param::Route3,
    Param::Envelope1Attack,
    Param::Tension,
    Param::BloomTime,
    Param::Touch,
    Param::TouchPosition,
    Param::Colour,
    Param::DriftLevel,
    Param::DriftPitch,
];

/// The parameter with a number, modulo their count.
pub(crate) fn param(number: u8) -> Param {
    let ids = || PARAM_IDS.split_whitespace();
    let id = ids().nth(usize::from(number) % ids().count());
    id.and_then(Param::from_id).expect("an id of the table")
}

/// The patch without what stands behind the voices, which the bound does not know, and without the limiter, which would hide sounds
/// above it.
pub(crate) fn voices_alone(patch: Patch) -> Patch {
    let behind = PARAMS.iter().filter(|info| info.param.is_behind_voices());
    let alone = behind.fold(patch, |patch, info| patch.with(info.param, info.default));
    alone.with(Param::Limiter, Limiter::Off.value())
}

/// Half of the byte values select one of these; the others cover 1–768 kHz in equal ratios.
const RATES: [u32; 16] = [
    48_000, 44_100, 22_050, 96_000, 1_000, 768_000, 8_000, 11_025, 16_000, 32_000, 88_200, 176_400, 192_000, 384_000,
    2_000, 4_000,
];
const BLOCKS: [usize; 8] = [512, 1 << 16, 32, 480, 64, 7, 1, 1000];
const CONTROLLERS: [u8; 13] = [1, 7, 10, 11, 64, 66, 67, 74, 120, 121, 123, 6, 2];
const GARBAGE: [f32; 4] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30];

/// Decodes a case.
pub(crate) fn decode(bytes: &[u8]) -> Case {
    let header: [u8; RECORD] = std::array::from_fn(|i| bytes.get(i).copied().unwrap_or(0));
    let [rate, base, form, seed, tail] = header;
    let factory = Preset::factory();
    let base = match base.checked_sub(128) {
        None => Patch::default(),
        Some(number) => factory[usize::from(number) % factory.len()].patch.clone(),
    };
    let records = || {
        let rest = bytes.get(RECORD..).unwrap_or(&[]);
        rest.chunks_exact(RECORD).map(|record| {
            let [kind, rest @ ..] = [0, 1, 2, 3, 4].map(|i| record[i]);
            (Kind::ALL[usize::from(kind) % Kind::ALL.len()], rest)
        })
    };

    let mut patch = base;
    let modes: Vec<Mode> = records().filter(|(kind, _)| *kind == Kind::Mode).map(|(_, rest)| mode(rest)).collect();
    if !modes.is_empty() {
        patch.modes = ModeTable::new(&modes);
    }
    for (_, [_, number, high, low]) in records().filter(|(kind, _)| *kind == Kind::Set) {
        let param = param(number);
        patch.set(param, setting(param, high, low));
    }
    for (_, [form, source, destination, amount]) in records().filter(|(kind, _)| *kind == Kind::Route) {
        let place = usize::from(form) % MAX_ROUTES;
        let numbered = |number: u8| Source::ALL[usize::from(number) % Source::ALL.len()];
        let (source, scale) = (numbered(source), (source >= 128).then(|| numbered(source / 2)));
        let destination = DESTINATIONS[usize::from(destination) % DESTINATIONS.len()];
        let response = Response::ALL[usize::from(form >> 4) % Response::ALL.len()];
        patch.routes.set(place, Some(Route { source, destination, response, scale }));
        patch.set(amount_param(place), (f32::from(amount) - 127.5) / 1.275);
    }

    let (mut events, mut now) = (vec![], 0_u32);
    for (kind, [pause, a, b, c]) in records() {
        if matches!(kind, Kind::Mode | Kind::Set | Kind::Route) {
            continue;
        }
        now += wait(pause);
        if now >= MAX_FRAMES || events.len() >= MAX_EVENTS {
            break;
        }
        let channel = c & 15;
        let one = |kind| Event { frame: now, channel, kind };
        match kind {
            Kind::Roll => {
                let (count, step, interval) = (1 + u32::from(b & 31), b >> 5, 1 + u32::from(c));
                for n in 0..count {
                    let key = a.wrapping_add(n as u8 * step);
                    events.push(Event::note_on(now + n * interval, key, 1.0));
                }
                now += (count - 1) * interval;
            }
            Kind::Registered => {
                let entry = |controller, value: u8| {
                    one(EventKind::Control { controller, value: f32::from(value & 127) / 127.0 })
                };
                events.extend([entry(101, 0), entry(100, [0, 1, 2, 6][usize::from(a & 3)]), entry(6, b)]);
            }
            _ => events.push(one(event(kind, a, b, c))),
        }
    }
    events.retain(|event| event.frame < MAX_FRAMES);
    let frames = now.saturating_add(1 + wait(tail)).min(MAX_FRAMES) as usize;
    let program = |preset: &Preset| voices_alone(preset.patch.clone());
    let programs = factory.iter().take(8).map(program).collect();
    let (ensemble, outputs, block) = (form & 128 != 0, form & 64 != 0, BLOCKS[usize::from(form & 7)]);
    let (sample_rate, seed, patch) = (sample_rate(rate), u64::from(seed), voices_alone(patch));
    Case { sample_rate, seed, ensemble, outputs, patch, programs, block, events, frames }
}

fn sample_rate(byte: u8) -> f64 {
    match byte.checked_sub(128) {
        None => RATES[usize::from(byte & 15)].into(),
        Some(travel) => libm::round(1000.0 * libm::pow(768.0, f64::from(travel) / 127.0)),
    }
}

/// The number of frames of a byte: up to 127 directly, then in about equal ratios up to 31,744.
fn wait(byte: u8) -> u32 {
    match byte.checked_sub(128) {
        None => byte.into(),
        Some(more) => (128 << (more >> 4)) + ((8 << (more >> 4)) * u32::from(more & 15)),
    }
}

fn unit(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}

/// From −1 to 1; 128 is 0.
fn signed(byte: u8) -> f32 {
    ((f32::from(byte) - 128.0) / 127.0).max(-1.0)
}

/// From `low` to `high` in equal ratios.
fn between(low: f32, high: f32, byte: u8) -> f32 {
    low * libm::powf(high / low, unit(byte))
}

fn mode([ratio, level, decay, rest]: [u8; 4]) -> Mode {
    Mode {
        ratio: between(0.01, 1000.0, ratio),
        level: signed(level),
        decay: between(0.001, 10.0, decay),
        strike: f32::from(rest >> 4) / 15.0,
        pan: ((f32::from(rest & 15) - 8.0) / 7.0).max(-1.0),
    }
}

/// The value of a parameter at a 16-bit position; the second-highest position gives NaN.
fn setting(param: Param, high: u8, low: u8) -> f32 {
    match u16::from_be_bytes([high, low]) {
        0xFFFE => f32::NAN,
        position => param.info().denormalise(f64::from(position) / 65_535.0),
    }
}

fn event(kind: Kind, a: u8, b: u8, c: u8) -> EventKind {
    // One in 256 numbers is out of every range.
    let number = |value: f32| if c == 255 { GARBAGE[usize::from(b & 3)] } else { value };
    let id = NoteId::new(i32::from((c >> 4) & 3) - 1);
    let notes = match c >> 6 {
        0 => Notes::default(),
        1 => Notes { id, ..Notes::default() },
        2 => Notes::on(c & 15, a),
        _ => Notes { channel: Some(c & 15), ..Notes::default() },
    };
    match kind {
        Kind::NoteOn => {
            let detune = number([0.0, 0.37, -12.7, 7.5][usize::from(c >> 6)]);
            EventKind::NoteOn { key: a, detune, velocity: number(unit(b)), id }
        }
        Kind::NoteOff => EventKind::NoteOff { key: a, velocity: number(unit(b)), id },
        Kind::Bend => EventKind::PitchBend(number(signed(b))),
        Kind::ChannelPressure => EventKind::ChannelPressure(number(unit(b))),
        Kind::PolyPressure => EventKind::PolyPressure { key: a, pressure: number(unit(b)) },
        Kind::Control => {
            let controller = CONTROLLERS[usize::from(a) % CONTROLLERS.len()];
            EventKind::Control { controller, value: number(unit(b)) }
        }
        Kind::Express => {
            let expression = Expression::ALL[usize::from(a) % Expression::ALL.len()];
            let value = match expression {
                Expression::Tuning => signed(b) * 48.0,
                Expression::Volume => unit(b) * 4.0,
                Expression::Pan => signed(b),
                _ => unit(b),
            };
            EventKind::Express { notes, expression, value: number(value) }
        }
        Kind::Param => EventKind::Param { param: param(a), value: setting(param(a), b, c) },
        Kind::Modulate => {
            let id = id.filter(|_| c & 128 != 0);
            EventKind::Modulate { id, param: param(a), offset: number(signed(b)) }
        }
        Kind::Release => EventKind::Release { notes, velocity: number(unit(b)) },
        Kind::Silence => EventKind::Silence { notes },
        Kind::Tempo => EventKind::Tempo(number(between(1.0, 10_000.0, b))),
        Kind::Nudge => EventKind::Nudge { key: a, mode: u16::from(b & 15), amplitude: number(unit(c)) },
        Kind::Choke => EventKind::Choke { group: a % 18 },
        Kind::Program => EventKind::Program(a % 10),
        Kind::Mode | Kind::Set | Kind::Route | Kind::Roll | Kind::Registered => unreachable!("handled by the caller"),
    }
}
