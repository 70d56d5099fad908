// SPDX-License-Identifier: Apache-2.0
// The page's own logic, on a page without layout.
import assert from "node:assert/strict";
import test from "node:test";
import {frameOf, openPage, pageFolder, panelsOf, sceneOf, timeOf} from "./fake_page.mjs";

const kRobots = [{id: 0, team: "blue"}, {id: 1, team: "yellow"}];
const kPlaces = [{id: 0, x: -2, y: 1}, {id: 1, x: 2, y: -1}];
let copies = 0;

/** Opens the monitor's page, as a new page of its own. */
async function openMonitor(options = {}, scene = {}) {
  const page = openPage("index.html", options);
  // Modules are loaded once per address, so each page has its own copies.
  const {register} = await import("node:module");
  if (copies++ === 0) register("./fresh_modules.mjs", import.meta.url);
  await import(`${new URL("main.js", pageFolder)}?page=${copies}`);
  page.socket().onopen();
  page.receive(sceneOf(kRobots, scene));
  page.receive({type: "events", events: []});
  page.receive(frameOf(104, kPlaces));
  page.receive(panelsOf(kRobots));
  page.receive(timeOf());
  page.draw();
  page.tick();
  return page;
}
const text = (page, id) => page.element(id).textContent;
const settled = () => new Promise((resolve) => setImmediate(resolve));

test("a running system is shown live, without hints", async () => {
  const page = await openMonitor();
  assert.equal(text(page, "lamp-text"), "promise kept");
  assert.equal(page.element("lamp-whole").hidden, true);
  assert.match(text(page, "clock"), / · live$/);
  assert.equal(text(page, "live"), "Live");
  assert.equal(text(page, "play"), "Pause");
  assert.equal(page.element("floor-hint").hidden, true);
  assert.equal(page.element("panel-robots").hidden, false);
  assert.equal(page.element("tab-control"), null);
  assert.deepEqual(page.sent, []);
});

test("a recording opens where the monitor opens it, with both verdicts", async () => {
  const page = await openMonitor({}, {is_recording: true});
  page.receive({type: "whole", is_over: true, promise: {state: "kept", reason: ""}});
  page.receive(panelsOf(kRobots, {promise: {state: "not judged", reason: "the run is too short"}}));
  page.receive(timeOf({mode: "paused"}));
  page.receive(frameOf(101.01, kPlaces));
  page.draw();
  assert.deepEqual(page.sent, []);
  assert.equal(text(page, "lamp-whole"), "whole recording: ✓ promise kept");
  assert.equal(page.element("lamp-whole").dataset.state, "kept");
  assert.equal(text(page, "lamp-scope") + text(page, "lamp-text"), "up to this moment: not judged");
  assert.match(text(page, "clock"), /^00:01:41.010 · 1.01 of 10.0 s · paused at the first granted motion$/);
});

test("while a recording is read, its verdict says so", async () => {
  const page = await openMonitor({}, {is_recording: true});
  page.receive({type: "whole", is_over: false, promise: {state: "kept", reason: ""}});
  page.receive(timeOf({mode: "paused", progress: 0.4}));
  assert.equal(text(page, "lamp-whole"), "whole recording: reading, 40 %");
  assert.equal(page.element("lamp-whole").dataset.state, "not judged");
});

test("a recording's end is not live, and Play plays it again from the first granted motion", async () => {
  const page = await openMonitor({}, {is_recording: true});
  page.receive(timeOf({mode: "live"}));
  page.receive(frameOf(110, kPlaces));
  page.draw();
  assert.doesNotMatch(text(page, "clock"), /live/);
  assert.match(text(page, "clock"), /end of the recording/);
  assert.equal(text(page, "live"), "End");
  assert.equal(text(page, "play"), "Play");
  page.element("speed").value = "2";
  page.key(" ");
  assert.deepEqual(page.sent, [{op: "seek", at_s: 101}, {op: "play", speed: 2}]);
});

test("at the very start of a recording Play plays", async () => {
  const page = await openMonitor({}, {is_recording: true});
  page.receive(timeOf({mode: "paused"}));
  page.receive(frameOf(100, kPlaces));
  page.draw();
  page.element("speed").value = "1";
  page.element("play").click();
  assert.deepEqual(page.sent, [{op: "play", speed: 1}]);
});

