// SPDX-License-Identifier: Apache-2.0
// A person drags obstacles while a roadmap or a tree adapts.
import {Connection} from "./connection.js";
import {element, number} from "./format.js";
import {drawPlan, viewOf} from "./planning_scene.js";
import {changeTheme, onThemeChange, startTheme} from "./theme.js";

/**
 * State for tests.
 * @type {any}
 */
const planning = {plan: null, plans: 0};
/** @type {any} */ (window).planning = planning;

const canvas = element("floor");
startTheme();
onThemeChange(draw);
element("theme").addEventListener("click", changeTheme);
// Leads back with the same right to command.
element("monitor-link").hash = location.hash;
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
  element("connection").textContent = state === "lost" ? "connection lost, trying again" : "connected";
  element("connection").dataset.state = state;
});

const view = () => viewOf(planning.plan.field, canvas);

function draw() {
  if (planning.plan && canvas.clientWidth > 1) drawPlan(canvas, planning.plan);
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
  if (e.ctrlKey || e.metaKey || e.altKey || ["INPUT", "SELECT"].includes(/** @type {HTMLElement} */ (e.target).tagName)) return;
  if (e.key === "n") another();
  if (e.key === "t") changeTheme();
});
new ResizeObserver(() => requestAnimationFrame(draw)).observe(canvas);
