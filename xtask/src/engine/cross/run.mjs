// Runs tests/cross as WebAssembly: node run.mjs PROGRAM FIRST STEP SONG_SECONDS
import { readFileSync } from "node:fs";

const [path, ...numbers] = process.argv.slice(2);
const text = new TextDecoder();
let memory;
const host = {
  argument: (place) => Number(numbers[place] ?? [0, 1, 1000][place]),
  print: (start, length) => console.log(text.decode(new Uint8Array(memory.buffer, start, length))),
};
const { instance } = await WebAssembly.instantiate(readFileSync(path), { host });
memory = instance.exports.memory;
instance.exports.main(0, 0);
