//! What the page can set of a sound, as lines of text, and a body of another model or material.

use ecolor::Color32;
use sprung::params::{PARAMS, Param, ParamInfo};
use sprung::patch::routes::macro_param;
use sprung::preset::Preset;
use sprung::sound::bodies::Model;
use sprung_picture::play::{DISCS, ESSENTIALS, EXCITERS, FLOORS, MODELS, needs_space};
use sprung_picture::{Glyph, Origin, Palette, or_suggested, tint};

/// All that can be set and how it looks, a line for each:
/// - `colour`, a theme, the colour's name and itself;
/// - `exciter`, its name, the number of its level, that of another parameter that is least while it is off or −1, the position at which
///   it starts, and its picture in a square from 0 to 1 as paths of SVG: strong lines, thin ones, those of what it touches, and faces;
/// - `macro`, nothing, its number and where it rests; `knob`, its name, number, where it rests and whether it needs a space (0, 1);
///   `output`, as `knob`;
/// - `space`, its name, the parameter's number and its position;
/// - `model` and its name; `material`, its name and colour.
///
/// Numbers are those of parameters, positions go from 0 to 1.
pub(crate) fn list() -> String {
    let number = |param: Param| param as usize;
    let rest = |param: Param| param.info().normalise(param.info().default);
    let themes = [("dark", &Palette::DARK), ("light", &Palette::LIGHT), ("high-contrast", &Palette::CONTRAST)];
    let colours = themes.iter().flat_map(|(theme, palette)| {
        named(palette).map(|(name, colour)| format!("colour\t{theme}\t{name}\t{}\n", hexadecimal(colour)))
    });
    // Nothing sounds into a page.
    let exciters = EXCITERS.iter().filter(|exciter| exciter.level != Param::InputLevel).map(|exciter| {
        let also = exciter.also.map_or(-1, |param| param as i32);
        let on = exciter.level.info().normalise(exciter.on);
        let glyph = Glyph::of(exciter.level);
        let [strong, thin, touched] = [glyph.lines, glyph.thin, glyph.touched].map(path);
        let faces: String = glyph.dots.0.iter().map(|centre| disc(*centre, glyph.dots.1)).collect();
        let level = number(exciter.level);
        format!("exciter\t{}\t{level}\t{also}\t{on}\t{strong}\t{thin}\t{touched}\t{faces}\n", exciter.section)
    });
    let knob = |kind: &str, name: &str, param: Param| {
        let needs = u8::from(needs_space(param));
        format!("{kind}\t{name}\t{}\t{}\t{needs}\n", number(param), rest(param))
    };
    let knobs = ESSENTIALS.iter().map(|(param, name)| knob("knob", name, *param));
    let space = Param::Space.info();
    let spaces = FLOORS
        .iter()
        .enumerate()
        .map(|(value, name)| format!("space\t{name}\t{}\t{}\n", number(Param::Space), space.normalise(value as f32)));
    let models = MODELS.iter().map(|(_, name)| format!("model\t{name}\n"));
    let materials = DISCS.iter().map(|id| format!("material\t{id}\t{}\n", hexadecimal(tint(id))));
    let macros = (0..).map_while(macro_param).map(|param| format!("macro\t\t{}\t{}\n", number(param), rest(param)));
    let all = colours.chain(exciters).chain(macros).chain(knobs).chain([knob("output", "Gain", Param::Gain)]);
    all.chain(spaces).chain(models).chain(materials).collect()
}

/// The colours of a theme that a page has use for, by the names that its style sheet gives them.
fn named(palette: &Palette) -> [(&'static str, Color32); 13] {
    let edge = if palette.outline.a() > 0 { palette.outline } else { palette.panel };
    [
        ("ground", palette.ground),
        ("panel", palette.panel),
        ("raised", palette.raised),
        ("line", palette.line),
        ("edge", edge),
        ("text", palette.text),
        ("muted", palette.muted),
        ("accent", palette.accent),
        ("accent-text", palette.accent_text),
        ("empty-edge", palette.empty_edge()),
        ("white-key", palette.white_key),
        ("black-key", palette.black_key),
        ("key-text", palette.key_text),
    ]
}

fn hexadecimal(colour: Color32) -> String {
    let [red, green, blue, _] = colour.to_array();
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Lines as a path of SVG.
fn path(lines: &[&[[f32; 2]]]) -> String {
    let line = |line: &&[[f32; 2]]| line.iter().map(|[x, y]| format!("{x} {y}")).collect::<Vec<_>>().join(" L");
    lines.iter().map(|points| format!("M{}", line(points))).collect()
}

/// A disc as a path of SVG.
fn disc([x, y]: [f32; 2], radius: f32) -> String {
    let half = |way: f32| format!("a{radius} {radius} 0 1 0 {} 0", 2.0 * way * radius);
    format!("M{} {y}{}{}", x - radius, half(1.0), half(-1.0))
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