test("a lost connection is not live, and the floor says that it is old", async () => {
  const page = await openMonitor();
  page.socket().onclose();
  page.tick();
  assert.equal(text(page, "connection"), "connection lost, trying again");
  assert.doesNotMatch(text(page, "clock"), /live/);
  assert.equal(page.element("live").getAttribute("aria-pressed"), "false");
  assert.match(text(page, "floor-hint"), /last moment received/);
  assert.equal(page.element("floor-hint").hidden, false);
});

test("a run that ends becomes a recording: nothing can be commanded any more", async () => {
  const page = await openMonitor({hash: "#token=secret"}, {can_command: true});
  assert.equal(page.element("command-hold-all").disabled, false);
  page.receive(sceneOf(kRobots, {is_recording: true, can_command: false}));
  page.receive(timeOf({mode: "paused"}));
  assert.equal(page.element("command-hold-all").disabled, true);
  assert.match(text(page, "panel-control"), /The run is over/);
  assert.equal(page.element("record").hidden, true);
  assert.doesNotMatch(text(page, "clock"), /live/);
});

test("when a run ends, the page says that messages and images are not kept, and asks for none", async () => {
  const page = await openMonitor({}, {cameras: 1});
  const channel = page.element("inspected");
  channel.value = "feedback/0";
  channel.fire("change");
  assert.deepEqual(page.sent, [{op: "inspect", channel: "feedback/0"}]);
  page.element("tab-cameras").click();
  const images = () => page.requests.filter((request) => request.path.startsWith("/api/cameras")).length;
  page.tick();
  await settled();
  assert.ok(images() > 0);
  page.receive(sceneOf(kRobots, {cameras: 1, is_recording: true, has_messages: false}));
  const before = images();
  page.tick();
  await settled();
  assert.equal(images(), before);
  assert.match(text(page, "panel-cameras"), /images of cameras are not kept/);
  assert.match(text(page, "panel-inspect"), /messages are not kept/);
  channel.value = "feedback/0";
  channel.fire("change");
  assert.match(text(page, "panel-inspect"), /messages are not kept/);
  assert.doesNotMatch(text(page, "panel-inspect"), /30 s before/);
  assert.deepEqual(page.sent.slice(1), [{op: "inspect", channel: null}]);
});

test("the messages of a recording are inspected", async () => {
  const page = await openMonitor({}, {is_recording: true});
  page.element("inspected").value = "feedback/0";
  page.element("inspected").fire("change");
  assert.deepEqual(page.sent, [{op: "inspect", channel: "feedback/0"}]);
  assert.match(text(page, "panel-inspect"), /No message in the 30 s before/);
});

test("without the token, the control panel says how to get it", async () => {
  const page = await openMonitor({}, {can_command: true});
  assert.match(text(page, "panel-control"), /Open the link that the monitor printed/);
  assert.equal(page.element("command-hold-all").disabled, true);
});

test("an order is shown until its end, with the reason of a refusal", async () => {
  const page = await openMonitor({hash: "#token=secret"}, {can_command: true});
  page.answers = {"/api/robots/1/hold": {order: "17"}, "/api/orders/17": {order: "17", phase: "refused", reason: "there are too many holds"}};
  page.element("floor").fire("pointerdown", {pointerId: 1, ...at(page, kPlaces[1])});
  page.element("floor").fire("pointerup", {pointerId: 1, ...at(page, kPlaces[1])});
  assert.match(text(page, "panel-control"), /Robot 1 is selected/);
  page.element("command-hold").click();
  await settled();
  assert.equal(text(page, "command-result"), "Robot 1: hold sent");
  assert.equal(page.requests.at(-1).headers.Authorization, "Bearer secret");
  page.tick();
  await settled();
  assert.equal(text(page, "command-result"), "Robot 1: hold 17 refused: there are too many holds");
});

