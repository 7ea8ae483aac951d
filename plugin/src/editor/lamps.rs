//! Lamps that switch parts of the sound off and on: a level goes to its end, and comes back to where it was.

use crate::editor::controls::Controls;
use egui::{Id, Rect, Response, Role, Sense, Stroke, Ui, WidgetInfo};
use sprung::params::{Param, ParamInfo};
use sprung::patch::Patch;
use sprung::patch::routes::{Source, amount_param};
use sprung_picture::play::{EXCITERS, Exciter};

/// How much of the brightness is left of a knob that has no effect.
const DIMMED: f32 = 0.45;

/// A part of the sound that can be off.
pub(crate) struct Lamp {
    /// The section of the part's parameters.
    pub(crate) section: &'static str,
    /// The parameter that is at rest while the part is off.
    pub(crate) param: Param,
    /// Another parameter that must be at rest as well.
    pub(crate) also: Option<Param>,
    /// Whether they rest at their defaults, and not where they are least.
    pub(crate) rests_at_default: bool,
    /// The value of the first for a part that has not been on before.
    pub(crate) on: f32,
    /// What the part does.
    pub(crate) help: &'static str,
}

const fn lamp(section: &'static str, param: Param, on: f32, help: &'static str) -> Lamp {
    Lamp { section, param, also: None, rests_at_default: false, on, help }
}

/// The lamp of an exciter.
const fn mover(exciter: &Exciter, help: &'static str) -> Lamp {
    let Exciter { section, level, also, on } = *exciter;
    Lamp { section, param: level, also, rests_at_default: false, on, help }
}

/// What moves the body.
pub(crate) const MOVERS: [Lamp; 6] = {
    let [mallet, pluck, noise, bow, breath, input] = &EXCITERS;
    [
        mover(mallet, "A mallet strikes it."),
        mover(pluck, "A finger or a plectrum pulls it aside and lets go."),
        mover(noise, "A burst of noise, or noise that lasts: a brush, a scrape, breath."),
        mover(bow, "A bow, for as long as a key is held."),
        mover(breath, "Breath through a reed, lips or a flute’s jet, for as long as a key is held."),
        mover(input, "Incoming sound drives it while a key is held. Nothing sounds unless the host sends it sound."),
    ]
};

/// What touches the body, and what its sound passes through.
const OTHERS: [Lamp; 7] = [
    lamp("Rattle", Param::Rattle, 1.0, "Something loose lies on it or hangs at it, and strikes back."),
    lamp("Soundbox", Param::Soundbox, 1.0, "A second body, whose resonances all notes pass."),
    lamp("Strings", Param::StringsLevel, 30.0, "Strings that ring along."),
    lamp("Tremolo", Param::TremoloDepth, 50.0, "A motor takes the loudness down and up again."),
    lamp("Drive", Param::Drive, 6.0, "Lifts what is soft and holds what is loud."),
    Lamp {
        also: Some(Param::ToneHigh),
        rests_at_default: true,
        ..lamp("Tone", Param::ToneLow, 3.0, "Lifts or lowers what is low and what is high.")
    },
    lamp("Space", Param::Space, 1.0, "A plate, a spring tank or a room that reverberates."),
];

/// Parameters that do nothing while all of some others are at their defaults, and those others.
const DEPENDENT: [(&[Param], &[Param]); 8] = [
    (&[Param::NoiseSpacing], &[Param::NoiseHits]),
    (&[Param::BloomTime], &[Param::Bloom]),
    (&[Param::DriftRate], &[Param::DriftLevel, Param::DriftPitch]),
    (&[Param::TouchPosition], &[Param::Touch]),
    (&[Param::SweepTime, Param::SweepCurve], &[Param::Sweep]),
    (&[Param::VibratoRate, Param::VibratoDelay, Param::VibratoSync], &[Param::Vibrato]),
    (&[Param::GlideWhen, Param::GlideBy], &[Param::Glide]),
    (&[Param::UnisonDetune, Param::UnisonSpread, Param::UnisonPhase], &[Param::Unison]),
];

/// Why turning a parameter of a preset cannot be heard, if it cannot. Those of a kit move other sounds than the one that is shown, too.
fn quiet(info: &ParamInfo, patch: &Patch, controls: &Controls) -> Option<String> {
    if !controls.is_preset {
        return None;
    }
    let is_modulated = |param: &Param| controls.params.knobs()[*param as usize].offset() != 0.0;
    let acts = |param: &Param| controls.value(param.info()) != param.info().default || is_modulated(param);
    if let Some(lamp) = of(info.section)
        && lamp.params().all(|param| param != info.param)
        && info.param != Param::StereoWidth
        && !lamp.is_on(controls)
        && !lamp.params().any(|param| is_modulated(&param))
        && !is_raised(lamp.params(), patch, controls)
    {
        let pages = if MOVERS.iter().any(|mover| mover.section == info.section) { "Sound and Play" } else { "Sound" };
        return Some(format!("{} is off: its lamp is on {pages}.", info.section));
    }
    if info.section == "Macros" {
        let is_of = |source: Option<Source>| source.is_some_and(|source| source.id() == info.id);
        let leads = patch.routes.iter().any(|(_, route)| is_of(Some(route.source)) || is_of(route.scale));
        return (!leads).then(|| "No route leads from it yet: drag it to a knob, on Motion.".to_owned());
    }
    let (_, others) = DEPENDENT.iter().find(|(dependent, _)| dependent.contains(&info.param))?;
    if others.iter().any(acts) || is_raised(others.iter().copied(), patch, controls) {
        return None;
    }
    let names: Vec<String> = others.iter().map(|other| other.info().name.to_owned()).collect();
    let [names, is, it] = match names.len() {
        1 => [names[0].clone(), format!("is {}", controls.text(others[0].info())), "it".to_owned()],
        _ => [names.join(" and "), "are 0".to_owned(), "one".to_owned()],
    };
    Some(format!("{names} {is}: turn {it} up and this matters."))
}

