//! The page of the program's device, sample rate, block size and MIDI ports. A host has its own.

use crate::devices::{Chosen, Devices};
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{GAP, PADDING, SMALL, paint_panel};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::choice::Field;
use crate::editor::widgets::text::{line, paragraph};
use egui::{Align2, Id, Rect, Ui, pos2, vec2};

/// Height of a field, and of a row.
const FIELD: f32 = 22.0;
const ROW: f32 = 28.0;
/// Width of the names.
const NAMES: f32 = 78.0;
/// Largest widths of the two columns.
const COLUMNS: [f32; 2] = [460.0, 260.0];
/// Block sizes to choose from, in frames.
const BLOCKS: [u32; 7] = [32, 64, 128, 256, 512, 1024, 2048];

/// A list to choose from: names with their values, and the name of the chosen one.
struct Choices<T> {
    all: Vec<(String, T)>,
    chosen: String,
}

impl<T: PartialEq + Clone> Choices<T> {
    /// The chosen value is always in the list, even if it is not available now.
    fn new(mut all: Vec<(String, T)>, chosen: &T, missing: impl FnOnce() -> String) -> Self {
        let known = all.iter().find(|(_, one)| one == chosen).map(|(name, _)| name.clone());
        let name = known.unwrap_or_else(|| {
            let name = missing();
            all.push((name.clone(), chosen.clone()));
            name
        });
        Self { all, chosen: name }
    }

    /// Shows the choice in a row. Returns the picked value.
    fn show(&self, ui: &Ui, row: Rect, [name, help]: [&str; 2], controls: &mut Controls) -> Option<T> {
        let palette = controls.palette;
        let label = row.with_max_x(row.left() + NAMES);
        line(ui.painter(), label, Align2::LEFT_CENTER, name, SMALL, palette.muted);
        let names: Vec<_> = self.all.iter().map(|(name, _)| name.as_str()).collect();
        let field = Field { id: Id::unique(("device", name)), name, value: &self.chosen, is_default: true };
        let (response, picked) = field.show(ui, row.with_min_x(label.right()), &names, palette);
        if response.hovered() {
            *controls.hint = Hint::new(format!("{name}: {}", self.chosen), help);
        }
        let (_, value) = self.all.get(picked?)?;
        Some(value.clone())
    }
}

/// Shows the page. Returns whether the user closes it.
pub(super) fn show(ui: &Ui, rect: Rect, controls: &mut Controls) -> bool {
    let palette = controls.palette;
    paint_panel(ui.painter(), rect, palette);
    let inner = rect.shrink(2.0 * PADDING);
    let devices = controls.params.link().devices.look();
    let share = (inner.width() - 2.0 * GAP) / (COLUMNS[0] + COLUMNS[1]);
    let [wide, narrow] = COLUMNS.map(|width| (width * share).min(width));
    let row = |column: usize, place: usize| {
        let left = inner.left() + if column == 0 { 0.0 } else { wide + 2.0 * GAP };
        let size = vec2(if column == 0 { wide } else { narrow }, FIELD);
        Rect::from_min_size(pos2(left, inner.top() + place as f32 * ROW), size)
    };
    let chosen = &devices.chosen;
    let mut request = chosen.clone();
    if let Some((host, device)) = outputs(&devices).show(ui, row(0, 0), OUTPUT, controls) {
        // Another device may not support the same sample rates and block sizes.
        request = Chosen { host, device, midi_in: chosen.midi_in.clone(), ..Chosen::default() };
    }
    if let Some(port) = ports(&devices).show(ui, row(0, 1), PORTS, controls) {
        request.midi_in = port;
    }
    let rates = numbers("48000 Hz, or the device’s", &devices.rates, chosen.rate, "Hz");
    if let Some(rate) = rates.show(ui, row(1, 0), RATE, controls) {
        request.rate = rate;
    }
    // The blocks of a size that was chosen are not the device's own.
    let own = match (chosen.buffer, devices.block) {
        (None, frames @ 1..) => format!("the usual: {frames} frames"),
        _ => "256 frames, or the nearest".to_owned(),
    };
    let blocks = numbers(&own, &BLOCKS, chosen.buffer, "frames");
    if let Some(buffer) = blocks.show(ui, row(1, 1), BLOCK, controls) {
        request.buffer = buffer;
    }
    if request != *chosen {
        controls.params.link().devices.request(request);
    }
    let mut below = inner.with_min_y(inner.top() + 2.0 * ROW);
    let playing = match &*devices.playing {
        "" => "Nothing plays yet: choose an output, or plug one in.".to_owned(),
        playing => format!("Playing on {playing}"),
    };
    line(ui.painter(), below.with_max_y(below.top() + 18.0), Align2::LEFT_CENTER, &playing, SMALL, palette.text);
    below.set_top(below.top() + 24.0);
    below.set_right(below.right().min(below.left() + COLUMNS[0] + COLUMNS[1] + 2.0 * GAP));
    if below.height() > 30.0 {
        let keys = if devices.ports.is_empty() { NO_PORTS } else { "" };
        paragraph(ui.painter(), below, &format!("{keys}{ABOUT}"), SMALL, palette.muted);
    }
    let close = Rect::from_min_size(inner.left_bottom() - vec2(0.0, FIELD), vec2(NAMES, FIELD));
    button(ui, close, "Close", "Close the devices", Look::Plain, palette).clicked()
}

