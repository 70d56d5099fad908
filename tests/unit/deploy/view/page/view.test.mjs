// SPDX-License-Identifier: Apache-2.0
// Which part of the floor is shown, trails, and other arithmetic of the page.
import assert from "node:assert/strict";
import test from "node:test";
import {orderText} from "../../../../../deploy/view/page/controls.js";
import {scaleLength_m} from "../../../../../deploy/view/page/floor_layers.js";
import {floorHint} from "../../../../../deploy/view/page/hint.js";
import {layers, presets} from "../../../../../deploy/view/page/layers.js";
import {menuPlace} from "../../../../../deploy/view/page/menu.js";
import {momentText} from "../../../../../deploy/view/page/moment.js";
import {reachable} from "../../../../../deploy/view/page/panel.js";
import {numbersOf} from "../../../../../deploy/view/page/plots.js";
import {sideWidth} from "../../../../../deploy/view/page/splitter.js";
import {isJump, kTrail_s, TrailStore} from "../../../../../deploy/view/page/trails.js";
import {boxAround, floorBox, Viewport} from "../../../../../deploy/view/page/viewport.js";
import {pageFile} from "./fake_page.mjs";

function viewOf(width, height) {
  return Object.assign(new Viewport(), {width, height});
}

test("a fitted floor fills the canvas in one direction and is wholly shown", () => {
  for (const [length_m, width_m] of [[9, 6], [6, 9], [100, 40], [2, 2]]) {
    const view = viewOf(1040, 760);
    view.fit({min: [1, 2], max: [1 + length_m, 2 + width_m]});
    const from = view.toPixels({x: 1, y: 2 + width_m}), to = view.toPixels({x: 1 + length_m, y: 2});
    assert.ok(from.x >= 0 && from.y >= 0 && to.x <= 1040 && to.y <= 760);
    assert.ok((to.x - from.x) / 1040 > 0.92 || (to.y - from.y) / 760 > 0.92);
  }
});

test("pixels and metres are converted to and fro, also after zooming and moving", () => {
  const view = viewOf(800, 600);
  view.fit({min: [-4, -3], max: [4, 3]});
  const pixel = {x: 123, y: 456}, place = view.toMetres(pixel);
  view.zoom(pixel, 3);
  for (const key of ["x", "y"]) assert.ok(Math.abs(view.toMetres(pixel)[key] - place[key]) < 1e-9);
  view.move(place, view.toMetres({x: 200, y: 200}));
  const moved = view.toPixels(place);
  assert.ok(Math.hypot(moved.x - 200, moved.y - 200) < 1e-6);
});

test("the map is the floor if there is one", () => {
  assert.deepEqual(floorBox({field: {length_m: 9, width_m: 6}}), {min: [-4.5, -3], max: [4.5, 3]});
  assert.deepEqual(floorBox({field: {length_m: 9, width_m: 6}, map: {min: [0, 0], max: [20, 10]}}).max, [20, 10]);
});

test("robots are fitted with some of their surroundings, a single one too", () => {
  assert.equal(boxAround([{x: NaN, y: NaN}]), null);
  const single = boxAround([{x: 5, y: 5}]);
  assert.ok(single.max[0] - single.min[0] >= 3);
  const two = boxAround([{x: -10, y: 0}, {x: 10, y: 1}, {x: NaN, y: 0}]);
  assert.ok(two.min[0] < -10 && two.max[0] > 10);
});

test("trails are kept whatever the order in which moments are shown", () => {
  const store = new TrailStore();
  for (const time of [10, 10.1, 10.2, 3, 3.1, 20]) store.add(4, {time, x: time, y: 0});
  assert.deepEqual(store.before(4, 10.3).map((p) => p.x), [10, 10.1, 10.2]);
  assert.deepEqual(store.before(4, 3.2).map((p) => p.x), [3, 3.1]);
  assert.deepEqual(store.before(4, 10.15).map((p) => p.x), [10, 10.1]);
  assert.deepEqual(store.before(4, 3.1 + kTrail_s + 0.01).map((p) => p.x), []);
  store.addAll({robots: [{id: 4, points: [[9.5, 9.5, 0], [10.01, 10.01, 0]]}]});
  assert.deepEqual(store.before(4, 10.15).map((p) => p.x), [9.5, 10, 10.1]);
  assert.deepEqual(store.before(5, 10), []);
});

test("a store of trails has a limit, and forgets what is far from the moment shown", () => {
  const store = new TrailStore();
  for (let id = 0; id < 4000; ++id) store.add(id, {time: 0, x: 0, y: 0});
  for (let i = 0; i < 500; ++i) store.add(7, {time: i, x: i, y: 0});
  assert.ok(store.robots.get(7).length <= 100);
  assert.equal(store.robots.get(7).at(-1).x, 499);
});

test("seeking is a jump, playing is not", () => {
  assert.ok(isJump(-Infinity, 5) && isJump(10, 5) && isJump(5, 10));
  assert.ok(!isJump(5, 5.025) && !isJump(5, 4.975) && !isJump(5, 5.5));
});

