// SPDX-License-Identifier: Apache-2.0
// Layers of robots and of their motions.
import {placeOf} from "./floor.js";
import {addVersion} from "./frame.js";
import {addCircle, eachRobot, kGreen, kOrange, kPurple, kRed, kSky, kYellow, shared} from "./shapes.js";

/** @typedef {import("./shapes.js").View} View */

const kMaxLabels = 120;
const kTrail_s = 5;

const kSpanEnd = {x: 0, y: 0};

/**
 * The floor that a version covers.
 * @param {CanvasRenderingContext2D} c @param {View} view @param {string} kind @param {string} colour
 */
export function drawCovered(c, view, kind, colour) {
  const path = new Path2D();
  /** @type {[Path2D, number][]} */
  const inflated = [];
  const column = view.scene.layout.columns.robots[`${kind}_start`];
  const width_m = 2 * (view.scene.radius_m + view.scene.margin_m / 2);
  eachRobot(view, (v, at) => {
    const inflation_m = v[at + column + 5];
    if (!(inflation_m > 0)) return void addVersion(path, v, at + column, kSpanEnd);
    const own = new Path2D();
    addVersion(own, v, at + column, kSpanEnd);
    inflated.push([own, inflation_m]);
  });
  c.strokeStyle = colour;
  c.lineCap = c.lineJoin = "round";
  c.lineWidth = width_m;
  c.stroke(path);
  for (const [own, inflation_m] of inflated) {
    c.lineWidth = width_m + 2 * inflation_m;
    c.stroke(own);
  }
}

/**
 * The path of a version.
 * @param {CanvasRenderingContext2D} c @param {View} view @param {string} kind @param {string} colour @param {number[]} dash
 */
