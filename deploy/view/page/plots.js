// SPDX-License-Identifier: Apache-2.0
// The messages of one channel, and plots of their numbers over time.
import {create, number} from "./format.js";
import {palette} from "./theme.js";

const kColours = ["sky", "orange", "green", "purple", "yellow", "red"];
const kNoChannel = "Choose a channel to see its messages, and one of its numbers to plot it over time.";
const kNoMessage = "No message in the 30 s before this moment.";
const kNotKept = "The run is over, and its messages are not kept. Record a run (sidestep run --record FILE.mcap) to see its messages " +
    "later: sidestep monitor FILE.mcap.";
const kSpan_s = 30;
const kMaxPoints = 6000;

/** A whole number that JavaScript would round; the monitor sends its digits as text. */
const kLongNumber = /^-?\d{16,20}$/;

/**
 * The numbers of a message by their paths, e.g. "executing.x_m".
 * @param {any} value @param {string} path @param {Map<string, number>} found
 */
export function numbersOf(value, path, found) {
  if (typeof value === "number") found.set(path, value);
  else if (typeof value === "boolean") found.set(path, value ? 1 : 0);
  else if (typeof value === "string" && kLongNumber.test(value)) found.set(path, Number(value));
  else if (value && typeof value === "object")
    for (const [key, inner] of Object.entries(value)) numbersOf(inner, path ? `${path}.${key}` : key, found);
  return found;
}

/** A plot that keeps the minimum and the maximum of each column of pixels. */
export class Plot {
  constructor() {
    this.canvas = create("canvas", {class: "plot", role: "img", "aria-label": "Plot"});
    /** @type {Map<string, {t: number[], y: number[]}>} */
    this.series = new Map();
  }

  /** @param {string} name @param {number} t @param {number} y */
  add(name, t, y) {
    let series = this.series.get(name);
    if (!series) this.series.set(name, (series = {t: [], y: []}));
    series.t.push(t);
    series.y.push(y);
    if (series.t.length > kMaxPoints) {
      series.t.splice(0, 1000);
      series.y.splice(0, 1000);
    }
  }

  draw() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width) return;
    this.canvas.width = width;
    this.canvas.height = height;  // also clears it
    const c = this.canvas.getContext("2d");
    let end = -Infinity, low = Infinity, high = -Infinity;
    for (const {t} of this.series.values()) end = Math.max(end, t[t.length - 1] ?? -Infinity);
    for (const {t, y} of this.series.values())
      for (let i = 0; i < t.length; ++i)
        if (t[i] >= end - kSpan_s && Number.isFinite(y[i])) [low, high] = [Math.min(low, y[i]), Math.max(high, y[i])];
    if (!(high >= low)) {
      c.font = "12px system-ui, sans-serif";
      c.fillStyle = palette.dim;
      c.fillText("Nothing is plotted yet: choose a number.", 8, 20);
      return;
    }
    if (high === low) [low, high] = [low - 1, high + 1];
    c.font = "12px system-ui, sans-serif";
    c.fillStyle = palette.dim;
    c.fillText(number(high, 3), 2, 12);
    c.fillText(number(low, 3), 2, height - 3);
    let index = 0;
    for (const [name, {t, y}] of this.series) {
      const colour = palette[kColours[index % kColours.length]];
      const least = new Float64Array(width).fill(Infinity), greatest = new Float64Array(width).fill(-Infinity);
      for (let i = 0; i < t.length; ++i) {
        const x = Math.floor((width - 1) * (1 - (end - t[i]) / kSpan_s));
        if (x < 0 || !Number.isFinite(y[i])) continue;
        least[x] = Math.min(least[x], y[i]);
        greatest[x] = Math.max(greatest[x], y[i]);
      }
      const toY = (/** @type {number} */ value) => 4 + (height - 8) * (1 - (value - low) / (high - low));
      c.strokeStyle = c.fillStyle = colour;
      c.beginPath();
      for (let x = 0, begun = false; x < width; ++x) {
        if (least[x] > greatest[x]) continue;
        begun ? c.lineTo(x, toY(least[x])) : c.moveTo(x, toY(least[x]));
        c.lineTo(x, toY(greatest[x]) + 0.5);
        begun = true;
      }
      c.stroke();
      c.fillText(`${name}: ${number(y[y.length - 1], 4)}`, 80, 12 + 14 * index);
      ++index;
    }
  }
}

/** The panel that shows the messages of one channel. */
export class Inspector {
  /** @param {(message: object) => void} send */
  constructor(send) {
    this.send = send;
    this.channel = create("select", {id: "inspected", "aria-label": "Channel"});
    this.field = create("select", {id: "plotted", "aria-label": "Number to plot"});
    this.text = create("pre", {id: "inspected-message", tabindex: "0"});
    this.hint = create("p", {class: "hint"}, kNoChannel);
    this.plot = new Plot();
    this.received = 0;
    this.hasMessages = true;
    this.isInspecting = false;
    /** @type {Set<string>} */
    this.plotted = new Set();
    /** @type {Set<string>} */
    this.fields = new Set();
    const clear = create("button", {}, "Clear plot");
    this.node = create("div", {}, create("div", {class: "buttons"}, create("label", {}, "Channel ", this.channel),
                       create("label", {}, "Plot ", this.field), clear), this.plot.canvas, this.hint, this.text);
    this.channel.addEventListener("change", () => this.choose());
    this.field.addEventListener("change", () => {
      if (this.field.value) this.plotted.add(this.field.value);
      this.field.value = "";
    });
    clear.addEventListener("click", () => {
      this.plotted.clear();
      this.plot.series.clear();
      this.plot.draw();
    });
    new ResizeObserver(() => this.plot.draw()).observe(this.plot.canvas);
  }

  /** @param {string} text */
  showHint(text) {
    this.hint.textContent = text;
    this.hint.hidden = !text;
  }

  /** @param {string[]} channels @param {boolean} hasMessages whether the monitor has messages to show */
  setChannels(channels, hasMessages) {
    this.hasMessages = hasMessages;
    const chosen = this.channel.value;
    this.channel.replaceChildren(create("option", {value: ""}, "none"), ...channels.map((c) => create("option", {value: c}, c)));
    this.channel.value = chosen;
    this.choose();
  }

  choose() {
    this.fields.clear();
    this.field.replaceChildren(create("option", {value: ""}, "add a number"));
    this.text.textContent = "";
    this.showHint(!this.hasMessages ? kNotKept : this.channel.value ? kNoMessage : kNoChannel);
    const wanted = this.hasMessages ? this.channel.value || null : null;
    if (wanted || this.isInspecting) this.send({op: "inspect", channel: wanted});
    this.isInspecting = wanted !== null;
  }

  /** @param {{channel: string, is_new: boolean, messages: {at_s: number, message: any}[]}} batch */
  update(batch) {
    if (!this.hasMessages || batch.channel !== this.channel.value) return;
    if (batch.is_new) this.plot.series.clear();
    this.received += batch.messages.length;
    for (const {at_s, message} of batch.messages) {
      const numbers = numbersOf(message, "", new Map());
      for (const [path, value] of numbers) {
        if (!this.fields.has(path)) {
          this.fields.add(path);
          this.field.append(create("option", {value: path}, path));
        }
        if (this.plotted.has(path)) this.plot.add(`${batch.channel} ${path}`, at_s, value);
      }
    }
    const last = batch.messages[batch.messages.length - 1];
    this.text.textContent = last ? JSON.stringify(last.message, null, 1) : "";
    this.showHint(last ? "" : kNoMessage);
    this.plot.draw();
  }
}
