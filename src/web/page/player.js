// An instance of the module. A take is a list of {frame, preset}, {frame, strike}, {frame, listen}, {frame, make}, {frame, param,
// position} and {frame, message}: a preset’s number, the place at which its body is struck or heard from then on, the numbers of its model
// and material, a parameter’s number with 0 to 1, or the bytes of a MIDI message, in order of frames from the start. The same take gives
// the same samples, whatever the lengths of blocks.

const BLOCK = 1024;

// Whether an event of a take is set between blocks.
const setsSound = ({ preset, strike, listen, make }) => [preset, strike, listen, make].some((one) => one !== undefined);

// Whether an event of a take starts a note.
export const startsNote = ({ message }) => message && (message[0] & 0xf0) === 0x90 && message[2] > 0;

export class Player {
  constructor(module, sampleRate, seed = 0) {
    this.wasm = new WebAssembly.Instance(module, {}).exports;
    this.synth = this.wasm.create(sampleRate, seed);
    this.frame = 0;
  }

  // Numbers at a place in the module’s memory, which moves when it grows.
  floats(place, length) {
    return new Float32Array(this.wasm.memory.buffer, place, length);
  }

  // The presets, each with name, family, lowest, highest and home key, macros and comment. Not on the audio thread, which cannot
  // decode text.
  presets() {
    return this.text(this.wasm.presets(this.synth)).split("\n").map((line, number) => {
      const [name, family, lowest, highest, home, macros, comment] = line.split("\t");
      const keys = { lowest: +lowest, highest: +highest, home: +home };
      return { number, name, family, ...keys, macros: macros.split(";"), comment };
    });
  }

  // The text of this length that the module has just written.
  text(length) {
    return new TextDecoder().decode(new Uint8Array(this.wasm.memory.buffer, this.wasm.text(this.synth), length)).trimEnd();
  }

  // What can be set, by kind: for each a name and what the module’s `controls` says of it.
  controls() {
    const rows = this.text(this.wasm.controls(this.synth)).split("\n").map((line) => line.split("\t"));
    return (kind) => rows.filter(([own]) => own === kind).map(([, name, ...numbers]) => ({ name, numbers }));
  }

  // The position of a parameter in the preset, and its value there as text.
  position(param) {
    return this.wasm.position(this.synth, param);
  }

  say(param, position) {
    return this.text(this.wasm.say(this.synth, param, position));
  }

  // The numbers of the preset’s model and material; −1 for none of the lists.
  madeOf() {
    return [0, 1].map((which) => this.wasm.made_of(this.synth, which));
  }

  // Plays one event of a take, at an offset into the next block.
  play(event, offset) {
    if (event.preset !== undefined) this.wasm.load(this.synth, event.preset);
    else if (event.strike !== undefined) this.wasm.put(this.synth, false, ...event.strike);
    else if (event.listen !== undefined) this.wasm.put(this.synth, true, ...event.listen);
    else if (event.make !== undefined) this.wasm.make(this.synth, ...event.make);
    else if (event.param !== undefined) this.wasm.turn(this.synth, offset, event.param, event.position);
    else this.wasm.midi(this.synth, offset, event.message[0], event.message[1] ?? 0, event.message[2] ?? 0);
  }

  // Fills both sides and plays the events of the take that fall on these frames, from the given one on. Returns the number
  // of the next event.
  render(take, next, left, right) {
    for (let start = 0; start < left.length; ) {
      let frames = Math.min(BLOCK, left.length - start);
      // A sound is set between blocks, with all events of its frame: a block ends before the first that is in it.
      for (let n = next; n < take.length && take[n].frame < this.frame + frames; n++) {
        if (setsSound(take[n]) && take[n].frame > this.frame) frames = take[n].frame - this.frame;
      }
      for (; next < take.length && take[next].frame < this.frame + frames; next++) {
        this.play(take[next], take[next].frame - this.frame);
      }
      this.sounds = this.wasm.process(this.synth, frames) !== 0;
      left.set(this.floats(this.wasm.samples(this.synth, 0), frames), start);
      right.set(this.floats(this.wasm.samples(this.synth, 1), frames), start);
      start += frames;
      this.frame += frames;
    }
    return next;
  }

  // The body some seconds after the last time, as the module’s `draw` says, for the energies of its modes.
  draw(energies, width, height, seconds, glow) {
    this.floats(this.wasm.energies(this.synth), energies.length).set(energies);
    const length = this.wasm.draw(this.synth, width, height, seconds, glow);
    return this.floats(this.wasm.numbers(this.synth), length);
  }

  // The tile of a model, as `draw`.
  tile(model, width, height, glow) {
    const length = this.wasm.tile(this.synth, model, width, height, glow);
    return this.floats(this.wasm.numbers(this.synth), length);
  }

  // The floor of a stage, as the module’s `floor` says.
  floor(width, height, left, right, level) {
    const length = this.wasm.floor(this.synth, width, height, left, right, level);
    return this.floats(this.wasm.numbers(this.synth), length);
  }

  // Whether a place of the picture is on the body, and the body’s place there; none where it cannot be struck, or its ear cannot be moved.
  touch(isEar, width, height, x, y) {
    const found = this.wasm.touch(this.synth, isEar, width, height, x, y);
    return { isOn: found > 0, place: found > 1 ? this.point() : undefined };
  }

  // Where the body is struck, or heard; none if that cannot be moved.
  place(isEar) {
    return this.wasm.place(this.synth, isEar) ? this.point() : undefined;
  }

  point() {
    return [...this.floats(this.wasm.numbers(this.synth), 2)];
  }

  // Number of voices, 64 energies and 64 ratios.
  look() {
    return this.floats(this.wasm.look(this.synth), 129).slice();
  }
}
