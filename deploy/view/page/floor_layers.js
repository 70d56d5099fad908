// SPDX-License-Identifier: Apache-2.0
// All layers except those of robots.
import {addCircle, addPolygon, shared} from "./shapes.js";
import {palette} from "./theme.js";

/** @typedef {import("./shapes.js").View} View */

let mapLoaded = () => {};
/**
 * Calls back when the map can be drawn.
 * @param {() => void} callback
 */
export function onMapLoaded(callback) {
  mapLoaded = callback;
}

// Blocked cells of the map, legible in both themes.
const kMapColour = [118, 130, 141, 255];
/** @type {Map<any, HTMLCanvasElement>} */
const maps = new Map();

/**
 * The cells of the map as a picture.
 * @param {any} map
 */
function pictureOf(map) {
  const known = maps.get(map);
  if (known) return known;
  const canvas = document.createElement("canvas");
  canvas.width = map.columns;
  canvas.height = map.rows;
  maps.set(map, canvas);
  fetch("/api/map").then((response) => response.arrayBuffer()).then((buffer) => {
    const bits = new Uint8Array(buffer);
    const stride = Math.ceil(map.columns / 8);
    const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    const image = c.createImageData(map.columns, map.rows);
    for (let row = 0; row < map.rows; ++row)
      for (let column = 0; column < map.columns; ++column)
        if (bits[row * stride + (column >> 3)] & (1 << (column & 7)))
          image.data.set(kMapColour, 4 * ((map.rows - 1 - row) * map.columns + column));
    c.putImageData(image, 0, 0);
    mapLoaded();
  });
  return canvas;
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawField(c, view) {
  const {length_m, width_m} = view.scene.field;
  c.strokeStyle = palette.grey;
  c.lineWidth = 2 * view.pixel;
  c.strokeRect(-length_m / 2, -width_m / 2, length_m, width_m);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawObstacles(c, view) {
  if (view.scene.map) {
    const {min, max} = view.scene.map;
    c.save();
    c.imageSmoothingEnabled = false;
    c.translate(min[0], max[1]);
    c.scale(1, -1);
    c.drawImage(pictureOf(view.scene.map), 0, 0, max[0] - min[0], max[1] - min[1]);
    c.restore();
  }
  const path = new Path2D();
  for (const shape of view.scene.obstacles) {
    if (shape.centre) addCircle(path, shape.centre[0], shape.centre[1], shape.radius_m);
    else addPolygon(path, shape.corners);
  }
  c.fillStyle = c.strokeStyle = palette.grey;
  c.lineWidth = 2 * view.pixel;
  c.fill(path);
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawZones(c, view) {
  for (const zone of shared.zones) {
    const path = new Path2D();
    addPolygon(path, zone.corners);
    const isSlow = zone.speed_limit_mps !== undefined;
    c.fillStyle = c.strokeStyle = isSlow ? `${palette.orange}33` : `${palette.red}44`;
    c.lineJoin = "round";
    c.lineWidth = 2 * Math.max(zone.radius_m, view.pixel);
    c.fill(path);
    c.stroke(path);
  }
}

/**
 * Opponents and people, and how far each may have moved since it was seen.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawMovingObstacles(c, view) {
  const {values: v, rows, stride} = view.frame.sections.obstacles;
  const columns = view.scene.layout.columns.obstacles;
  const bodies = new Path2D(), reach = new Path2D();
  for (let i = 0; i < rows; ++i) {
    const at = i * stride, r = v[at + columns.radius], age = Math.max(v[at + columns.age], 0);
    const x = v[at + columns.x], y = v[at + columns.y];
    addCircle(bodies, x, y, r);
    addCircle(reach, x, y, r + age * view.scene.opponent_speed_mps);
    bodies.moveTo(x, y);
    bodies.lineTo(x + v[at + columns.vx], y + v[at + columns.vy]);
  }
  c.fillStyle = `${palette.red}55`;
  c.fill(bodies);
  c.strokeStyle = palette.red;
  c.lineWidth = view.pixel;
  c.stroke(bodies);
  c.setLineDash([4 * view.pixel, 4 * view.pixel]);
  c.stroke(reach);
  c.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawBall(c, view) {
  const {values: v, rows, stride} = view.frame.sections.balls;
  const path = new Path2D();
  for (let i = 0; i < rows; ++i) addCircle(path, v[i * stride], v[i * stride + 1], Math.max(0.022, 3 * view.pixel));
  c.fillStyle = "#ff8c1a";  // as balls of the league are, in both themes
  c.fill(path);
  c.strokeStyle = palette.edge;
  c.lineWidth = view.pixel;
  c.stroke(path);
}

/**
 * What cameras detect, before vision combines it.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawDetections(c, view) {
  const {values: v, rows, stride} = view.frame.sections.detections;
  const columns = view.scene.layout.columns.detections;
  const path = new Path2D();
  const size = 4 * view.pixel;
  for (let i = 0; i < rows; ++i) {
    const x = v[i * stride + columns.x], y = v[i * stride + columns.y];
    path.moveTo(x - size, y);
    path.lineTo(x + size, y);
    path.moveTo(x, y - size);
    path.lineTo(x, y + size);
  }
  c.strokeStyle = palette.text;
  c.lineWidth = view.pixel;
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawScans(c, view) {
  const {values: v, rows, stride} = view.frame.sections.beams;
  const path = new Path2D();
  const size = 1.5 * view.pixel;
  for (let i = 0; i < rows; ++i) path.rect(v[i * stride + 1] - size, v[i * stride + 2] - size, 2 * size, 2 * size);
  c.fillStyle = palette.green;
  c.fill(path);
}

/**
 * The longest of 1, 2, 5, 10, … metres (or parts of a metre) that takes at most so much of the screen.
 * @param {number} pixel metres per pixel @param {number} most_px
 */
export function scaleLength_m(pixel, most_px) {
  const most_m = most_px * pixel;
  const power = 10 ** Math.floor(Math.log10(most_m));
  return power * (most_m >= 5 * power ? 5 : most_m >= 2 * power ? 2 : 1);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawScale(c, view) {
  const {ratio, canvas} = view.floor;
  const length_m = scaleLength_m(view.pixel, 140);
  const width = length_m / view.pixel, x = canvas.clientWidth - 14 - width, y = canvas.clientHeight - 14;
  c.save();
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.strokeStyle = c.fillStyle = palette.dim;
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x, y - 5);
  c.lineTo(x, y);
  c.lineTo(x + width, y);
  c.lineTo(x + width, y - 5);
  c.stroke();
  c.font = "12px system-ui, sans-serif";
  c.textAlign = "right";
  c.textBaseline = "bottom";
  c.fillText(length_m < 1 ? `${Math.round(length_m * 1000)} mm` : `${length_m} m`, x + width - 4, y - 2);
  c.restore();
}
