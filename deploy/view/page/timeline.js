// SPDX-License-Identifier: Apache-2.0
// The moment that is shown: slider, event marks and buttons.
import {element, setText} from "./format.js";
import {isAtEnd, momentText} from "./moment.js";
import {palette} from "./theme.js";

/** @type {Record<string, string>} */
const kColours = {info: "grey", warning: "orange", error: "red"};
/** @type {Record<string, number>} */
const kHeights = {warning: 10, error: 14};

export class Timeline {
  /** @param {(message: object) => void} send */
  constructor(send) {
    this.send = send;
    /** @type {import("./moment.js").Moment} */
    this.moment = {mode: "live", speed: 1, shown_s: 0, begin_s: 0, end_s: 1, first_grant_s: null, progress: 1, isRecording: false,
                   isConnected: true};
    /** @type {any[]} */
    this.events = [];
    this.isDragged = false;
    const slider = element("time");
    slider.addEventListener("input", () => {
      this.isDragged = true;
      this.seek(this.moment.begin_s + Number(slider.value));
    });
    slider.addEventListener("change", () => (this.isDragged = false));
    element("play").addEventListener("click", () => this.toggle());
    element("live").addEventListener("click", () => this.live());
    element("step-back").addEventListener("click", () => this.step(-1));
    element("step-forward").addEventListener("click", () => this.step(1));
    element("previous-event").addEventListener("click", () => this.toEvent(-1));
    element("next-event").addEventListener("click", () => this.toEvent(1));
    element("speed").addEventListener("change", () => this.mode === "playing" && this.play());
    new ResizeObserver(() => this.draw()).observe(element("marks"));
  }

  get mode() {
    return this.moment.mode;
  }
  get shown_s() {
    return this.moment.shown_s;
  }

  /** @param {any} message */
  update(message) {
    const {mode, speed, begin_s, end_s, progress} = message;
    Object.assign(this.moment, {mode, speed, begin_s, end_s, progress, first_grant_s: message.first_grant_s ?? null});
    element("time").max = String(Math.max(end_s - begin_s, 0.1));
    this.refresh();
    this.draw();
  }

  /** @param {Partial<import("./moment.js").Moment>} changes */
  set(changes) {
    Object.assign(this.moment, changes);
    this.refresh();
  }

  /** @param {number} at_s */
  show(at_s) {
    this.set({shown_s: at_s});
  }

  refresh() {
    const {isRecording, shown_s, begin_s} = this.moment;
    if (!this.isDragged) element("time").value = String(shown_s - begin_s);
    setText(element("play"), this.isStanding() ? "Play" : "Pause");
    const live = element("live");
    setText(live, isRecording ? "End" : "Live");
    live.title = isRecording ? "The end of the recording (L)" : "The newest moment (L)";
    live.setAttribute("aria-pressed", String(this.mode === "live" && this.moment.isConnected));
    setText(element("clock"), momentText(this.moment));
  }

  /** Whether the moment shown stays until somebody changes it. */
  isStanding() {
    return this.mode === "paused" || this.mode === "live" && this.moment.isRecording && this.moment.progress >= 1;
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
    if (!this.isStanding()) return this.send({op: "pause"});
    const {isRecording, first_grant_s, begin_s} = this.moment;
    if (isRecording && isAtEnd(this.moment)) this.seek(first_grant_s ?? begin_s);  // plays it again
    this.play();
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
    const found = direction > 0 ? times.find((t) => t > this.shown_s + 0.03)
        : times.reverse().find((t) => t < this.shown_s - 0.03);
    if (found !== undefined) this.seek(found);
  }

  draw() {
    const canvas = element("marks");
    const width = Math.max(1, canvas.clientWidth);
    canvas.width = width;
    canvas.height = 14;
    const c = canvas.getContext("2d");
    const {begin_s, end_s} = this.moment;
    const span = Math.max(end_s - begin_s, 0.1);
    for (const event of this.events) {
      const x = width * (event.at_s - begin_s) / span;
      if (x < 0) continue;
      c.fillStyle = palette[kColours[event.severity] || "grey"];
      const height = kHeights[event.severity] || 6;
      c.fillRect(x - 1, 14 - height, 2, height);
    }
  }
}
