//! Kits that are made and saved, the sounds of their pads that are edited and put back, and their knobs.

use super::pads::at;
use super::pictures::{Stage, facing};
use super::sounding::Band;
use crate::editor::theme::{SIZE, Theme};
use crate::editor::window::Face;
use crate::link::Touch;
use crate::state::State;
use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable as _;
use sprung::internals::library::Library;
use sprung::params::Param;
use sprung::patch::routes::amount_param;
use sprung::preset::{KitPreset, Playable};

#[test]
fn a_kit_of_three_is_made_played_undone_and_saved() {
    let mut stage = at("Kick", SIZE, Theme::Dark);
    let before = stage.params.state();
    stage.button("Make a kit of this sound");
    assert_eq!(stage.pad(36).map(|(name, pad)| (name, pad.pitch)), Some(("Kick".to_owned(), Some(60.0))));
    // A click puts a sound on the chosen pad; a drag on any.
    let snare = stage.sound("Snare");
    let aim = stage.place("D2");
    stage.drag(snare, aim - snare, Modifiers::NONE);
    let hat = stage.sound("Closed Hat");
    let aim = stage.place("F#2");
    stage.drag(hat, aim - hat, Modifiers::NONE);
    let names = |stage: &Stage| [36, 38, 42].map(|key| stage.pad(key).map(|(name, _)| name).unwrap_or_default());
    assert_eq!(names(&stage), ["Kick", "Snare", "Closed Hat"]);
    stage.button("Undo");
    assert_eq!(names(&stage), ["Kick", "Snare", ""]);
    stage.button("Redo");
    let wanted = stage.kit();
    // Saved under a name, and the same when it is read.
    stage.button("Save");
    stage.harness.event(Event::Text("My Three".to_owned()));
    stage.harness.run_steps(2);
    stage.harness.key_press(Key::Enter);
    stage.harness.run_steps(3);
    let saved = Library::at(stage.folder.path()).entries().remove(0).playable.unwrap();
    assert_eq!((saved.name(), stage.params.name().as_str()), ("My Three", "My Three"));
    assert_eq!(saved.kit().sounds(), wanted.kit().sounds());
    for _ in 0..3 {
        stage.button("Undo");
    }
    assert_eq!(stage.params.state().playable, before.playable);
}

#[test]
fn the_body_is_that_of_the_pad_that_was_struck() {
    let mut band = Band::of(facing(Face::Play, "Acoustic Kit", SIZE, 1.0, Theme::Dark));
    for key in [38, 49] {
        band.strike(&[key]);
        band.passes(2);
        band.silence();
        band.heard.clear();
        band.stage.harness.get_by_label("Strike").click();
        band.passes(3);
        assert!(matches!(band.heard[..], [.., Touch::Down { key: struck, .. }] if struck == key), "{:?}", band.heard);
    }
}

#[test]
fn the_values_of_one_sound_go_with_it_and_end_with_it() {
    let mut stage = at("Kick", SIZE, Theme::Dark);
    let Playable::Preset(kick) = stage.params.state().playable else { panic!("a preset") };
    stage.button("Make a kit of this sound");
    stage.params.knobs()[Param::Decay as usize].turn(0.7);
    let turned = stage.params.state().values;
    let (snare, aim) = (stage.sound("Snare"), stage.place("D2"));
    stage.drag(snare, aim - snare, Modifiers::NONE);
    let kit = stage.kit();
    assert_eq!(kit.sounds[0].1.patch.values, turned, "beside another, the first sound is as it was");
    assert_ne!(turned, kick.patch.values);
    // Alone again, it has its values; and a sound in its place has its own.
    let snare = stage.place("D2");
    stage.drag(snare, vec2(0.0, 0.0), Modifiers::NONE);
    stage.button("Empty this pad");
    assert_eq!(stage.params.state().values, turned);
    for name in ["Taiko", "Marimba"] {
        let (sound, aim) = (stage.sound(name), stage.place("C2"));
        stage.drag(sound, aim - sound, Modifiers::NONE);
        let Ok(Playable::Preset(expected)) = Playable::find(name) else { panic!("a preset") };
        assert_eq!((stage.kit().sounds.len(), stage.params.state().values), (1, expected.patch.values), "{name}");
    }
}

#[test]
fn a_click_puts_a_sound_beside_that_of_a_new_kit() {
    let mut stage = at("Marimba", SIZE, Theme::Dark);
    stage.button("Make a kit of this sound");
    stage.sound("Taiko");
    stage.button("Put Taiko");
    let kit = stage.kit();
    let pads: Vec<_> = kit.pads.iter().map(|(key, pad)| (*key, kit.sounds[pad.sound].0.as_str())).collect();
    assert_eq!(pads, [(36, "Marimba"), (38, "Taiko")]);
}

