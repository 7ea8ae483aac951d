// The page: loads the module, starts the audio worklet with the first note, and keeps what is played.
import { Player, startsNote } from "./player.js";
import { listen, useMidi } from "./keys.js";
import { STRIKE, drawBody } from "./body.js";
import { panel } from "./panel.js";
import { draw } from "./pictures.js";
import { dress } from "./theme.js";
import { renderTake, wav } from "./wav.js";

const element = (id) => document.getElementById(id);
const SAMPLE_RATE = 48000;

const module = await WebAssembly.compileStreaming(fetch("sprung.wasm"));
// The page’s own player lists presets and draws; it does not sound.
const own = new Player(module, SAMPLE_RATE);
const presets = own.presets();
const state = { take: [], preset: presets.find((preset) => preset.name === "Church Bell") ?? presets[0], key: 60 };
let node;

// The node, which browsers let sound only after a gesture.
async function start() {
  const context = new AudioContext({ sampleRate: SAMPLE_RATE, latencyHint: "interactive" });
  await context.audioWorklet.addModule("worklet.js");
  const options = { numberOfInputs: 0, outputChannelCount: [2], processorOptions: { module, take: [] } };
  const made = new AudioWorkletNode(context, "sprung", options);
  made.connect(context.destination);
  made.onprocessorerror = () => (element("status").textContent = "The audio worklet has failed; reload the page.");
  made.port.onmessage = ({ data }) => {
    if (data.masses) {
      drawMasses(data.masses);
      body.swing(data.masses.subarray(1, 65), data.level);
    }
    if (data.played) {
      state.take.push(data.played);
      element("render").disabled = element("forget").disabled = !state.take.some(startsNote);
    }
  };
  made.port.postMessage({ preset: state.preset.number });
  return made;
}

function send(event) {
  node ??= start();
  node.then((made) => {
    if (made.context.state !== "running") made.context.resume();
    made.port.postMessage(event);
  }, (error) => (element("status").textContent = `No sound: ${error.message}`));
}

function play(key, isOn, velocity = +element("velocity").value) {
  // A velocity of 0 releases the key at medium speed.
  send({ message: [0x90, key, isOn ? velocity : 0] });
  keys.show(key, isOn);
  if (isOn) [state.key, element("tip").hidden] = [key, true];
}

const keys = listen(element("keys"), play);
// The key that a click on the body or the pull of a mass holds, and lets go of a while later.
let held;
function letGo() {
  if (!held) return;
  clearTimeout(held.timer);
  play(held.key, false);
  held = undefined;
}

function hold(key, velocity, time) {
  letGo();
  play(key, true, velocity);
  held = { key, timer: setTimeout(letGo, time) };
}

const strike = (velocity = STRIKE) => hold(state.preset.home, velocity, 700);
const drawMasses = draw(element("modes"), element("plane"), (pull) => hold(state.key, Math.max(1, Math.round(127 * pull)), 400));

// A change of the sound, which the page’s own player draws.
function change(event) {
  send(event);
  own.play(event, 0);
  body.renew();
}

const controls = own.controls();
const shown = panel(element, own, controls, change, strike);
const body = drawBody(element("body"), own, {
  strike: (place, velocity) => {
    if (place) change({ strike: place });
    strike(velocity);
  },
  listen: (place) => change({ listen: place }),
  nudge: shown.nudge,
});
dress(element("theme"), controls, () => {
  shown.colour();
  body.renew();
});

function choose(preset) {
  state.preset = preset;
  own.play({ preset: preset.number }, 0);
  body.renew();
  state.key = preset.home;
  element("about").textContent = preset.comment;
  element("preset").value = preset.number;
  shown.show(preset);
  keys.centre(preset);
  drawMasses(own.look());
  if (node) send({ preset: preset.number });
}

// The presets of the chosen family.
const chosen = () => presets.filter((preset) => ["", preset.family].includes(element("family").value));

function list() {
  element("preset").replaceChildren(...chosen().map(({ name, number }) => new Option(name, number)));
}

const families = [...new Set(presets.map((preset) => preset.family))].filter(Boolean);
element("family").append(new Option("all families", ""), ...families.map((family) => new Option(family)));
list();
choose(state.preset);
element("family").onchange = () => {
  list();
  choose(chosen()[0]);
};
// The next sound of the list, which is heard.
function step(by) {
  const among = chosen();
  choose(among[(among.indexOf(state.preset) + by + among.length) % among.length]);
  strike();
}
element("before").onclick = () => step(-1);
element("after").onclick = () => step(1);
// The pitch wheel springs back when it is let go.
const bend = (value) => send({ message: [0xe0, value & 127, value >> 7] });
element("bend").oninput = ({ target }) => bend(+target.value);
element("bend").onchange = ({ target }) => bend((target.value = 8192));
element("wheel").oninput = ({ target }) => send({ message: [0xb0, 1, +target.value] });
element("preset").onchange = ({ target }) => choose(presets[+target.value]);

element("render").onclick = () => {
  const file = new Blob([wav(renderTake(module, state.take, SAMPLE_RATE), SAMPLE_RATE)], { type: "audio/wav" });
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(file), download: "sprung.wav" });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  element("status").textContent = `sprung.wav: ${(file.size / 1e6).toFixed(1)} MB`;
};

// A new take begins with a new synth, so that its bits are those of its events alone.
element("forget").onclick = async () => {
  letGo();
  const old = await node;
  // What it still sends belongs to the old take.
  if (old) old.port.onmessage = null;
  node = undefined;
  state.take = [];
  element("render").disabled = element("forget").disabled = true;
  element("wheel").value = 0;
  choose(state.preset);
  await old?.context.close();
  body.swing(new Float32Array(64), 0);
};

// A message of a keyboard; the page’s wheel follows the keyboard’s.
function hear(message) {
  const [status, controller, value] = message;
  if ((status & 0xf0) === 0xb0 && controller === 1) element("wheel").value = value;
  send({ message });
}

element("midi").onclick = () =>
  useMidi(hear).then(
    (names) => (element("status").textContent = names.length ? `MIDI: ${names.join(", ")}` : "No MIDI port yet."),
    (error) => (element("status").textContent = `No MIDI: ${error.message}`),
  );

// For tests.
window.sprung = { module, presets, state, body, play, choose };
document.body.dataset.ready = "yes";
