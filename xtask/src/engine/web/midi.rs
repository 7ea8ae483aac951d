//! Plays the page by simulated MIDI ports in place of the browser's.

use super::page::{Page, until};

/// JavaScript: gives the page a port. `midi.send` sends a message through a port, as a keyboard does, and `midi.plug` adds one.
const PORTS: &str = "(() => {
  const port = (name) => ({name, onmidimessage: null});
  const access = {inputs: new Map([['first', port('Keys')]]), onstatechange: null};
  window.midi = {
    plug: () => { access.inputs.set('second', port('Pads')); access.onstatechange(); },
    send: (place, ...data) => access.inputs.get(place).onmidimessage({data: new Uint8Array(data)}),
  };
  Object.defineProperty(navigator, 'requestMIDIAccess', {configurable: true, value: async () => access});
})()";

/// JavaScript: a browser or a user that refuses.
const REFUSED: &str = "Object.defineProperty(navigator, 'requestMIDIAccess', {
  configurable: true, value: async () => { throw new Error('refused'); } }) && true";

/// Plays a note through a port, and one through a port that is plugged in later. `heard` waits for one more note.
pub(super) fn plays(
    page: &mut Page,
    mut heard: impl FnMut(&mut Page, &str) -> Result<(), String>,
) -> Result<(), String> {
    let says = |text: &str| format!("document.querySelector('#status').textContent === '{text}'");
    page.value(PORTS);
    page.click("#midi");
    until(page, &says("MIDI: Keys"))?;
    page.value("midi.send('first', 0x90, 64, 80)");
    heard(page, "a MIDI keyboard")?;
    page.value("midi.plug()");
    // A clock message is not sent to the synth.
    page.value("(midi.send('second', 0xf8), midi.send('second', 0x91, 67, 80))");
    heard(page, "a MIDI port that is plugged in later")?;
    page.value("(midi.send('first', 0x80, 64, 0), midi.send('second', 0x91, 67, 0))");
    let ended = "[[0x80, 64], [0x91, 67]].every(([status, key]) => sprung.state.take.some(({message}) => \
                 message?.[0] === status && message[1] === key && message[2] === 0))";
    until(page, ended)?;
    until(page, "sprung.state.take.every(({message}) => !message || message[0] < 0xf0)")?;
    page.value(REFUSED);
    page.click("#midi");
    until(page, &says("No MIDI: refused"))
}
