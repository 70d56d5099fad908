// SPDX-License-Identifier: Apache-2.0
// The canvas with the floor: the drawing of all layers, and what pointers do on it.
import {element} from "./format.js";
import {markRadius, placeOf} from "./shapes.js";
import {palette} from "./theme.js";
import {boxAround, floorBox, Viewport} from "./viewport.js";

const kClick_px = 4;  // a pointer that moves less has clicked
const kReach_px = 4;  // beyond the mark of a robot, for fingers

export class Floor {
  /** @param {import("./shapes.js").Layer[]} layers */
  constructor(layers) {
    this.layers = layers;
    this.canvas = element("floor");
    this.context = this.canvas.getContext("2d");
    this.view = new Viewport();
    this.ratio = 1;  // pixels of the screen per CSS pixel
    /**
     * What is fitted again when the canvas changes its size.
     * @type {"floor" | "robots" | null}
     */
    this.fitted = "floor";
    this.isStale = true;  // the canvas must be drawn again
    /** @type {any} */
    this.scene = null;
    /** @type {any} */
    this.frame = null;
    this.selected = -1;
    this.canCommand = false;
    /** @type {(robot: number) => void} */
    this.onSelect = () => {};
    /** @type {(robot: number, x: number, y: number) => void} */
    this.onDrag = () => {};
    /** @type {any} */
    this.drag = null;
    /**
     * Pointers that are pressed, by id.
     * @type {Map<number, {x: number, y: number}>}
     */
    this.pointers = new Map();
    this.canvas.addEventListener("wheel", (/** @type {WheelEvent} */ e) => {
      e.preventDefault();
      this.zoom(Math.exp(-e.deltaY * 0.0015), {x: e.offsetX, y: e.offsetY});
    }, {passive: false});
    this.canvas.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => this.press(e));
    this.canvas.addEventListener("pointermove", (/** @type {PointerEvent} */ e) => this.move(e));
    this.canvas.addEventListener("pointerup", (/** @type {PointerEvent} */ e) => this.release(e));
    this.canvas.addEventListener("pointercancel", (/** @type {PointerEvent} */ e) => this.cancel(e));
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  resize() {
    this.ratio = window.devicePixelRatio || 1;
    this.view.width = this.canvas.clientWidth;
    this.view.height = this.canvas.clientHeight;
    this.canvas.width = Math.max(1, Math.round(this.view.width * this.ratio));
    this.canvas.height = Math.max(1, Math.round(this.view.height * this.ratio));
    this.isStale = true;
    if (this.fitted === "robots") this.fitRobots();
    else if (this.fitted) this.fitFloor();
  }

  /** Shows the whole floor. */
  fitFloor() {
    if (this.scene) this.fit("floor", floorBox(this.scene));
  }

  /** Shows all robots, as large as possible. */
  fitRobots() {
    const box = boxAround(this.places());
    if (box) this.fit("robots", box);
  }

  /** @param {"floor" | "robots"} what @param {import("./viewport.js").Box} box */
  fit(what, box) {
    if (this.view.width < 2) return;
    this.view.fit(box);
    this.fitted = what;
    this.isStale = true;
  }

  /** @param {number} factor @param {{x: number, y: number}} [at] */
  zoom(factor, at) {
    if (!this.view.scale) return;
    this.view.zoom(at || {x: this.view.width / 2, y: this.view.height / 2}, factor);
    this.fitted = null;
    this.isStale = true;
  }

  /** Where all robots are. */
  places() {
    if (!this.frame || !this.scene) return [];
    const {values, rows, stride} = this.frame.sections.robots;
    const columns = this.scene.layout.columns.robots;
    return Array.from({length: rows}, (_, i) => ({id: values[i * stride], ...placeOf(values, i * stride, columns)}));
  }

  /** Whether a robot is outside of what is shown. */
  hasOutsiders() {
    return this.places().some((place) => {
      const {x, y} = this.toPixels(place);
      return x < 0 || y < 0 || x > this.view.width || y > this.view.height;
    });
  }

  /** @param {{x: number, y: number}} metres */
  toPixels(metres) {
    return this.view.toPixels(metres);
  }

