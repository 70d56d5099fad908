// SPDX-License-Identifier: Apache-2.0
// Drawing primitives shared by all layers.

/** @typedef {{scene: any, frame: any, pixel: number, selected: number, floor: any}} View */
/** @typedef {{id: string, name: string, key: string, on: boolean, draw: (c: CanvasRenderingContext2D, view: View) => void}} Layer */

// Colours of Okabe and Ito, which colour-blind people can tell apart.
export const kBlue = "#0072b2", kSky = "#56b4e9", kYellow = "#f0e442", kOrange = "#e69f00", kGreen = "#009e73",
             kRed = "#d55e00", kPurple = "#cc79a7", kGrey = "#8b96a1";

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
