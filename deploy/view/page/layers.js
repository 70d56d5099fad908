// SPDX-License-Identifier: Apache-2.0
// All layers that can be drawn on the floor, and useful choices of them.
import {drawCourses} from "./course_layers.js";
import {drawBand, drawLocalGrid, drawNavigation} from "./fields.js";
import {drawBall, drawDetections, drawField, drawMovingObstacles, drawObstacles, drawScale, drawScans,
        drawZones} from "./floor_layers.js";
import {drawLabels} from "./labels.js";
import {drawBraked, drawConflicts, drawCovered, drawGoals, drawIntents, drawLedger, drawOutlines, drawPath, drawRobots,
        drawSelection} from "./robot_layers.js";
import {palette} from "./theme.js";
import {drawTrails} from "./trails.js";

/** @typedef {import("./shapes.js").Layer} Layer */

/**
 * The layers in drawing order, the lowest first.
 * @type {Layer[]}
 */
export const layers = [
  {id: "field", name: "Field", key: "1", on: true, draw: drawField},
  {id: "obstacles", name: "Obstacles and map", key: "2", on: true, draw: drawObstacles},
  {id: "navigation", name: "Navigation function of the selected robot", key: "a", on: false, draw: drawNavigation},
  {id: "local", name: "Local grid of the selected robot", key: "x", on: false, draw: drawLocalGrid},
  {id: "band", name: "Band of the selected robot", key: "y", on: false, draw: drawBand},
  {id: "zones", name: "Zones", key: "3", on: true, draw: drawZones},
  {id: "trails", name: "Trails", key: "4", on: true, draw: drawTrails},
  {id: "ledger", name: "Ledger", key: "5", on: false, draw: drawLedger},
  {id: "executing", name: "Executed motions, with stops", key: "6", on: true,
   draw: (c, view) => drawCovered(c, view, "executing", `${palette.sky}55`)},
  {id: "granted", name: "Granted", key: "7", on: true, draw: (c, view) => drawPath(c, view, "granted", palette.green, [])},
  {id: "proposed", name: "Proposed", key: "8", on: false,
   draw: (c, view) => drawPath(c, view, "proposed", palette.orange, [4, 3])},
  {id: "braked", name: "Stops if all braked now", key: "9", on: false, draw: drawBraked},
  {id: "courses", name: "Courses, with a mark for each second", key: "u", on: true, draw: drawCourses},
  {id: "intents", name: "Intents", key: "0", on: false, draw: (c, view) => drawIntents(c, view)},
  {id: "moving", name: "Moving obstacles", key: "m", on: true, draw: drawMovingObstacles},
  {id: "goals", name: "Goals", key: "g", on: true, draw: drawGoals},
  {id: "robots", name: "Robots", key: "r", on: true, draw: drawRobots},
  {id: "seen", name: "Robots as vision sees them", key: "v", on: false,
   draw: (c, view) => drawOutlines(c, view, ["seen_x", "seen_y"], palette.purple)},
  {id: "estimated", name: "Robots' own estimates", key: "e", on: false,
   draw: (c, view) => drawOutlines(c, view, ["x", "y"], palette.blue)},
  {id: "conflicts", name: "Who waits for whom", key: "w", on: true, draw: drawConflicts},
  {id: "ball", name: "Ball", key: "o", on: true, draw: drawBall},
  {id: "detections", name: "Detections of cameras", key: "d", on: false, draw: drawDetections},
  {id: "scans", name: "Laser scans", key: "s", on: true, draw: drawScans},
  {id: "selection", name: "Mark of the selected robot", key: "q", on: true, draw: drawSelection},
  {id: "labels", name: "Numbers of robots", key: "n", on: true, draw: drawLabels},
  {id: "scale", name: "Scale", key: "i", on: true, draw: drawScale},
];

const kAlways = ["field", "obstacles", "zones", "moving", "robots", "selection", "labels", "scale", "ball"];

/**
 * Choices of layers by what a person looks for.
 * @type {{id: string, name: string, layers: string[]}[]}
 */
export const presets = [
  {id: "standard", name: "Standard", layers: layers.filter((layer) => layer.on).map((layer) => layer.id)},
  {id: "plain", name: "Robots only", layers: kAlways},
  {id: "motions", name: "Motions", layers: [...kAlways, "executing", "granted", "proposed", "braked", "courses", "intents", "goals"]},
  {id: "conflicts", name: "Conflicts", layers: [...kAlways, "granted", "ledger", "courses", "conflicts", "goals"]},
  {id: "perception", name: "Perception", layers: [...kAlways, "seen", "estimated", "detections", "scans", "trails"]},
  {id: "all", name: "All", layers: layers.map((layer) => layer.id)},
];

/** The preset that is switched on now, or undefined. */
export function currentPreset() {
  return presets.find((preset) => layers.every((layer) => layer.on === preset.layers.includes(layer.id)));
}
