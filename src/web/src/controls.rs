//! What the page can set of a sound, as lines of text, and a body of another model or material.

use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::patch::routes::macro_param;
use sprung::preset::Preset;
use sprung::sound::bodies::Model;
use sprung_picture::play::{DISCS, ESSENTIALS, EXCITERS, FLOORS, MODELS};
use sprung_picture::{Origin, or_suggested, tint};

/// All that can be set, a line for each: `exciter`, its name, the number of its level, that of another parameter that is least while
/// it is off or −1, and the position at which it starts; `knob`, its name and number; `space`, its name, the parameter's number and
/// its position; `model` and its name; `material`, its name and colour; `macro`, nothing, and its number. Numbers are those of
/// parameters, positions go from 0 to 1.
pub(crate) fn list() -> String {
    let number = |param: Param| param as usize;
    // Nothing sounds into a page.
    let exciters = EXCITERS.iter().filter(|exciter| exciter.level != Param::InputLevel).map(|exciter| {
        let also = exciter.also.map_or(-1, |param| param as i32);
        let on = exciter.level.info().normalise(exciter.on);
        format!("exciter\t{}\t{}\t{also}\t{on}\n", exciter.section, number(exciter.level))
    });
    let knobs = ESSENTIALS.iter().map(|(param, name)| format!("knob\t{name}\t{}\n", number(*param)));
    let space = Param::Space.info();
    let spaces = FLOORS
        .iter()
        .enumerate()
        .map(|(value, name)| format!("space\t{name}\t{}\t{}\n", number(Param::Space), space.normalise(value as f32)));
    let models = MODELS.iter().map(|(_, name)| format!("model\t{name}\n"));
    let materials = DISCS.iter().map(|id| {
        let [red, green, blue, _] = tint(id).to_array();
        format!("material\t{id}\t#{red:02x}{green:02x}{blue:02x}\n")
    });
    let macros = (0..).map_while(macro_param).map(|param| format!("macro\t\t{}\n", number(param)));
    exciters.chain(knobs).chain(spaces).chain(models).chain(materials).chain(macros).collect()
}

/// The parameter with a number, if there is one.
pub(crate) fn info(number: usize) -> Option<&'static ParamInfo> {
    PARAMS.get(number)
}

/// The numbers of a preset's model and material in the list; −1 for others, and for a table of modes.
pub(crate) fn made_of(preset: &Preset) -> [i32; 2] {
    let origin = Origin::of(&preset.patch.modes);
    let place = |found: Option<usize>| found.map_or(-1, |place| place as i32);
    let body = origin.body();
    [
        place(body.and_then(|body| MODELS.iter().position(|(id, _)| *id == body.model.id()))),
        place(body.and_then(|body| DISCS.iter().position(|id| *id == body.material.id))),
    ]
}

/// Gives a preset a body of a model and a material by their numbers in the list; another number leaves what it has. A table of modes
/// becomes the body as which it is drawn, of two joined bodies the first one stays. The decay is moved along, as in the plugin.
pub(crate) fn make(preset: &mut Preset, [model, material]: [i32; 2]) {
    let before = Origin::of(&preset.patch.modes);
    // Of one body this changes nothing.
    let mut made = or_suggested(&before, preset.guide.family, &preset.tags).with_model(true, None);
    if let Some((id, _)) = usize::try_from(model).ok().and_then(|model| MODELS.get(model)) {
        made = made.with_model(false, Model::find(id));
    }
    let material = usize::try_from(material).ok().and_then(|material| DISCS.get(material));
    made = material.and_then(|id| made.of_material(id)).unwrap_or(made);
    let Ok(Some(modes)) = made.modes() else { return };
    preset.patch.modes = modes;
    let decay = f64::from(preset.patch.get(Param::Decay));
    let share = before.t60().map_or(1.0, |t60| decay / t60);
    let t60 = made.t60().unwrap_or(1.0);
    preset.patch.set(Param::Decay, Param::Decay.info().clamp((share * t60) as f32));
}
