"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const SVG = "http://www.w3.org/2000/svg";
const make = (name, attributes, text) => {
  const element = document.createElementNS(SVG, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  return element;
};
const byId = (id) => document.getElementById(id);
const boxes = [...document.querySelectorAll("#methods input")];
const radios = [...document.querySelectorAll("#steps input")];
const classOf = (n) => `series s${n % 6}${Math.floor(n / 6) % 2 ? " dashed" : ""}`;

/** The runs to be shown: those of the checked methods at the chosen step. */
function shown() {
  const step = Math.max(0, radios.findIndex((radio) => radio.checked));
  return data.methods
    .filter((method, n) => boxes[n].checked)
    .map((method) => ({ method, run: method.runs[step] }));
}

const short = (value) => {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(1).replace(".0e", "e") : String(+value.toPrecision(4));
  return text.replace(/-/g, "−").replace("e+", "e");
};

function ticks([low, high], count) {
  const least = (high - low) / count;
  const unit = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map((digit) => digit * unit).find((value) => value >= least);
  const list = [];
  for (let n = Math.ceil(low / step - 1e-9); n <= Math.floor(high / step + 1e-9); n++) list.push(n * step);
  return list;
}

const W = 600, H = 340, LEFT = 66, RIGHT = 12, TOP = 8, BOTTOM = 40;

/** Draws lines, each {points: [[x, y], …], kind}, into the element `id`. */
function chart(id, name, x, y, lines) {
  const svg = make("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": name });
  const clip = make("clipPath", { id: `${id}-clip` });
  clip.append(make("rect", { x: LEFT, y: TOP, width: W - LEFT - RIGHT, height: H - TOP - BOTTOM }));
  svg.append(clip);
  const across = (value) => LEFT + ((value - x.range[0]) / (x.range[1] - x.range[0])) * (W - LEFT - RIGHT);
  const up = (value) => H - BOTTOM - ((value - y.range[0]) / (y.range[1] - y.range[0])) * (H - TOP - BOTTOM);
  for (const tick of ticks(x.range, 8)) {
    svg.append(make("line", { class: "grid", x1: across(tick), x2: across(tick), y1: TOP, y2: H - BOTTOM }));
    svg.append(make("text", { x: across(tick), y: H - BOTTOM + 15, "text-anchor": "middle" }, short(tick)));
  }
  for (const tick of ticks(y.range, 7)) {
    svg.append(make("line", { class: "grid", x1: LEFT, x2: W - RIGHT, y1: up(tick), y2: up(tick) }));
    svg.append(make("text", { x: LEFT - 6, y: up(tick) + 4, "text-anchor": "end" }, short(tick)));
  }
  svg.append(make("rect", { class: "frame", x: LEFT, y: TOP, width: W - LEFT - RIGHT, height: H - TOP - BOTTOM }));
  const middle = (TOP + H - BOTTOM) / 2;
  svg.append(make("text", { x: (LEFT + W - RIGHT) / 2, y: H - 6, "text-anchor": "middle" }, x.label));
  svg.append(make("text", { x: 14, y: middle, "text-anchor": "middle", transform: `rotate(-90 14 ${middle})` }, y.label));
  // Far outside the frame a line needs no exact place, only its direction.
  const far = (value) => Math.max(-1e4, Math.min(1e4, value)).toFixed(1);
  const group = make("g", { "clip-path": `url(#${id}-clip)` });
  for (const { points, kind } of lines) {
    const path = points.map(([a, b]) => `${far(across(a))},${far(up(b))}`).join(" ");
    group.append(make("polyline", { class: kind, points: path }));
  }
  svg.append(group);
  byId(id).replaceChildren(svg);
}

const timed = (run, values) => values.map((value, n) => [n * run.step, value]);
const padded = ([low, high], share) => [low - share * (high - low), high + share * (high - low)];

