// Draws the modes and the phase plane, and lets the mass be pulled.
import { colour } from "./theme.js";

const TURNS = 1; // per second: the true motion is too fast to be seen
const FLOOR = -90; // dB

// `strike(velocity)` is called when the mass is let go, with 0 to 1. Returns a function that takes what the player looks at.
export function draw(modes, plane, strike) {
  let masses = new Float32Array(129);
  let [greatest, angle, before, pulled] = [0, 0, performance.now(), null];
  const trail = [];

  const place = (event) => {
    const box = plane.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height];
    return [(2 * x - 1) / 0.9, (1 - 2 * y) / 0.9];
  };
  plane.addEventListener("pointerdown", (event) => {
    plane.setPointerCapture(event.pointerId);
    plane.classList.add("held");
    pulled = place(event);
  });
  plane.addEventListener("pointermove", (event) => pulled && (pulled = place(event)));
  plane.addEventListener("pointerup", () => {
    if (!pulled) return;
    plane.classList.remove("held");
    angle = Math.atan2(pulled[1], pulled[0]);
    strike(Math.min(1, Math.hypot(...pulled)));
    pulled = null;
  });
  plane.addEventListener("pointercancel", () => {
    plane.classList.remove("held");
    pulled = null;
  });

  function frame(now) {
    const [energies, ratios] = [masses.subarray(1, 65), masses.subarray(65)];
    const loudest = energies.reduce((best, energy, n) => (energy > energies[best] ? n : best), 0);
    const energy = energies[loudest];
    greatest = energy > 1e-12 ? Math.max(greatest, energy) : 0;
    angle -= 2 * Math.PI * TURNS * Math.min(0.1, (now - before) / 1000);
    before = now;
    const radius = greatest > 0 ? Math.sqrt(energy / greatest) : 0;
    const at = pulled ?? [radius * Math.cos(angle), radius * Math.sin(angle)];
    trail.push(at);
    if (trail.length > 240) trail.shift();
    drawModes(modes.getContext("2d"), modes, energies, ratios);
    drawPlane(plane.getContext("2d"), plane.width, trail, at, pulled);
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
  return (look) => (masses = look);
}

function drawModes(context, { width, height }, energies, ratios) {
  context.clearRect(0, 0, width, height);
  const sorted = [...ratios.keys()].filter((n) => ratios[n] > 0);
  if (sorted.length === 0) return;
  const logs = sorted.map((n) => Math.log2(ratios[n]));
  const [low, high] = [Math.min(...logs) - 0.5, Math.max(...logs) + 0.5];
  const [bottom, top] = [height - 36, 16];
  context.font = "20px system-ui, sans-serif";
  context.fillStyle = colour("muted");
  context.strokeStyle = colour("line");
  for (let octave = Math.ceil(low); octave <= high; octave++) {
    const x = ((octave - low) / (high - low)) * width;
    context.beginPath(), context.moveTo(x, top), context.lineTo(x, bottom), context.stroke();
    const ratio = octave < 0 ? `1/${2 ** -octave}` : `${2 ** octave}`;
    // The last octave may be so near to the edge that its label must stand further left.
    context.fillText(ratio, Math.min(x + 4, width - context.measureText(ratio).width), height - 10);
  }
  sorted.forEach((n, place) => {
    const x = ((logs[place] - low) / (high - low)) * width;
    const level = energies[n] > 0 ? 10 * Math.log10(energies[n]) : FLOOR;
    const length = Math.max(0, Math.min(1, 1 - level / FLOOR)) * (bottom - top);
    context.fillStyle = colour(length > 0 ? "accent" : "line");
    context.fillRect(x - 3, bottom - Math.max(3, length), 6, Math.max(3, length));
  });
}

function drawPlane(context, size, trail, at, isPulled) {
  const point = ([x, y]) => [size / 2 + x * size * 0.45, size / 2 - y * size * 0.45];
  context.clearRect(0, 0, size, size);
  context.strokeStyle = colour("line");
  context.beginPath(), context.arc(size / 2, size / 2, size * 0.45, 0, 7), context.stroke();
  context.beginPath(), context.moveTo(0, size / 2), context.lineTo(size, size / 2);
  context.moveTo(size / 2, 0), context.lineTo(size / 2, size), context.stroke();
  context.strokeStyle = context.fillStyle = colour("accent");
  trail.slice(1).forEach((to, n) => {
    context.globalAlpha = (n / trail.length) ** 2;
    context.beginPath(), context.moveTo(...point(trail[n])), context.lineTo(...point(to)), context.stroke();
  });
  context.globalAlpha = 1;
  context.beginPath(), context.arc(...point(at), isPulled ? 16 : 12, 0, 7), context.fill();
}