#[test]
fn a_pad_is_edited_and_put_back_and_each_is_one_step() {
    // With the knobs of the kit moved, the sound is edited as it is heard.
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    stage.params.knobs()[Param::Decay as usize].turn(0.7);
    let hat = stage.place("F#2");
    stage.drag(hat, hat - hat, Modifiers::NONE);
    let kit = stage.params.state();
    let (_, pad) = stage.pad(42).unwrap();
    let heard = kit.clone().into_sound();
    stage.button("Edit this pad");
    assert_eq!(stage.params.name(), "Closed Hat");
    assert!(stage.paints("pad F#2 of Acoustic Kit"));
    let Playable::Kit(heard) = heard else { panic!("a kit") };
    let alone = stage.params.state();
    assert_eq!(alone.values, heard.sounds[pad.sound].1.patch.values);
    // A change of the sound, and one that loads it anew.
    stage.tab("Mallet");
    let knob = stage.at("Mallet hardness");
    stage.drag(knob, vec2(0.0, -22.0), Modifiers::NONE);
    stage.tab("Play");
    stage.button("Bow alone");
    let changed = stage.params.state();
    assert!(changed.values != alone.values && changed.pad.is_some());
    // It is kept in the project.
    let read = State::parse(&changed.to_json()).unwrap();
    assert_eq!((read.state, read.complaints), (changed.clone(), Vec::new()));
    stage.button("Put back");
    let after = stage.kit();
    let Playable::Preset(expected) = &changed.playable else { panic!("a preset") };
    assert_eq!(stage.pad(42).map(|(_, pad)| pad), Some(pad.clone()), "the pad is as it was");
    for (place, ((_, before), (_, now))) in heard.sounds.iter().zip(&after.sounds).enumerate() {
        assert_eq!(now, if place == pad.sound { expected } else { before });
    }
    assert!(stage.params.pad().is_none() && stage.paints("Closed hat"), "the kit is shown, and the pad chosen");
    for (steps, before) in [(1, &changed), (2, &alone), (1, &kit)] {
        for _ in 0..steps {
            stage.button("Undo");
        }
        assert!(stage.params.state() == *before);
    }
}

#[test]
fn a_pad_that_shares_its_sound_is_edited_by_itself() {
    let mut stage = at("Kick", SIZE, Theme::Dark);
    stage.button("Make a kit of this sound");
    let (kick, aim) = (stage.place("C2"), stage.place("D2"));
    stage.drag(kick, aim - kick, Modifiers::COMMAND);
    stage.button("Edit this pad");
    stage.tab("Body");
    let knob = stage.at("Decay");
    stage.drag(knob, vec2(0.0, -22.0), Modifiers::NONE);
    let changed = stage.params.state().values;
    // Another sound that is loaded takes its place, also on the pad.
    stage.button("Next sound");
    let other = stage.params.name();
    assert!(stage.paints(&format!("{other} *")), "the kit is not saved");
    assert!(stage.harness.query_by_label_contains("was not saved").is_none(), "and it is not lost");
    stage.button("Put back");
    assert!(stage.kit().sounds.iter().any(|(_, sound)| sound.name == other));
    stage.button("Undo");
    stage.button("Undo");
    stage.button("Put back");
    let kit = stage.kit();
    let values = |key: u8| kit.sounds[kit.pads.iter().find(|(own, _)| *own == key).unwrap().1.sound].1.patch.values;
    assert_eq!((values(38), kit.sounds.len()), (changed, 2));
    assert_ne!(values(36), changed);
}

/// The acoustic kit with the pads of these keys alone.
fn part_of_it(keys: &[u8]) -> KitPreset {
    let Ok(Playable::Kit(mut kit)) = Playable::find("Acoustic Kit") else { panic!("it is there") };
    kit.pads.retain(|(key, _)| keys.contains(key));
    let sounds = std::mem::take(&mut kit.sounds);
    for (place, (_, pad)) in kit.pads.iter_mut().enumerate() {
        kit.sounds.push(sounds[pad.sound].clone());
        pad.sound = place;
    }
    kit
}

