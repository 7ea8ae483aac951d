//! Tests the page in headless Chromium: samples as of the renderer, notes by keys, mouse, masses and MIDI, and speed.

use super::midi;
use super::page::{Page, installed, until};
use serde_json::{Value, json};
use sprung::internals::measures::Digest;
use sprung::io::Song;
use sprung::preset::Preset;
use sprung::render::{Job, Options, Tail};
use std::path::Path;

/// A preset of a mallet, one of a plate's modes, one with noise.
const PRESETS: [&str; 3] = ["Marimba", "Church Bell", "Snare"];

/// A preset of 64 modes, for the measurement.
const SIXTY_FOUR_MODES: &str = "Electric Piano 1";

/// How many notes the measurement plays at once.
const VOICES: f64 = 8.0;

const RATE: u32 = 48_000;

/// Seconds that a note is held, and that are rendered after it.
const SECONDS: u32 = 1;

/// JavaScript: renders a take of the preset with this number in the page's worklet, and returns its SHA-256.
const DIGEST: &str = "(async (preset) => {
  const context = new OfflineAudioContext(2, 2 * SECONDS * RATE, RATE);
  await context.audioWorklet.addModule('worklet.js');
  const take = [{frame: 0, preset}, {frame: 0, message: [0x90, 60, 100]}, {frame: SECONDS * RATE, message: [0x90, 60, 0]}];
  const processorOptions = {module: sprung.module, take};
  new AudioWorkletNode(context, 'sprung', {numberOfInputs: 0, outputChannelCount: [2], processorOptions}).connect(context.destination);
  const sound = await context.startRendering();
  const [left, right] = [sound.getChannelData(0), sound.getChannelData(1)];
  const both = new Float32Array(2 * left.length);
  left.forEach((sample, n) => { both[2 * n] = sample; both[2 * n + 1] = right[n]; });
  const hash = new Uint8Array(await crypto.subtle.digest('SHA-256', both));
  return [...hash].map((byte) => byte.toString(16).padStart(2, '0')).join('');
})";

/// JavaScript: plays notes of the preset for ten seconds, at once and then live. Returns how many times as fast as real time
/// the first is, how many seconds the worklet took to start, and how many frames were lost from its first block on; then how many
/// frames a silent worklet loses in a run of its own, which are the browser's fault.
const SPEED: &str = "(async (preset) => {
  const events = [{frame: 0, preset}];
  for (let second = 0; second < 10; second++)
    for (let n = 0; n < VOICES; n++) events.push({frame: second * RATE, message: [0x90, 40 + 3 * n, 100]});
  const node = async (context, take) => {
    await context.audioWorklet.addModule('worklet.js');
    const processorOptions = {module: sprung.module, take};
    const made = new AudioWorkletNode(context, 'sprung', {numberOfInputs: 0, outputChannelCount: [2], processorOptions});
    made.connect(context.destination);
    return made;
  };
  const offline = new OfflineAudioContext(2, 10 * RATE, RATE);
  await node(offline, events);
  const start = performance.now();
  await offline.startRendering();
  const times = 10_000 / (performance.now() - start);
  const live = async (take) => {
    const context = new AudioContext({sampleRate: RATE});
    const opened = performance.now();
    const made = await node(context, take);
    let voices = 0;
    const playing = new Promise((done) => {
      made.port.onmessage = ({data}) => {
        if (data.masses) done(voices = Math.max(voices, data.masses[0]));
      };
    });
    await context.resume();
    await playing;
    const started = (performance.now() - opened) / 1000;
    const underruns = () => (context.playbackStats ?? context.playoutStats)?.underrunDuration;
    const [before, at, lostBefore] = [context.currentTime, performance.now(), underruns()];
    await new Promise((done) => setTimeout(done, 7500));
    const missing = (performance.now() - at) / 1000 - (context.currentTime - before);
    const lost = lostBefore === undefined ? null : Math.round((underruns() - lostBefore) * RATE);
    await context.close();
    return {started, voices, behind: Math.max(0, Math.round(missing * RATE / 128)), lost};
  };
  const played = await live(events);
  const silent = await live([{frame: 0, preset}]);
  return {times, ...played, silent: silent.lost};
})";

