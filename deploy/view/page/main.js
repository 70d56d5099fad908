// SPDX-License-Identifier: Apache-2.0
// The monitor's page: connects its parts.
import {Cameras} from "./cameras.js";
import {Connection} from "./connection.js";
import {Controls} from "./controls.js";
import {watchFields} from "./fields.js";
import {Floor} from "./floor.js";
import {create, element} from "./format.js";
import {Frame, Layout} from "./frame.js";
import {onMapLoaded} from "./floor_layers.js";
import {layers} from "./layers.js";
import {coordinatorPanel, eventPanel, onSeek, robotTable, Tabs, topicPanel, updateCoordinators, updateEvents, updateLamp,
        updateNetwork, updateRobots, updateTopics, updateWhole} from "./panels.js";
import {Inspector} from "./plots.js";
import {shared} from "./shapes.js";
import {Timeline} from "./timeline.js";

const link = new URLSearchParams(location.hash.slice(1));
const token = link.get("token") || "";

/** State for tests and for debugging. */
const monitor = {frames: 0, script_ms: /** @type {number[]} */ ([]), panels: /** @type {any} */ (null),
                 scene: /** @type {any} */ (null), frame: /** @type {any} */ (null), events: /** @type {any[]} */ ([]),
                 event_received_ms: /** @type {number[]} */ ([]), connection: "connecting"};
/** @type {any} */ (window).monitor = monitor;

const send = (/** @type {object} */ message) => connection.send(message);
const floor = new Floor(layers);
const timeline = new Timeline(send);
const inspector = new Inspector(send);
const controls = new Controls(token);
const tabs = new Tabs();
const cameras = new Cameras(() => tabs.shown === "cameras" && monitor.connection === "connected");
/** @type {Layout | null} */
let layout = null;

tabs.add("robots", "Robots", robotTable.node);
tabs.add("events", "Events", eventPanel);
tabs.add("coordinators", "Coordinators", coordinatorPanel);
tabs.add("topics", "Topics", topicPanel);
tabs.add("inspect", "Messages and plots", inspector.node);

// Requested only while the tab is shown, because discovery costs the run's processes some work.
setInterval(async () => {
  if (tabs.shown !== "topics" || !monitor.scene || monitor.scene.is_recording || monitor.connection !== "connected") return;
  const response = await fetch("/api/network").catch(() => null);
  if (response && response.ok) updateNetwork(await response.json());
}, 2000);

const fieldLayers = layers.filter((layer) => ["navigation", "local", "band"].includes(layer.id));
watchFields(() => (timeline.mode === "live" && fieldLayers.some((layer) => layer.on) ? floor.selected : -1),
            () => (floor.isStale = true));

/** @param {number} robot */
function select(robot) {
  floor.selected = robot;
  controls.select(robot);
  floor.isStale = true;
  if (monitor.panels) updateRobots(monitor.panels, monitor.scene, robot);
}
floor.onSelect = select;
floor.onDrag = (/** @type {number} */ robot, /** @type {number} */ x, /** @type {number} */ y) => {
  if (!monitor.scene.can_command) return;
  select(robot);
  controls.post(`/api/robots/${robot}/order`, {goals: [[x, y]]});
};
robotTable.onClick = select;
onMapLoaded(() => (floor.isStale = true));
onSeek((at_s) => timeline.seek(at_s));

/** @param {any} scene */
function useScene(scene) {
  const isFirst = !monitor.scene;
  monitor.scene = floor.scene = scene;
  layout = new Layout(scene.layout);
  scene.layout = layout;
  scene.teams = new Map(scene.robots.map((/** @type {any} */ robot) => [robot.id, robot.team]));
  element("title").textContent = scene.name ? `Sidestep: ${scene.name}` : "Sidestep";
  element("live").textContent = scene.is_recording ? "End" : "Live";
  timeline.isRecording = scene.is_recording;
  inspector.setChannels(scene.channels);
  if (scene.can_command && isFirst) tabs.add("control", "Control", controls.node);
  if (isFirst && scene.cameras > 0 && !scene.is_recording) {
    tabs.add("cameras", "Cameras", cameras.node);
    cameras.start(scene.cameras);
  }
  element("bookmark").hidden = element("record").hidden = !scene.can_command;
  if (isFirst) floor.fit();
  if (inspector.channel.value) inspector.choose();
  const at_s = Number(link.get("t"));
  if (isFirst && at_s > 0) timeline.seek(at_s);
}

function useEvents() {
  timeline.events = monitor.events;
  updateEvents(monitor.events);
  timeline.draw();
}

