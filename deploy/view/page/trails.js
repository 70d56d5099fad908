// SPDX-License-Identifier: Apache-2.0
// Where robots were in the last seconds before the moment shown. Positions are kept when the moment changes, and fetched
// for moments that were not shown yet.
import {eachRobot, placeOf} from "./shapes.js";
import {palette} from "./theme.js";

/** @typedef {import("./shapes.js").View} View */
/** @typedef {{time: number, x: number, y: number}} Point */

export const kTrail_s = 5;
const kStep_s = 0.05;
// A longer pause between two positions is not bridged by a line.
const kMaxGap_s = 0.6;
const kMaxPoints = 400000;  // of all robots

/**
 * The first index whose time is not before `time`.
 * @param {Point[]} points @param {number} time
 */
function indexAt(points, time) {
  let low = 0, high = points.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (points[middle].time < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Positions of robots, sorted by time, whatever the order in which they are added. */
export class TrailStore {
  constructor() {
    /** @type {Map<number, Point[]>} */
    this.robots = new Map();
  }

  /** @param {number} id @param {Point} point */
  add(id, point) {
    let points = this.robots.get(id);
    if (!points) this.robots.set(id, (points = []));
    const at = indexAt(points, point.time);
    const isNear = (/** @type {Point | undefined} */ other) => other && Math.abs(other.time - point.time) < kStep_s;
    if (isNear(points[at]) || isNear(points[at - 1])) return;
    points.splice(at, 0, point);
    // Forgets what is farther from the new position in time.
    if (points.length <= kMaxPoints / this.robots.size) return;
    at > points.length / 2 ? points.shift() : points.pop();
  }

  /** @param {{robots: {id: number, points: number[][]}[]}} answer to GET /api/trails */
  addAll(answer) {
    for (const {id, points} of answer.robots)
      for (const [time, x, y] of points) this.add(id, {time, x, y});
  }

  /** @param {number} id @param {number} time */
  before(id, time) {
    const points = this.robots.get(id) || [];
    return points.slice(indexAt(points, time - kTrail_s), indexAt(points, time));
  }
}

export const trails = new TrailStore();
let lastTime = -Infinity;

/**
 * Called when a moment is shown whose past is unknown. Replaced by main.js.
 * @type {(time: number) => void}
 */
let needTrails = () => {};
/** @param {(time: number) => void} callback */
export function onTrailsNeeded(callback) {
  needTrails = callback;
}

/**
 * Whether the moment shown does not continue the one before.
 * @param {number} last @param {number} time
 */
export const isJump = (last, time) => time < last - kMaxGap_s || time > last + kMaxGap_s;

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawTrails(c, view) {
  const time = view.frame.time;
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => {
    const place = placeOf(v, at, columns);
    if (Number.isNaN(place.x)) return;
    const trail = trails.before(v[at], time);
    trail.push({time, x: place.x, y: place.y});
    trail.forEach((p, i) => {
      if (i === 0 || p.time - trail[i - 1].time > kMaxGap_s) path.moveTo(p.x, p.y);
      else path.lineTo(p.x, p.y);
    });
    trails.add(v[at], {time, x: place.x, y: place.y});
  });
  if (isJump(lastTime, time)) needTrails(time);
  lastTime = time;
  c.strokeStyle = `${palette.sky}88`;
  c.lineWidth = 1.5 * view.pixel;
  c.stroke(path);
}
