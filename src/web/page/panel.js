// What moves the body, what it is and is made of, what it stands on, and knobs: as on the first page of the plugin’s window.
import { paint } from "./body.js";

// A chip that is chosen or not.
function chip(place, name, press, face) {
  const button = document.createElement("button");
  button.className = "chip";
  button.append(...(face ? [face] : []), name);
  button.onclick = press;
  place.append(button);
  return (isOn) => button.setAttribute("aria-pressed", isOn);
}

// `set({param, position})` turns a parameter, `set({make})` gives the sound another body, and `strike()` lets it be heard. `player` is
// the page’s own. Returns a function that shows the preset that it has now.
export function panel(element, player, set, strike) {
  const controls = player.controls();
  const macros = controls("macro").map(({ numbers: [param] }) => +param);
  const positions = new Map();
  const remembered = new Map();
  const turn = (param, position) => {
    positions.set(param, position);
    set({ param, position });
  };

  const exciters = controls("exciter").map(({ name, numbers: [level, also, on] }) => {
    const levels = [+level, +also].filter((param) => param >= 0);
    const isOn = () => levels.some((param) => positions.get(param) > 0);
    const light = chip(element("exciters"), name, () => {
      const before = levels.map((param) => [param, positions.get(param)]);
      const next = isOn() ? levels.map((param) => [param, 0]) : (remembered.get(name) ?? [[+level, +on]]);
      if (isOn()) remembered.set(name, before);
      next.forEach(([param, position]) => turn(param, position));
      light(isOn());
      strike();
    });
    return { params: levels, show: () => light(isOn()) };
  });

  const spaces = controls("space").map(({ name, numbers: [param, position] }) => ({
    params: [+param],
    isHere: () => Math.abs(positions.get(+param) - +position) < 0.01,
    light: chip(element("spaces"), name, () => {
      turn(+param, +position);
      spaces.forEach((space) => space.show());
      strike();
    }),
    show() {
      this.light(this.isHere());
    },
  }));

  const make = (model, material) => {
    set({ make: [model, material] });
    lightBody();
    // The decay has moved along with the losses of the body.
    knobs.forEach((knob) => knob.params.forEach((param) => positions.set(param, player.position(param))));
    knobs.forEach((knob) => knob.show());
    strike();
  };
  const models = controls("model").map(({ name }, model) => {
    const canvas = Object.assign(document.createElement("canvas"), { width: 96, height: 56 });
    const gold = getComputedStyle(document.documentElement).getPropertyValue("--gold").trim();
    paint(canvas.getContext("2d"), player.tile(model, 96, 56, Number.parseInt(gold.slice(1), 16)), gold);
    return chip(element("models"), name, () => make(model, -1), canvas);
  });
  const materials = controls("material").map(({ name, numbers: [colour] }, material) => {
    const disc = Object.assign(document.createElement("span"), { className: "disc" });
    disc.style.background = colour;
    return chip(element("materials"), name, () => make(-1, material), disc);
  });
  function lightBody() {
    const [model, material] = player.madeOf();
    models.forEach((light, number) => light(number === model));
    materials.forEach((light, number) => light(number === material));
  }

  // A slider under its name, with its value.
  function slider(place, name, param) {
    const label = Object.assign(document.createElement("label"), { textContent: name });
    const input = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 1, step: "any" });
    input.dataset.param = param;
    const value = document.createElement("output");
    const say = () => (value.textContent = player.say(param, +input.value));
    input.oninput = () => {
      turn(param, +input.value);
      say();
    };
    label.append(input, value);
    place.append(label);
    const show = () => {
      input.value = positions.get(param);
      say();
    };
    return { params: [param], show };
  }
  const knobs = controls("knob").map(({ name, numbers: [param] }) => slider(element("knobs"), name, +param));

  return (preset) => {
    element("macros").replaceChildren();
    const named = preset.macros.map((name, number) => name && slider(element("macros"), name, macros[number])).filter(Boolean);
    const all = [...exciters, ...spaces, ...knobs, ...named];
    remembered.clear();
    all.forEach(({ params }) => params.forEach((param) => positions.set(param, player.position(param))));
    all.forEach((one) => one.show());
    lightBody();
  };
}
