// SPDX-License-Identifier: Apache-2.0
// Which part of the floor the canvas shows.

/** @typedef {{min: number[], max: number[]}} Box in metres */
/** @typedef {{x: number, y: number}} Point */

const kMinScale = 0.5, kMaxScale = 5000;  // CSS pixels per metre
// Around what is fitted: room for marks, numbers and goals at the edge.
const kMargin_px = 24;
// Robots close together, or a single one, are shown with this much of their surroundings.
const kMinExtent_m = 3;

export class Viewport {
  constructor() {
    this.centre = {x: 0, y: 0};
    this.scale = 0;  // 0: not known yet
    this.width = 0;
    this.height = 0;
  }

  /** @param {Box} box */
  fit({min, max}) {
    this.centre = {x: (min[0] + max[0]) / 2, y: (min[1] + max[1]) / 2};
    const free = (/** @type {number} */ size) => Math.max(size - 2 * kMargin_px, size / 2);
    this.scale = this.limited(Math.min(free(this.width) / Math.max(max[0] - min[0], 0.1),
                                       free(this.height) / Math.max(max[1] - min[1], 0.1)));
  }

  /** @param {number} scale */
  limited(scale) {
    return Math.min(Math.max(scale, kMinScale), kMaxScale);
  }

  /** @param {Point} pixels @returns {Point} */
  toMetres({x, y}) {
    return {x: this.centre.x + (x - this.width / 2) / this.scale, y: this.centre.y - (y - this.height / 2) / this.scale};
  }

  /** @param {Point} metres @returns {Point} */
  toPixels({x, y}) {
    return {x: this.width / 2 + (x - this.centre.x) * this.scale, y: this.height / 2 - (y - this.centre.y) * this.scale};
  }

  /**
   * Zooms so that the floor below a pixel stays there.
   * @param {Point} pixel @param {number} factor
   */
  zoom(pixel, factor) {
    const before = this.toMetres(pixel);
    this.scale = this.limited(this.scale * factor);
    this.move(before, this.toMetres(pixel));
  }

  /**
   * Moves the floor so that the place `from` gets to where the place `to` is shown now.
   * @param {Point} from @param {Point} to
   */
  move(from, to) {
    this.centre.x += from.x - to.x;
    this.centre.y += from.y - to.y;
  }
}

/**
 * The whole floor: the map if there is one, otherwise the field.
 * @param {any} scene @returns {Box}
 */
export function floorBox(scene) {
  if (scene.map) return scene.map;
  const {length_m, width_m} = scene.field;
  return {min: [-length_m / 2, -width_m / 2], max: [length_m / 2, width_m / 2]};
}

/**
 * A box around places with some surroundings; null if there are none.
 * @param {Point[]} places @returns {Box | null}
 */
export function boxAround(places) {
  const known = places.filter((p) => Number.isFinite(p.x) && Number.isFinite(p.y));
  if (known.length === 0) return null;
  const box = {min: [Infinity, Infinity], max: [-Infinity, -Infinity]};
  for (const {x, y} of known)
    [x, y].forEach((value, axis) => {
      box.min[axis] = Math.min(box.min[axis], value);
      box.max[axis] = Math.max(box.max[axis], value);
    });
  for (const axis of [0, 1]) {
    const extra = Math.max((kMinExtent_m - (box.max[axis] - box.min[axis])) / 2, 0.3);
    box.min[axis] -= extra;
    box.max[axis] += extra;
  }
  return box;
}
