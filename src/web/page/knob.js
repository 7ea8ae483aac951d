// A knob: a range of the browser, for keyboards and screen readers, under a face that is dragged up and down.

// Movement of the pointer for the whole way, in pixels; with Shift ten times as much.
const TRAVEL = 200;
// A notch of the mouse wheel moves it by so much.
const NOTCH = 0.02;
// Where the face’s ends are, in degrees from its top, and the radius of its arcs.
const [END, RADIUS] = [135, 21];

const at = (position, radius) => {
  const angle = ((2 * position - 1) * END * Math.PI) / 180;
  return `${(radius * Math.sin(angle)).toFixed(2)} ${(-radius * Math.cos(angle)).toFixed(2)}`;
};

const arc = (from, to) => {
  const [low, high] = [Math.min(from, to), Math.max(from, to)];
  return `M${at(low, RADIUS)} A${RADIUS} ${RADIUS} 0 ${(high - low) * 2 * END > 180 ? 1 : 0} 1 ${at(high, RADIUS)}`;
};

// Adds a knob for a parameter that rests at `rest`; positions go from 0 to 1. `say(position)` is its value as text, `turn(position)` is
// called when it is turned. Returns functions that show a position, and that hide it or show it again.
export function knob(place, { name, param, rest }, say, turn) {
  const label = document.createElement("label");
  label.className = "knob";
  label.innerHTML = `<svg viewBox="-27 -27 54 54" aria-hidden="true"><circle r="17"/><path class="track" d="${arc(0, 1)}"/><path class="arc"/><path class="hand"/></svg>
    <span></span><input type="range" min="0" max="1" step="any" autocomplete="off"><output aria-hidden="true"></output>`;
  const [input, value, gold, hand] = ["input", "output", ".arc", ".hand"].map((part) => label.querySelector(part));
  label.querySelector("span").textContent = name;
  input.dataset.param = param;
  place.append(label);

  const show = (position) => {
    input.value = position;
    value.textContent = say(position);
    input.setAttribute("aria-valuetext", value.textContent);
    gold.setAttribute("d", Math.abs(position - rest) < 0.005 ? "" : arc(rest, position));
    hand.setAttribute("d", `M${at(position, 6)} L${at(position, 15)}`);
  };
  const move = (position) => {
    const next = Math.max(0, Math.min(1, position));
    show(next);
    turn(next);
  };
  input.oninput = () => move(+input.value);
  // As long as it is pressed: which pointer does that, and where it was.
  let held;
  label.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || held) return;
    label.setPointerCapture(event.pointerId);
    held = { id: event.pointerId, y: event.clientY };
    input.focus({ focusVisible: false });
  });
  label.addEventListener("pointermove", (event) => {
    if (held?.id !== event.pointerId) return;
    const way = (held.y - event.clientY) / (event.shiftKey ? 10 * TRAVEL : TRAVEL);
    held.y = event.clientY;
    if (way !== 0) move(+input.value + way);
  });
  for (const end of ["pointerup", "pointercancel"]) label.addEventListener(end, (event) => held?.id === event.pointerId && (held = undefined));
  label.addEventListener("dblclick", () => move(rest));
  const turned = (event) => {
    // With Shift, browsers turn the wheel sideways.
    const way = event.deltaY || event.deltaX;
    // A page that scrolls past turns nothing: only the knob that has the focus.
    if (event.ctrlKey || way === 0 || !label.matches(":focus-within")) return;
    event.preventDefault();
    const notches = Math.max(-1, Math.min(1, way / (event.deltaMode === 0 ? 100 : 3)));
    move(+input.value - notches * (event.shiftKey ? NOTCH / 10 : NOTCH));
  };
  label.addEventListener("wheel", turned, { passive: false });
  return { show, hide: (isHidden) => (label.hidden = isHidden) };
}