/// JavaScript: leaves the list of sounds as a click does, but without opening it: an open list would take the keys.
const CHOSEN_FROM: &str =
    "(list => { list.dispatchEvent(new PointerEvent('pointerdown', { bubbles: true })); list.focus(); })
  (document.querySelector('#preset'))";

/// JavaScript: turns the first macro.
const TURN: &str = "(input => { input.value = 0.7; input.dispatchEvent(new Event('input')); })
  (document.querySelector('#macros input'))";

/// JavaScript: whether a note sounds otherwise after a macro was turned.
const IS_MACRO_HEARD: &str = "import('./wav.js').then(({renderTake}) => {
  const preset = sprung.state.preset.number;
  const note = [{frame: 9600, message: [0x90, 60, 100]}];
  const param = +document.querySelector('#macros input').dataset.param;
  const [plain, turned] = [[], [{frame: 0, param, position: 1}]].map((events) =>
    renderTake(sprung.module, [{frame: 0, preset}, ...events, ...note], 48000, 1)[0]);
  return plain.some((block, n) => block.some((sample, k) => sample !== turned[n][k]));
})";

/// Opens the page, and checks it or takes its picture.
pub(super) fn run(address: &str, check: bool, picture: Option<&Path>) -> Result<(), String> {
    let Some(program) = installed() else {
        return Err("there is no chromium; install it with: sudo apt-get install chromium".to_owned());
    };
    let mut page = Page::open_at(&program, address);
    until(&mut page, "document.body.dataset.ready === 'yes'")?;
    if check {
        PRESETS.iter().try_for_each(|preset| same_samples(&mut page, preset))?;
        sounds(&mut page)?;
        speed(&mut page)?;
    }
    if let Some(path) = picture {
        take_picture(&mut page, path)?;
    }
    if page.errors.is_empty() { Ok(()) } else { Err(page.errors.join("\n")) }
}

/// A script with the values of its constants in place of their names.
fn with_constants(script: &str) -> String {
    let constants = [("SECONDS", f64::from(SECONDS)), ("RATE", f64::from(RATE)), ("VOICES", VOICES)];
    constants.iter().fold(script.to_owned(), |script, (name, value)| script.replace(name, &value.to_string()))
}

fn number_of(preset: &str) -> usize {
    Preset::factory().iter().position(|one| one.name == preset).expect("the presets exist")
}

/// Renders a note in the page and with the offline renderer, as `sprung render` does.
fn same_samples(page: &mut Page, preset: &str) -> Result<(), String> {
    let found = page.value(&format!("{}({})", with_constants(DIGEST), number_of(preset)));
    let expected = rendered(preset).map_err(|error| error.to_string())?;
    if found != json!(expected) {
        return Err(format!("{preset}: the page has {found}, the renderer {expected}"));
    }
    println!("{preset}: the page has the renderer’s samples, {}…", &expected[..16]);
    Ok(())
}

fn rendered(preset: &str) -> sprung::Result<String> {
    let song = Song::chord(&[60.0], 100.0 / 127.0, f64::from(SECONDS));
    let kit = Preset::find(preset)?.kit();
    let options = Options { sample_rate: RATE, tail: Tail::Seconds(f64::from(SECONDS)), ..Options::default() };
    let [left, right] = Job::new(&song, &kit, options).samples()?;
    Ok(Digest::of(&left, &right, f64::from(RATE)).sha256)
}

