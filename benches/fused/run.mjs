// Runs sprung-fused as WebAssembly: node run.mjs PROGRAM
import { readFileSync } from "node:fs";

const text = new TextDecoder();
let memory;
const host = {
  now: () => performance.now(),
  print: (start, length) => console.log(text.decode(new Uint8Array(memory.buffer, start, length))),
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
memory = instance.exports.memory;
instance.exports.main(0, 0);
