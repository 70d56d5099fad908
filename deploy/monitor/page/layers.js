// SPDX-License-Identifier: Apache-2.0
// What is drawn on the floor. Each layer gathers the shapes of one colour into one path.
import {placeOf} from "./floor.js";
import {addVersion} from "./frame.js";

/** @typedef {{scene: any, frame: any, pixel: number, selected: number, floor: any, zones?: any[], goals?: any}} View */
/** @typedef {{id: string, name: string, key: string, on: boolean, draw: (c: CanvasRenderingContext2D, view: View) => void}} Layer */

const kBlue = "#0072b2", kSky = "#56b4e9", kYellow = "#f0e442", kOrange = "#e69f00", kGreen = "#009e73",
      kRed = "#d55e00", kPurple = "#cc79a7", kGrey = "#8b96a1";
const kMaxLabels = 120;
const kTrail_s = 5;

/** What panels know and frames do not. */
export const shared = {zones: /** @type {any[]} */ ([]), goals: /** @type {Map<number, number[][]>} */ (new Map())};

/**
 * Calls `use` with the index of each robot's row.
 * @param {View} view @param {(v: Float32Array, at: number, c: any) => void} use
 */
function eachRobot(view, use) {
  const {values, rows, stride} = view.frame.sections.robots;
  const c = view.scene.layout.columns.robots;
  for (let i = 0; i < rows; ++i) use(values, i * stride, c);
}

/** @param {Path2D} path @param {number} x @param {number} y @param {number} r */
function addCircle(path, x, y, r) {
  if (Number.isNaN(x)) return;
  path.moveTo(x + r, y);
  path.arc(x, y, r, 0, 2 * Math.PI);
}

/** @param {Path2D} path @param {number[][]} corners */
function addPolygon(path, corners) {
  corners.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
}

let mapLoaded = () => {};
/**
 * Calls back when the map can be drawn.
 * @param {() => void} callback
 */