const OUTPUT: [&str; 2] = ["Output", "The sound device to play on"];
const PORTS: [&str; 2] = ["MIDI in", "The MIDI ports to listen to; those that are plugged in later are found too"];
const RATE: [&str; 2] = ["Sample rate", "Frames per second"];
const BLOCK: [&str; 2] = ["Block", "Frames per block: fewer make keys answer sooner, more are safer"];
const NO_PORTS: &str = "No MIDI port is listed: the computer’s keys play too, from Z and from Q on. ";
const ABOUT: &str = "A choice holds at once and for the next time. If a device cannot be opened, the present one goes on. What \
                     sounds ends at a change. A device that disappears is waited for.";

fn outputs(devices: &Devices) -> Choices<(Option<String>, Option<String>)> {
    let chosen = &devices.chosen;
    let name = |host: &str, id: &str, description: &str| match description {
        "" => format!("{host}: {id}"),
        description if description == id => format!("{host}: {id}"),
        description => format!("{host}: {description} ({id})"),
    };
    let first = ("the system’s".to_owned(), (None, None));
    let others = devices.outputs.iter().map(|output| {
        let names = (Some(output.host.clone()), Some(output.id.clone()));
        (name(&output.host, &output.id, &output.description), names)
    });
    let missing = || {
        let [host, device] = [&chosen.host, &chosen.device].map(|name| name.as_deref().unwrap_or("the default"));
        format!("{host}: {device}")
    };
    Choices::new(std::iter::once(first).chain(others).collect(), &(chosen.host.clone(), chosen.device.clone()), missing)
}

fn ports(devices: &Devices) -> Choices<Option<String>> {
    let fixed = [("all ports".to_owned(), None), ("no port".to_owned(), Some("none".to_owned()))];
    let ports = devices.ports.iter().map(|name| (name.clone(), Some(name.clone())));
    let chosen = devices.chosen.midi_in.clone().filter(|name| name != "all");
    let missing = || format!("those with “{}”", chosen.as_deref().unwrap_or_default());
    Choices::new(fixed.into_iter().chain(ports).collect(), &chosen, missing)
}

/// Numbers to choose from, after a name for the program's own choice.
fn numbers(own: &str, all: &[u32], chosen: Option<u32>, unit: &str) -> Choices<Option<u32>> {
    let written = |number: u32| format!("{number} {unit}");
    let numbers = all.iter().map(|number| (written(*number), Some(*number)));
    let all = std::iter::once((own.to_owned(), None)).chain(numbers).collect();
    Choices::new(all, &chosen, || written(chosen.unwrap_or(0)))
}
