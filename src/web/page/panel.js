// What moves the body, what it is and is made of, what it stands on, and knobs: as on the first page of the plugin’s window.
import { paint } from "./body.js";
import { knob } from "./knob.js";
import { number } from "./theme.js";

const TILE = [96, 56];

function button(place, className, press) {
  const made = Object.assign(document.createElement("button"), { className, onclick: press });
  place.append(made);
  return made;
}

// A chip that is chosen or not.
function chip(place, name, press, face, className = "chip") {
  const made = button(place, className, press);
  if (className === "chip") made.append(...(face ? [face] : []), name);
  else made.ariaLabel = made.title = name;
  return Object.assign(made, { light: (isOn) => made.setAttribute("aria-pressed", isOn) });
}

// A picture of lines and faces in a square.
function glyph(paths) {
  const classes = ["strong", "thin", "touched", "face"];
  const holder = document.createElement("template");
  const drawn = paths.map((path, n) => path && `<path class="${classes[n]}" d="${path}"/>`).join("");
  holder.innerHTML = `<svg class="glyph" viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true">${drawn}</svg>`;
  return holder.content.firstChild;
}

// `set({param, position})` turns a parameter, `set({make})` gives the sound another body, and `strike()` lets it be heard. `player` is
// the page’s own. Returns functions: one that shows the preset that it has now, one that draws the tiles in the present colours, and one
// that turns a parameter from elsewhere.
export function panel(element, player, controls, set, strike) {
  const macros = controls("macro").map(({ numbers: [param, rest] }) => ({ param: +param, rest: +rest }));
  const positions = new Map();
  const remembered = new Map();
  const turn = (param, position) => {
    positions.set(param, position);
    set({ param, position });
  };

  const exciters = controls("exciter").map(({ name, numbers: [level, also, on, ...paths] }) => {
    const levels = [+level, +also].filter((param) => param >= 0);
    const isOn = () => levels.some((param) => positions.get(param) > 0);
    const place = document.createElement("div");
    place.className = "mover";
    element("exciters").append(place);
    const own = {
      params: levels,
      isOn,
      show: () => {
        tile.light(isOn());
        tile.title = isOn() ? "Hear it" : `${name} alone`;
        lamp.setAttribute("aria-checked", isOn());
      },
      switch: (to) => {
        if (to === isOn()) return;
        const before = levels.map((param) => [param, positions.get(param)]);
        const next = to ? (remembered.get(name) ?? [[+level, +on]]) : levels.map((param) => [param, 0]);
        if (!to) remembered.set(name, before);
        next.forEach(([param, position]) => turn(param, position));
        own.show();
      },
    };
    // A click on one that is off: it alone. Its lamp adds it to the others.
    const tile = chip(place, name, () => {
      if (!isOn()) exciters.forEach((other) => other.switch(other === own));
      strike();
    }, glyph(paths));
    const lamp = button(place, "lamp", () => own.switch(!isOn()));
    lamp.setAttribute("role", "switch");
    lamp.ariaLabel = lamp.title = `${name} too`;
    return own;
  });

  const spaces = controls("space").map(({ name, numbers: [param, position] }) => ({
    params: [+param],
    tab: chip(element("spaces"), name, () => {
      turn(+param, +position);
      showSpaces();
      strike();
    }),
    isHere: () => Math.abs(positions.get(+param) - +position) < 0.01,
  }));
  function showSpaces() {
    spaces.forEach((space) => space.tab.light(space.isHere()));
    knobs.forEach((one) => one.face.hide(one.needsSpace && spaces[0].isHere()));
  }

  const make = (model, material) => {
    set({ make: [model, material] });
    lightBody();
    // The decay has moved along with the losses of the body.
    knobs.forEach((one) => {
      positions.set(one.param, player.position(one.param));
      one.show();
    });
    strike();
  };
  const canvases = [];
  const models = controls("model").map(({ name }, model) => {
    const [width, height] = TILE;
    canvases.push(Object.assign(document.createElement("canvas"), { width, height }));
    return chip(element("models"), name, () => make(model, -1), canvases[model]);
  });
  const materials = controls("material").map(({ name, numbers: [own] }, material) => {
    const disc = chip(element("materials"), name, () => make(-1, material), undefined, "disc");
    disc.style.setProperty("--own", own);
    return disc;
  });
  function lightBody() {
    const [model, material] = player.madeOf();
    models.forEach((tile, place) => tile.light(place === model));
    materials.forEach((disc, place) => disc.light(place === material));
  }

  function turned(place, name, param, rest, needsSpace = false) {
    const face = knob(place, { name, param, rest }, (position) => player.say(param, position), (position) => turn(param, position));
    return { name, param, needsSpace, face, params: [param], show: () => face.show(positions.get(param)) };
  }
  const knobs = ["knob", "output"].flatMap((kind) =>
    controls(kind).map(({ name, numbers: [param, rest, needsSpace] }) =>
      turned(element(kind === "knob" ? "knobs" : "output"), name, +param, +rest, needsSpace === "1")));

  return {
    show: (preset) => {
      element("macros").replaceChildren();
      const face = (name, place) => name && turned(element("macros"), name, macros[place].param, macros[place].rest);
      const named = preset.macros.map(face).filter(Boolean);
      remembered.clear();
      const all = [...exciters, ...spaces, ...knobs, ...named];
      all.forEach(({ params }) => params.forEach((param) => positions.set(param, player.position(param))));
      [...exciters, ...knobs, ...named].forEach((one) => one.show());
      showSpaces();
      lightBody();
    },
    colour: () =>
      canvases.forEach((canvas, model) => {
        const context = canvas.getContext("2d");
        context.clearRect(0, 0, ...TILE);
        paint(context, player.tile(model, ...TILE, number("accent")));
      }),
    // By so much of the way of the knob with a name.
    nudge: (name, way) => {
      const { param, show } = knobs.find((one) => one.name === name);
      turn(param, Math.max(0, Math.min(1, positions.get(param) + way)));
      show();
    },
  };
}