#[test]
fn the_effects_of_a_kit_stay_when_a_pad_is_edited_and_put_back() {
    let heard = |stage: &Stage| stage.params.state().values.get(Param::SpaceMix);
    let edit = |stage: &mut Stage, key: &str, position: Option<f32>| {
        let pad = stage.place(key);
        stage.drag(pad, vec2(0.0, 0.0), Modifiers::NONE);
        stage.button("Edit this pad");
        let alone = heard(stage);
        position.into_iter().for_each(|position| stage.params.knobs()[Param::SpaceMix as usize].turn(position));
        stage.button("Put back");
        alone
    };
    let with = |kit: KitPreset| {
        let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
        stage.params.load(State::new(Playable::Kit(kit), 0, stage.params.view()).into());
        stage.harness.run_steps(3);
        stage
    };
    // One sound alone is heard with the kit's room, and has it in its kit again.
    let mut stage = with(part_of_it(&[38]));
    let room = heard(&stage);
    assert!(room > Param::SpaceMix.info().min);
    assert_eq!((edit(&mut stage, "D2", None), heard(&stage)), (room, room));
    edit(&mut stage, "D2", Some(0.9));
    assert!(heard(&stage) > room, "a single sound brings its effects");
    // Several sounds that have an effect in common, in a kit that does not name it.
    let mut kit = part_of_it(&[36, 38]);
    kit.params.clear();
    kit.sounds.iter_mut().for_each(|(_, preset)| preset.patch.set(Param::SpaceMix, 20.0));
    let mut stage = with(kit);
    edit(&mut stage, "D2", None);
    assert!(heard(&stage) == 20.0 && !stage.paints("Acoustic Kit *"), "nothing was changed");
    edit(&mut stage, "D2", Some(0.9));
    assert_eq!(heard(&stage), 20.0);
    // One that is the same on two pads becomes two.
    let mut kit = part_of_it(&[36]);
    kit.params.clear();
    kit.sounds[0].1.patch.set(Param::SpaceMix, 20.0);
    kit.pads.push((38, kit.pads[0].1.clone()));
    let mut stage = with(kit);
    edit(&mut stage, "D2", Some(0.9));
    assert_eq!((stage.kit().sounds.len(), heard(&stage)), (2, 20.0));
}

#[test]
fn the_routes_of_a_pad_are_shown_as_the_knobs_move_them() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    let place = stage.kit().sounds[stage.pad(42).unwrap().1.sound].1.patch.routes.iter().next().unwrap().0;
    let amount = amount_param(place);
    stage.params.knobs()[amount as usize].turn(0.3127);
    let Playable::Kit(heard) = stage.params.state().into_sound() else { panic!("a kit") };
    let hat = stage.place("F#2");
    stage.drag(hat, vec2(0.0, 0.0), Modifiers::NONE);
    stage.tab("Motion");
    let moved = heard.sounds[stage.pad(42).unwrap().1.sound].1.patch.get(amount);
    assert!(moved < 0.0 && stage.paints(&amount.info().format(-moved)), "{moved}: its sign tells the sides");
}

#[test]
fn the_knobs_of_a_kit_say_what_they_add_and_not_a_value() {
    for face in [Face::Play, Face::Sound, Face::Motion] {
        let stage = facing(face, "Acoustic Kit", SIZE, 1.0, Theme::Dark);
        assert!(stage.paints("added to what each pad has"), "{face:?}");
    }
    let mut stage = facing(Face::Play, "Acoustic Kit", SIZE, 1.0, Theme::Dark);
    assert!(stage.paints("× 1") && stage.paints("±0 dB") && !stage.paints("1 s"));
    assert!(stage.paints("ESSENTIALS") && !stage.paints("OUTPUT"), "the space is the kit’s own");
    let type_value = |stage: &mut Stage, text: &str| {
        stage.harness.get_by_label("Type Decay").click();
        stage.harness.run_steps(2);
        stage.type_text(text);
        stage.harness.key_press(Key::Enter);
        stage.harness.run_steps(3);
    };
    type_value(&mut stage, "1.5");
    assert_eq!(stage.params.state().values.get(Param::Decay), 1.5 * Param::Decay.info().default);
    assert!(stage.paints("× 1.5"));
    type_value(&mut stage, "3 s");
    assert!(stage.harness.query_by_label_contains("expected from × 0.005 to × 60").is_some());
    // One sound alone is no offset: its knobs have its values.
    let mut stage = facing(Face::Kit, "Kick", SIZE, 1.0, Theme::Dark);
    stage.button("Make a kit of this sound");
    stage.tab("Sound");
    assert!(!stage.paints("added to"));
}

#[test]
fn the_macros_of_a_pad_have_its_names() {
    let mut stage = at("Acoustic Kit", SIZE, Theme::Dark);
    for (key, sound) in [("C2", "Kick"), ("F#2", "Closed Hat")] {
        let pad = stage.place(key);
        stage.drag(pad, vec2(0.0, 0.0), Modifiers::NONE);
        stage.tab("Motion");
        let Ok(Playable::Preset(preset)) = Playable::find(sound) else { panic!("a preset") };
        let name = &preset.guide.macros[0];
        assert!(stage.harness.query_by_label(&format!("Source {name}")).is_some(), "{sound}: {name}");
        stage.tab("Kit");
    }
}
