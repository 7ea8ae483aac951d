// The audio thread: an instance of the module that plays what the page sends.
import { Player } from "./player.js";

class Sprung extends AudioWorkletProcessor {
  // `module` is compiled; `take` is what is played from the start: see player.js.
  constructor({ processorOptions: { module, take } }) {
    super();
    this.player = new Player(module, sampleRate);
    this.take = take;
    this.next = 0;
    [this.looking, this.peak] = [0, 0];
    this.port.onmessage = ({ data }) => {
      const played = { ...data, frame: this.player.frame };
      this.player.play(played, 0);
      this.port.postMessage({ played });
    };
  }

  process(_inputs, [[left, right]]) {
    this.next = this.player.render(this.take, this.next, left, right ?? left);
    // About sixty times a second.
    this.looking += left.length;
    for (const side of [left, right ?? left]) this.peak = side.reduce((most, sample) => Math.max(most, Math.abs(sample)), this.peak);
    if (this.looking >= sampleRate / 60) {
      // As on the meter of the plugin’s window: 60 dB from end to end.
      const level = Math.max(0, Math.min(1, 1 + Math.log10(this.peak) / 3));
      this.port.postMessage({ masses: this.player.look(), level });
      [this.looking, this.peak] = [0, 0];
    }
    return true;
  }
}

registerProcessor("sprung", Sprung);
