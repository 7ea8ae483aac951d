//! The names of macros, which a sound gives them.

use super::gestures::touch;
use super::{Controls, Typing};
use sprung::internals::editor::with_ending;
use sprung::params::{Param, ParamInfo};
use sprung::preset::Playable;

/// The number of a macro, from 0; none for other parameters.
fn number(info: &ParamInfo) -> Option<usize> {
    let number = (info.param as usize).checked_sub(Param::Macro1 as usize)?;
    info.id.starts_with("macro").then_some(number)
}

impl Controls<'_> {
    /// Whether a parameter is a macro that can be given a name: those of a kit's sounds have theirs in the sounds.
    pub(in crate::editor) fn can_name(&self, info: &ParamInfo) -> bool {
        number(info).is_some() && matches!(self.params.state().playable, Playable::Preset(_))
    }

    /// Opens the field for the name of a macro, in the place of the name at its knob.
    pub(in crate::editor) fn begin_naming(&mut self, info: &ParamInfo, text: String) {
        self.interaction.naming = Some(Typing { index: info.param as usize, text, is_open: false, complaint: None });
    }

    /// Gives a macro a name, as one step; without one, it is a macro like any.
    pub(in crate::editor) fn name_macro(&mut self, info: &ParamInfo, name: &str) {
        let Some(number) = number(info) else { return };
        let name = with_ending(name, "");
        let what =
            if name.is_empty() { format!("{} without a name", info.name) } else { format!("{} {name}", info.name) };
        self.release();
        self.history.begin(self.params);
        self.params.change(|mut state| {
            let Playable::Preset(preset) = &mut state.playable else { return None };
            let names = &mut preset.guide.macros;
            names.resize(names.len().max(number + 1), String::new());
            names[number] = name;
            let used = names.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
            names.truncate(used);
            Some(state)
        });
        self.history.end_of(&[], what, self.params);
        touch(self.params, self.host);
    }
}
