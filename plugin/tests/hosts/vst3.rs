//! The VST3 bundle in two hosts driven from Python: dawdreamer and pedalboard, both made with JUCE.

use crate::host::bundle;
use crate::host::reference::{At, assert_same_bits, assert_sound, render};
use crate::host::{Instance, open};
use crate::patches::{drums, patches, state, state_of_kit};
use crate::phrase::{self, FRAMES, SAMPLE_RATE};
use crate::process::wait_until;
use crate::resonator::{by_the_command, incoming, without_exciters};
use crate::screen::{Onlooker, Screen};
use crate::song::rendered_by_the_command;
use crate::thorough;
use serde_json::{Value, json};
use sprung::engine::EventKind;
use sprung::io::Song;
use sprung::params::{PARAMS, Param, ParamInfo, Unit};
use sprung::patch::Patch;
use sprung::preset::Preset;
use sprung::sound::Kit;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

/// The plugin's class id, as in preset files. Pinned: hosts find a song's plugin by it.
const CLASS: &[u8; 32] = b"537072756E674D617373537072696E67";

/// The virtual environment in which `cargo xtask setup` installs the hosts.
fn environment() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("python")
}

/// The hosts that cannot be loaded in the required versions, and why.
pub(crate) fn missing() -> Option<String> {
    let installed = std::fs::read_to_string(environment().join("requirements.txt"));
    // The environment serves other tests too, whose requirements are in the same file.
    if !installed.is_ok_and(|installed| installed.contains(include_str!("requirements.txt"))) {
        return Some("pedalboard and dawdreamer in target/python".to_owned());
    }
    let output = Command::new(python()).args(["-c", "import dawdreamer, pedalboard"]).env("DISPLAY", ":none").output();
    match output {
        Ok(output) if output.status.success() => None,
        Ok(output) => {
            let said = String::from_utf8_lossy(&output.stderr);
            Some(format!("what pedalboard and dawdreamer load ({})", said.lines().last().unwrap_or("no reason given")))
        }
        Err(error) => Some(format!("a Python in target/python that starts ({error})")),
    }
}

fn python() -> PathBuf {
    environment().join("bin/python")
}

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hosts").join(name)
}