  /**
   * The robot at a place, or -1.
   * @param {{x: number, y: number}} p
   */
  robotAt(p) {
    if (!this.scene) return -1;
    let best = markRadius(this.scene.radius_m, 1 / this.view.scale) + kReach_px / this.view.scale, found = -1;
    for (const place of this.places()) {
      const distance = Math.hypot(place.x - p.x, place.y - p.y);
      if (distance < best) [best, found] = [distance, place.id];
    }
    return found;
  }

  /** @param {PointerEvent} e */
  press(e) {
    this.canvas.setPointerCapture(e.pointerId);
    this.pointers.set(e.pointerId, {x: e.offsetX, y: e.offsetY});
    if (!this.view.scale) return;
    const at = this.view.toMetres({x: e.offsetX, y: e.offsetY});
    const robot = this.robotAt(at);
    // A second finger zooms: the first one then gives no order.
    this.drag = this.pointers.size > 1 ? null
        : {robot, isOrder: robot >= 0 && this.canCommand, from: at, x: e.offsetX, y: e.offsetY, at, has_moved: false};
  }

  /** @param {PointerEvent} e */
  move(e) {
    const before = this.pointers.get(e.pointerId);
    if (!before || !this.view.scale) return;
    const now = {x: e.offsetX, y: e.offsetY};
    if (this.pointers.size === 2) this.pinch(e.pointerId, before, now);
    this.pointers.set(e.pointerId, now);
    const drag = this.drag;
    if (!drag) return;
    if (Math.hypot(now.x - drag.x, now.y - drag.y) > kClick_px) drag.has_moved = true;
    drag.at = this.view.toMetres(now);
    this.isStale = true;
    if (drag.isOrder || !drag.has_moved) return;
    this.view.move(drag.from, drag.at);
    drag.at = drag.from;
    this.fitted = null;
  }

  /**
   * Two fingers zoom and move.
   * @param {number} id @param {{x: number, y: number}} before @param {{x: number, y: number}} now
   */
  pinch(id, before, now) {
    const other = [...this.pointers].filter(([known]) => known !== id)[0][1];
    const distance = (/** @type {{x: number, y: number}} */ p) => Math.max(Math.hypot(p.x - other.x, p.y - other.y), 1);
    const factor = distance(now) / distance(before);
    this.zoom(factor, {x: (now.x + other.x) / 2, y: (now.y + other.y) / 2});
    // The point between both fingers moves by half as much as the finger.
    this.view.move(this.view.toMetres({x: before.x / 2, y: before.y / 2}), this.view.toMetres({x: now.x / 2, y: now.y / 2}));
  }

  /** @param {PointerEvent} e */
  release(e) {
    const drag = this.drag;
    this.cancel(e);
    if (!drag) return;
    if (!drag.has_moved) return this.onSelect(drag.robot);
    const at = this.view.toMetres({x: e.offsetX, y: e.offsetY});
    if (drag.isOrder) this.onDrag(drag.robot, at.x, at.y);
  }

  /** @param {PointerEvent} e */
  cancel(e) {
    this.pointers.delete(e.pointerId);
    this.drag = null;
    this.isStale = true;
  }

  draw() {
    this.isStale = false;
    if (!this.frame || !this.scene || !this.view.scale) return;
    const c = this.context;
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const s = this.view.scale * this.ratio, {x, y} = this.view.centre;
    c.setTransform(s, 0, 0, -s, this.canvas.width / 2 - x * s, this.canvas.height / 2 + y * s);
    const pixel = 1 / this.view.scale;
    const view = {scene: this.scene, frame: this.frame, pixel, mark_m: markRadius(this.scene.radius_m, pixel),
                  selected: this.selected, floor: this};
    for (const layer of this.layers)
      if (layer.on) layer.draw(c, view);
    if (this.drag && this.drag.isOrder && this.drag.has_moved) this.drawOrder(c, pixel);
  }

  /**
   * The order that a drag will give.
   * @param {CanvasRenderingContext2D} c @param {number} pixel
   */
  drawOrder(c, pixel) {
    c.strokeStyle = palette.purple;
    c.lineWidth = 2 * pixel;
    c.beginPath();
    c.moveTo(this.drag.from.x, this.drag.from.y);
    c.lineTo(this.drag.at.x, this.drag.at.y);
    c.stroke();
  }
}
