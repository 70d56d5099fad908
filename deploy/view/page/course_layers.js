// SPDX-License-Identifier: Apache-2.0
// Where robots will be: their courses, or the intents of those that have none.
import {drawIntents} from "./robot_layers.js";
import {addCircle} from "./shapes.js";
import {palette} from "./theme.js";

/** @typedef {import("./shapes.js").View} View */

// The opacity is multiplied by this for each second ahead.
const kFading = 0.8, kLeastOpacity = 0.3;

/**
 * A colour of the palette for what happens in so many seconds.
 * @param {string} colour @param {number} second
 */
export function fadedColour(colour, second) {
  return colour + Math.round(255 * Math.max(kFading ** second, kLeastOpacity)).toString(16);
}

/**
 * The course of each robot, in the colour of its team. It fades with time, and has a mark for each second. Robots without
 * a course have their intent.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
export function drawCourses(c, view) {
  const {values: v, rows, stride} = view.frame.sections.courses;
  const columns = view.scene.layout.columns.courses;
  /** @type {Map<string, {lines: Path2D, marks: Path2D}>} */
  const shades = new Map();
  const robots = new Set();
  for (let i = 0; i < rows; ++i) {
    const to = i * stride, from = to - stride, robot = v[to + columns.robot];
    if (!robots.has(robot)) {
      robots.add(robot);
      continue;
    }
    const begin = v[from + columns.ahead], end = v[to + columns.ahead];
    // The colours of teams are for discs with an edge; these are the same in the dark theme, and legible in the light one.
    const colour = fadedColour(view.scene.teams.get(robot) === "yellow" ? palette.yellow : palette.sky, Math.floor(begin));
    const shade = shades.get(colour) ?? {lines: new Path2D(), marks: new Path2D()};
    shades.set(colour, shade);
    // The cubic that has these positions and velocities.
    const third = (end - begin) / 3;
    const x0 = v[from + columns.x], y0 = v[from + columns.y], x = v[to + columns.x], y = v[to + columns.y];
    shade.lines.moveTo(x0, y0);
    shade.lines.bezierCurveTo(x0 + third * v[from + columns.vx], y0 + third * v[from + columns.vy],
                              x - third * v[to + columns.vx], y - third * v[to + columns.vy], x, y);
    if (Number.isInteger(end)) addCircle(shade.marks, x, y, 3 * view.pixel);
  }
  c.lineCap = "butt";
  c.lineWidth = 2 * view.pixel;
  for (const [colour, {lines, marks}] of shades) {
    c.strokeStyle = c.fillStyle = colour;
    c.stroke(lines);
    c.fill(marks);
  }
  drawIntents(c, view, (robot) => !robots.has(robot));
}
