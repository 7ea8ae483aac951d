// Draws the body as it swings on its floor, and lets strike, ear and floor be moved on it.
import { colour, number } from "./theme.js";

// The velocity of a strike by a pointer at rest, as in the plugin, and how much harder it is for each pixel a millisecond.
const [AT_REST, PER_SPEED] = [0.7, 0.2];
const RECENT = 80; // ms
export const STRIKE = Math.round(127 * AT_REST);
// An arrow key moves a place by so much of the body’s length or of the way round it.
const STEP = 0.02;
const ARROWS = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };
// Movement of the pointer for the whole way of the floor, how far from its far edge and from the ear that is taken hold of, and how far a
// pointer moves before it drags, in pixels.
const [TRAVEL, GRIP, EAR, SLOP] = [200, 12, 18, 5];

// How the lines of a body are painted: colour, width, strength.
const INKS = [["accent", 2.5, 1], ["text", 1.2, 0.5], ["text", 1, 0.25], ["text", 1, 0.6], ["muted", 1.3, 1]];

// `player` is the page’s own, with the preset that is heard. `strike(place, velocity)` is called for a click or a key, without a place if the
// body has none there; `listen(place)` when the ear is let go elsewhere; `nudge(name, way)` when the floor is dragged, by a share of the way.
// Returns functions that take the energies of the modes and the level, that say that the picture is another, and that tell where the ear
// and the floor’s far edge are.
export function drawBody(canvas, player, { strike, listen, nudge }) {
  let [before, moves, drawn, renewed, level] = [performance.now(), [], "", 0, 0];
  let energies = new Float32Array(64);
  // What the floor is, where the ear is, and what a pointer drags: the ear, or the knob of a part of the floor by its name.
  let [floor, ear, held] = [undefined, undefined, undefined];
  // What nothing covers: its left end, its width and its height.
  const middle = () => {
    const look = getComputedStyle(canvas);
    const [left, right] = ["--left", "--right"].map((side) => Number.parseFloat(look.getPropertyValue(side)));
    return [left, canvas.clientWidth - left - right, canvas.clientHeight];
  };
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.x, event.clientY - box.y];
  };
  const touch = (isEar, [x, y]) => {
    const [left, width, height] = middle();
    return player.touch(isEar, width, height, x - left, y);
  };
  // The knob of the floor’s part there.
  const part = ([x, y]) => {
    if (!floor || floor.space === 0 || y < floor.far - GRIP) return undefined;
    return y < floor.far + GRIP ? "Reverb size" : "Reverb mix";
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || held) return;
    const here = at(event);
    const first = moves.find(([, , time, id]) => id === event.pointerId && event.timeStamp - time < RECENT);
    const way = first ? Math.hypot(event.clientX - first[0], event.clientY - first[1]) : 0;
    const speed = way / Math.max(1, event.timeStamp - (first?.[2] ?? 0));
    const velocity = Math.min(127, Math.round(127 * (AT_REST + PER_SPEED * speed)));
    const isEar = ear && Math.hypot(here[0] - ear[0], here[1] - ear[1]) < EAR;
    const { isOn, place } = isEar ? {} : touch(false, here);
    const name = isEar ? "ear" : isOn ? undefined : part(here);
    if (name) {
      canvas.setPointerCapture(event.pointerId);
      held = { id: event.pointerId, name, from: here, here, velocity, isMoved: false };
    } else strike(place, velocity);
  });
  canvas.addEventListener("pointermove", (event) => {
    moves = moves.filter(([, , time]) => event.timeStamp - time < RECENT).concat([[event.clientX, event.clientY, event.timeStamp, event.pointerId]]);
    const here = at(event);
    if (!held) {
      canvas.style.cursor = part(here) && !touch(false, here).isOn ? "ns-resize" : "";
      return;
    }
    if (held.id !== event.pointerId) return;
    held.isMoved ||= Math.hypot(here[0] - held.from[0], here[1] - held.from[1]) > SLOP;
    if (!held.isMoved) return;
    if (held.name === "ear") held.place = touch(true, here).place ?? held.place;
    else nudge(held.name, (held.here[1] - here[1]) / TRAVEL);
    held.here = here;
    renewed++;
  });
  canvas.addEventListener("pointerup", ({ pointerId }) => {
    if (held?.id !== pointerId) return;
    if (held.place) listen(held.place);
    strike(undefined, held.velocity);
    held = undefined;
  });
  canvas.addEventListener("pointercancel", ({ pointerId }) => held?.id === pointerId && (held = undefined));
  // What is held is dragged; elsewhere a finger scrolls the page.
  canvas.addEventListener("touchstart", (event) => held && event.preventDefault(), { passive: false });
  for (const end of ["pointerup", "pointercancel", "pointerleave"]) canvas.addEventListener(end, () => (moves = []));
  canvas.addEventListener("keydown", (event) => {
    const way = ARROWS[event.key];
    const from = way && player.place(event.shiftKey);
    if (from) {
      // Arrows move the strike, with Shift the ear.
      const to = from.map((share, axis) => Math.max(0, Math.min(1, share + way[axis])));
      if (event.shiftKey) listen(to);
      strike(event.shiftKey ? undefined : to);
    } else if (event.repeat || (event.key !== "Enter" && event.key !== " ")) return;
    else strike();
    event.preventDefault();
  });

  function frame(now) {
    requestAnimationFrame(frame);
    // Who asks for less motion sees how far it bends, and not how it swings.
    const seconds = matchMedia("(prefers-reduced-motion: reduce)").matches ? -1 : Math.min(0.25, (now - before) / 1000);
    before = now;
    const scale = Math.min(2, devicePixelRatio);
    const [left, width, height] = middle();
    // A body at rest stays as it was drawn.
    const still = energies.some((energy) => energy > 0) || level > 0 ? "" : [left, width, height, scale, renewed].join();
    if (width <= 0 || height === 0 || (still !== "" && still === drawn)) return;
    drawn = still;
    const whole = canvas.clientWidth;
    if (canvas.width !== Math.round(whole * scale)) canvas.width = Math.round(whole * scale);
    if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, whole, height);
    floor = paintFloor(context, player.floor(whole, height, left, left + width, level), whole, height);
    context.translate(left, 0);
    const dragged = held?.place && [held.here[0] - left, held.here[1]];
    const heard = paint(context, player.draw(energies, width, height, seconds, number("accent")), dragged);
    ear = heard && [heard[0] + left, heard[1]];
  }
  requestAnimationFrame(frame);
  return {
    swing: (look, loudness) => ([energies, level] = [look, loudness]),
    renew: () => renewed++,
    places: () => ({ ear, far: floor.far }),
  };
}

