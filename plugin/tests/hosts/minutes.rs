//! The first five minutes of the manual's page on the window, as a hand does them: the mouse and the keyboard, nothing else.

use crate::process::wait_until;
use crate::screen::Onlooker;
use crate::standalone::{Stand, preset};
use sprung::params::Param;
use sprung::preset::Preset;
use std::time::{Duration, Instant};

/// Where things are in a new window.
const BROWSE: [i16; 2] = [613, 23];
const SAVE: [i16; 2] = [668, 23];
/// The tab *Sound*: a new window shows *Play*.
const SOUND: [i16; 2] = [158, 23];
const FIRST_SOUND: [i16; 2] = [200, 205];
const MODEL_TAB: [i16; 2] = [346, 274];
const MODEL: [i16; 2] = [213, 323];
const MATERIAL: [i16; 2] = [213, 348];
const SPACE_TAB: [i16; 2] = [891, 156];
const SPACE: [i16; 2] = [696, 314];
const SIZE_VALUE: [i16; 2] = [788, 350];
const MIX_VALUE: [i16; 2] = [696, 506];
/// Entries of the lists that open there.
const MARIMBA: [i16; 2] = [418, 227];
const GLASS: [i16; 2] = [419, 275];
const ROOM: [i16; 2] = [717, 429];

const ENTER: u8 = 36;
const ESCAPE: u8 = 9;
const SHIFT: u8 = 50;

/// The number of a character's key on an American keyboard, and whether it needs Shift.
fn key(character: char) -> (u8, bool) {
    const ROWS: [(u8, &str, &str); 4] = [
        (10, "1234567890-=", "!@#$%^&*()_+"),
        (24, "qwertyuiop[]", "QWERTYUIOP{}"),
        (38, "asdfghjkl;'`", "ASDFGHJKL:\"~"),
        (52, "zxcvbnm,./", "ZXCVBNM<>?"),
    ];
    if character == ' ' {
        return (65, false);
    }
    let found = ROWS.iter().find_map(|(first, plain, shifted)| {
        let place = |row: &str| row.chars().position(|one| one == character);
        let (place, needs_shift) = place(plain).map(|at| (at, false)).or(place(shifted).map(|at| (at, true)))?;
        Some((first + place as u8, needs_shift))
    });
    found.unwrap_or_else(|| panic!("no key for {character:?}"))
}

impl Onlooker {
    /// Types as a hand does, one key after the other.
    fn type_text(&self, text: &str) {
        for (key, needs_shift) in text.chars().map(key) {
            let keys = [SHIFT, key];
            self.press_keys(if needs_shift { &keys } else { &keys[1..] });
            std::thread::sleep(Duration::from_millis(60));
        }
    }

    fn click(&self, place: [i16; 2]) {
        self.hover(place);
        self.drag_slowly(place, place);
        std::thread::sleep(Duration::from_millis(400));
    }
}

/// Does something again and again, from the window as it is when nothing is open over it, until it has had its effect: on
/// a busy machine, a key may come before the field that it is for.
fn until(stand: &Stand, what: &str, act: impl Fn(&Onlooker), so: impl Fn() -> bool) {
    wait_until(what, || {
        stand.onlooker.press_key(ESCAPE);
        std::thread::sleep(Duration::from_millis(400));
        act(&stand.onlooker);
        let start = Instant::now();
        while !so() && start.elapsed() < Duration::from_secs(3) {
            std::thread::sleep(Duration::from_millis(50));
        }
        so()
    });
}

pub(crate) fn the_first_five_minutes() {
    let stand = Stand::new("minutes");
    let now = || {
        let text = stand.state().is_file().then(|| preset(&stand.state()))?;
        Preset::parse(&text, "the saved state").ok()
    };
    let is = |so: &dyn Fn(&Preset) -> bool| now().is_some_and(|preset| so(&preset));
    let find = |words: &'static str| {
        move |hand: &Onlooker| {
            hand.click(BROWSE);
            hand.type_text(words);
            hand.click(FIRST_SOUND);
        }
    };
    let (running, _) = stand.start(&["Kick"]);
    until(&stand, "1. a marimba is found and loaded", find("marimba"), || is(&|preset| preset.name == "Marimba"));
    let wood = now().unwrap().patch.get(Param::Decay);
    let glass = |hand: &Onlooker| {
        for place in [SOUND, MODEL_TAB, MODEL, MARIMBA, MATERIAL, GLASS] {
            hand.click(place);
        }
    };
    let is_glass = || is(&|preset| preset.patch.get(Param::Decay) > 2.0 * wood);
    until(&stand, "2. it is of glass", glass, is_glass);
    let room = |hand: &Onlooker| {
        for place in [SOUND, SPACE_TAB, SPACE, ROOM] {
            hand.click(place);
        }
        for (value, text) in [(SIZE_VALUE, "200 %"), (MIX_VALUE, "40 %")] {
            hand.click(value);
            hand.type_text(text);
            hand.press_key(ENTER);
        }
    };
    let is_large =
        |preset: &Preset| [Param::SpaceSize, Param::SpaceMix].map(|param| preset.patch.get(param)) == [200.0, 40.0];
    until(&stand, "3. it is in a big room", room, || is(&is_large));
    let save = |hand: &Onlooker| {
        hand.click(SAVE);
        hand.type_text("Glass Hall");
        hand.press_key(ENTER);
    };
    let file = stand.folder.path().join("sprung/presets/glass-hall.toml");
    until(&stand, "4. it is saved", save, || file.is_file());
    wait_until("it has the name", || is(&|preset| preset.name == "Glass Hall"));
    let made = now().unwrap();
    drop(running);
    let (running, _) = stand.start(&["Kick"]);
    wait_until("another sound", || is(&|preset| preset.name == "Kick"));
    until(&stand, "5. it is found again", find("glass hall"), || is(&|preset| *preset == made));
    drop(running);
}