/** Opens a page that may command, and selects robot 1. */
async function openWithSelection() {
  const page = await openMonitor({hash: "#token=secret"}, {can_command: true});
  for (const type of ["pointerdown", "pointerup"]) page.element("floor").fire(type, {pointerId: 1, ...at(page, kPlaces[1])});
  return page;
}
const answerOf = (status, body) => ({ok: status === 200, status, text: async () => JSON.stringify(body)});

test("a fault that nobody has answered may have been applied, and is not said to be refused", async () => {
  const page = await openWithSelection();
  const shown = async (answer) => {
    page.answers["/api/robots/1/fault"] = answer;
    page.element("command-lift").click();
    await settled();
    return text(page, "command-result");
  };
  assert.equal(await shown(() => answerOf(504, {error: "the simulator does not answer"})),
               "Robot 1: lift: no answer; it may have been applied");
  assert.equal(await shown(() => answerOf(409, {error: "robot 1 is off the floor"})), "Robot 1: lift refused: robot 1 is off the floor");
  assert.equal(await shown(() => answerOf(500, {error: "the disk is full"})), "Robot 1: lift failed: the disk is full");
  assert.match(await shown(() => Promise.reject(new Error("connection lost"))), /^Robot 1: lift: no answer; it may have been applied /);
});

test("a slow answer to a fault does not hide what became of a later command", async () => {
  const page = await openWithSelection();
  for (const status of [200, 504]) {
    let finish = (_) => {};
    page.answers = {"/api/robots/1/fault": () => new Promise((resolve) => (finish = resolve)), "/api/robots/1/hold": {order: 17}};
    page.element("command-lift").click();
    page.element("command-hold").click();
    await settled();
    assert.equal(text(page, "command-result"), "Robot 1: hold sent");
    finish(answerOf(status, {}));
    await settled();
    assert.equal(text(page, "command-result"), "Robot 1: hold sent");
  }
});

/** The pixel of the canvas that shows a place. */
function at(page, place) {
  const {x, y} = globalThis.monitor.floor.toPixels(place);
  return {offsetX: x, offsetY: y};
}

test("a click selects a robot, its row is marked and scrolled to, and the mark is drawn in the colour of texts", async () => {
  for (const prefersLight of [false, true]) {
    const page = await openMonitor({prefersLight});
    const row = [...page.element("panel-robots")].find((node) => node.dataset.key === "1");
    row.getBoundingClientRect = () => ({top: 700, bottom: 720});
    row.offsetHeight = 20;
    row.closest(".panel-body").getBoundingClientRect = () => ({top: 100, bottom: 600});
    const {floor} = globalThis.monitor, colour = prefersLight ? "#15191d" : "#e8ecf0";
    floor.draw();
    assert.ok(!floor.context.styles.has(colour));
    page.element("floor").fire("pointerdown", {pointerId: 1, ...at(page, kPlaces[1])});
    page.element("floor").fire("pointerup", {pointerId: 1, ...at(page, kPlaces[1])});
    floor.draw();
    assert.equal(floor.selected, 1);
    assert.equal(row.dataset.selected, "true");
    assert.equal(row.closest(".panel-body").scrollTop, 120);
    assert.ok(floor.context.styles.has(colour));
  }
});

test("a drag on a robot moves the floor if the page may not command, and gives an order if it may", async () => {
  for (const mayCommand of [false, true]) {
    const page = await openMonitor(mayCommand ? {hash: "#token=secret"} : {}, {can_command: mayCommand});
    const {floor} = globalThis.monitor;
    const centre = {...floor.view.centre}, goal = {x: 1, y: 2}, end = at(page, goal);
    page.element("floor").fire("pointerdown", {pointerId: 1, ...at(page, kPlaces[0])});
    page.element("floor").fire("pointermove", {pointerId: 1, ...end});
    page.element("floor").fire("pointerup", {pointerId: 1, ...end});
    await settled();
    const order = page.requests.find((request) => request.path === "/api/robots/0/order");
    assert.equal(Boolean(order), mayCommand);
    assert.equal(floor.view.centre.x !== centre.x, !mayCommand);
    if (order) assert.deepEqual(JSON.parse(order.body).goals[0].map((v) => Math.round(v * 100) / 100), [goal.x, goal.y]);
  }
});