/// Makes a host do things and returns its answers. All in one process, because hosts take a second to start.
#[track_caller]
fn ask(host: &str, questions: &[Value]) -> Vec<Value> {
    let mut child = Command::new(python())
        .arg(script(&format!("{host}_host.py")))
        // Without this the hosts would use the first display, which may belong to another test.
        .env("DISPLAY", ":none")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("Python starts");
    child.stdin.take().expect("stdin is piped").write_all(Value::from(questions).to_string().as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{host}: {}\n{stdout}\n{stderr}", output.status);
    // Hosts may print other lines first.
    let answers: Vec<Value> =
        serde_json::from_str(stdout.lines().last().unwrap_or_default()).unwrap_or_else(|_| panic!("{host}: {stdout}"));
    assert_eq!(answers.len(), questions.len(), "{host}");
    answers
}

/// Writes a preset file in the format of VST3 hosts, from a state in the format of CLAP hosts, into a folder.
fn preset_file(folder: &Path, name: &str, state: &[u8]) -> PathBuf {
    let state = &state[8..];
    let header = 48_u64;
    let mut bytes = b"VST3".to_vec();
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(CLASS);
    bytes.extend((header + state.len() as u64).to_le_bytes());
    bytes.extend(state);
    bytes.extend(b"List");
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(b"Comp");
    bytes.extend(header.to_le_bytes());
    bytes.extend((state.len() as u64).to_le_bytes());
    let path = folder.join(format!("{}.vstpreset", name.replace(' ', "-")));
    std::fs::write(&path, bytes).unwrap();
    path
}

/// The samples in a file written by a host, one vector per channel.
fn samples(path: &Path) -> Vec<Vec<f32>> {
    let bytes = std::fs::read(path).unwrap();
    let samples: Vec<f32> =
        bytes.chunks_exact(4).map(|sample| f32::from_le_bytes([sample[0], sample[1], sample[2], sample[3]])).collect();
    samples.chunks(samples.len() / 2).map(<[f32]>::to_vec).collect()
}

/// The value for a position in VST3's range 0–1.
fn value_at(info: &ParamInfo, position: f64) -> f32 {
    match info.unit {
        Unit::Count | Unit::Choice => info.clamp(info.min + (info.max - info.min) * position as f32),
        _ => info.denormalise(f64::from(position as f32)),
    }
}

pub(crate) fn every_parameter_can_be_set_and_read() {
    let positions = [0.0, 1.0, 0.25, 0.333_333, 0.618];
    for host in ["dawdreamer", "pedalboard"] {
        let answer = &ask(host, &[json!(["parameters", bundle::vst3(), positions])])[0];
        let rows = answer[0].as_array().unwrap();
        for info in PARAMS {
            let row: Vec<&Value> = rows.iter().filter(|row| row[0] == info.name).collect();
            assert_eq!(row.len(), 1, "{host}: parameters called ‘{}’", info.name);
            let tried = row[0].as_array().unwrap().last().unwrap().as_array().unwrap();
            assert_eq!(tried.len(), positions.len());
            for one in tried {
                let (position, found) = (one[0].as_f64().unwrap(), one[1].as_f64().unwrap());
                let value = value_at(info, position);
                // Hosts return the value that was set, either before or after rounding to the nearest step.
                let step = f64::from((value - info.min) / (info.max - info.min));
                let is_step = matches!(info.unit, Unit::Count | Unit::Choice) && (found - step).abs() < 1e-6;
                assert!((found - position).abs() < 1e-6 || is_step, "{host}: {} at {position} is {found}", info.id);
                assert_eq!(one[2], info.format(value), "{host}: {} at {position}", info.id);
            }
        }
        if host == "dawdreamer" {
            // For each MIDI channel the wrapper adds 130 parameters, which bend, wheel and pedals need.
            assert_eq!(answer[1], PARAMS.len() + 16 * 130);
            assert_eq!(answer[2], 0, "latency");
            assert!(rows.iter().all(|row| row[2] == true), "all can be automated");
        } else {
            let about: Vec<&str> = [1, 2, 3].map(|field| answer[field].as_str().unwrap()).to_vec();
            assert_eq!(about, ["Sprung", "The Sprung authors", env!("CARGO_PKG_VERSION")]);
            assert_eq!(answer[4], true, "an instrument");
        }
    }
}

/// A MIDI file in a VST3 host, with a preset that contains the patch: the same bits as from `sprung render`, with
/// controllers moved to the frames at which the host sends them. VST3 passes controllers as parameters, and JUCE, with
/// which both hosts are made, gives each parameter one value per block, at its first frame. Notes and their pressure
/// have their own frames.
pub(crate) fn one_channel_has_the_bits_of_the_command() {
    let cases = patches().into_iter().skip(thorough::of(3, 0)).zip([1, 64, 480].into_iter().cycle());
    let cases: Vec<Case> = cases
        .map(|((name, patch), block)| Case { name, state: state(&patch), kit: Kit::of_patch(&patch), block })
        .collect();
    assert_bits_of_the_command(&phrase::messages(), &cases);
}

/// The same for a kit in a project.
pub(crate) fn a_kit_has_the_bits_of_the_command() {
    let drums = drums();
    let case = Case { name: "drums", state: state_of_kit(&drums), kit: drums.kit(), block: 64 };
    assert_bits_of_the_command(&phrase::kit_messages(), &[case]);
}

/// A state, the kit that it contains, and the length of the blocks in which dawdreamer plays it.
struct Case {
    name: &'static str,
    state: Vec<u8>,
    kit: Arc<Kit>,
    block: u64,
}

/// Plays messages with these states in both hosts.
fn assert_bits_of_the_command(messages: &[(u64, [u8; 3])], cases: &[Case]) {
    const BLOCK: u64 = 480;
    let folder = tempfile::tempdir().unwrap();
    let midi = folder.path().join("phrase.mid");
    std::fs::write(&midi, phrase::file(messages)).unwrap();
    let audio = |host: &str, case: &Case| folder.path().join(format!("{} in {host}", case.name));
    let (mut of_dawdreamer, mut of_pedalboard) = (vec![], vec![]);
    for case in cases {
        let preset = preset_file(folder.path(), case.name, &case.state);
        let [first, second] = ["dawdreamer", "pedalboard"].map(|host| audio(host, case));
        of_dawdreamer.push(json!(["render", bundle::vst3(), preset, midi, SAMPLE_RATE, case.block, FRAMES, first]));
        of_pedalboard.push(json!(["render", bundle::vst3(), preset, messages, SAMPLE_RATE, BLOCK, FRAMES, second]));
    }
    for (host, questions) in [("dawdreamer", of_dawdreamer), ("pedalboard", of_pedalboard)] {
        ask(host, &questions);
        for case in cases {
            let block = if host == "dawdreamer" { case.block } else { BLOCK };
            let file = phrase::file(&phrase::with_controllers_by_block(messages, block));
            let what = format!("{host}, {}, blocks of {block}", case.name);
            assert_same_bits(&what, &samples(&audio(host, case)), &rendered_by_the_command(&file, &case.kit));
        }
    }
}

/// What plays on the main output has the bits of Sprung in Sprung Multi too, although this host has no buffers for the others.
pub(crate) fn many_outputs_leave_the_main_one_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["Sprung", "Sprung Multi"];
    let messages = phrase::messages();
    let audio = |name: &str| folder.path().join(name);
    let render = |name| json!(["render", bundle::vst3(), null, messages, SAMPLE_RATE, 480, FRAMES, audio(name), name]);
    ask("pedalboard", &names.map(render));
    let [plain, multi] = names.map(|name| samples(&audio(name)));
    assert_sound("Sprung", &plain);
    assert_same_bits("Sprung Multi", &multi, &plain);
}