export function drawPath(c, view, kind, colour, dash) {
  const path = new Path2D();
  const column = view.scene.layout.columns.robots[`${kind}_start`];
  eachRobot(view, (v, at) => void addVersion(path, v, at + column, kSpanEnd));
  c.strokeStyle = colour;
  c.lineWidth = 1.5 * view.pixel;
  c.setLineDash(dash.map((/** @type {number} */ d) => d * view.pixel));
  c.stroke(path);
  c.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawBraked(c, view) {
  const path = new Path2D(), ghosts = new Path2D();
  const column = view.scene.layout.columns.robots.executing_start;
  const end = {x: 0, y: 0};
  eachRobot(view, (v, at) => {
    if (addVersion(path, v, at + column, end)) addCircle(ghosts, end.x, end.y, view.scene.radius_m);
  });
  c.strokeStyle = kGreen;
  c.lineWidth = 1.5 * view.pixel;
  c.setLineDash([3 * view.pixel, 3 * view.pixel]);
  c.stroke(ghosts);
  c.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawRobots(c, view) {
  const paths = {blue: new Path2D(), yellow: new Path2D(), off: new Path2D(), headings: new Path2D(),
                 denied: new Path2D(), selected: new Path2D()};
  const r = view.scene.radius_m;
  const flags = view.scene.layout.flags;
  eachRobot(view, (v, at, columns) => {
    const place = placeOf(v, at, columns);
    if (Number.isNaN(place.x)) return;
    const id = v[at], state = v[at + columns.flags];
    const isYellow = view.scene.teams.get(id) === "yellow";
    addCircle(isYellow ? paths.yellow : paths.blue, place.x, place.y, r);
    if (state & (flags.off_reference | flags.lifted)) addCircle(paths.off, place.x, place.y, 1.25 * r);
    if (!Number.isNaN(v[at + columns.denied])) addCircle(paths.denied, place.x, place.y, 1.12 * r);
    if (id === view.selected) addCircle(paths.selected, place.x, place.y, 1.5 * r);
    // The front of blue robots is a line, that of yellow ones an arrow, so that teams also differ in shape.
    const dx = Math.cos(place.heading) * r, dy = Math.sin(place.heading) * r;
    if (isYellow) {
      paths.headings.moveTo(place.x - 0.5 * dx - 0.6 * dy, place.y - 0.5 * dy + 0.6 * dx);
      paths.headings.lineTo(place.x + dx, place.y + dy);
      paths.headings.lineTo(place.x - 0.5 * dx + 0.6 * dy, place.y - 0.5 * dy - 0.6 * dx);
    } else {
      paths.headings.moveTo(place.x, place.y);
      paths.headings.lineTo(place.x + dx, place.y + dy);
    }
  });
  c.fillStyle = kSky;
  c.fill(paths.blue);
  c.fillStyle = kYellow;
  c.fill(paths.yellow);
  c.lineWidth = 1.5 * view.pixel;
  c.strokeStyle = "#10151a";
  c.stroke(paths.headings);
  c.lineWidth = 2 * view.pixel;
  c.strokeStyle = kOrange;
  c.stroke(paths.denied);
  c.strokeStyle = kRed;
  c.stroke(paths.off);
  c.strokeStyle = "#ffffff";
  c.stroke(paths.selected);
}

/** @param {CanvasRenderingContext2D} c @param {View} view @param {string[]} names @param {string} colour */
export function drawOutlines(c, view, names, colour) {
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => addCircle(path, v[at + columns[names[0]]], v[at + columns[names[1]]], view.scene.radius_m));
  c.strokeStyle = colour;
  c.lineWidth = 1.2 * view.pixel;
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawLabels(c, view) {
  if (view.frame.sections.robots.rows > kMaxLabels && view.scene.radius_m < 12 * view.pixel) return;
  c.save();
  c.fillStyle = "#10151a";
  c.textAlign = "center";
  c.textBaseline = "middle";
  const size = Math.max(view.scene.radius_m, 5 * view.pixel);
  c.font = "10px sans-serif";
  const {a, d, e, f} = c.getTransform();
  const s = a * size / 9;
  eachRobot(view, (v, at, columns) => {
    const place = placeOf(v, at, columns);
    if (Number.isNaN(place.x)) return;
    c.setTransform(s, 0, 0, s, e + a * place.x, f + d * place.y);
    c.fillText(String(v[at]), 0, 0);
  });
  c.restore();
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawGoals(c, view) {
  const goals = new Path2D(), lines = new Path2D();
  const size = 5 * view.pixel;
  eachRobot(view, (v, at, columns) => {
    const x = v[at + columns.goal_x], y = v[at + columns.goal_y];
    if (Number.isNaN(x)) return;
    goals.moveTo(x - size, y - size);
    goals.lineTo(x + size, y + size);
    goals.moveTo(x - size, y + size);
    goals.lineTo(x + size, y - size);
    const place = placeOf(v, at, columns);
    const nearestX = v[at + columns.nearest_x], nearestY = v[at + columns.nearest_y];
    if (!Number.isNaN(nearestX)) {
      // The robot cannot reach its goal now, so it drives here instead.
      lines.moveTo(place.x, place.y);
      lines.lineTo(nearestX, nearestY);
    }
    if (v[at] !== view.selected) return;
    lines.moveTo(place.x, place.y);
    for (const [gx, gy] of shared.goals.get(v[at]) || [[x, y]]) lines.lineTo(gx, gy);
  });
  c.strokeStyle = kPurple;
  c.lineWidth = 1.5 * view.pixel;
  c.stroke(goals);
  c.setLineDash([6 * view.pixel, 4 * view.pixel]);
  c.stroke(lines);
  c.setLineDash([]);
}

/**
 * Where robots intend to go: the next point, then the goal.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawIntents(c, view) {
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => {
    const x = v[at + columns.via_x], y = v[at + columns.via_y];
    if (Number.isNaN(x)) return;
    const place = placeOf(v, at, columns);
    path.moveTo(place.x, place.y);
    path.lineTo(x, y);
    path.lineTo(v[at + columns.goal_x], v[at + columns.goal_y]);
  });
  c.strokeStyle = "#cc79a766";
  c.lineWidth = view.pixel;
  c.stroke(path);
}

/**
 * A line from each robot whose motion was denied to the robot that it would have met; red where the robots wait for
 * each other in a cycle.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawConflicts(c, view) {
  /** @type {Map<number, {x: number, y: number}>} */
  const places = new Map();
  /** @type {Map<number, number>} */
  const waits = new Map();
  eachRobot(view, (v, at, columns) => {
    places.set(v[at], placeOf(v, at, columns));
    if (!Number.isNaN(v[at + columns.blocker])) waits.set(v[at], v[at + columns.blocker]);
  });
  const lines = new Path2D(), circles = new Path2D();
  for (const [robot, blocker] of waits) {
    const from = places.get(robot), to = places.get(blocker);
    if (!from || !to) continue;
    let next = blocker;
    for (let i = 0; i < waits.size && next !== robot; ++i) next = waits.get(next) ?? -1;
    const path = next === robot ? circles : lines;
    const angle = Math.atan2(to.y - from.y, to.x - from.x), head = 7 * view.pixel;
    path.moveTo(from.x, from.y);
    path.lineTo(to.x, to.y);
    path.moveTo(to.x - head * Math.cos(angle - 0.4), to.y - head * Math.sin(angle - 0.4));
    path.lineTo(to.x, to.y);
    path.lineTo(to.x - head * Math.cos(angle + 0.4), to.y - head * Math.sin(angle + 0.4));
  }
  c.lineWidth = 2 * view.pixel;
  c.strokeStyle = kOrange;
  c.stroke(lines);
  c.strokeStyle = kRed;
  c.stroke(circles);
}

/**
 * All versions in the coordinator's ledger.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawLedger(c, view) {
  const {values, rows, stride} = view.frame.sections.ledger;
  const path = new Path2D();
  const column = view.scene.layout.columns.ledger.version_start;
  for (let i = 0; i < rows; ++i) addVersion(path, values, i * stride + column, kSpanEnd);
  c.strokeStyle = "#f0e44288";
  c.lineWidth = 3 * view.pixel;
  c.stroke(path);
}

/**
 * Positions in the last seconds, by robot.
 * @type {Map<number, {time: number, x: number, y: number}[]>}
 */
const trails = new Map();
let trailTime = 0;

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawTrails(c, view) {
  const time = view.frame.time;
  if (time < trailTime || time > trailTime + 1) trails.clear();
  const isNew = time > trailTime + 0.05 || trails.size === 0;
  if (isNew) trailTime = time;
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => {
    const place = placeOf(v, at, columns);
    if (Number.isNaN(place.x)) return;
    let trail = trails.get(v[at]);
    if (!trail) trails.set(v[at], (trail = []));
    if (isNew) trail.push({time, x: place.x, y: place.y});
    while (trail.length > 0 && trail[0].time < time - kTrail_s) trail.shift();
    trail.forEach((p, i) => (i === 0 ? path.moveTo(p.x, p.y) : path.lineTo(p.x, p.y)));
    path.lineTo(place.x, place.y);
  });
  c.strokeStyle = "#56b4e966";
  c.lineWidth = 1.5 * view.pixel;
  c.stroke(path);
}
