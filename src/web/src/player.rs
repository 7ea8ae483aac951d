//! A synth with memory that JavaScript reads and writes.

use crate::controls;
use crate::drawn::{Drawn, SHOWN};
use sprung::engine::{Event, EventKind, Snapshot, Synth, midi::parse_message};
use sprung::params::ParamInfo;
use sprung::preset::Preset;
use sprung::sound::bodies::Point;
use sprung_picture::Origin;

/// Frames that can be rendered at once.
pub const BLOCK: usize = 1024;

/// Maximum number of messages for a block; further ones are dropped.
const MESSAGES: usize = 256;

/// A synth that plays factory presets.
pub struct Player {
    synth: Synth,
    events: Vec<Event>,
    sides: [[f32; BLOCK]; 2],
    shown: [f32; 1 + 2 * SHOWN],
    text: String,
    preset: Preset,
    /// Whether it is set with the next block: a page only draws it.
    is_new: bool,
    /// Its body, where it is drawn.
    drawn: Option<Drawn>,
}

impl Player {
    pub(crate) fn new(sample_rate: f64, seed: u64) -> Self {
        let mut synth = Synth::new(sample_rate, seed);
        synth.reserve_space();
        let (sides, shown) = ([[0.0; BLOCK]; 2], [0.0; 1 + 2 * SHOWN]);
        let events = Vec::with_capacity(MESSAGES);
        let preset = Preset::factory()[0].clone();
        let mut player = Self { synth, events, sides, shown, text: String::new(), preset, is_new: true, drawn: None };
        player.take_preset();
        player
    }

