// SPDX-License-Identifier: Apache-2.0
// The canvas with the floor: its view, clicks and drags, and the drawing of all layers.
import {element} from "./format.js";

export class Floor {
  /** @param {import("./shapes.js").Layer[]} layers */
  constructor(layers) {
    this.layers = layers;
    this.canvas = element("floor");
    this.context = this.canvas.getContext("2d");
    this.centre = {x: 0, y: 0};
    this.scale = 0;  // CSS pixels per metre; 0: not known yet
    this.ratio = 1;  // pixels of the screen per CSS pixel
    this.isFitted = true;
    this.isStale = true;  // the canvas must be drawn again
    /** @type {any} */
    this.scene = null;
    /** @type {any} */
    this.frame = null;
    this.selected = -1;
    /** @type {(robot: number) => void} */
    this.onSelect = () => {};
    /** @type {(robot: number, x: number, y: number) => void} */
    this.onDrag = () => {};
    this.drag = null;
    this.canvas.addEventListener("wheel", (/** @type {WheelEvent} */ e) => this.zoom(e), {passive: false});
    this.canvas.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => this.press(e));
    this.canvas.addEventListener("pointermove", (/** @type {PointerEvent} */ e) => this.move(e));
    this.canvas.addEventListener("pointerup", (/** @type {PointerEvent} */ e) => this.release(e));
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    this.ratio = ratio;
    this.isStale = true;
    if (this.isFitted) this.fit();
  }

  /** Shows the whole field. */
  fit() {
    if (!this.scene || this.canvas.clientWidth < 2) return;
    const {length_m, width_m} = this.scene.field;
    this.centre = {x: 0, y: 0};
    if (this.scene.map) {
      const {min, max} = this.scene.map;
      this.centre = {x: (min[0] + max[0]) / 2, y: (min[1] + max[1]) / 2};
    }
    this.scale = Math.min(this.canvas.clientWidth / (length_m + 1), this.canvas.clientHeight / (width_m + 1));
    this.isFitted = this.isStale = true;
  }

  /** @param {{offsetX: number, offsetY: number}} e */
  toMetres(e) {
    return {x: this.centre.x + (e.offsetX - this.canvas.clientWidth / 2) / this.scale,
            y: this.centre.y - (e.offsetY - this.canvas.clientHeight / 2) / this.scale};
  }

  /** @param {WheelEvent} e */
  zoom(e) {
    e.preventDefault();
    const before = this.toMetres(e);
    this.scale = Math.min(Math.max(this.scale * Math.exp(-e.deltaY * 0.0015), 0.5), 5000);
    const after = this.toMetres(e);
    this.centre.x += before.x - after.x;
    this.centre.y += before.y - after.y;
    this.isFitted = false;
    this.isStale = true;
  }

  /**
   * The robot at a place, or -1.
   * @param {{x: number, y: number}} p
   */
  robotAt(p) {
    if (!this.frame || !this.scene) return -1;
    const {values, rows, stride} = this.frame.sections.robots;
    const c = this.scene.layout.columns.robots;
    let best = Math.max(this.scene.radius_m, 8 / this.scale), found = -1;
    for (let i = 0; i < rows; ++i) {
      const place = placeOf(values, i * stride, c);
      const distance = Math.hypot(place.x - p.x, place.y - p.y);
      if (distance < best) [best, found] = [distance, values[i * stride]];
    }
    return found;
  }

  /** @param {PointerEvent} e */
  press(e) {
    this.canvas.setPointerCapture(e.pointerId);
    const at = this.toMetres(e);
    this.drag = {robot: this.robotAt(at), from: at, offsetX: e.offsetX, offsetY: e.offsetY, at, has_moved: false};
  }

  /** @param {PointerEvent} e */
  move(e) {
    if (!this.drag) return;
    if (Math.hypot(e.offsetX - this.drag.offsetX, e.offsetY - this.drag.offsetY) > 4) this.drag.has_moved = true;
    this.drag.at = this.toMetres(e);
    this.isStale = true;
    if (this.drag.robot >= 0 || !this.drag.has_moved) return;
    this.centre.x += this.drag.from.x - this.drag.at.x;
    this.centre.y += this.drag.from.y - this.drag.at.y;
    this.drag.at = this.drag.from;
    this.isFitted = false;
  }

  /** @param {PointerEvent} e */
  release(e) {
    const drag = this.drag;
    this.drag = null;
    this.isStale = true;
    if (!drag) return;
    if (!drag.has_moved) return this.onSelect(drag.robot);
    const at = this.toMetres(e);
    if (drag.robot >= 0) this.onDrag(drag.robot, at.x, at.y);
  }

  draw() {
    this.isStale = false;
    if (!this.frame || !this.scene || !this.scale) return;
    const c = this.context;
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const s = this.scale * this.ratio;
    c.setTransform(s, 0, 0, -s, this.canvas.width / 2 - this.centre.x * s, this.canvas.height / 2 + this.centre.y * s);
    const pixel = 1 / this.scale;
    for (const layer of this.layers)
      if (layer.on) layer.draw(c, {scene: this.scene, frame: this.frame, pixel, selected: this.selected, floor: this});
    if (this.drag && this.drag.robot >= 0 && this.drag.has_moved) {
      c.strokeStyle = "#cc79a7";
      c.lineWidth = 2 * pixel;
      c.beginPath();
      c.moveTo(this.drag.from.x, this.drag.from.y);
      c.lineTo(this.drag.at.x, this.drag.at.y);
      c.stroke();
    }
  }
}

/**
 * Where a robot is: by ground truth, else by vision, else by its own estimate.
 * @param {Float32Array} v @param {number} at @param {Record<string, number>} c
 */
export function placeOf(v, at, c) {
  for (const [x, y, heading] of [["true_x", "true_y", "true_heading"], ["seen_x", "seen_y", "seen_heading"],
                                 ["x", "y", "heading"]])
    if (!Number.isNaN(v[at + c[x]])) return {x: v[at + c[x]], y: v[at + c[y]], heading: v[at + c[heading]]};
  return {x: NaN, y: NaN, heading: NaN};
}