/// Plays by mouse, by the computer's keys, on the body, by pulling the mass and by MIDI, and renders the take.
fn sounds(page: &mut Page) -> Result<(), String> {
    let mut strikes = 0;
    let mut heard = |page: &mut Page, what: &str| {
        strikes += 1;
        until(page, &format!("sprung.state.take.filter((event) => event.message?.[2] > 0).length === {strikes}"))?;
        println!("{what} sounds");
        Ok::<(), String>(())
    };
    page.click("[data-key='60']");
    heard(page, "a key under the mouse")?;
    press(page, "e", "KeyE");
    heard(page, "a key of the computer")?;
    // A list that a pointer has chosen from keeps the focus, and the next letter would search it.
    page.value(CHOSEN_FROM);
    press(page, "m", "KeyM");
    heard(page, "a key of the computer after a choice from a list")?;
    // A letter that plays no note does not search it either.
    press(page, "f", "KeyF");
    if page.value("sprung.state.preset.name") != json!("Church Bell") {
        return Err("a letter has chosen a sound from a list that was clicked".to_owned());
    }
    page.click("#body");
    heard(page, "a body that is clicked")?;
    drag(
        page,
        "(r => [r.x + r.width / 2, r.y + r.height / 2, 0.3 * r.width, 0])(document.querySelector('#plane').getBoundingClientRect())",
    );
    heard(page, "a mass that is pulled")?;
    until(page, "sprung.state.take.filter((event) => event.message).length === 10")?;
    midi::plays(page, heard)?;
    page.value(TURN);
    until(page, "sprung.state.take.at(-1)?.position === 0.7")?;
    if page.value(IS_MACRO_HEARD) != json!(true) {
        return Err("a macro that is turned is not heard".to_owned());
    }
    println!("a macro is heard");
    // One body is struck where it is clicked.
    page.value("sprung.choose(sprung.presets.find((preset) => preset.name === 'Gong'))");
    page.click("#body");
    until(page, "sprung.state.take.some((event) => event.strike?.length === 2)")?;
    println!("a body is struck elsewhere");
    drag(
        page,
        "(r => { const [x, y] = sprung.body.places().ear; return [r.x + x, r.y + y, 40, 10]; })(document.querySelector('#body').getBoundingClientRect())",
    );
    until(page, "sprung.state.take.some((event) => event.listen?.length === 2)")?;
    println!("its ear is moved");
    // Each kind of chip makes its event, and is heard.
    for (chip, event) in [
        ("#exciters .mover:nth-child(2) .chip", "event.param !== undefined && event.position > 0"),
        ("#spaces .chip:nth-child(2)", "event.param !== undefined && event.position > 0"),
        ("#models .chip:nth-child(4)", "event.make?.[0] === 3"),
        ("#materials .disc:nth-child(5)", "event.make?.[1] === 4"),
    ] {
        page.value("window.before = sprung.state.take.length");
        page.click(chip);
        until(page, &format!("sprung.state.take.slice(before).some((event) => {event})"))?;
        until(page, "sprung.state.take.at(-1)?.message?.[2] > 0")?;
        until(page, &format!("document.querySelector('{chip}').ariaPressed === 'true'"))?;
    }
    println!("what moves it, what it stands on, what it is and is made of are chosen by a click");
    page.value("window.before = sprung.state.take.length");
    drag(
        page,
        "(r => [r.x + 150, r.y + sprung.body.places().far + 40, 0, -60])(document.querySelector('#body').getBoundingClientRect())",
    );
    until(page, "sprung.state.take.slice(before).filter((event) => event.position > 0.25).length > 0")?;
    println!("the floor is dragged");
    let colours = ["dark", "light", "high-contrast"].map(|theme| {
        page.value(&format!(
            "(select => {{ select.value = '{theme}'; select.onchange(); return getComputedStyle(document.body).backgroundColor; }})\
             (document.querySelector('#theme'))"
        ))
    });
    if colours != ["rgb(19, 19, 24)", "rgb(228, 225, 218)", "rgb(0, 0, 0)"].map(Value::from) {
        return Err(format!("the themes’ grounds are {colours:?}"));
    }
    let peak = page.value(
        "import('./wav.js').then(({renderTake}) => Math.max(...renderTake(sprung.module, sprung.state.take, 48000, 2)[0].map((block) => Math.max(...block))))",
    );
    match peak.as_f64() {
        Some(peak) if peak > 0.01 && peak < 1.0 => Ok(()),
        _ => Err(format!("the take’s peak is {peak}")),
    }
}

/// Presses a key of the computer that types a letter, and holds it until it has repeated.
fn press(page: &mut Page, letter: &str, code: &str) {
    for (kind, is_repeated) in [("keyDown", false), ("keyDown", true), ("keyUp", false)] {
        let mut event = json!({ "type": kind, "key": letter, "code": code, "autoRepeat": is_repeated });
        if kind == "keyDown" {
            event["text"] = json!(letter);
        }
        page.call("Input.dispatchKeyEvent", event);
    }
}

/// Drags the mouse in three steps, by the numbers of an expression: from where, and by how much.
fn drag(page: &mut Page, expression: &str) {
    let way = page.value(expression);
    let number = |place: usize| way[place].as_f64().unwrap_or(f64::NAN);
    for (kind, share) in [("mousePressed", 0.0), ("mouseMoved", 0.5), ("mouseMoved", 1.0), ("mouseReleased", 1.0)] {
        let [x, y] = [0, 1].map(|axis| number(axis) + share * number(axis + 2));
        let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1 });
        page.call("Input.dispatchMouseEvent", event);
    }
}

