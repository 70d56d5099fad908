// SPDX-License-Identifier: Apache-2.0
// Fields by which the selected robot could plan: a navigation function, a band, a local grid. The monitor computes them.
import {palette} from "./theme.js";

const kPeriod_ms = 500;

/** The fields of one robot. */
export const fields = {robot: -1, data: /** @type {any} */ (null)};
/** @type {Map<any, HTMLCanvasElement>} */
let pictures = new Map();

/**
 * Requests the fields of a robot periodically, while they are shown.
 * @param {() => number} wanted the robot, or -1 @param {() => void} onChange
 */
export function watchFields(wanted, onChange) {
  setInterval(async () => {
    const robot = wanted();
    if (robot < 0) {
      if (fields.data) onChange();
      fields.data = null;
      return;
    }
    const response = await fetch(`/api/fields/${robot}`).catch(() => null);
    if (!response || !response.ok) return;
    fields.robot = robot;
    fields.data = await response.json();
    pictures = new Map();
    onChange();
  }, kPeriod_ms);
}

/**
 * A grid as a picture.
 * @param {any} grid @param {(value: number) => number[]} colour red, green, blue, opacity
 */
function pictureOf(grid, colour) {
  const known = pictures.get(grid);
  if (known) return known;
  const canvas = document.createElement("canvas");
  canvas.width = grid.columns;
  canvas.height = grid.rows;
  const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const image = c.createImageData(grid.columns, grid.rows);
  for (let row = 0; row < grid.rows; ++row)
    for (let column = 0; column < grid.columns; ++column)
      image.data.set(colour(grid.values[row * grid.columns + column]), 4 * ((grid.rows - 1 - row) * grid.columns + column));
  c.putImageData(image, 0, 0);
  pictures.set(grid, canvas);
  return canvas;
}

/** @param {CanvasRenderingContext2D} c @param {any} grid @param {(value: number) => number[]} colour */
function drawGrid(c, grid, colour) {
  const width = grid.columns * grid.cell_m, height = grid.rows * grid.cell_m;
  c.save();
  c.imageSmoothingEnabled = false;
  c.translate(grid.min[0], grid.min[1] + height);
  c.scale(1, -1);
  c.drawImage(pictureOf(grid, colour), 0, 0, width, height);
  c.restore();
}

/** @param {number} value 0: not reachable, 1 to 255: low to high cost */
const navigationColour = (value) => (value === 0 ? [0, 0, 0, 0] : [0, 60 + 0.6 * (255 - value), 178 - 0.4 * value, 120]);
const kLocalColours = [[0, 0, 0, 0], [0, 158, 115, 60], [213, 94, 0, 200]];

/** @param {CanvasRenderingContext2D} c @param {import("./shapes.js").View} view */
export function drawNavigation(c, view) {
  if (!fields.data || !fields.data.navigation) return;
  drawGrid(c, fields.data.navigation, navigationColour);
  c.strokeStyle = palette.text;
  c.lineWidth = 1.5 * view.pixel;
  c.beginPath();
  (fields.data.path || []).forEach((/** @type {number[]} */ p, /** @type {number} */ i) => (i === 0 ? c.moveTo(p[0], p[1]) : c.lineTo(p[0], p[1])));
  c.stroke();
}

/** @param {CanvasRenderingContext2D} c @param {import("./shapes.js").View} view */
export function drawBand(c, view) {
  if (!fields.data || !fields.data.band) return;
  c.strokeStyle = palette.yellow;
  c.lineWidth = view.pixel;
  c.beginPath();
  for (const [x, y, radius] of fields.data.band) {
    c.moveTo(x + radius, y);
    c.arc(x, y, radius, 0, 2 * Math.PI);
  }
  c.stroke();
}

/** @param {CanvasRenderingContext2D} c */
export function drawLocalGrid(c) {
  if (fields.data && fields.data.local) drawGrid(c, fields.data.local, (value) => kLocalColours[value]);
}
