// SPDX-License-Identifier: Apache-2.0
// Drawing primitives shared by all layers.

/** @typedef {{scene: any, frame: any, pixel: number, mark_m: number, selected: number, floor: any}} View */
/** @typedef {(c: CanvasRenderingContext2D, view: View) => void} Draw */
/** @typedef {{id: string, name: string, key: string, on: boolean, draw: Draw}} Layer */

// A robot is drawn at least this large, so that it can be seen and hit on large floors.
const kMinMark_px = 6;

/**
 * The radius of the discs that stand for robots.
 * @param {number} radius_m of a robot @param {number} pixel metres per CSS pixel
 */
export const markRadius = (radius_m, pixel) => Math.max(radius_m, kMinMark_px * pixel);

/** Data that arrive with panels, not with frames. */
export const shared = {zones: /** @type {any[]} */ ([]), goals: /** @type {Map<number, number[][]>} */ (new Map())};

/**
 * Calls `use` with the index of each robot's row.
 * @param {View} view @param {(v: Float32Array, at: number, c: any) => void} use
 */
export function eachRobot(view, use) {
  const {values, rows, stride} = view.frame.sections.robots;
  const c = view.scene.layout.columns.robots;
  for (let i = 0; i < rows; ++i) use(values, i * stride, c);
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

/** @param {Path2D} path @param {number} x @param {number} y @param {number} r */
export function addCircle(path, x, y, r) {
  if (Number.isNaN(x)) return;
  path.moveTo(x + r, y);
  path.arc(x, y, r, 0, 2 * Math.PI);
}

/** @param {Path2D} path @param {number[][]} corners */
export function addPolygon(path, corners) {
  corners.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
}

/**
 * A cross of two lines.
 * @param {Path2D} path @param {number} x @param {number} y @param {number} size
 */
export function addCross(path, x, y, size) {
  path.moveTo(x - size, y - size);
  path.lineTo(x + size, y + size);
  path.moveTo(x - size, y + size);
  path.lineTo(x + size, y - size);
}
