//! The first five minutes of the manual's page on the window, as a hand does them: the mouse and the keyboard, nothing else.

use crate::process::wait_until;
use crate::screen::Onlooker;
use crate::standalone::{Stand, preset};
use sprung::params::Param;
use sprung::preset::Preset;
use std::time::Duration;

/// Where things are in a new window.
const BROWSE: [i16; 2] = [511, 23];
const SAVE: [i16; 2] = [566, 23];
const FIRST_SOUND: [i16; 2] = [266, 93];
const MODEL_TAB: [i16; 2] = [466, 344];
const MODEL: [i16; 2] = [137, 400];
const MATERIAL: [i16; 2] = [137, 425];
const SPACE_TAB: [i16; 2] = [336, 344];
const SPACE: [i16; 2] = [519, 395];
const SIZE_VALUE: [i16; 2] = [593, 430];
const MIX_VALUE: [i16; 2] = [519, 562];
/// Entries of the lists that open there.
const MARIMBA: [i16; 2] = [266, 114];
const GLASS: [i16; 2] = [133, 141];
const ROOM: [i16; 2] = [547, 509];
/// Left, top, right and bottom of the lowest line.
const LINE: [u32; 4] = [8, 674, 700, 692];
/// Blue, green and red of messages.
const MESSAGE: [u8; 3] = [96, 146, 255];

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

    fn sees_a_message(&self) -> bool {
        let [left, top, right, bottom] = LINE;
        let (width, pixels) = (right, self.pixels(right, bottom));
        let mut line = (top..bottom).flat_map(|y| (left..right).map(move |x| (y * width + x) as usize));
        line.any(|at| pixels[at].iter().zip(MESSAGE).all(|(one, other)| one.abs_diff(other) < 24))
    }
}

pub(crate) fn the_first_five_minutes() {
    let stand = Stand::new("minutes");
    let hand = &stand.onlooker;
    let now = || {
        let text = stand.state().is_file().then(|| preset(&stand.state()))?;
        Preset::parse(&text, "the kept state").ok()
    };
    let becomes =
        |what: &str, so: &dyn Fn(&Preset) -> bool| wait_until(what, || now().is_some_and(|preset| so(&preset)));
    let (running, _) = stand.start(&["Kick"]);
    // 1.
    hand.click(BROWSE);
    hand.type_text("marimba");
    hand.click(FIRST_SOUND);
    becomes("a marimba is found and loaded", &|preset| preset.name == "Marimba");
    let wood = now().unwrap().patch.get(Param::Decay);
    hand.press_key(ESCAPE);
    // 2.
    hand.click(MODEL_TAB);
    for place in [MODEL, MARIMBA, MATERIAL, GLASS] {
        hand.click(place);
    }
    becomes("it is of glass", &|preset| preset.patch.get(Param::Decay) > 2.0 * wood);
    // 3.
    hand.click(SPACE_TAB);
    hand.click(SPACE);
    hand.click(ROOM);
    for (value, text) in [(SIZE_VALUE, "200 %"), (MIX_VALUE, "40 %")] {
        hand.click(value);
        hand.type_text(text);
        hand.press_key(ENTER);
    }
    becomes("it is in a big room", &|preset| {
        [Param::SpaceSize, Param::SpaceMix].map(|param| preset.patch.get(param)) == [200.0, 40.0]
    });
    // 4. The pointer stays on the button, whose own line must not hide the message.
    assert!(!hand.sees_a_message());
    hand.click(SAVE);
    hand.type_text("Glass Hall");
    hand.press_key(ENTER);
    let file = stand.folder.path().join("sprung/presets/glass-hall.toml");
    wait_until("it is saved", || file.is_file());
    wait_until("the lowest line says where", || hand.sees_a_message());
    becomes("it has the name", &|preset| preset.name == "Glass Hall");
    let made = now().unwrap();
    drop(running);
    // 5.
    let (running, _) = stand.start(&["Kick"]);
    becomes("another sound", &|preset| preset.name == "Kick");
    hand.click(BROWSE);
    hand.type_text("hall");
    hand.click(FIRST_SOUND);
    becomes("it is found again", &|preset| *preset == made);
    drop(running);
}
