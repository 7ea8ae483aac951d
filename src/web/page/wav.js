// Takes as WAV files of 32-bit floats, which hold every bit.
import { Player, startsNote } from "./player.js";

// The samples of a take, from the frame of its first note until it has died away, or `longest` seconds later.
export function renderTake(module, take, sampleRate, longest = 60) {
  const player = new Player(module, sampleRate);
  const first = take.find(startsNote)?.frame ?? 0;
  const last = take.at(-1)?.frame ?? 0;
  const [left, right] = [[], []];
  let next = 0;
  const render = (frames) => {
    const [l, r] = [new Float32Array(frames), new Float32Array(frames)];
    next = player.render(take, next, l, r);
    return [l, r];
  };
  if (first > 0) render(first);
  do {
    const [l, r] = render(4096);
    left.push(l);
    right.push(r);
  } while ((player.frame <= last || player.sounds) && player.frame < last + longest * sampleRate);
  return [left, right];
}

// A WAV file of two sides, each a list of blocks.
export function wav([left, right], sampleRate) {
  const frames = left.reduce((sum, block) => sum + block.length, 0);
  const view = new DataView(new ArrayBuffer(58 + 8 * frames));
  const word = (at, text) => [...text].forEach((letter, n) => view.setUint8(at + n, letter.charCodeAt(0)));
  const long = (at, number) => view.setUint32(at, number, true);
  const short = (at, number) => view.setUint16(at, number, true);
  word(0, "RIFF"), long(4, 50 + 8 * frames), word(8, "WAVEfmt "), long(16, 18), short(20, 3), short(22, 2);
  long(24, sampleRate), long(28, 8 * sampleRate), short(32, 8), short(34, 32), short(36, 0);
  word(38, "fact"), long(42, 4), long(46, frames), word(50, "data"), long(54, 8 * frames);
  let at = 58;
  left.forEach((block, number) => block.forEach((sample, n) => {
    view.setFloat32(at, sample, true);
    view.setFloat32(at + 4, right[number][n], true);
    at += 8;
  }));
  return view.buffer;
}
