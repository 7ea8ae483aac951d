// The audio thread: an instance of the module that plays what the page sends.
import { Player } from "./player.js";

class Sprung extends AudioWorkletProcessor {
  // `module` is compiled; `take` is what is played from the start: see player.js.
  constructor({ processorOptions: { module, take } }) {
    super();
    this.player = new Player(module, sampleRate);
    this.take = take;
    this.next = 0;
    [this.looking, this.level] = [0, 0];
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
    this.level = left.reduce((most, sample) => Math.max(most, Math.abs(sample)), this.level);
    if (this.looking >= sampleRate / 60) {
      this.port.postMessage({ masses: this.player.look(), level: Math.min(1, this.level) });
      [this.looking, this.level] = [0, 0];
    }
    return true;
  }
}

registerProcessor("sprung", Sprung);
