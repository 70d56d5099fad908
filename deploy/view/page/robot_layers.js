// SPDX-License-Identifier: Apache-2.0
// Layers of robots and of their motions.
import {addVersion} from "./frame.js";
import {addCircle, addCross, eachRobot, placeOf, shared} from "./shapes.js";
import {palette} from "./theme.js";

/** @typedef {import("./shapes.js").View} View */

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
    if (addVersion(path, v, at + column, end)) addCircle(ghosts, end.x, end.y, view.mark_m);
  });
  c.strokeStyle = palette.green;
  c.lineWidth = 1.5 * view.pixel;
  c.setLineDash([3 * view.pixel, 3 * view.pixel]);
  c.stroke(ghosts);
  c.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawRobots(c, view) {
  const paths = {blue: new Path2D(), yellow: new Path2D(), off: new Path2D(), headings: new Path2D(),
                 denied: new Path2D(), sizes: new Path2D()};
  const r = view.mark_m;
  const flags = view.scene.layout.flags;
  eachRobot(view, (v, at, columns) => {
    const place = placeOf(v, at, columns);
    if (Number.isNaN(place.x)) return;
    const state = v[at + columns.flags];
    const isYellow = view.scene.teams.get(v[at]) === "yellow";
    addCircle(isYellow ? paths.yellow : paths.blue, place.x, place.y, r);
    // A mark that is much larger than its robot shows the true size, too.
    if (r > 1.3 * view.scene.radius_m) addCircle(paths.sizes, place.x, place.y, view.scene.radius_m);
    if (state & (flags.off_reference | flags.lifted)) addCircle(paths.off, place.x, place.y, 1.25 * r);
    if (!Number.isNaN(v[at + columns.denied])) addCircle(paths.denied, place.x, place.y, 1.12 * r);
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
  c.fillStyle = palette["team-blue"];
  c.fill(paths.blue);
  c.fillStyle = palette["team-yellow"];
  c.fill(paths.yellow);
  c.strokeStyle = palette.edge;
  c.lineWidth = view.pixel;
  c.stroke(paths.blue);
  c.stroke(paths.yellow);
  c.stroke(paths.sizes);
  c.lineWidth = 1.5 * view.pixel;
  c.stroke(paths.headings);
  c.lineWidth = 2 * view.pixel;
  c.strokeStyle = palette.orange;
  c.stroke(paths.denied);
  c.strokeStyle = palette.red;
  c.stroke(paths.off);
}

/**
 * A ring around the selected robot, with four ticks: no other mark has these. Light on dark ground, dark on light.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawSelection(c, view) {
  if (view.selected < 0) return;
  const path = new Path2D();
  const r = view.mark_m + 5 * view.pixel, tick = 6 * view.pixel;
  eachRobot(view, (v, at, columns) => {
    if (v[at] !== view.selected) return;
    const {x, y} = placeOf(v, at, columns);
    addCircle(path, x, y, r);
    for (const [dx, dy] of [[1, 0], [0, 1], [-1, 0], [0, -1]]) {
      path.moveTo(x + r * dx, y + r * dy);
      path.lineTo(x + (r + tick) * dx, y + (r + tick) * dy);
    }
  });
  c.strokeStyle = palette.ground;
  c.lineWidth = 5 * view.pixel;
  c.stroke(path);
  c.strokeStyle = palette.text;
  c.lineWidth = 2.5 * view.pixel;
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view @param {string[]} names @param {string} colour */
export function drawOutlines(c, view, names, colour) {
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => addCircle(path, v[at + columns[names[0]]], v[at + columns[names[1]]], view.mark_m));
  c.strokeStyle = colour;
  c.lineWidth = 1.2 * view.pixel;
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawGoals(c, view) {
  const goals = new Path2D(), lines = new Path2D();
  const size = 5 * view.pixel;
  eachRobot(view, (v, at, columns) => {
    const x = v[at + columns.goal_x], y = v[at + columns.goal_y];
    if (Number.isNaN(x)) return;
    addCross(goals, x, y, size);
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
  c.strokeStyle = palette.purple;
  c.lineWidth = 1.5 * view.pixel;
  c.stroke(goals);
  c.setLineDash([6 * view.pixel, 4 * view.pixel]);
  c.stroke(lines);
  c.setLineDash([]);
}

/**
 * Where robots intend to go: the next point, then the goal.
 * @param {CanvasRenderingContext2D} c @param {View} view @param {(robot: number) => boolean} isShown
 */
export function drawIntents(c, view, isShown = () => true) {
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => {
    const x = v[at + columns.via_x], y = v[at + columns.via_y];
    if (Number.isNaN(x) || !isShown(v[at])) return;
    const place = placeOf(v, at, columns);
    path.moveTo(place.x, place.y);
    path.lineTo(x, y);
    path.lineTo(v[at + columns.goal_x], v[at + columns.goal_y]);
  });
  c.strokeStyle = `${palette.purple}88`;
  c.lineWidth = view.pixel;
  c.stroke(path);
}

/**
 * An arrow from each robot whose motion was denied to the robot that it would have met, and a dashed one from each robot
 * that drives slowly by its course to the robot that it lets pass; red where the robots wait for each other in a cycle.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawConflicts(c, view) {
  /** @type {Map<number, {x: number, y: number}>} */
  const places = new Map();
  /** @type {Map<number, number>} */
  const waits = new Map();
  const planned = new Set();
  eachRobot(view, (v, at, columns) => {
    places.set(v[at], placeOf(v, at, columns));
    const isDenied = !Number.isNaN(v[at + columns.blocker]);
    const other = v[at + (isDenied ? columns.blocker : columns.waits_for)];
    if (Number.isNaN(other)) return;
    waits.set(v[at], other);
    if (!isDenied) planned.add(v[at]);
  });
  const lines = new Path2D(), dashed = new Path2D(), circles = new Path2D();
  for (const [robot, blocker] of waits) {
    const from = places.get(robot), to = places.get(blocker);
    if (!from || !to) continue;
    let next = blocker;
    for (let i = 0; i < waits.size && next !== robot; ++i) next = waits.get(next) ?? -1;
    const path = next === robot ? circles : planned.has(robot) ? dashed : lines;
    const angle = Math.atan2(to.y - from.y, to.x - from.x), head = 7 * view.pixel;
    path.moveTo(from.x, from.y);
    path.lineTo(to.x, to.y);
    // Dashes begin anew at each moveTo, so the two sides of the head, from its tip on, have no gap.
    for (const turn of [-0.4, 0.4]) {
      path.moveTo(to.x, to.y);
      path.lineTo(to.x - head * Math.cos(angle + turn), to.y - head * Math.sin(angle + turn));
    }
  }
  c.lineWidth = 2 * view.pixel;
  c.strokeStyle = palette.orange;
  c.stroke(lines);
  c.setLineDash([8 * view.pixel, 4 * view.pixel]);
  c.stroke(dashed);
  c.setLineDash([]);
  c.strokeStyle = palette.red;
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
  c.strokeStyle = `${palette.yellow}88`;
  c.lineWidth = 3 * view.pixel;
  c.stroke(path);
}