export function onMapLoaded(callback) {
  mapLoaded = callback;
}

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
          image.data.set([139, 150, 161, 255], 4 * ((map.rows - 1 - row) * map.columns + column));
    c.putImageData(image, 0, 0);
    mapLoaded();
  });
  return canvas;
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawField(c, view) {
  const {length_m, width_m} = view.scene.field;
  c.strokeStyle = kGrey;
  c.lineWidth = 2 * view.pixel;
  c.strokeRect(-length_m / 2, -width_m / 2, length_m, width_m);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawObstacles(c, view) {
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
  c.fillStyle = c.strokeStyle = kGrey;
  c.lineWidth = 2 * view.pixel;
  c.fill(path);
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawZones(c, view) {
  for (const zone of shared.zones) {
    const path = new Path2D();
    addPolygon(path, zone.corners);
    const isSlow = zone.speed_limit_mps !== undefined;
    c.fillStyle = c.strokeStyle = isSlow ? "#e69f0033" : "#d55e0044";
    c.lineJoin = "round";
    c.lineWidth = 2 * Math.max(zone.radius_m, view.pixel);
    c.fill(path);
    c.stroke(path);
  }
}

const kSpanEnd = {x: 0, y: 0};

/**
 * The floor that a version covers.
 * @param {CanvasRenderingContext2D} c @param {View} view @param {string} kind @param {string} colour
 */
function drawCovered(c, view, kind, colour) {
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
function drawPath(c, view, kind, colour, dash) {
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
function drawBraked(c, view) {
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
function drawRobots(c, view) {
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
    // The front of blue robots is a line, of yellow ones an arrow, so that shapes tell teams apart too.
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
function drawOutlines(c, view, names, colour) {
  const path = new Path2D();
  eachRobot(view, (v, at, columns) => addCircle(path, v[at + columns[names[0]]], v[at + columns[names[1]]], view.scene.radius_m));
  c.strokeStyle = colour;
  c.lineWidth = 1.2 * view.pixel;
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawLabels(c, view) {
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
function drawGoals(c, view) {
  const goals = new Path2D(), lines = new Path2D();
  const size = 5 * view.pixel;
  eachRobot(view, (v, at, columns) => {
    const x = v[at + columns.goal_x], y = v[at + columns.goal_y];
    if (Number.isNaN(x)) return;
    goals.moveTo(x - size, y - size);
    goals.lineTo(x + size, y + size);
    goals.moveTo(x - size, y + size);
    goals.lineTo(x + size, y - size);
    if (v[at] !== view.selected) return;
    const place = placeOf(v, at, columns);
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
function drawIntents(c, view) {
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
 * each other in a circle.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
function drawConflicts(c, view) {
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
function drawLedger(c, view) {
  const {values, rows, stride} = view.frame.sections.ledger;
  const path = new Path2D();
  const column = view.scene.layout.columns.ledger.version_start;
  for (let i = 0; i < rows; ++i) addVersion(path, values, i * stride + column, kSpanEnd);
  c.strokeStyle = "#f0e44288";
  c.lineWidth = 3 * view.pixel;
  c.stroke(path);
}

/**
 * Opponents and people, and how far each can have got since it was seen.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
function drawMovingObstacles(c, view) {
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
  c.fillStyle = "#d55e0055";
  c.fill(bodies);
  c.strokeStyle = kRed;
  c.lineWidth = view.pixel;
  c.stroke(bodies);
  c.setLineDash([4 * view.pixel, 4 * view.pixel]);
  c.stroke(reach);
  c.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawBall(c, view) {
  const {values: v, rows, stride} = view.frame.sections.balls;
  const path = new Path2D();
  for (let i = 0; i < rows; ++i) addCircle(path, v[i * stride], v[i * stride + 1], Math.max(0.022, 3 * view.pixel));
  c.fillStyle = "#ff8c1a";
  c.fill(path);
}

/**
 * What cameras detect, before vision combines it.
 * @param {CanvasRenderingContext2D} c @param {View} view
 */
function drawDetections(c, view) {
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
  c.strokeStyle = "#ffffff";
  c.lineWidth = view.pixel;
  c.stroke(path);
}

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawScans(c, view) {
  const {values: v, rows, stride} = view.frame.sections.beams;
  const path = new Path2D();
  const size = 1.5 * view.pixel;
  for (let i = 0; i < rows; ++i) path.rect(v[i * stride + 1] - size, v[i * stride + 2] - size, 2 * size, 2 * size);
  c.fillStyle = kGreen;
  c.fill(path);
}

/**
 * Places of the last seconds, by robot.
 * @type {Map<number, {time: number, x: number, y: number}[]>}
 */
const trails = new Map();
let trailTime = 0;

/** @param {CanvasRenderingContext2D} c @param {View} view */
function drawTrails(c, view) {
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

/**
 * From below to above.
 * @type {Layer[]}
 */
export const layers = [
  {id: "field", name: "Field", key: "1", on: true, draw: drawField},
  {id: "obstacles", name: "Obstacles and map", key: "2", on: true, draw: drawObstacles},
  {id: "zones", name: "Zones", key: "3", on: true, draw: drawZones},
  {id: "trails", name: "Trails", key: "4", on: true, draw: drawTrails},
  {id: "ledger", name: "Ledger", key: "5", on: false, draw: drawLedger},
  {id: "executing", name: "Executing, with stop", key: "6", on: true,
   draw: (c, view) => drawCovered(c, view, "executing", "#56b4e955")},
  {id: "granted", name: "Granted", key: "7", on: true, draw: (c, view) => drawPath(c, view, "granted", kGreen, [])},
  {id: "proposed", name: "Proposed", key: "8", on: false, draw: (c, view) => drawPath(c, view, "proposed", kOrange, [4, 3])},
  {id: "braked", name: "If all braked now", key: "9", on: false, draw: drawBraked},
  {id: "intents", name: "Intents", key: "0", on: false, draw: drawIntents},
  {id: "moving", name: "Moving obstacles", key: "m", on: true, draw: drawMovingObstacles},
  {id: "robots", name: "Robots", key: "r", on: true, draw: drawRobots},
  {id: "seen", name: "Robots as seen", key: "v", on: false, draw: (c, view) => drawOutlines(c, view, ["seen_x", "seen_y"], kPurple)},
  {id: "estimated", name: "Robots' own estimates", key: "e", on: false,
   draw: (c, view) => drawOutlines(c, view, ["x", "y"], kBlue)},
  {id: "goals", name: "Goals", key: "g", on: true, draw: drawGoals},
  {id: "conflicts", name: "Who waits for whom", key: "w", on: true, draw: drawConflicts},
  {id: "ball", name: "Ball", key: "o", on: true, draw: drawBall},
  {id: "detections", name: "Detections of cameras", key: "d", on: false, draw: drawDetections},
  {id: "scans", name: "Laser scans", key: "s", on: true, draw: drawScans},
  {id: "labels", name: "Numbers", key: "n", on: true, draw: drawLabels},
];
