//! Bodies fitted to the sounds of bodies: each mode of the fit has the level of the original.

use super::played::{Outcome, Stereo, fitted_by, mean, preset_at};
use sprung::analysis::fit::Family;
use sprung::analysis::log_mel::RATE;
use sprung::analysis::modes::{Mode, Settings, modes};
use sprung::internals::editor::modes_of_body;
use sprung::params::{Choice, MalletPulse, Param};
use sprung::preset::Preset;
use sprung::sound::bodies::{Body, Model, Point};

/// Model, key, strike position, hardness of the mallet, and largest difference of a mode's level in dB. The third mode of the
/// free bar is struck near a node.
const STRUCK: [(&str, u8, f64, f32, f64); 3] =
    [("marimba", 60, 0.55, 45.0, 3.0), ("xylophone", 72, 0.6, 65.0, 3.5), ("free_bar", 60, 0.75, 55.0, 4.0)];
/// Level in dB, relative to the loudest mode, above which modes are compared.
const HEARD_DB: f64 = -40.0;
/// Seconds that are fitted.
const SECONDS: f64 = 0.6;

fn sound(model: &str, key: u8, x: f64, hardness: f32) -> Outcome<Stereo> {
    let (_, model) = Model::ALL.iter().find(|(id, _)| *id == model).ok_or("no such model")?;
    let body = Body::new(model.clone());
    let body = Body { strike: Point { x, ..body.strike }, modes: 12, ..body };
    let mut preset = Preset::find("init")?.clone();
    preset.patch.modes = modes_of_body(&body);
    preset.patch.set(Param::Decay, body.t60() as f32);
    preset.patch.set(Param::MalletPulse, MalletPulse::Contact.value());
    preset.patch.set(Param::MalletHardness, hardness);
    Ok(preset_at(&preset, key).map(|channel| channel[..(SECONDS * f64::from(RATE)) as usize].to_vec()))
}

fn modes_of(sound: &Stereo) -> Outcome<Vec<Mode>> {
    let found = modes(&[mean(sound)], RATE.into(), &Settings::default(), &mut |_| true)?;
    Ok(found.strikes.into_iter().next().map(|strike| strike.modes).unwrap_or_default())
}

#[test]
fn a_bar_has_the_levels_of_its_modes() -> Outcome<()> {
    levels(&STRUCK[..1])
}

#[test]
#[ignore = "takes a minute"]
fn other_bars_have_the_levels_of_their_modes() -> Outcome<()> {
    levels(&STRUCK[1..])
}

fn levels(of: &[(&str, u8, f64, f32, f64)]) -> Outcome<()> {
    let mut faults = Vec::new();
    for (model, key, x, hardness, most) in of {
        let sound = sound(model, *key, *x, *hardness)?;
        let fitted = fitted_by(&sound, (*key).into(), Family::Bar, &mut |_| true)?;
        let (own, again) = (modes_of(&sound)?, modes_of(&fitted.played)?);
        if own.len() < 3 {
            faults.push(format!("{model}: only {} modes found", own.len()));
        }
        let loudest = own.iter().map(|mode| mode.level_db).fold(f64::NEG_INFINITY, f64::max);
        for mode in own.iter().filter(|mode| mode.level_db > loudest + HEARD_DB) {
            let distance = |other: &&Mode| (other.frequency / mode.frequency - 1.0).abs();
            let nearest = again.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let off = nearest.filter(|other| distance(other) < 0.01).map(|other| other.level_db - mode.level_db);
            println!("{model}: {:.1} Hz, {:.1} dB, {off:.1?} dB off", mode.frequency, mode.level_db);
            if off.is_none_or(|off| off.abs() > *most) {
                faults.push(format!("{model}: {:.1} Hz is {off:.1?} dB off", mode.frequency));
            }
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}
