//! The program's page of devices and ports.

use super::pictures::{Stage, compare, compare_small, finish, stage};
use crate::devices::{Chosen, Devices, Output};
use crate::editor::theme::{LEAST_SIZE, SIZE, Theme};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use std::sync::atomic::Ordering::Relaxed;

/// Devices of an example machine.
fn devices() -> Devices {
    let output = |host: &str, id: &str, description: &str| Output {
        host: host.to_owned(),
        id: id.to_owned(),
        description: description.to_owned(),
    };
    Devices {
        outputs: vec![
            output("alsa", "default", "default"),
            output("alsa", "hw:CARD=PCH,DEV=0", "HDA Intel PCH, ALC257 Analog"),
            output("jack", "JACK Output", ""),
        ],
        rates: vec![44_100, 48_000, 96_000],
        ports: vec!["Keystation 49:Keystation 49 MIDI 1 24:0".to_owned()],
        chosen: Chosen { buffer: Some(128), ..Chosen::default() },
        block: 0,
        playing: "ALSA ‘default’, 48000 Hz, 2 × f32".to_owned(),
    }
}

/// The page in a program that has published devices.
fn page(size: [u32; 2], theme: Theme) -> Stage {
    let mut stage = stage("Marimba", size, 1.0, theme);
    stage.button("Menu");
    assert!(stage.harness.query_by_label("Devices").is_none(), "a host has its own");
    stage.harness.key_press(Key::Escape);
    stage.host.is_alone.store(true, Relaxed);
    stage.params.link().devices.show(devices());
    stage.harness.run_steps(3);
    assert!(!stage.params.link().devices.was_watched(), "nothing is looked for while another page is shown");
    stage.devices();
    assert!(stage.params.link().devices.was_watched());
    stage
}

impl Stage {
    /// Opens the page of devices.
    pub(super) fn devices(&mut self) {
        self.button("Menu");
        self.button("Devices");
    }

    /// Picks from the list of the original devices.
    fn pick_device(&mut self, field: &str, name: &str) -> Option<Chosen> {
        self.params.link().devices.show(devices());
        self.harness.run_steps(1);
        self.pick_another(field, name)
    }

    fn pick_another(&mut self, field: &str, name: &str) -> Option<Chosen> {
        self.harness.get_by_role_and_label(Role::ComboBox, field).click();
        self.harness.run_steps(3);
        self.harness.get_by_role_and_label(Role::Button, name).click();
        self.harness.run_steps(3);
        self.params.link().devices.take_request()
    }
}

#[test]
fn devices_are_a_page_of_their_own_that_is_closed() {
    let mut stage = page(SIZE, Theme::Dark);
    assert!(stage.harness.query_by_label("Modes of the body").is_none(), "no pictures of the sound are beside it");
    stage.button("Close the devices");
    assert!(stage.harness.query_by_label("Modes of the body").is_some());
    stage.devices();
    stage.tab("Play");
    assert!(stage.harness.query_by_label("Strike").is_some());
}

#[test]
fn what_is_picked_is_asked_for() {
    let mut stage = page(SIZE, Theme::Dark);
    let before = devices().chosen;
    let text = |name: &str| Some(name.to_owned());
    assert_eq!(stage.pick_device("Sample rate", "96000 Hz"), Some(Chosen { rate: Some(96_000), ..before.clone() }));
    assert_eq!(stage.pick_device("Block", "256 frames, or the nearest"), Some(Chosen::default()));
    assert_eq!(stage.pick_device("MIDI in", "no port"), Some(Chosen { midi_in: text("none"), ..before.clone() }));
    let port = "Keystation 49:Keystation 49 MIDI 1 24:0";
    assert_eq!(stage.pick_device("MIDI in", port), Some(Chosen { midi_in: text(port), ..before.clone() }));
    let jack = Chosen { host: text("jack"), device: text("JACK Output"), ..Chosen::default() };
    assert_eq!(stage.pick_device("Output", "jack: JACK Output"), Some(jack), "with the rate and blocks that suit it");
    assert_eq!(stage.pick_device("Block", "128 frames"), None, "as it is");
    stage.pick_device("Sample rate", "96000 Hz");
    let both = Chosen { rate: Some(96_000), midi_in: text("none"), ..before.clone() };
    assert_eq!(stage.pick_another("MIDI in", "no port"), Some(both), "a wish builds on the one before");
    assert!(stage.host.calls().is_empty(), "no parameter is concerned");
    // The blocks that the device takes by itself.
    stage.params.link().devices.show(Devices { chosen: Chosen::default(), block: 1024, ..devices() });
    stage.harness.run_steps(3);
    let own = stage.harness.get_by_role_and_label(Role::ComboBox, "Block").accesskit_node().value();
    assert_eq!(own, text("the usual: 1024 frames"));
    stage.params.link().devices.show(Devices { block: 64, ..devices() });
    assert_eq!(
        stage.pick_another("Block", "256 frames, or the nearest"),
        Some(Chosen::default()),
        "64 are not its own"
    );
    // A chosen device that is not available now is still shown.
    let gone = Chosen { host: text("alsa"), device: text("hw:9"), rate: Some(22_050), ..Chosen::default() };
    stage.params.link().devices.show(Devices { chosen: gone, ..devices() });
    stage.harness.run_steps(3);
    let shown = |field| stage.harness.get_by_role_and_label(Role::ComboBox, field).accesskit_node().value();
    assert_eq!([shown("Output"), shown("Sample rate")], [text("alsa: hw:9"), text("22050 Hz")]);
}

#[test]
fn pictures_of_devices_are_as_accepted() {
    for (size, theme, name) in [
        (SIZE, Theme::Dark, "devices"),
        (SIZE, Theme::Light, "devices-light"),
        (LEAST_SIZE, Theme::HighContrast, "devices-least"),
    ] {
        compare(name, &mut page(size, theme).harness);
    }
    compare_small("devices-high-contrast", 2, &mut page(SIZE, Theme::HighContrast).harness);
    finish();
}