const kMoment = {mode: "paused", speed: 1, shown_s: 105, begin_s: 100, end_s: 110, first_grant_s: 101, progress: 1, isRecording: true,
                 isConnected: true};
test("the clock says what is shown", () => {
  const text = (changes) => momentText({...kMoment, ...changes});
  assert.equal(text({}), "00:01:45.000 · 5.00 of 10.0 s · paused");
  assert.match(text({shown_s: 101}), /paused at the first granted motion$/);
  assert.match(text({shown_s: 100}), /paused at the beginning$/);
  assert.match(text({shown_s: 110}), /paused at the end$/);
  assert.match(text({mode: "playing", speed: 0.25}), /playing at 0.25 times the speed$/);
  assert.match(text({mode: "live"}), /end of the recording$/);
  assert.match(text({mode: "live", progress: 0.5}), /the last moment read so far · reading, 50 %$/);
  assert.equal(text({mode: "live", isRecording: false}), "00:01:45.000 · live");
  assert.match(text({isRecording: false, shown_s: 108}), /paused, 2.00 s ago$/);
  assert.match(text({mode: "live", isRecording: false, isConnected: false}), /connection lost: this is the last moment received$/);
  for (const changes of [{mode: "live"}, {mode: "live", progress: 0.5}, {mode: "live", isConnected: false, isRecording: false}])
    assert.doesNotMatch(text(changes), /· live/);
});

test("the floor says why it is empty, and nothing else", () => {
  const state = {connection: "connected", hasScene: true, isRecording: false, mode: "live", robots: 3, wantsField: false, selected: -1,
                 beforeFirstGrant: false};
  const text = (changes) => floorHint({...state, ...changes});
  assert.equal(text({}), "");
  assert.match(text({connection: "lost"}), /connection to the monitor is lost/);
  assert.match(text({hasScene: false}), /Connecting/);
  assert.match(text({robots: 0}), /No robot has been heard/);
  assert.match(text({robots: 0, isRecording: true, beforeFirstGrant: true}), /has just begun/);
  assert.match(text({robots: 0, isRecording: true}), /at this moment of the recording/);
  assert.match(text({wantsField: true}), /Select a robot/);
  assert.equal(text({wantsField: true, selected: 2}), "");
  assert.match(text({wantsField: true, selected: 2, isRecording: true}), /live only/);
});

test("presets name layers that exist, all show the robots with numbers, and the first one is the default", () => {
  const known = layers.map((layer) => layer.id);
  for (const preset of presets) {
    for (const id of preset.layers) assert.ok(known.includes(id), `${preset.id}: ${id}`);
    for (const id of ["field", "obstacles", "robots", "labels", "selection"]) assert.ok(preset.layers.includes(id), `${preset.id}: ${id}`);
  }
  assert.deepEqual(presets[0].layers, layers.filter((layer) => layer.on).map((layer) => layer.id));
});

test("no key has two meanings", () => {
  const others = [...pageFile("main.js").matchAll(/^ {2}\["(.)", "/gm)].map((match) => match[1]);
  assert.ok(others.length >= 15);
  const all = [...others, ...layers.map((layer) => layer.key)];
  assert.equal(new Set(all).size, all.length, all.sort().join(""));
});

test("menus, windows and the side stay within reach", () => {
  const page = {width: 400, height: 800};
  assert.deepEqual(menuPlace({left: 20, bottom: 50}, 200, page), {left: 20, top: 54, maxHeight: 742});
  assert.equal(menuPlace({left: 350, bottom: 50}, 200, page).left, 196);
  assert.equal(menuPlace({left: 350, bottom: 790}, 200, page).top, 400);
  assert.deepEqual(reachable({x: -50, y: 2000}, page), {x: 0, y: 766});
  assert.equal(sideWidth(2000, 1500), 975);
  assert.equal(sideWidth(10, 1500), 240);
});

test("the scale is a round length that fits", () => {
  assert.equal(scaleLength_m(1 / 100, 140), 1);
  assert.equal(scaleLength_m(1 / 10, 140), 10);
  assert.equal(scaleLength_m(1 / 65, 140), 2);
  assert.equal(scaleLength_m(1 / 1000, 140), 0.1);
});

test("numbers of 64 bits, which are texts, can be plotted; other texts cannot", () => {
  const message = {epoch: "9223372036854775807", name: "vision", digits: "17", header: {stamp_ns: "-1795630117800000000"}, is_on: true,
                   list: [1.5]};
  const found = numbersOf(message, "", new Map());
  assert.deepEqual([...found.keys()], ["epoch", "header.stamp_ns", "is_on", "list.0"]);
  assert.equal(found.get("header.stamp_ns"), -1795630117800000000);
});

test("an order is told with its state, and with the reason if there is one", () => {
  assert.equal(orderText("Robot 3: order", {order: "9007199254740993", phase: "driving"}), "Robot 3: order 9007199254740993 driving");
  assert.equal(orderText("Robot 3: order", {order: 5, phase: "refused", reason: "a goal is outside the field"}),
               "Robot 3: order 5 refused: a goal is outside the field");
});