test("keys fit the floor and the robots", async () => {
  const page = await openMonitor();
  const {view} = globalThis.monitor.floor;
  const whole = view.scale;
  page.key("z");
  assert.ok(view.scale > 1.5 * whole);
  for (const place of kPlaces) {
    const {x, y} = view.toPixels(place);
    assert.ok(x > 0 && x < view.width && y > 0 && y < view.height);
  }
  page.key("f");
  assert.equal(view.scale, whole);
});

test("presets and boxes switch layers, and the page remembers them", async () => {
  const page = await openMonitor();
  assert.equal(page.element("preset-standard").getAttribute("aria-pressed"), "true");
  page.element("preset-perception").click();
  assert.equal(page.element("layer-seen").checked, true);
  assert.equal(page.element("layer-executing").checked, false);
  assert.equal(page.element("preset-perception").getAttribute("aria-pressed"), "true");
  page.element("layer-ledger").check(true);
  for (const name of ["standard", "perception"]) assert.equal(page.element(`preset-${name}`).getAttribute("aria-pressed"), "false");
  const again = await openMonitor({storage: page.storage});
  assert.equal(again.element("layer-ledger").checked, true);
  assert.equal(again.element("layer-executing").checked, false);
});

test("columns are chosen, remembered, and a warning in a hidden one is announced", async () => {
  const page = await openMonitor();
  const heads = (on) => [...on.element("panel-robots")].filter((node) => node.tagName === "TH" && !node.hidden).map((node) => node.textContent);
  assert.deepEqual(heads(page), ["Robot", "State", "Order", "To go m", "m/s", "Waits for", "Denied"]);
  const summary = [...page.element("columns-robots")].find((node) => node.tagName === "SUMMARY");
  assert.equal(summary.textContent, "Columns");
  const panels = panelsOf(kRobots);
  panels.robots[0].off_reference = true;
  page.receive(panels);
  assert.equal(summary.textContent, "Columns !");
  assert.match(summary.title, /Error mm/);
  page.element("column-robots-error").check(true);
  page.element("column-robots-denied").check(false);
  assert.equal(summary.textContent, "Columns");
  const again = await openMonitor({storage: page.storage});
  assert.deepEqual(heads(again), ["Robot", "State", "Order", "To go m", "m/s", "Waits for", "Error mm"]);
});

test("panels become windows, are closed, and come back; the page remembers them", async () => {
  const page = await openMonitor();
  const homeOf = (on, id) => on.element(`panel-${id}`).parentNode.id;
  page.element("move-events").click();
  assert.equal(homeOf(page, "events"), "windows");
  assert.equal(page.element("panel-events").hidden, false);
  assert.equal(page.element("tab-events").hidden, true);
  page.element("close-robots").click();
  assert.equal(page.element("panel-robots").hidden, true);
  assert.equal(page.element("panel-coordinators").hidden, false);
  const again = await openMonitor({storage: page.storage});
  assert.equal(homeOf(again, "events"), "windows");
  assert.equal(again.element("tab-robots").hidden, true);
  again.element("menu-robots").check(true);
  assert.equal(again.element("panel-robots").hidden, false);
  again.element("reset-panels").click();
  assert.equal(homeOf(again, "events"), "panels");
  assert.equal(again.element("tab-events").hidden, false);
});

test("a tab that is dragged over the floor becomes a window there, and goes back when it is dropped on the side", async () => {
  const page = await openMonitor();
  page.element("side").getBoundingClientRect = () => ({left: 1050, x: 1050, y: 0, width: 450, height: 900});
  page.element("tab-topics").fire("pointerdown", {clientX: 1200, clientY: 60});
  page.windowEvents.fire("pointermove", {clientX: 400, clientY: 300});
  page.windowEvents.fire("pointerup", {clientX: 400, clientY: 300});
  const panel = page.element("panel-topics");
  assert.equal(panel.parentNode.id, "windows");
  assert.deepEqual([panel.style.left, panel.style.top], ["340px", "288px"]);
  const bar = panel.children[0];
  bar.fire("pointerdown", {clientX: 400, clientY: 300});
  page.windowEvents.fire("pointermove", {clientX: 1300, clientY: 300});
  page.windowEvents.fire("pointerup", {clientX: 1300, clientY: 300});
  assert.equal(panel.parentNode.id, "panels");
  assert.equal(panel.hidden, false);
});

