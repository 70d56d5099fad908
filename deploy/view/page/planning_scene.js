// SPDX-License-Identifier: Apache-2.0
// Draws the scene of the planning page, in the colours of its legend (style.css).
import {addCircle, addCross} from "./shapes.js";
import {palette} from "./theme.js";

const kMargin_m = 0.2;

/**
 * Pixels per metre, and where the middle of the field is.
 * @param {number[]} field length and width in metres @param {{clientWidth: number, clientHeight: number}} canvas
 */
export function viewOf([length_m, width_m], canvas) {
  return {scale: Math.min(canvas.clientWidth / (length_m + 2 * kMargin_m), canvas.clientHeight / (width_m + 2 * kMargin_m)),
          x: canvas.clientWidth / 2, y: canvas.clientHeight / 2};
}

/**
 * Edges as one path for each state: blocked, free, unchecked.
 * @param {any} plan
 */
function edgePaths(plan) {
  const paths = [new Path2D(), new Path2D(), new Path2D()];
  for (const [a, b, state] of plan.edges) {
    paths[state].moveTo(plan.nodes[a][0], plan.nodes[a][1]);
    paths[state].lineTo(plan.nodes[b][0], plan.nodes[b][1]);
  }
  return paths;
}

/** @param {any} canvas @param {any} plan */
export function drawPlan(canvas, plan) {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const c = canvas.getContext("2d");
  const {scale, x, y} = viewOf(plan.field, canvas);
  c.setTransform(scale * ratio, 0, 0, -scale * ratio, x * ratio, y * ratio);
  const pixel = 1 / scale;
  const [length_m, width_m] = plan.field;
  c.lineWidth = 2 * pixel;
  c.strokeStyle = palette.dim;
  c.strokeRect(-length_m / 2, -width_m / 2, length_m, width_m);
  const [blocked, free, unchecked] = edgePaths(plan);
  c.lineWidth = pixel;
  /** @type {[Path2D, string, number[]][]} */
  const lines = [[unchecked, `${palette.grey}88`, [1, 3]], [free, `${palette.green}aa`, []], [blocked, palette.red, [3, 3]]];
  for (const [path, colour, dash] of lines) {
    c.strokeStyle = colour;
    c.setLineDash(dash.map((d) => d * pixel));
    c.stroke(path);
  }
  c.setLineDash([]);
  const obstacles = new Path2D(), way = new Path2D(), goal = new Path2D(), start = new Path2D();
  for (const [ox, oy, radius] of plan.obstacles) addCircle(obstacles, ox, oy, radius);
  c.fillStyle = `${palette.grey}bb`;
  c.fill(obstacles);
  for (const [px, py] of plan.path) way.lineTo(px, py);  // the first one moves there
  c.strokeStyle = palette.sky;
  c.lineWidth = 4 * pixel;
  c.stroke(way);
  addCircle(start, plan.start[0], plan.start[1], Math.max(plan.radius_m, 6 * pixel));
  c.fillStyle = palette.sky;
  c.fill(start);
  addCross(goal, plan.goal[0], plan.goal[1], 7 * pixel);
  c.strokeStyle = palette.purple;
  c.stroke(goal);
}
