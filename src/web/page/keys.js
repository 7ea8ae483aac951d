// Where notes come from: a keyboard on the page, the computer’s keys, MIDI ports.

const LOWEST = 36;
const HIGHEST = 96;
// The physical keys of an octave and a third from C3, and of as many from C4.
const ROWS = [
  [48, "KeyZ KeyS KeyX KeyD KeyC KeyV KeyG KeyB KeyH KeyN KeyJ KeyM Comma KeyL Period Semicolon Slash"],
  [60, "KeyQ Digit2 KeyW Digit3 KeyE KeyR Digit5 KeyT Digit6 KeyY Digit7 KeyU KeyI Digit9 KeyO Digit0 KeyP"],
];
const NAMES = ["C", "C sharp", "D", "E flat", "E", "F", "F sharp", "G", "A flat", "A", "B flat", "B"];

// Velocities of a key that is struck at its top and at its bottom: both can be struck without aiming at an edge.
const [SOFTEST, LOUDEST] = [30, 127];
// Keys that a narrow screen has room for.
const NARROW = 25;

// `play(key, isOn, velocity)` is called for each key, with a velocity where the pointer gives one. Returns functions that show a
// key, and that bring the home of a sound to the middle of a narrow screen.
export function listen(place, play) {
  const keys = new Map();
  for (let key = LOWEST; key <= HIGHEST; key++) {
    const button = document.createElement("button");
    button.className = NAMES[key % 12].length > 1 ? "key black" : "key";
    button.ariaLabel = `${NAMES[key % 12]} ${Math.floor(key / 12) - 1}`;
    button.tabIndex = -1;
    button.dataset.key = key;
    if (key % 12 === 0) button.textContent = `C${key / 12 - 1}`;
    place.append(button);
    keys.set(key, button);
  }
  pointers(place, play);
  computerKeys(place, play, keys);
  return {
    show: (key, isOn) => keys.get(key)?.classList.toggle("down", isOn),
    // For a sound that is made for some keys, and has one at home.
    centre: ({ lowest: from, highest: to, home: middle }) => {
      // From a white C, so that octaves are seen as such.
      const lowest = Math.max(LOWEST, Math.min(HIGHEST + 1 - NARROW, middle - (middle % 12) - 12 * (middle % 12 < 6)));
      const highest = lowest + NARROW - 1;
      // Tab leads to one key, from where arrows lead on.
      const entry = Math.max(lowest, Math.min(highest, middle));
      keys.forEach((button, key) => {
        button.classList.toggle("far", key < lowest || key > highest);
        button.classList.toggle("beyond", key < from || key > to);
        button.tabIndex = key === entry ? 0 : -1;
      });
    },
  };
}

// The velocity of a key that is struck at a height of the page: the further down, the louder.
function struckAt(button, y) {
  const { top, height } = button.getBoundingClientRect();
  const share = Math.max(0, Math.min(1, (y - top) / height));
  return Math.round(SOFTEST + (LOUDEST - SOFTEST) * share);
}

// A pointer that is dragged plays the keys that it crosses.
function pointers(place, play) {
  const held = new Map();
  const move = (event, isDown) => {
    const button = isDown ? document.elementFromPoint(event.clientX, event.clientY) : undefined;
    const under = button?.dataset.key;
    const [now, before] = [under === undefined ? undefined : +under, held.get(event.pointerId)];
    if (now === before) return;
    if (before !== undefined) play(before, false);
    if (now !== undefined) play(now, true, struckAt(button, event.clientY));
    if (now === undefined) held.delete(event.pointerId);
    else held.set(event.pointerId, now);
  };
  place.addEventListener("pointerdown", (event) => event.button === 0 && move(event, true));
  addEventListener("pointermove", (event) => held.has(event.pointerId) && move(event, true));
  for (const end of ["pointerup", "pointercancel"]) addEventListener(end, (event) => move(event, false));
}

function computerKeys(place, play, keys) {
  const codes = new Map(ROWS.flatMap(([first, row]) => row.split(" ").map((code, n) => [code, first + n])));
  const down = new Map();
  // The list last clicked: letters typed there play notes and arrows still choose. A list reached by Tab is searched by letters.
  // It counts from the click on, not from a choice: browsers give the keys of an open list to the list, not to the page, and whoever
  // chooses the same sound again makes no change.
  let pointed;
  addEventListener("pointerdown", ({ target }) => (pointed = target.closest("select")));
  addEventListener("keydown", (event) => {
    if (event.key === "Tab") pointed = undefined;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // No character searches the clicked list, not even one that plays no note; and a held key that plays one searches no list.
    const isCharacter = event.key.length === 1 && event.key !== " ";
    if ((event.target === pointed && isCharacter) || (event.repeat && down.has(event.code))) event.preventDefault();
    const searches = event.target.matches("select") && event.target !== pointed;
    if (event.repeat || searches) return;
    let key = codes.get(event.code);
    const focused = event.target.dataset?.key;
    // Arrows move along the keyboard; Enter and space play the key that has the focus.
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.code];
    if (focused !== undefined && step) keys.get(+focused + step)?.focus();
    if (focused !== undefined && ["Enter", "Space"].includes(event.code)) key = +focused;
    if (key === undefined || down.has(event.code)) return;
    event.preventDefault();
    down.set(event.code, key);
    play(key, true);
  });
  const release = (code) => {
    if (down.has(code)) play(down.get(code), false);
    down.delete(code);
  };
  addEventListener("keyup", (event) => release(event.code));
  addEventListener("blur", () => [...down.keys()].forEach(release));
}

// Asks for the MIDI ports and returns their names. Later ports are heard too.
export async function useMidi(message) {
  const access = await navigator.requestMIDIAccess();
  const connect = () => access.inputs.forEach((port) => (port.onmidimessage = ({ data }) => data[0] < 0xf0 && message([...data])));
  access.onstatechange = connect;
  connect();
  return [...access.inputs.values()].map((port) => port.name);
}
