// SPDX-License-Identifier: Apache-2.0
// The moment that is shown: slider, event marks and buttons.
import {element, timeOfDay} from "./format.js";

/** @type {Record<string, string>} */
const kColours = {info: "#8b96a1", warning: "#e69f00", error: "#d55e00"};

export class Timeline {
  /** @param {(message: object) => void} send */
  constructor(send) {
    this.send = send;
    this.mode = "live";
    this.begin_s = 0;
    this.end_s = 1;
    this.shown_s = 0;
    this.firstGrant_s = /** @type {number | null} */ (null);
    this.isRecording = false;
    this.isConnected = false;
    /** @type {any[]} */
    this.events = [];
    this.isDragged = false;
    const slider = element("time");
    slider.addEventListener("input", () => {
      this.isDragged = true;
      this.seek(this.begin_s + Number(slider.value));
    });
    slider.addEventListener("change", () => (this.isDragged = false));
    element("play").addEventListener("click", () => this.toggle());
    element("live").addEventListener("click", () => this.live());
    element("step-back").addEventListener("click", () => this.step(-1));
    element("step-forward").addEventListener("click", () => this.step(1));
    element("previous-event").addEventListener("click", () => this.toEvent(-1));
    element("next-event").addEventListener("click", () => this.toEvent(1));
    element("speed").addEventListener("change", () => this.mode === "playing" && this.play());
  }

  /** @param {any} message */
  update(message) {
    Object.assign(this, {mode: message.mode, begin_s: message.begin_s, end_s: message.end_s,
                         firstGrant_s: message.first_grant_s});
    const slider = element("time");
    slider.max = String(Math.max(message.end_s - message.begin_s, 0.1));
    element("play").textContent = this.mode === "paused" ? "play" : "||";
    element("live").setAttribute("aria-pressed", String(this.mode === "live"));
    this.progress = message.progress;
    this.show(this.shown_s);
    this.draw();
  }

  /** @param {number} at_s */
  show(at_s) {
    this.shown_s = at_s;
    if (!this.isDragged) element("time").value = String(at_s - this.begin_s);
    const parts = [timeOfDay(at_s)];
    if (this.isRecording && this.firstGrant_s !== null)
      parts.push(`${(at_s - this.firstGrant_s).toFixed(2)} s after the first grant`);
    if (!this.isConnected) parts.push("not connected");
    else if (this.mode !== "live") parts.push(`${this.mode}, ${(this.end_s - at_s).toFixed(2)} s before the end`);
    else parts.push(this.isRecording ? "the end" : "live");
    if (this.progress < 1) parts.push(`reading ${Math.round(100 * this.progress)} %`);
    element("clock").textContent = parts.join(" · ");
  }

  /** @param {number} at_s */
  seek(at_s) {
    this.send({op: "seek", at_s});
  }
  live() {
    this.send({op: "live"});
  }
  play() {
    this.send({op: "play", speed: Number(element("speed").value)});
  }
  toggle() {
    this.mode === "paused" ? this.play() : this.send({op: "pause"});
  }
  /** @param {number} frames */
  step(frames) {
    this.send({op: "step", frames});
  }

  /**
   * Goes to the next event after the moment shown, or to the previous one.
   * @param {number} direction
   */
  toEvent(direction) {
    const times = this.events.map((event) => event.at_s).sort((a, b) => a - b);
    const found = direction > 0 ? times.find((t) => t > this.shown_s + 0.03) : times.reverse().find((t) => t < this.shown_s - 0.03);
    if (found !== undefined) this.seek(found);
  }

  draw() {
    const canvas = element("marks");
    const width = Math.max(1, canvas.clientWidth);
    canvas.width = width;
    canvas.height = 14;
    const c = canvas.getContext("2d");
    const span = Math.max(this.end_s - this.begin_s, 0.1);
    for (const event of this.events) {
      const x = width * (event.at_s - this.begin_s) / span;
      if (x < 0) continue;
      c.fillStyle = kColours[event.severity] || kColours.info;
      const height = event.severity === "error" ? 14 : event.severity === "warning" ? 10 : 6;
      c.fillRect(x - 1, 14 - height, 2, height);
    }
  }
}
