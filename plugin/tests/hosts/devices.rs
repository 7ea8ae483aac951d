//! The program's page *Devices*: another device is chosen while it plays, and one that cannot be opened changes nothing.

use crate::standalone::Stand;
use std::path::Path;
use std::time::{Duration, Instant};

/// A device that accepts everything, and one that does not exist.
const ALSA: &str = "pcm.!default { type null
 hint { show on
 description \"Nothing\" } }
pcm.broken { type hw
 card 9
 hint { show on
 description \"Broken\" } }
";
/// Positions of the menu, of its *Devices*, and of the field *Output*.
const MENU: [i16; 2] = [935, 23];
const DEVICES: [i16; 2] = [940, 335];
const FIELD: [i16; 2] = [280, 74];
/// Possible positions of the lines of the field's list: the column, and the rows from the first line to the last.
const LIST: i16 = 150;
const LINES: std::ops::Range<i16> = 95..250;
const PATIENCE: Duration = Duration::from_secs(120);

/// The devices on which the program has said that it plays, and whether one was refused.
fn heard(stderr: &Path) -> (Vec<String>, bool) {
    let text = std::fs::read_to_string(stderr).unwrap();
    let playing = text.lines().filter_map(|line| line.split_once("playing on ")).map(|(_, name)| name.to_owned());
    (playing.collect(), text.contains("; still on "))
}

pub(crate) fn another_device_is_chosen_while_it_plays() {
    let mut stand = Stand::new("devices");
    let config = stand.folder.path().join("asound.conf");
    std::fs::write(&config, ALSA).unwrap();
    stand.alsa = Some(config);
    let (mut running, stderr) = stand.start(&["Marimba"]);
    let click = |place| {
        stand.onlooker.drag_slowly(place, place);
        std::thread::sleep(Duration::from_millis(250));
    };
    click(MENU);
    click(DEVICES);
    let start = Instant::now();
    let mut lines = LINES.step_by(10).cycle();
    let is_alsa = |name: &String| name.contains("ALSA");
    while !matches!(heard(&stderr), (playing, true) if playing.iter().any(is_alsa)) {
        let text = std::fs::read_to_string(&stderr).unwrap();
        assert!(start.elapsed() < PATIENCE, "no other device, or none that is refused: {text}");
        click(FIELD);
        click([LIST, lines.next().unwrap()]);
    }
    running.interrupt();
    assert_eq!(running.ends().code(), Some(0));
    // Read again, because the program may have followed the last click only after the loop looked.
    let (playing, _) = heard(&stderr);
    assert!(playing[0].contains("JACK") && playing[1..].iter().any(is_alsa), "{playing:?}");
    let saved = std::fs::read_to_string(stand.state().with_file_name("devices.json")).unwrap();
    // Without options, the last choice holds.
    let (mut running, stderr) = stand.start_with(&[], &["--midi-in", "none"]);
    assert_eq!(heard(&stderr).0.first(), playing.last(), "{saved}");
    running.interrupt();
    assert_eq!(running.ends().code(), Some(0));
}
