// SPDX-License-Identifier: Apache-2.0
// A person drags obstacles while a roadmap or a tree adapts.
import {Connection} from "./connection.js";
import {element, number} from "./format.js";

const kColours = {blocked: "#d55e00", free: "#009e7388", unchecked: "#8b96a155"};
/**
 * State for tests.
 * @type {any}
 */
const planning = {plan: null, plans: 0};
/** @type {any} */ (window).planning = planning;

const canvas = element("floor");
/** @type {{what: string | number, at: {x: number, y: number}, is_sent: boolean} | null} */
let drag = null;
let isWaiting = false;  // for the plan of the last change
let seed = 1;

const connection = new Connection("sidestep.planning.v1", (message) => {
  planning.plan = message;
  ++planning.plans;
  isWaiting = false;
  element("result").textContent = `${message.solved ? `${number(message.length_m, 2)} m` : "no path"} in ${number(message.time_us, 0)} µs; ` +
      `${message.nodes.length} nodes, ${message.edges.length} edges`;
  requestAnimationFrame(draw);
  // The next position of the dragged object is sent only after the answer, so that positions never queue up.
  if (drag && !drag.is_sent) sendDrag();
}, () => {}, (state) => {
  element("connection").textContent = state === "lost" ? "connection lost, trying again" : "";
  element("connection").dataset.state = state;
});

/** Pixels per metre, and the centre of the canvas. */
function view() {
  const [length_m, width_m] = planning.plan.field;
  return {scale: Math.min(canvas.clientWidth / (length_m + 0.4), canvas.clientHeight / (width_m + 0.4)),
          x: canvas.clientWidth / 2, y: canvas.clientHeight / 2};
}

function draw() {
  const plan = planning.plan;
  if (!plan || canvas.clientWidth < 2) return;
  const ratio = window.devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const c = canvas.getContext("2d");
  const {scale, x, y} = view();
  c.setTransform(scale * ratio, 0, 0, -scale * ratio, x * ratio, y * ratio);
  const pixel = 1 / scale;
  const [length_m, width_m] = plan.field;
  c.lineWidth = 2 * pixel;
  c.strokeStyle = "#8b96a1";
  c.strokeRect(-length_m / 2, -width_m / 2, length_m, width_m);
  const paths = [new Path2D(), new Path2D(), new Path2D()];
  for (const [a, b, state] of plan.edges) {
    paths[state].moveTo(plan.nodes[a][0], plan.nodes[a][1]);
    paths[state].lineTo(plan.nodes[b][0], plan.nodes[b][1]);
  }
  c.lineWidth = pixel;
  c.strokeStyle = kColours.unchecked;
  c.stroke(paths[2]);
  c.strokeStyle = kColours.free;
  c.stroke(paths[1]);
  c.setLineDash([3 * pixel, 3 * pixel]);
  c.strokeStyle = kColours.blocked;
  c.stroke(paths[0]);
  c.setLineDash([]);
  c.fillStyle = "#8b96a1aa";
  for (const [ox, oy, radius] of plan.obstacles) {
    c.beginPath();
    c.arc(ox, oy, radius, 0, 2 * Math.PI);
    c.fill();
  }
  c.strokeStyle = "#56b4e9";
  c.lineWidth = 3 * pixel;
  c.beginPath();
  plan.path.forEach((/** @type {number[]} */ p, /** @type {number} */ i) => (i === 0 ? c.moveTo(p[0], p[1]) : c.lineTo(p[0], p[1])));
  c.stroke();
  c.fillStyle = "#56b4e9";
  c.beginPath();
  c.arc(plan.start[0], plan.start[1], Math.max(plan.radius_m, 6 * pixel), 0, 2 * Math.PI);
  c.fill();
  c.strokeStyle = "#cc79a7";
  const [gx, gy] = plan.goal, size = 7 * pixel;
  c.beginPath();
  c.moveTo(gx - size, gy - size);
  c.lineTo(gx + size, gy + size);
  c.moveTo(gx - size, gy + size);
  c.lineTo(gx + size, gy - size);
  c.stroke();
}

/** @param {PointerEvent} e */
function toMetres(e) {
  const {scale, x, y} = view();
  const [length_m, width_m] = planning.plan.field;
  const clamp = (/** @type {number} */ v, /** @type {number} */ limit) => Math.min(Math.max(v, -limit), limit);
  return {x: clamp((e.offsetX - x) / scale, length_m / 2), y: clamp((y - e.offsetY) / scale, width_m / 2)};
}

function sendDrag() {
  if (!drag) return;
  drag.is_sent = isWaiting = true;
  connection.send({op: "move", what: drag.what, x: drag.at.x, y: drag.at.y});
}

canvas.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => {
  if (!planning.plan) return;
  const at = toMetres(e);
  const isNear = (/** @type {number[]} */ p, /** @type {number} */ reach) => Math.hypot(p[0] - at.x, p[1] - at.y) < reach;
  const near = Math.max(planning.plan.radius_m, 12 / view().scale);
  const obstacle = planning.plan.obstacles.findIndex((/** @type {number[]} */ o) => isNear(o, o[2]));
  const what = isNear(planning.plan.start, near) ? "start" : isNear(planning.plan.goal, near) ? "goal" : obstacle;
  if (what === -1) return;
  canvas.setPointerCapture(e.pointerId);
  drag = {what, at, is_sent: true};
});
canvas.addEventListener("pointermove", (/** @type {PointerEvent} */ e) => {
  if (!drag) return;
  drag.at = toMetres(e);
  drag.is_sent = false;
  if (!isWaiting) sendDrag();
});
canvas.addEventListener("pointerup", () => {
  if (drag && !drag.is_sent) sendDrag();
  drag = null;
});

function another() {
  connection.send({op: "scene", seed: ++seed, obstacles: Number(element("count").value)});
}
element("next").addEventListener("click", another);
element("planner").addEventListener("change", () => connection.send({op: "planner", name: element("planner").value}));
addEventListener("keydown", (e) => {
  if (e.key === "n" && !["INPUT", "SELECT"].includes(/** @type {HTMLElement} */ (e.target).tagName)) another();
});
new ResizeObserver(() => requestAnimationFrame(draw)).observe(canvas);