fn speed(page: &mut Page) -> Result<(), String> {
    let preset = number_of(SIXTY_FOUR_MODES);
    if Preset::factory()[preset].patch.modes.as_slice().len() != 64 {
        return Err(format!("{SIXTY_FOUR_MODES} has not 64 modes any more: choose another preset"));
    }
    // Other work on the machine takes time from the page.
    let load = std::fs::read_to_string("/proc/loadavg");
    let load = load.ok().and_then(|text| text.split(' ').next().map(|load| format!("; load average before: {load}")));
    let found = page.value(&format!("{}({preset})", with_constants(SPEED)));
    if !is_measured(&found) {
        return Err(format!("the measurement of {VOICES} voices failed: {found}"));
    }
    let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
    println!(
        "{}: {} voices of 64 modes: {:.1} times real time; live, the worklet starts in {:.2} s, and in 7.5 s from then on is \
         behind by {} blocks of 128 frames; underruns: {}{}",
        Preset::factory()[preset].name,
        number("voices"),
        number("times"),
        number("started"),
        number("behind"),
        if found["lost"] == Value::Null {
            "not told by this browser".to_owned()
        } else {
            format!("{} frames ({} in a silent run)", found["lost"], found["silent"])
        },
        load.unwrap_or_default(),
    );
    Ok(())
}

/// Whether all voices have played, both at once and live.
fn is_measured(found: &Value) -> bool {
    let is_finite = |key: &str| found[key].as_f64().is_some_and(f64::is_finite);
    found["voices"].as_f64() == Some(VOICES) && ["times", "started", "behind"].into_iter().all(is_finite)
}

/// Plays a chord and takes a picture of the page while it rings.
fn take_picture(page: &mut Page, path: &Path) -> Result<(), String> {
    page.call(
        "Emulation.setDeviceMetricsOverride",
        json!({ "width": 1160, "height": 1040, "deviceScaleFactor": 1, "mobile": false }),
    );
    let dark = json!({ "features": [{ "name": "prefers-color-scheme", "value": "dark" }] });
    page.call("Emulation.setEmulatedMedia", dark);
    page.click("[data-key='48']");
    page.value("[48, 55, 60].forEach((key) => sprung.play(key, true))");
    page.value("scrollTo(0, 0); document.documentElement.style.overflow = 'hidden'");
    page.value("new Promise((done) => setTimeout(done, 2500))");
    let answer = page.call("Page.captureScreenshot", json!({ "format": "png", "optimizeForSpeed": false }));
    let bytes = answer["data"].as_str().and_then(decoded).ok_or("the browser’s picture is not base64")?;
    std::fs::write(path, &bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{}: {} kB", path.display(), bytes.len() / 1000);
    Ok(())
}

/// The bytes of a base64 text; none if it has other characters.
fn decoded(text: &str) -> Option<Vec<u8>> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::with_capacity(text.len() * 3 / 4);
    let (mut bits, mut count) = (0u32, 0);
    for letter in text.trim_end_matches('=').bytes() {
        bits = bits << 6 | DIGITS.iter().position(|digit| *digit == letter)? as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::{decoded, is_measured};
    use serde_json::json;

    #[test]
    fn a_measurement_without_all_voices_or_times_is_none() {
        assert!(is_measured(&json!({ "times": 9.5, "started": 0.2, "voices": 8, "behind": 0, "lost": null })));
        assert!(!is_measured(&json!({ "times": 9.5, "started": 0.2, "voices": 7, "behind": 0, "lost": null })));
        // JSON has no infinity and no NaN: a browser writes them as null.
        assert!(!is_measured(&json!({ "times": null, "started": 0.2, "voices": 8, "behind": 0, "lost": null })));
        assert!(!is_measured(&json!(null)));
    }

    #[test]
    fn base64_is_decoded() {
        assert_eq!(decoded("U3BydW5n"), Some(b"Sprung".to_vec()));
        assert_eq!(decoded("bWFzcw=="), Some(b"mass".to_vec()));
        assert_eq!(decoded("no!"), None);
    }
}
