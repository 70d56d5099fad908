// SPDX-License-Identifier: Apache-2.0
// Where the numbers of robots are put.
import assert from "node:assert/strict";
import test from "node:test";
import {placeLabels} from "../../../../../deploy/view/page/labels.js";
import {markRadius} from "../../../../../deploy/view/page/shapes.js";
import {Viewport} from "../../../../../deploy/view/page/viewport.js";

/** Robots as they are drawn on a floor of 1,040 × 760 pixels that shows a field. */
function marksOf(places, length_m, width_m) {
  const view = new Viewport();
  Object.assign(view, {width: 1040, height: 760});
  view.fit({min: [-length_m / 2, -width_m / 2], max: [length_m / 2, width_m / 2]});
  const r = markRadius(0.09, 1 / view.scale) * view.scale;
  return places.map(([id, x, y]) => ({id, text: String(id), ...view.toPixels({x, y}), r, width: 7.5 * String(id).length, height: 13}));
}

const overlaps = (a, b) => Math.abs(a.x - b.x) < (a.width + b.width) / 2 && Math.abs(a.y - b.y) < (a.height + b.height) / 2;
const covers = (label, mark) => Math.hypot(Math.max(Math.abs(label.x - mark.x) - label.width / 2, 0),
                                           Math.max(Math.abs(label.y - mark.y) - label.height / 2, 0)) < mark.r - 0.01;

function checkLegible(marks, labels) {
  for (const label of labels) {
    assert.ok(label.height >= 12, "smaller than 12 pixels");
    for (const mark of marks) assert.ok(!covers(label, mark), `number ${label.id} covers robot ${mark.id}`);
    for (const other of labels) assert.ok(label === other || !overlaps(label, other), `numbers ${label.id} and ${other.id} overlap`);
  }
}

// deploy/scenarios/two-teams-22.yaml: the numbers of yellow robots begin with 16.
const kHalf = [[-5.6, 0], [-3.9, -0.8], [-3.9, 0.8], [-3.4, -2.6], [-3.4, 2.6], [-2.2, 0], [-2, -1.7], [-2, 1.7], [-0.9, -1], [-0.9, 1],
               [-0.7, 0.2]];
const kTeams = [...kHalf.map(([x, y], i) => [i, x, y]), ...kHalf.map(([x, y], i) => [16 + i, -x, -y])];

test("22 robots of two teams each have their own number, beside all robots", () => {
  for (const [length_m, width_m] of [[12, 9], [24, 18], [60, 45]]) {
    const marks = marksOf(kTeams, length_m, width_m);
    const labels = placeLabels(marks, new Map(), () => false);
    assert.deepEqual(labels.map((label) => label.text), kTeams.map(([id]) => String(id)));
    if (length_m < 60) checkLegible(marks, labels);
  }
});

test("numbers of 22 robots stay legible while the teams drive through each other", () => {
  const slots = new Map();
  for (let share = 0; share <= 1; share += 0.02) {
    // Lanes half a metre apart, so that no two robots touch.
    const places = kTeams.map(([id, x], i) => [id, x * (1 - 2 * share), (i - 10.5) * 0.4]);
    const marks = marksOf(places, 12, 9);
    const labels = placeLabels(marks, slots, () => false);
    assert.equal(labels.length, 22);
    checkLegible(marks, labels);
  }
});

test("a number keeps its side while that is free", () => {
  const slots = new Map();
  const pair = (distance) => marksOf([[0, 0, 0], [1, distance, distance]], 9, 6);
  placeLabels(pair(0.2), slots, () => false);
  const pushed = slots.get(0);
  assert.notEqual(pushed, 0);  // the other robot is where the number would be
  placeLabels(pair(3), slots, () => false);
  assert.equal(slots.get(0), pushed);
});

test("of many robots the numbers that fit are shown, of a thousand none, and always that of the selected one", () => {
  const marksOfCrowd = (count) => marksOf(Array.from({length: count}, (_, i) => [i, (i % 40) - 20, Math.floor(i / 40) - 12.5]), 80, 60);
  const many = marksOfCrowd(240);
  const labels = placeLabels(many, new Map(), (id) => id === 100);
  assert.equal(labels[0].id, 100);
  assert.ok(labels.length > 20 && labels.length < 240, `${labels.length}`);
  checkLegible(many, labels.slice(1));
  assert.deepEqual(placeLabels(marksOfCrowd(1000), new Map(), (id) => id === 500).map((label) => label.id), [500]);
});

test("a mark is never smaller than 12 pixels, and never smaller than its robot", () => {
  for (const scale of [1, 5, 20, 100, 500]) {
    const across_px = 2 * markRadius(0.09, 1 / scale) * scale;
    assert.ok(across_px >= 12 && across_px >= 0.18 * scale - 1e-9);
  }
});