// Traces so many points.
function trace(context, next, points) {
  context.beginPath();
  for (let n = 0; n < points; n++) n === 0 ? context.moveTo(next(), next()) : context.lineTo(next(), next());
}

// The numbers are as the module’s `floor` says. Returns the space and the height of the far edge.
function paintFloor(context, numbers, width, height) {
  let place = 0;
  const next = () => numbers[place++];
  const [space, strength, glow, far, from, to] = [next(), next(), next(), next(), next(), next()];
  const ground = context.createLinearGradient(0, far, 0, height);
  ground.addColorStop(0, colour("panel"));
  ground.addColorStop(1, `color-mix(in srgb, ${colour("raised")} 80%, ${colour("panel")})`);
  context.fillStyle = ground;
  context.beginPath(), context.moveTo(from, far), context.lineTo(to, far), context.lineTo(width, height), context.lineTo(0, height);
  context.fill();
  context.lineWidth = 1;
  context.strokeStyle = colour("line");
  context.beginPath(), context.moveTo(from, far), context.lineTo(to, far), context.stroke();
  context.save();
  context.beginPath(), context.rect(0, space === 1 ? far : 0, width, height), context.clip();
  context.lineWidth = 1.2 + glow;
  context.strokeStyle = `color-mix(in srgb, ${colour("accent")} ${100 * strength}%, ${colour("line")})`;
  context.fillStyle = `color-mix(in srgb, ${colour("ground")} 70%, transparent)`;
  for (let lines = next(); lines > 0; lines--) {
    trace(context, next, next());
    space === 0 ? context.fill() : context.stroke();
  }
  context.restore();
  return { space, far };
}

// The numbers are as the module’s `draw` says; an ear that is dragged is where the pointer is. Returns where the ear is, if it is known.
export function paint(context, numbers, dragged) {
  let place = 0;
  const next = () => numbers[place++];
  // Patches meet without gaps when their edges are drawn too.
  context.lineWidth = 0.8;
  context.lineJoin = "round";
  const polygons = next();
  for (let n = 0; n < polygons; n++) {
    trace(context, next, 4), context.closePath();
    context.fillStyle = context.strokeStyle = `rgb(${next()} ${next()} ${next()})`;
    context.fill(), context.stroke();
  }
  const inks = INKS.map(([ink, ...look]) => [colour(ink), ...look]);
  for (let lines = next(); lines > 0; lines--) {
    [context.strokeStyle, context.lineWidth, context.globalAlpha] = inks[next()];
    trace(context, next, next()), context.stroke();
  }
  context.globalAlpha = 1;
  if (place < numbers.length) handle(context, next(), next(), "accent", "strike");
  if (place === numbers.length) return undefined;
  const known = [next(), next()];
  const [x, y] = dragged ?? known;
  handle(context, x, y, "text", "listen");
  return [x, y];
}

// A place that can be moved, with its name, and for an ear its waves.
function handle(context, x, y, edge, name) {
  const isEar = name === "listen";
  context.lineWidth = 2;
  context.strokeStyle = colour(edge);
  context.fillStyle = colour("panel");
  context.beginPath(), context.arc(x, y, 7.5, 0, 7), context.fill(), context.stroke();
  context.fillStyle = colour("text");
  context.beginPath(), context.arc(x, y, 2.4, 0, 7), context.fill();
  context.lineWidth = 1.5;
  for (const radius of isEar ? [13, 18.5] : []) context.beginPath(), context.arc(x, y, radius, -0.75, 0.75), context.stroke();
  context.font = "11px Ubuntu, system-ui, sans-serif";
  context.textBaseline = "middle";
  const [left, wide] = [x + (isEar ? 24 : 13), context.measureText(name).width + 8];
  context.fillStyle = colour("panel");
  context.beginPath(), context.roundRect(left, y - 7.5, wide, 15, 4), context.fill();
  context.fillStyle = colour("text");
  context.fillText(name, left + 4, y + 0.5);
}