function charts() {
  const runs = shown();
  const kind = ({ method }) => classOf(data.methods.indexOf(method));
  const time = { range: [0, data.end], label: "time / s" };
  const x = padded(data.x, 0.5), v = padded(data.v, 0.5);
  const truth = (values) => ({ points: timed(data.truth, values), kind: "series truth" });
  const lines = (values) => runs.map((entry) => ({ points: timed(entry.run, values(entry.run)), kind: kind(entry) }));
  chart("trajectory", "Position over time of the chosen methods", time, { range: x, label: "position / m" },
    [truth(data.truth.x), ...lines((run) => run.x)]);
  const size = data.x[1] - data.x[0];
  const most = Math.min(1.5 * size, Math.max(1e-17, ...runs.map(({ run }) => run.worst ?? Infinity)));
  chart("difference", "Difference from the true position over time", time,
    { range: [-1.1 * most, 1.1 * most], label: "difference / m" }, lines((run) => run.error));
  chart("phase", "Phase plane: position over velocity", { range: v, label: "velocity / (m/s)" },
    { range: x, label: "position / m" },
    [...runs.map((entry) => ({ points: entry.run.v.map((value, n) => [value, entry.run.x[n]]), kind: kind(entry) })),
      { points: data.truth.v.map((value, n) => [value, data.truth.x[n]]), kind: "series truth" }]);
  chart("energy", "Total energy over time", time, { range: [0, 2.5 * data.energy], label: "energy / J" },
    [truth(data.truth.energy), ...lines((run) => run.energy)]);
}

/* The masses side by side. */
const TRACK = 900, ROW = 34, WALL = 190;
let rows = [];

function position(run, t) {
  const place = t / run.step, n = Math.floor(place);
  if (n >= run.x.length - 1) return run.x[run.x.length - 1];
  return run.x[n] + (place - n) * (run.x[n + 1] - run.x[n]);
}

function stage() {
  const entries = [{ title: "truth", run: data.truth, kind: "series truth" }].concat(shown().map((entry) => (
    { title: entry.method.title, run: entry.run, kind: classOf(data.methods.indexOf(entry.method)).replace(" dashed", "") })));
  const height = ROW * entries.length + 6;
  const svg = make("svg", { viewBox: `0 0 ${TRACK} ${height}`, role: "img", "aria-label": "Masses moving side by side" });
  rows = entries.map(({ title, run, kind }, n) => {
    const y = ROW * n + ROW / 2 + 3;
    svg.append(make("text", { x: WALL - 12, y: y + 4, "text-anchor": "end" }, title));
    svg.append(make("line", { class: "frame", x1: WALL, x2: WALL, y1: y - 13, y2: y + 13 }));
    const spring = make("polyline", { class: "spring" });
    const mass = make("rect", { class: `${kind} mass`, y: y - 10, width: 20, height: 20, rx: 3 });
    svg.append(spring, mass);
    return { run, spring, mass, y };
  });
  byId("motion").replaceChildren(svg);
  move();
}

let now = 0, playing = false, last = 0;

function move() {
  const [low, high] = padded(data.x, 0.3);
  for (const { run, spring, mass, y } of rows) {
    const x = position(run, now);
    const inside = x >= low && x <= high;
    const share = Math.max(0, Math.min(1, (x - low) / (high - low)));
    const place = WALL + 40 + share * (TRACK - WALL - 70);
    mass.setAttribute("x", place - 10);
    mass.setAttribute("opacity", inside ? 1 : 0.35);
    const coils = 14, points = [];
    for (let n = 0; n <= coils; n++) {
      const side = n === 0 || n === coils ? 0 : n % 2 ? 6 : -6;
      points.push(`${(WALL + ((place - 10 - WALL) * n) / coils).toFixed(1)},${y + side}`);
    }
    spring.setAttribute("points", points.join(" "));
  }
  byId("clock").textContent = `${now.toFixed(2)} s`;
  byId("time").value = now / data.end;
}

function frame(stamp) {
  if (!playing) return;
  // A frame's stamp can be earlier than the click that started it.
  now = (now + Math.max(0, Math.min(0.1, (stamp - last) / 1000))) % data.end;
  last = stamp;
  move();
  requestAnimationFrame(frame);
}

function play(on) {
  playing = on;
  byId("play").textContent = on ? "Pause" : "Play";
  byId("play").setAttribute("aria-pressed", on);
  if (on) {
    last = performance.now();
    requestAnimationFrame(frame);
  }
}

function redraw() {
  charts();
  stage();
}

byId("controls").addEventListener("change", redraw);
for (const [id, on] of [["all", true], ["none", false]]) {
  byId(id).addEventListener("click", () => {
    boxes.forEach((box) => { box.checked = on; });
    redraw();
  });
}
byId("play").addEventListener("click", () => play(!playing));
byId("time").addEventListener("input", (event) => {
  play(false);
  now = event.target.value * data.end;
  move();
});
redraw();
// Who has asked for less motion starts it by hand.
if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