    /// Writes the list of presets and returns its length.
    pub(crate) fn list_presets(&mut self) -> usize {
        let line = |preset: &Preset| {
            let guide = &preset.guide;
            let family = guide.family.map_or("", |family| family.name());
            let comment = preset.comment.split_whitespace().collect::<Vec<_>>().join(" ");
            let (name, macros) = (&preset.name, guide.macros.join(";"));
            format!("{name}\t{family}\t{}\t{}\t{}\t{macros}\t{comment}\n", guide.lowest, guide.highest, guide.home)
        };
        self.text = Preset::factory().iter().map(line).collect();
        self.text.len()
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn load(&mut self, preset: usize) {
        if let Some(preset) = Preset::factory_at(preset) {
            self.preset = preset.clone();
            // What was turned and not heard yet was of the sound before.
            self.events.retain(|event| !matches!(event.kind, EventKind::Param { .. }));
            self.take_preset();
        }
    }

    /// Lets the body of the preset be struck, or heard, elsewhere; its parameters stay. A table of modes knows nothing of places, and two
    /// joined bodies take too long to compute while others sound: both stay as they are.
    pub(crate) fn put(&mut self, is_ear: bool, x: f64, y: f64) {
        let mut origin = Origin::of(&self.preset.patch.modes);
        let point = Point { x: x.clamp(0.0, 1.0), y: y.clamp(0.0, 1.0) };
        let Origin::FromBody(body) = &mut origin else { return };
        let place = if is_ear { &mut body.pickup } else { &mut body.strike };
        if std::mem::replace(place, point) == point {
            return;
        }
        if let Ok(Some(modes)) = origin.modes() {
            self.take_values();
            self.preset.patch.modes = modes;
            self.take_preset();
        }
    }

    /// Draws the floor of a stage.
    pub(crate) fn floor(&mut self, size: [f32; 2], middle: [f32; 2], level: f32) -> usize {
        let values = if self.is_new { self.preset.patch.values } else { *self.synth.values() };
        self.drawn().floor(&values, size, middle, level)
    }

    /// Gives the preset a body of another model or material, by their numbers among the controls.
    pub(crate) fn make(&mut self, made_of: [i32; 2]) {
        self.take_values();
        controls::make(&mut self.preset, made_of);
        self.take_preset();
    }

    /// The numbers of model and material.
    pub(crate) fn made_of(&self) -> [i32; 2] {
        controls::made_of(&self.preset)
    }

    /// What was turned belongs to the preset that is set next.
    fn take_values(&mut self) {
        if !self.is_new {
            self.preset.patch.values = *self.synth.values();
        }
    }

    fn take_preset(&mut self) {
        self.is_new = true;
        let mut ratios = self.preset.patch.modes.as_slice().iter().map(|mode| mode.ratio);
        self.shown[1 + SHOWN..].fill_with(|| ratios.next().unwrap_or(0.0));
        self.drawn = None;
    }

    /// The body of the preset, to be drawn.
    pub(crate) fn drawn(&mut self) -> &mut Drawn {
        self.drawn.get_or_insert_with(|| Drawn::new(&self.preset))
    }

    pub(crate) fn midi(&mut self, frame: u32, message: [u8; 3]) {
        // Program change and channel pressure have two bytes; the third is ignored.
        if let Some((channel, kind)) = parse_message(&message) {
            self.push(Event { frame, channel, kind });
        }
    }

    /// Turns the parameter with a number to a position from 0 to 1.
    pub(crate) fn turn(&mut self, frame: u32, number: usize, position: f64) {
        if let Some(info) = controls::info(number) {
            let value = info.denormalise(position.clamp(0.0, 1.0));
            // At the first frame of a sound that is not set yet it is a part of that.
            if self.is_new && frame == 0 {
                self.preset.patch.set(info.param, value);
            }
            self.push(Event { frame, channel: 0, kind: EventKind::Param { param: info.param, value } });
        }
    }

    /// The position of a parameter in the preset, from 0 to 1; 0 for a number that none has.
    pub(crate) fn position(&self, number: usize) -> f64 {
        controls::info(number).map_or(0.0, |info| info.normalise(self.preset.patch.get(info.param)))
    }

    /// Writes a parameter's value at a position as text, and returns its length.
    pub(crate) fn say(&mut self, number: usize, position: f64) -> usize {
        let text = |info: &ParamInfo| info.format(info.denormalise(position.clamp(0.0, 1.0)));
        self.text = controls::info(number).map_or(String::new(), text);
        self.text.len()
    }

    /// Writes the list of what can be set, and returns its length.
    pub(crate) fn list_controls(&mut self) -> usize {
        self.text = controls::list();
        self.text.len()
    }

    fn push(&mut self, event: Event) {
        if self.events.len() < MESSAGES {
            self.events.push(event);
        }
    }

    pub(crate) fn process(&mut self, frames: usize) -> bool {
        let frames = frames.min(BLOCK);
        if std::mem::take(&mut self.is_new) {
            self.synth.set_kit(&self.preset.kit());
        }
        let [left, right] = &mut self.sides;
        self.synth.process(&self.events, &mut left[..frames], &mut right[..frames]);
        self.events.clear();
        !self.synth.is_silent()
    }

    pub(crate) fn samples(&self, side: usize) -> &[f32] {
        &self.sides[side.min(1)]
    }

    pub(crate) fn look(&mut self) -> &[f32] {
        let mut snapshot = Snapshot::default();
        self.synth.show(&mut snapshot);
        self.shown[0] = snapshot.voices as f32;
        for (shown, mass) in self.shown[1..=SHOWN].iter_mut().zip(&snapshot.masses) {
            *shown = mass.energy;
        }
        &self.shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::Param;
    use sprung::patch::routes::macro_param;

    #[test]
    fn a_preset_of_the_list_is_played_and_shown() {
        let mut player = Player::new(48_000.0, 0);
        assert!(player.list_presets() > 1000);
        let marimba = player.text().lines().position(|line| line.starts_with("Marimba\t")).unwrap();
        player.load(marimba);
        assert_eq!(player.look()[0], 0.0);
        player.midi(100, [0x90, 60, 100]);
        assert!(player.process(128));
        assert!(player.samples(0)[..100].iter().all(|sample| *sample == 0.0), "it starts at its frame");
        assert!(player.process(1024) && player.samples(1).iter().any(|sample| sample.abs() > 0.001));
        let shown = player.look();
        let first = Preset::factory()[marimba].patch.modes.as_slice()[0].ratio;
        assert!(shown[0] == 1.0 && shown[1] > 1e-6 && shown[1 + SHOWN] == first, "{:?}", &shown[..3]);
    }

    #[test]
    fn a_macro_that_is_turned_is_heard_and_a_parameter_that_does_not_exist_is_not() {
        let played = |number: usize| {
            let mut player = Player::new(48_000.0, 0);
            player.load(Preset::factory().iter().position(|preset| preset.name == "Marimba").unwrap());
            player.turn(0, number, 1.0);
            player.process(1024);
            player.midi(0, [0x90, 60, 100]);
            player.process(1024);
            player.samples(0).to_vec()
        };
        let number = |place| macro_param(place).unwrap() as usize;
        assert_ne!(played(number(0)), played(9999));
        assert_eq!(played(9999), played(number(7)), "the eighth has no name and moves nothing");
    }

    #[test]
    fn all_that_can_be_set_is_set() {
        let mut player = Player::new(48_000.0, 0);
        player.load(Preset::factory().iter().position(|preset| preset.name == "Marimba").unwrap());
        assert!(player.list_controls() > 500);
        let text = player.text().to_owned();
        let kinds = |kind: &str| text.lines().filter(|line| line.starts_with(kind)).count();
        let all = ["exciter", "knob", "space", "model", "material", "macro"].map(kinds);
        assert_eq!(all, [5, 6, 4, 9, 10, 8]);
        let decay = Param::Decay as usize;
        player.turn(0, decay, 0.75);
        player.process(64);
        player.make([3, 1]);
        player.process(64);
        assert_eq!(player.made_of(), [3, 1], "a bell of steel");
        assert!(player.position(decay) > 0.0 && player.say(decay, player.position(decay)) > 2, "{}", player.text());
        player.midi(0, [0x90, 60, 100]);
        assert!(player.process(1024) && player.samples(0).iter().any(|sample| sample.abs() > 1e-3));
        // Two joined bodies, and a table of modes.
        for name in ["Church Bell", "Piccolo"] {
            player.load(Preset::factory().iter().position(|preset| preset.name == name).unwrap());
            player.make([-1, 4]);
            assert_eq!(player.made_of()[1], 4, "{name} of glass");
        }
    }

    #[test]
    fn a_turn_counts_from_its_frame_on_whatever_the_lengths_of_blocks() {
        let decay = Param::Decay as usize;
        let note = |player: &mut Player| player.midi(0, [0x90, 60, 100]);
        let [mut live, mut replayed] = [0, 1].map(|_| Player::new(48_000.0, 0));
        note(&mut live);
        live.process(300);
        let mut sound = live.samples(0)[..300].to_vec();
        live.turn(0, decay, 0.1);
        live.process(724);
        sound.extend(&live.samples(0)[..724]);
        note(&mut replayed);
        replayed.turn(300, decay, 0.1);
        replayed.process(1024);
        assert_eq!(replayed.samples(0), sound);
        // Nor is it of the sound that is loaded before it is heard.
        replayed.load(1);
        replayed.turn(0, decay, 0.9);
        replayed.load(2);
        replayed.process(64);
        assert_eq!(replayed.synth.values().get(Param::Decay), Preset::factory()[2].patch.get(Param::Decay));
    }

    #[test]
    fn the_body_is_drawn_where_it_is_struck_and_swings_as_it_sounds() {
        let mut player = Player::new(48_000.0, 0);
        player.load(Preset::factory().iter().position(|preset| preset.name == "Church Bell").unwrap());
        let size = [600.0, 400.0];
        let still = player.drawn().draw(size, 0.0, 0xff_ff_ff);
        let before = player.drawn().numbers.clone();
        assert!(still > 10_000 && before.len() == still && before.iter().all(|number| number.is_finite()));
        player.drawn().energies[0] = 1.0;
        assert!(player.drawn().draw(size, 0.3, 0xff_ff_ff) > 10_000);
        assert_ne!(player.drawn().numbers, before);
        assert!(player.drawn().touch(false, size, [1.0, 1.0]) == 0, "beside it");
        assert!(player.drawn().touch(false, size, [300.0, 300.0]) == 1, "two joined bodies stay as they are");
        player.load(Preset::factory().iter().position(|preset| preset.name == "Gong").unwrap());
        assert_eq!(player.drawn().touch(false, size, [360.0, 210.0]), 2);
        let [x, y] = player.drawn().numbers[..] else { panic!("a point") };
        let modes = player.preset.patch.modes.clone();
        player.turn(0, macro_param(0).unwrap() as usize, 1.0);
        player.process(64);
        player.put(false, x.into(), y.into());
        assert_ne!(player.preset.patch.modes, modes);
        player.process(64);
        assert_eq!(player.synth.values().get(macro_param(0).unwrap()), 100.0, "a macro stays where it was turned to");
        player.load(Preset::factory().iter().position(|preset| preset.name == "Piccolo").unwrap());
        let modes = player.preset.patch.modes.clone();
        player.put(false, f64::NAN, 2.0);
        assert_eq!(player.preset.patch.modes, modes, "a table stays as it is");
    }
}