/// A chord that is held has the bits of `sprung render --note … --input …` in pedalboard.
pub(crate) fn the_effect_has_the_bits_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let [file, audio] = ["in.f32", "out.f32"].map(|name| folder.path().join(name));
    let incoming = incoming(24_000);
    std::fs::write(&file, incoming.iter().flat_map(|sample| sample.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let mut instance = Instance::resonator(&open());
    let mut position = |name: &str, value: f64| {
        let parameters = instance.parameters();
        let found = parameters.iter().find(|parameter| parameter.name == name).unwrap();
        (value - found.min) / (found.max - found.min)
    };
    let settings = json!({
        "Chord": position("Chord", 3.0), "Chord root": position("Chord root", 48.0), "Resonator mix": position("Resonator mix", 1.0)
    });
    ask(
        "pedalboard",
        &[json!(["effect", bundle::vst3(), "Sprung Resonator", settings, file, SAMPLE_RATE, 480, audio])],
    );
    let song = Song::chord(&[48.0, 55.0, 60.0], 100.0 / 127.0, 0.5);
    let patch = without_exciters(&Patch::default()).with(Param::InputLevel, 0.0);
    let expected = by_the_command(&song, &patch, &incoming);
    // This host sets parameters while the effect runs, and the mix moves in 20 ms.
    let settled = |sound: Vec<Vec<f32>>| sound.into_iter().map(|side| side[960..].to_vec()).collect::<Vec<_>>();
    let expected = settled(expected);
    assert_sound("the effect", &expected);
    assert_same_bits("the effect", &settled(samples(&audio)), &expected);
}

pub(crate) fn what_is_saved_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let patches = &patches()[thorough::of(4, 0)..];
    let file = |name: &str, what: &str| folder.path().join(format!("{name}.{what}"));
    let (mut of_dawdreamer, mut of_pedalboard) = (vec![], vec![]);
    for (name, patch) in patches {
        let preset = preset_file(folder.path(), name, &state(patch));
        of_dawdreamer.push(json!(["state", bundle::vst3(), preset, file(name, "first"), file(name, "second")]));
        of_pedalboard.push(json!(["state", bundle::vst3(), preset]));
    }
    let answers = ask("dawdreamer", &of_dawdreamer).into_iter().zip(ask("pedalboard", &of_pedalboard));
    for ((name, patch), (values, answer)) in patches.iter().zip(answers) {
        for info in PARAMS {
            let position = values[info.param as usize].as_f64().unwrap();
            let expected = info.normalise(patch.get(info.param));
            assert!((position - expected).abs() < 1e-6, "{name}: {} is at {position}", info.id);
        }
        let same = std::fs::read(file(name, "first")).unwrap() == std::fs::read(file(name, "second")).unwrap();
        assert!(same, "{name}: the state is not the same again");
        assert_eq!((&answer[0], &answer[1]), (&values_of_table(&values), &json!(true)), "{name}, in pedalboard");
    }
}

/// Dawdreamer's values of the parameters of the table, without those that stand for controllers.
fn values_of_table(values: &Value) -> Value {
    values.as_array().unwrap()[..PARAMS.len()].into()
}

