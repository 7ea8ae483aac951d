// Draws the body as it swings, and lets it be struck where it is clicked.

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// The velocity of a strike by a pointer at rest, as in the plugin, and how much harder it is for each pixel a millisecond.
const [AT_REST, PER_SPEED] = [0.7, 0.2];
const RECENT = 80; // ms

// How the lines of a body are painted: colour, width, strength.
const INKS = [["string", 2.5, 1], ["--text", 1.2, 0.5], ["--text", 1, 0.25], ["--text", 1, 0.6], ["--muted", 1.3, 1]];

// `player` is the page’s own, with the preset that is heard; `strike(place, velocity)` is called for a click, without a place if the
// body has none there. Returns functions that take the energies of the modes, and that say that the body is another.
export function drawBody(canvas, player, strike) {
  let [before, moves, drawn, renewed] = [performance.now(), [], "", 0];
  let energies = new Float32Array(64);
  const size = () => [canvas.clientWidth, canvas.clientHeight];

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const box = canvas.getBoundingClientRect();
    const first = moves.find(([, , time]) => event.timeStamp - time < RECENT);
    const way = first ? Math.hypot(event.clientX - first[0], event.clientY - first[1]) : 0;
    const speed = way / Math.max(1, event.timeStamp - (first?.[2] ?? 0));
    const place = player.touch(...size(), event.clientX - box.x, event.clientY - box.y);
    strike(place, Math.min(127, Math.round(127 * (AT_REST + PER_SPEED * speed))));
  });
  canvas.addEventListener("pointermove", (event) => {
    moves = moves.filter(([, , time]) => event.timeStamp - time < RECENT).concat([[event.clientX, event.clientY, event.timeStamp]]);
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"]) canvas.addEventListener(end, () => (moves = []));
  canvas.addEventListener("keydown", (event) => {
    if (event.repeat || (event.key !== "Enter" && event.key !== " ")) return;
    event.preventDefault();
    strike(undefined, Math.round(127 * AT_REST));
  });

  function frame(now) {
    requestAnimationFrame(frame);
    // Who asks for less motion sees how far it bends, and not how it swings.
    const seconds = matchMedia("(prefers-reduced-motion: reduce)").matches ? -1 : Math.min(0.25, (now - before) / 1000);
    before = now;
    const scale = Math.min(2, devicePixelRatio);
    const [width, height] = size();
    // A body at rest stays as it was drawn.
    const still = energies.some((energy) => energy > 0) ? "" : [width, height, scale, colour("--gold"), renewed].join();
    if (width === 0 || height === 0 || (still !== "" && still === drawn)) return;
    drawn = still;
    if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
    if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    const gold = colour("--gold");
    paint(context, player.draw(energies, width, height, seconds, Number.parseInt(gold.slice(1), 16)), gold);
  }
  requestAnimationFrame(frame);
  return { swing: (look) => (energies = look), renew: () => renewed++ };
}

// The numbers are as the module’s `draw` says.
export function paint(context, numbers, gold) {
  let at = 0;
  const next = () => numbers[at++];
  const trace = (points) => {
    context.beginPath();
    for (let n = 0; n < points; n++) n === 0 ? context.moveTo(next(), next()) : context.lineTo(next(), next());
  };
  // Patches meet without gaps when their edges are drawn too.
  context.lineWidth = 0.8;
  context.lineJoin = "round";
  const polygons = next();
  for (let n = 0; n < polygons; n++) {
    trace(4), context.closePath();
    context.fillStyle = context.strokeStyle = `rgb(${next()} ${next()} ${next()})`;
    context.fill(), context.stroke();
  }
  const inks = INKS.map(([ink, ...look]) => [ink === "string" ? gold : colour(ink), ...look]);
  for (let lines = next(); lines > 0; lines--) {
    [context.strokeStyle, context.lineWidth, context.globalAlpha] = inks[next()];
    trace(next()), context.stroke();
  }
  context.globalAlpha = 1;
  if (at === numbers.length) return;
  const [x, y] = [next(), next()];
  context.lineWidth = 2;
  context.strokeStyle = context.fillStyle = colour("--text");
  context.beginPath(), context.arc(x, y, 5.5, 0, 7), context.stroke();
  context.beginPath(), context.arc(x, y, 1.8, 0, 7), context.fill();
}