test("the side closes and gives the floor its room", async () => {
  const page = await openMonitor();
  page.key("p");
  assert.equal(page.element("side").hidden, true);
  assert.equal(page.element("splitter").hidden, true);
  page.element("menu-side").check(true);
  assert.equal(page.element("side").hidden, false);
  for (const id of ["robots", "events", "coordinators", "topics", "inspect"]) page.element(`close-${id}`).click();
  assert.equal(page.element("side").hidden, true);
});

test("on a narrow page windows are tabs", async () => {
  const page = await openMonitor();
  page.element("move-events").click();
  const narrow = await openMonitor({storage: page.storage, isNarrow: true});
  assert.equal(narrow.element("panel-events").parentNode.id, "panels");
  assert.equal(narrow.element("tab-events").hidden, false);
});

test("each empty panel says why it is empty", async () => {
  const page = await openMonitor();
  page.receive(panelsOf([]));
  for (const id of ["robots", "events", "coordinators", "topics", "inspect"]) {
    const hints = [...page.element(`panel-${id}`)].filter((node) => node.className === "hint" && !node.hidden);
    assert.ok(hints.length >= 1, id);
    for (const hint of hints) assert.ok(hint.textContent.length > 20, id);
  }
  page.receive(panelsOf(kRobots));
  assert.equal([...page.element("panel-robots")].filter((node) => node.className === "hint" && !node.hidden).length, 0);
});

test("after a jump the trails of the new moment are fetched", async () => {
  const page = await openMonitor();
  await settled();
  const wanted = () => page.requests.filter((request) => request.path.startsWith("/api/trails"));
  assert.equal(wanted().length, 1);
  page.receive(frameOf(104.025, kPlaces));
  page.draw();
  assert.equal(wanted().length, 1);
  page.answers["/api/trails"] = {robots: [{id: 0, points: [[101.5, -3, 1], [101.9, -2.5, 1]]}]};
  page.receive(frameOf(102, kPlaces));
  page.draw();
  await settled();
  await settled();
  assert.equal(wanted().length, 2);
  assert.deepEqual(globalThis.monitor.trails.before(0, 102).map((p) => p.x), [-3, -2.5]);
});

test("trails are fetched again after an answer that was cut off", async () => {
  const page = await openMonitor();
  await settled();
  const jumpTo = async (time) => {
    page.receive(frameOf(time, kPlaces));
    page.draw();
    await settled();
    await settled();
  };
  page.answers["/api/trails"] = () => ({ok: true, json: () => Promise.reject(new Error("cut off"))});
  await jumpTo(102);
  page.answers["/api/trails"] = () => Promise.reject(new Error("no connection"));
  await jumpTo(108);
  page.answers["/api/trails"] = {robots: [{id: 0, points: [[105.5, -3, 1]]}]};
  await jumpTo(106);
  assert.ok(globalThis.monitor.trails.before(0, 106).some((p) => p.x === -3));
});

test("without a scenario the robots are fitted, as they are found", async () => {
  const page = await openMonitor({}, {is_known: false});
  const {floor} = globalThis.monitor;
  page.receive(frameOf(105, [...kPlaces, {id: 2, x: 40, y: 30}]));
  assert.equal(floor.hasOutsiders(), false);
  floor.zoom(4);
  page.receive(frameOf(105.1, [...kPlaces, {id: 2, x: 60, y: 30}]));
  assert.equal(floor.hasOutsiders(), true);  // the person has chosen another view
});

test("the link to the planning page keeps the right to command", async () => {
  const page = await openMonitor({hash: "#token=secret"}, {can_command: true});
  assert.equal(page.element("planning-link").hash, "token=secret");
});

test("the theme is that of the system until a person chooses one, and it is remembered", async () => {
  const light = await openMonitor({prefersLight: true});
  assert.equal(document.documentElement.dataset.theme, "light");
  light.key("t");
  assert.equal(document.documentElement.dataset.theme, "dark");
  await openMonitor({prefersLight: true, storage: light.storage});
  assert.equal(document.documentElement.dataset.theme, "dark");
});