/// A parameter moved by the host's automation: the same as the engine's own events at the frames used by the host.
pub(crate) fn automation_has_the_bits_of_the_engine() {
    let block = 512;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("strike.mid");
    std::fs::write(&path, phrase::file(&[(3, [0x90, 57, 100])])).unwrap();
    let positions: Vec<f32> = (0..FRAMES).map(|frame| 0.2 + 0.6 * (frame / 5_120) as f32 / 15.0).collect();
    let values = folder.path().join("automation.f32");
    std::fs::write(&values, positions.iter().flat_map(|position| position.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let params = [Param::Gain, Param::Tune, Param::Decay];
    let audio = |param: Param| folder.path().join(param.info().id);
    let automate = |param: Param| {
        json!(["automate", bundle::vst3(), "", param as usize, values, path, SAMPLE_RATE, FRAMES, audio(param)])
    };
    ask("dawdreamer", &params.map(automate));
    for param in params {
        let info = param.info();
        let mut song = vec![At(3, 0, EventKind::NoteOn { key: 57, detune: 0.0, velocity: 100.0 / 127.0, id: None })];
        // A value that is set while nothing sounds takes effect at once.
        let first = info.denormalise(positions[0].into());
        let mut last = Some(first);
        for frame in (0..FRAMES).step_by(block) {
            let value = info.denormalise(positions[frame].into());
            if last.replace(value) != Some(value) {
                song.push(At(frame as u64, 0, EventKind::Param { param, value }));
            }
        }
        song.sort_by_key(|At(frame, ..)| *frame);
        let expected = render(
            &Preset::find("Church Bell").unwrap().patch.clone().with(param, first),
            SAMPLE_RATE.into(),
            &song,
            FRAMES,
        );
        assert_same_bits(&format!("automated {}", info.id), &samples(&audio(param)), &expected);
    }
}

/// Resizes a host's window, types into the plugin's, and checks that keys go back to the host.
fn is_used(onlooker: &Onlooker, window: u32) {
    const ESCAPE: u8 = 9;
    const Z: u8 = 52;
    let plugin = onlooker.innermost(window);
    assert!(plugin != window, "the plugin has a window of its own");
    // A click takes the keys for a moment.
    wait_until("keys to the host after a drag", || !onlooker.has_focus(plugin));
    let [width, height] = onlooker.size(plugin);
    let [outer_width, outer_height] = onlooker.size(window);
    onlooker.resize(window, [outer_width - 100, outer_height - 60]);
    wait_until("a smaller window", || onlooker.size(plugin) == [width - 100, height - 60]);
    onlooker.resize(window, [outer_width, outer_height]);
    wait_until("the window as it was", || onlooker.size(plugin) == [width, height]);
    let [left, top] = onlooker.place(plugin);
    // In the line at the bottom.
    let empty = [left + 550, top + height as i16 - 8];
    onlooker.drag_slowly(empty, empty);
    std::thread::sleep(std::time::Duration::from_millis(300));
    wait_until("keys to the host after a click", || !onlooker.has_focus(plugin));
    // The browser's search takes them at once.
    let browse = [left + 510, top + 22];
    onlooker.drag_slowly(browse, browse);
    wait_until("keys to the search", || onlooker.has_focus(plugin));
    let before = onlooker.pixels(1_100, 700);
    wait_until("letters in the search", || {
        onlooker.press_key(Z);
        std::thread::sleep(std::time::Duration::from_millis(200));
        // More than a cursor that blinks: the list has become shorter.
        let changed = onlooker.pixels(1_100, 700).iter().zip(&before).filter(|(now, before)| now != before).count();
        changed > 5_000
    });
    wait_until("keys back to the host", || {
        onlooker.press_key(ESCAPE);
        std::thread::sleep(std::time::Duration::from_millis(200));
        !onlooker.has_focus(plugin)
    });
}

pub(crate) fn the_window_opens_and_closes_fifty_times() {
    const TITLE: &str = "DawDreamer: Sprung";
    let screen = Screen::new();
    let onlooker = Onlooker::new(Some(&screen.display));
    onlooker.stand_in_for_a_window_manager();
    let mut host = Command::new(python())
        .arg(script("dawdreamer_window.py"))
        .arg(bundle::vst3())
        .arg("50")
        .env("DISPLAY", &screen.display)
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("Python starts");
    for time in 0..50 {
        let mut window = None;
        wait_until(&format!("window {time}"), || {
            assert_eq!(host.try_wait().unwrap(), None, "the host has ended before window {time}");
            window = onlooker.find(TITLE);
            window.is_some() && onlooker.sees_a_picture(1_280, 800)
        });
        let window = window.expect("it was found");
        onlooker.drag([400, 300 + 5 * time], [500, 300]);
        if time == 0 {
            is_used(&onlooker, window);
        }
        onlooker.close(window);
        wait_until("the window to go", || onlooker.find(TITLE) != Some(window));
    }
    let output = host.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