/** @param {any} message */
function onMessage(message) {
  switch (message.type) {
    case "scene":
      return useScene(message);
    case "events":
      monitor.events = message.events;
      return useEvents();
    case "event":
      monitor.events.push(message);
      monitor.event_received_ms.push(Date.now() - 1000 * message.at_s);
      return useEvents();
    case "panels":
      monitor.panels = message;
      shared.zones = message.zones;
      shared.goals = new Map(message.robots.map((/** @type {any} */ robot) => [robot.id, robot.goals]));
      updateLamp(message.promise);
      updateRobots(message, monitor.scene, floor.selected);
      updateCoordinators(message);
      updateTopics(message);
      return;
    case "whole":
      return updateWhole(message, monitor.scene);
    case "time":
      return timeline.update(message);
    case "messages":
      return inspector.update(message);
  }
}

const connection = new Connection(
    "sidestep.monitor.v1", onMessage,
    (buffer) => {
      if (!layout) return;
      monitor.frame = floor.frame = new Frame(buffer, layout);
      ++monitor.frames;
      floor.isStale = true;
    },
    (state) => {
      monitor.connection = state;
      timeline.isConnected = state === "connected";
      if (timeline.shown_s > 0) timeline.show(timeline.shown_s);
      element("connection").textContent = state === "lost" ? "connection lost, trying again" : "connected";
      element("connection").dataset.state = state;
    });

function draw() {
  requestAnimationFrame(draw);
  if (!floor.frame || !floor.isStale) return;
  const begin = performance.now();
  floor.draw();
  timeline.show(floor.frame.time);
  monitor.script_ms.push(performance.now() - begin);
  if (monitor.script_ms.length > 1000) monitor.script_ms.shift();
}
requestAnimationFrame(draw);

element("lamp").addEventListener("click", () => {
  const breach = monitor.events.find((event) => event.severity === "error" && ["contact", "crash", "violation", "firmware"].includes(event.kind));
  const at_s = breach ? breach.at_s : monitor.panels && monitor.panels.promise.smallest && monitor.panels.promise.smallest.at_s;
  if (at_s) timeline.seek(at_s);
});

function bookmark() {
  if (monitor.scene.can_command) controls.post("/api/bookmark", {text: `at ${element("clock").textContent}`});
}
async function record() {
  const button = element("record");
  const begins = button.getAttribute("aria-pressed") !== "true";
  const answer = await controls.post(`/api/recording/${begins ? "start" : "stop"}`);
  if (!answer) return;
  button.setAttribute("aria-pressed", String(begins));
  button.textContent = begins ? "Stop recording" : "Record";
}
function copyLink() {
  const hash = new URLSearchParams(link);
  hash.set("t", timeline.shown_s.toFixed(3));
  history.replaceState(null, "", `#${hash}`);
  if (navigator.clipboard) navigator.clipboard.writeText(location.href).catch(() => {});
}
function changeTheme() {
  const root = document.documentElement;
  root.dataset.theme = root.dataset.theme === "light" ? "dark" : "light";
}
element("bookmark").addEventListener("click", bookmark);
element("record").addEventListener("click", record);
element("link").addEventListener("click", copyLink);
element("theme").addEventListener("click", changeTheme);
if (matchMedia("(prefers-color-scheme: light)").matches) changeTheme();

/** @type {[string, string, () => void][]} */
const keys = [
  [" ", "pause or resume", () => timeline.toggle()],
  [",", "one frame back", () => timeline.step(-1)],
  [".", "one frame forward", () => timeline.step(1)],
  ["[", "previous event", () => timeline.toEvent(-1)],
  ["]", "next event", () => timeline.toEvent(1)],
  ["l", "the newest moment", () => timeline.live()],
  ["b", "bookmark", bookmark],
  ["c", "copy a link to this moment", copyLink],
  ["f", "fit the field", () => floor.fit()],
  ["t", "dark or light", changeTheme],
  ["h", "hold all robots", () => monitor.scene.can_command && controls.post("/api/hold")],
  ["?", "all keys", () => element("help").showModal()],
];

for (const layer of layers) {
  const box = create("input", {type: "checkbox", id: `layer-${layer.id}`});
  box.checked = layer.on;
  const set = (/** @type {boolean} */ on) => {
    layer.on = box.checked = on;
    floor.isStale = true;
  };
  box.addEventListener("change", () => set(box.checked));
  element("layers").append(create("label", {}, box, ` ${layer.name} `, create("kbd", {}, layer.key.toUpperCase())));
  keys.push([layer.key, `layer: ${layer.name}`, () => set(!layer.on)]);
}
for (const [key, what] of keys)
  element("keys").append(create("dt", {}, create("kbd", {}, key === " " ? "space" : key.toUpperCase())), create("dd", {}, what));
element("help-button").addEventListener("click", () => element("help").showModal());

addEventListener("keydown", (event) => {
  const target = /** @type {HTMLElement} */ (event.target);
  if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName)) return;
  if (event.key === " " && target.tagName === "BUTTON") return;
  const found = keys.find(([key]) => key === event.key.toLowerCase());
  if (!found) return;
  event.preventDefault();
  found[2]();
});
