// One bar for whatever takes long: how much is known beforehand, or else how much has arrived.

/** What is there sooner needs no bar. */
const PATIENCE = 200;

export class Progress {
  #box;
  #timer;
  #total = 0;
  #noun = "";
  #last = 0;

  constructor(box, stop) {
    this.#box = box;
    this.bar = box.querySelector("progress");
    this.text = box.querySelector("label");
    box.querySelector("button").addEventListener("click", () => {
      stop();
      this.end();
    });
  }

  /** So many are expected; 0 if nobody knows. */
  begin(total, noun) {
    clearTimeout(this.#timer);
    this.#total = total;
    this.#noun = noun;
    this.#last = 0;
    this.#timer = setTimeout(() => {
      this.#box.hidden = false;
    }, PATIENCE);
    this.#say(0);
  }

  /** So many have arrived. */
  reach(count) {
    const now = performance.now();
    if (now - this.#last < 50 && count !== this.#total) return;
    this.#last = now;
    this.#say(count);
  }

  #say(count) {
    const amount = this.#noun === "bytes" ? `${(count / 1e6).toFixed(1)} MB` : `${count.toLocaleString("en")}`;
    if (this.#total > 0) {
      this.bar.value = Math.min(1, count / this.#total);
      this.text.textContent = `${amount} of ${this.#total.toLocaleString("en")} ${this.#noun}`;
    } else {
      this.bar.removeAttribute("value");
      this.text.textContent = `${amount} received`;
    }
  }

  end() {
    clearTimeout(this.#timer);
    this.#box.hidden = true;
  }
}
