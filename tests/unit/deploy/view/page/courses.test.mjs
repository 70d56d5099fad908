// SPDX-License-Identifier: Apache-2.0
// How courses and waiting robots are drawn, and the column that says for whom robots wait.
import assert from "node:assert/strict";
import test from "node:test";
import {drawCourses, fadedColour} from "../../../../../deploy/view/page/course_layers.js";
import {Frame, Layout} from "../../../../../deploy/view/page/frame.js";
import {drawConflicts} from "../../../../../deploy/view/page/robot_layers.js";
import {palette} from "../../../../../deploy/view/page/theme.js";
import {coloursOf, frameOf, openPage, panelsOf, sceneOf} from "./fake_page.mjs";

const kRobots = [{id: 0, team: "blue"}, {id: 1, team: "yellow"}];
const kPlaces = [{id: 0, x: -2, y: 1}, {id: 1, x: 2, y: -1}];
const kTeams = new Map(kRobots.map(({id, team}) => [id, team]));

/** Remembers what is added to it, as [name, ...numbers]. */
class Path {
  calls = [];
}
for (const name of ["moveTo", "lineTo", "arc", "bezierCurveTo"])
  Path.prototype[name] = function (...numbers) {
    this.calls.push([name, ...numbers]);
  };

/** Remembers the paths that are drawn, unless they are empty. */
class Canvas {
  drawn = [];
  dash = [];
  setLineDash(dash) {
    this.dash = dash;
  }
  add(kind, colour, {calls}) {
    if (calls.length > 0) this.drawn.push({kind, colour, isDashed: this.dash.length > 0, calls});
  }
  stroke(path) {
    this.add("stroke", this.strokeStyle, path);
  }
  fill(path) {
    this.add("fill", this.fillStyle, path);
  }
}

/** What a layer draws. */
function drawnBy(draw, places, courses = []) {
  globalThis.Path2D = Path;
  Object.assign(palette, coloursOf("light"));
  const scene = sceneOf(kRobots), layout = new Layout(scene.layout), canvas = new Canvas();
  draw(canvas, {scene: {...scene, layout, teams: kTeams}, frame: new Frame(frameOf(100, places, courses), layout), pixel: 0.01,
                mark_m: 0.1, selected: -1, floor: null});
  return canvas.drawn;
}

test("a course is a line through its states that fades with time, with a mark for each second", () => {
  const courses = [[0, 0, 0, 0, 1, 0], [0, 0.5, 0.5, 0, 1, 0], [0, 1, 1, 0, 1, 0], [0, 1.25, 1.125, 0, 0, 0]];
  const drawn = drawnBy(drawCourses, kPlaces, courses);
  const [first, second] = [0, 1].map((s) => fadedColour(palette.sky, s));
  assert.deepEqual(drawn.map(({kind, colour}) => [kind, colour]), [["stroke", first], ["fill", first], ["stroke", second]]);
  const [from, curve] = drawn[0].calls;
  assert.deepEqual(from, ["moveTo", 0, 0]);
  // At constant velocity, the inner points of the cubic are at a third and at two thirds.
  [0.5 / 3, 0, 1 / 3, 0, 0.5, 0].forEach((value, i) => assert.ok(Math.abs(curve[i + 1] - value) < 1e-9));
  assert.deepEqual(drawn[1].calls.filter(([name]) => name === "arc").map(([, x, y]) => [x, y]), [[1, 0]]);
});

test("colours fade, but never vanish", () => {
  assert.equal(fadedColour("#123456", 0), "#123456ff");
  const opacities = [...Array(30).keys()].map((second) => parseInt(fadedColour("#123456", second).slice(7), 16));
  opacities.forEach((opacity, i) => assert.ok(opacity >= 64 && opacity <= (opacities[i - 1] ?? 255)));
});

test("courses have the colours of teams, and are not joined", () => {
  const courses = [[0, 0, 0, 0, 0, 0], [0, 0.5, 1, 0, 0, 0], [1, 0, 5, 5, 0, 0], [1, 0.5, 5, 6, 0, 0]];
  const drawn = drawnBy(drawCourses, kPlaces, courses);
  assert.deepEqual(drawn.map(({colour}) => colour), [fadedColour(palette.sky, 0), fadedColour(palette.yellow, 0)]);
  for (const {calls} of drawn) assert.equal(calls.length, 2);
  assert.deepEqual(drawn[1].calls[0], ["moveTo", 5, 5]);
});

test("a robot without a course has its intent", () => {
  const places = kPlaces.map((place) => ({...place, via_x: 0, via_y: 0, goal_x: 3, goal_y: 3}));
  const drawn = drawnBy(drawCourses, places, [[0, 0, -2, 1, 0, 0], [0, 0.5, -1, 1, 0, 0]]);
  assert.deepEqual(drawn.at(-1).calls, [["moveTo", 2, -1], ["lineTo", 0, 0], ["lineTo", 3, 3]]);
  assert.equal(drawn.at(-1).colour, `${palette.purple}88`);
});

test("an arrow leads from a waiting robot to the other: dashed by its course, solid if it was denied, red in a cycle", () => {
  const arrow = (first, second = {}) => {
    const drawn = drawnBy(drawConflicts, [{...kPlaces[0], ...first}, {...kPlaces[1], ...second}]);
    return drawn.map(({colour, isDashed, calls}) => [colour, isDashed, calls[0].slice(1), calls[1].slice(1)]);
  };
  assert.deepEqual(arrow({}), []);
  assert.deepEqual(arrow({waits_for: 1}), [[palette.orange, true, [-2, 1], [2, -1]]]);
  assert.deepEqual(arrow({blocker: 1, waits_for: 1}), [[palette.orange, false, [-2, 1], [2, -1]]]);
  assert.deepEqual(arrow({waits_for: 1}, {blocker: 0}).map(([colour, isDashed]) => [colour, isDashed]), [[palette.red, false]]);
  assert.deepEqual(arrow({waits_for: 5}), []);  // where robot 5 is, is not known
});

test("the table of robots says for whom a robot waits", async () => {
  openPage("index.html");
  const {robotTable, updateRobots} = await import("../../../../../deploy/view/page/robot_panel.js");
  const panels = panelsOf(kRobots);
  panels.robots[0].waits_for = 1;
  updateRobots(panels, {...sceneOf(kRobots), teams: kTeams}, -1);
  const column = robotTable.columns.findIndex(({title}) => title === "Waits for");
  assert.deepEqual(robotTable.body.rows.map((row) => row.cells[column].textContent), ["1", "–"]);
});
