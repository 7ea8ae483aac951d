//! The lab's pages in headless Chromium: switches by mouse and keyboard, light and dark, offline, without errors.

use super::browser::{Key, Page, installed};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A page written by `sprung lab`, in a directory that is removed afterwards.
fn written(command: &str, name: &str) -> (tempfile::TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join(name);
    let done = Command::new(env!("CARGO_BIN_EXE_sprung")).args(["lab", command, "-o"]).arg(&path).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    (directory, path)
}

/// A page in Chromium.
fn open(path: &Path) -> Page {
    Page::open(&installed().expect("chromium, which `cargo xtask setup` installs"), path)
}

fn report() -> (tempfile::TempDir, Page) {
    let (directory, path) = written("compare", "report.html");
    (directory, open(&path))
}

const LINES: &str = "document.querySelectorAll('#trajectory polyline').length";
const PICTURE: &str = "document.querySelector('#trajectory svg').outerHTML.length";

#[test]
fn a_click_on_a_toggle_changes_the_charts() {
    let (_directory, mut page) = report();
    assert_eq!(page.value(LINES), 6, "the truth and five methods");
    assert_eq!(page.value("document.querySelectorAll('#motion rect').length"), 6);
    page.click("input[value=heun]");
    assert_eq!(page.value(LINES), 7);
    assert_eq!(page.value("document.querySelectorAll('#motion rect').length"), 7);
    page.click("input[value=explicit-euler]");
    assert_eq!(page.value(LINES), 6);
    let before = page.value(PICTURE);
    page.click("#steps input[value='0']");
    assert_ne!(page.value(PICTURE), before, "another step, another picture");
    page.click("#all");
    assert_eq!(page.value(LINES), 13);
    page.click("#none");
    assert_eq!(page.value(LINES), 1);
    assert_eq!(page.errors, Vec::<String>::new());
}

#[test]
fn the_keyboard_reaches_every_control() {
    let (_directory, mut page) = report();
    let mut reached = Vec::new();
    // Once around: the time slider is the last element.
    while reached.last().is_none_or(|name| name != "time") && reached.len() < 40 {
        page.press(Key::Tab);
        let focused = page.value("(e => e === document.body ? '' : e.id || e.value)(document.activeElement)");
        reached.push(focused.as_str().unwrap_or("").to_owned());
        if reached.last().is_some_and(|name| name == "heun") {
            let outline = page.value("getComputedStyle(document.activeElement).outlineStyle");
            assert_eq!(outline, "solid", "focus can be seen");
            page.press(Key::Space);
            assert_eq!(page.value(LINES), 7, "space toggles");
        }
        if reached.last().is_some_and(|name| name == "play") {
            let pressed = page.value("document.activeElement.getAttribute('aria-pressed')");
            page.press(Key::Enter);
            assert_ne!(page.value("document.activeElement.getAttribute('aria-pressed')"), pressed);
        }
    }
    for name in ["explicit-euler", "heun", "exponential", "all", "none", "1", "play", "time"] {
        assert!(reached.iter().any(|reached| reached == name), "{name} among {reached:?}");
    }
    assert_eq!(page.errors, Vec::<String>::new());
}

/// Contrast ratios by WCAG 2.2 between each colour and the page's background: at least 4.5 for text, 2.5 for lines,
/// which also differ by dashes and have labels.
const CONTRASTS: &str = "(() => {
  const rgb = (text) => text.match(/[\\d.]+/g).slice(0, 3).map(Number);
  const light = (text) => rgb(text).map((c) => c / 255)
    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, n) => sum + c * [0.2126, 0.7152, 0.0722][n], 0);
  const paper = light(getComputedStyle(document.body).backgroundColor);
  const contrast = (text) => {
    const [low, high] = [paper, light(text)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  };
  const all = (selector, property) => [...document.querySelectorAll(selector)].map((e) => contrast(getComputedStyle(e)[property]));
  return {
    dark: paper < 0.2,
    text: Math.min(...all('h1, p, label, th, td, figcaption', 'color'), ...all('svg text', 'fill')),
    lines: Math.min(...all('#trajectory polyline', 'stroke')),
  };
})()";

#[test]
fn text_and_lines_are_legible_in_light_and_dark() {
    let (_directory, mut page) = report();
    page.click("#all");
    for scheme in ["light", "dark"] {
        let features = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        page.call("Emulation.setEmulatedMedia", features);
        let contrasts = page.value(CONTRASTS);
        assert_eq!(contrasts["dark"], scheme == "dark", "{contrasts}");
        assert!(contrasts["text"].as_f64().unwrap() >= 4.5, "{scheme}: {contrasts}");
        assert!(contrasts["lines"].as_f64().unwrap() >= 2.5, "{scheme}: {contrasts}");
    }
    assert_eq!(page.errors, Vec::<String>::new());
}

#[test]
fn nothing_is_asked_for_from_elsewhere() {
    let (_directory, mut page) = report();
    page.click("#all");
    page.value("new Promise((done) => setTimeout(done, 200))");
    assert!(
        !page.requests.is_empty() && page.requests.iter().all(|url| url.contains("report.html")),
        "{:?}",
        page.requests
    );
    assert!(page.value("document.querySelectorAll('table caption').length") == 3);
    assert_eq!(page.errors, Vec::<String>::new());
}

#[test]
fn the_animation_runs_and_can_be_held() {
    let (_directory, path) = written("animate", "masses.html");
    let mut page = open(&path);
    let held = "document.querySelector('svg').animationsPaused()";
    let place = "document.querySelector('rect.m').getBoundingClientRect().x";
    let moved = format!(
        "(async () => {{ const x = {place}; for (let n = 0; n < 300 && {place} === x; n++) await new Promise(requestAnimationFrame); return {place} !== x; }})()"
    );
    assert_eq!(page.value(held), false);
    assert_eq!(page.value(&moved), true);
    page.click("#hold");
    assert_eq!(page.value(held), true);
    page.press(Key::Enter);
    assert_eq!(page.value(held), false, "the button keeps the focus, and Enter works it");
    assert_eq!(page.errors, Vec::<String>::new());
}