/// Shows a parameter in a cell, dimmed if turning it cannot be heard; its hint then says what to switch on or to turn up first.
pub(crate) fn dimmed(
    ui: &mut Ui,
    cell: Rect,
    info: &ParamInfo,
    patch: &Patch,
    controls: &mut Controls,
    show: impl FnOnce(&mut Ui, &mut Controls),
) {
    let (opacity, why) = (ui.opacity(), quiet(info, patch, controls));
    ui.set_opacity(if why.is_some() { opacity * DIMMED } else { opacity });
    show(ui, controls);
    ui.set_opacity(opacity);
    if let (Some(why), Some(hint)) = (why, controls.hint.as_mut())
        && ui.rect_contains_pointer(cell)
    {
        hint.help = format!("{why} {}", hint.help);
    }
}

/// Whether a route can move one of these parameters.
pub(crate) fn is_raised(params: impl Iterator<Item = Param> + Clone, patch: &Patch, controls: &Controls) -> bool {
    let mut routes = patch.routes.iter().filter(|(_, route)| params.clone().any(|param| param == route.destination));
    routes.any(|(place, _)| controls.value(amount_param(place).info()) != 0.0)
}

/// The lamp of a preset's section, if it has one. The knobs of a kit move the levels of its sounds and say nothing of them.
pub(crate) fn of(section: &str) -> Option<&'static Lamp> {
    const ALL: [&[Lamp]; 2] = [&MOVERS, &OTHERS];
    ALL.into_iter().flatten().find(|lamp| lamp.section == section)
}

impl Lamp {
    /// Whether the part is on.
    pub(crate) fn is_on(&self, controls: &Controls) -> bool {
        self.params().any(|param| controls.heard(param.info()) != self.rest(param))
    }

    /// Where a parameter is while the part is off.
    fn rest(&self, param: Param) -> f32 {
        if self.rests_at_default { param.info().default } else { param.info().min }
    }

    /// The parameters that are at rest while the part is off.
    pub(crate) fn params(&self) -> impl Iterator<Item = Param> + Clone {
        std::iter::once(self.param).chain(self.also)
    }

    /// Values that switch the part off, if it is on, and otherwise on, as it was when it was switched off.
    pub(crate) fn switched(&self, controls: &mut Controls) -> Vec<(Param, f32)> {
        let part = (controls.params.name(), self.section);
        if self.is_on(controls) {
            let before = self.params().map(|param| (param, controls.value(param.info()))).collect();
            controls.interaction.switched_off.insert(part, before);
            self.params().map(|param| (param, self.rest(param))).collect()
        } else {
            controls.interaction.switched_off.remove(&part).unwrap_or_else(|| vec![(self.param, self.on)])
        }
    }

    /// Shows the lamp in the middle of the place where it can be clicked.
    pub(crate) fn show(&self, ui: &Ui, rect: Rect, controls: &mut Controls) -> Response {
        let (is_on, palette) = (self.is_on(controls), controls.palette);
        let response = ui.interact(rect, Id::unique(("lamp", self.section)), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_on, self.section));
        if response.clicked() {
            let values = self.switched(controls);
            controls.set_all(format!("{} {}", self.section, if is_on { "off" } else { "on" }), values);
        }
        if is_on {
            ui.painter().circle_filled(rect.center(), 3.5, palette.accent);
        } else {
            ui.painter().circle_stroke(rect.center(), 3.0, Stroke::new(1.0, palette.muted));
        }
        if response.has_focus() {
            ui.painter().circle_stroke(rect.center(), 6.0, Stroke::new(1.5, palette.text));
        }
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::engine::{Event, Synth};
    use sprung::preset::Preset;

    fn bits(patch: &Patch) -> Vec<u32> {
        let mut synth = Synth::new(48_000.0, 1);
        synth.set_patch(patch);
        let [mut left, mut right] = [vec![0.0; 24_000], vec![0.0; 24_000]];
        // Tied, and apart.
        let off = |key| Event::note_off(10_000, key);
        let events = [
            Event::note_on(0, 60, 0.8),
            Event::note_on(6_000, 67, 0.8),
            off(60),
            off(67),
            Event::note_on(14_000, 72, 0.8),
        ];
        synth.process(&events, &mut left, &mut right);
        left.iter().chain(&right).map(|sample| sample.to_bits()).collect()
    }

    #[test]
    fn what_is_dimmed_changes_no_bit_and_is_heard_otherwise() {
        let marimba = &Preset::find("Marimba").unwrap().patch;
        let patch = marimba.clone().with(Param::NoiseLevel, -6.0).with(Param::Voices, 1.0);
        let at_rest = bits(&patch);
        for (dependent, others) in DEPENDENT {
            let moved = others.iter().fold(patch.clone(), |patch, other| {
                let info = other.info();
                patch.with(*other, info.denormalise(0.75))
            });
            for param in dependent {
                let info = param.info();
                let to =
                    [0.0, 1.0].map(|end| info.denormalise(end)).into_iter().find(|to| *to != info.default).unwrap();
                assert!(bits(&patch.clone().with(*param, to)) == at_rest, "{}", info.id);
                assert!(bits(&moved.clone().with(*param, to)) != bits(&moved), "{} with {others:?}", info.id);
            }
        }
    }
}
