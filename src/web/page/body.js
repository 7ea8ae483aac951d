// Draws the body as it swings, and lets it be struck where it is clicked.

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// `player` is the page’s own, with the preset that is heard; `strike(place, velocity)` is called for a click, without a place if the
// body has none there. Returns a function that takes the energies of the modes.
export function drawBody(canvas, player, strike) {
  let [before, last] = [performance.now(), undefined];
  let energies = new Float32Array(64);
  const size = () => [canvas.clientWidth, canvas.clientHeight];

  canvas.addEventListener("pointerdown", (event) => {
    const box = canvas.getBoundingClientRect();
    const moving = last ? Math.hypot(event.clientX - last[0], event.clientY - last[1]) / Math.max(1, event.timeStamp - last[2]) : 0;
    const place = player.touch(...size(), event.clientX - box.x, event.clientY - box.y);
    // As in the plugin: a pointer at rest strikes with 0.7, one that moves harder, 1.5 pixels a millisecond with all force.
    strike(place, Math.min(127, Math.round(127 * (0.7 + 0.2 * moving))));
  });
  canvas.addEventListener("pointermove", (event) => (last = [event.clientX, event.clientY, event.timeStamp]));

  function frame(now) {
    const seconds = Math.min(0.25, (now - before) / 1000);
    before = now;
    const scale = Math.min(2, devicePixelRatio);
    const [width, height] = size();
    if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
    if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    const gold = colour("--gold");
    paint(context, player.draw(energies, width, height, seconds, Number.parseInt(gold.slice(1), 16)), gold);
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
  return (look) => (energies = look);
}

// The numbers are as the module’s `draw` says.
function paint(context, numbers, gold) {
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
  context.strokeStyle = polygons > 0 ? colour("--text") : gold;
  context.globalAlpha = polygons > 0 ? 0.5 : 1;
  context.lineWidth = polygons > 0 ? 1.2 : 2.5;
  for (let lines = next(); lines > 0; lines--) trace(next()), context.stroke();
  context.globalAlpha = 1;
  if (at === numbers.length) return;
  const [x, y] = [next(), next()];
  context.lineWidth = 2;
  context.strokeStyle = context.fillStyle = colour("--text");
  context.beginPath(), context.arc(x, y, 5.5, 0, 7), context.stroke();
  context.beginPath(), context.arc(x, y, 1.8, 0, 7), context.fill();
}
