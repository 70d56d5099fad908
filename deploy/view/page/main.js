// SPDX-License-Identifier: Apache-2.0
// The monitor's page: connects its parts.
import {Cameras} from "./cameras.js";
import {Connection} from "./connection.js";
import {Controls} from "./controls.js";
import {coordinatorPanel, coordinatorTable, epochTable, updateCoordinators} from "./coordinator_panel.js";
import {Dock} from "./dock.js";
import {eventTable, updateEvents} from "./event_panel.js";
import {watchFields} from "./fields.js";
import {Floor} from "./floor.js";
import {onMapLoaded} from "./floor_layers.js";
import {element, setText} from "./format.js";
import {Frame, Layout} from "./frame.js";
import {floorHint} from "./hint.js";
import {startKeys} from "./keys.js";
import {drawn} from "./labels.js";
import {updateLamp, updateWhole} from "./lamp.js";
import {buildLayerMenu} from "./layer_menu.js";
import {layers} from "./layers.js";
import {startMenus} from "./menu.js";
import {Inspector} from "./plots.js";
import {robotTable, updateRobots} from "./robot_panel.js";
import {shared} from "./shapes.js";
import {startSplitter} from "./splitter.js";
import {changeTheme, onThemeChange, startTheme} from "./theme.js";
import {Timeline} from "./timeline.js";
import {topicPanel, topicTable, updateNetwork, updateTopics} from "./topic_panel.js";
import {fetchTrails} from "./trail_source.js";
import {onTrailsNeeded, trails} from "./trails.js";

const link = new URLSearchParams(location.hash.slice(1));
const token = link.get("token") || "";
startTheme();
startMenus();
startSplitter();

const send = (/** @type {object} */ message) => connection.send(message);
const floor = new Floor(layers);
const timeline = new Timeline(send);
const inspector = new Inspector(send);
const controls = new Controls(token);
const dock = new Dock();
const cameras = new Cameras(() => dock.isShown("cameras") && !monitor.scene?.is_recording && monitor.connection === "connected");

/** State for tests and for debugging. */
const monitor = {frames: 0, script_ms: /** @type {number[]} */ ([]), panels: /** @type {any} */ (null),
                 whole: /** @type {any} */ (null), scene: /** @type {any} */ (null), frame: /** @type {any} */ (null),
                 events: /** @type {any[]} */ ([]), event_received_ms: /** @type {number[]} */ ([]), connection: "connecting",
                 floor, timeline, trails, drawn};
/** @type {any} */ (window).monitor = monitor;
/** @type {Layout | null} */
let layout = null;

dock.add("robots", "Robots", robotTable.node, [robotTable.menu]);
dock.add("events", "Events", eventTable.node);
dock.add("coordinators", "Coordinators", coordinatorPanel, [coordinatorTable.menu]);
dock.add("topics", "Topics", topicPanel, [topicTable.menu]);
dock.add("inspect", "Messages and plots", inspector.node);

// Requested only while the panel is shown, because discovery costs the run's processes some work.
setInterval(async () => {
  if (!dock.isShown("topics") || !monitor.scene || monitor.scene.is_recording || monitor.connection !== "connected") return;
  const response = await fetch("/api/network").catch(() => null);
  if (response && response.ok) updateNetwork(await response.json());
}, 2000);

const fieldLayers = layers.filter((layer) => ["navigation", "local", "band"].includes(layer.id));
const wantsField = () => fieldLayers.some((layer) => layer.on);
const redraw = () => (floor.isStale = true);
watchFields(() => (timeline.mode === "live" && !monitor.scene?.is_recording && wantsField() ? floor.selected : -1), redraw);
onMapLoaded(redraw);
onThemeChange(() => {
  redraw();
  timeline.draw();
  inspector.plot.draw();
});
onTrailsNeeded((time) => fetchTrails(time, redraw));

/** @param {number} robot */
function select(robot) {
  floor.selected = robot;
  controls.select(robot);
  redraw();
  if (monitor.panels) updateRobots(monitor.panels, monitor.scene, robot);
  robotTable.reveal(robot);
}
floor.onSelect = select;
floor.onDrag = (/** @type {number} */ robot, /** @type {number} */ x, /** @type {number} */ y) => {
  select(robot);
  controls.go(robot, x, y);
};
robotTable.onClick = select;
eventTable.onClick = epochTable.onClick = (/** @type {number} */ at_s) => timeline.seek(at_s);

/** @param {any} scene */
function useScene(scene) {
  const isFirst = !monitor.scene;
  monitor.scene = floor.scene = scene;
  layout = new Layout(scene.layout);
  scene.layout = layout;
  scene.teams = new Map(scene.robots.map((/** @type {any} */ robot) => [robot.id, robot.team]));
  const canCommand = floor.canCommand = scene.can_command && token !== "";
  element("title").textContent = scene.name ? `Sidestep: ${scene.name}` : "Sidestep";
  timeline.set({isRecording: scene.is_recording});
  inspector.setChannels(scene.channels, scene.has_messages);
  if (scene.can_command && isFirst) dock.add("control", "Control", controls.node);
  controls.allow(canCommand, scene.is_recording);
  if (isFirst && scene.cameras > 0 && !scene.is_recording) {
    dock.add("cameras", "Cameras", cameras.node);
    cameras.start(scene.cameras);
  }
  if (!isFirst && scene.is_recording) cameras.end();
  element("bookmark").hidden = element("record").hidden = !canCommand;
  if (isFirst) floor.fitFloor();
  showVerdicts();
  const at_s = Number(link.get("t"));
  if (isFirst && at_s > 0) timeline.seek(at_s);
}

function useEvents() {
  timeline.events = monitor.events;
  updateEvents(monitor.events);
  timeline.draw();
}

function showVerdicts() {
  const isRecording = Boolean(monitor.scene?.is_recording);
  if (monitor.panels) updateLamp(monitor.panels.promise, isRecording);
  updateWhole(monitor.whole, isRecording, timeline.moment.progress);
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
      showVerdicts();
      updateRobots(message, monitor.scene, floor.selected);
      updateCoordinators(message);
      updateTopics(message);
      return;
    case "whole":
      monitor.whole = message;
      return showVerdicts();
    case "time":
      timeline.update(message);
      return showVerdicts();
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
      // Without a scenario, only the robots tell where the floor is.
      if (!monitor.scene.is_known && floor.fitted && floor.hasOutsiders()) floor.fitRobots();
    },
    (state) => {
      monitor.connection = state;
      timeline.set({isConnected: state === "connected"});
      element("connection").textContent = state === "lost" ? "connection lost, trying again" : "connected";
      element("connection").dataset.state = state;
    });

function showHint() {
  const {first_grant_s, shown_s, mode} = timeline.moment;
  const text = floorHint({
    connection: monitor.connection, hasScene: monitor.scene !== null, isRecording: Boolean(monitor.scene?.is_recording), mode,
    robots: floor.places().filter((place) => Number.isFinite(place.x)).length, wantsField: wantsField(), selected: floor.selected,
    beforeFirstGrant: first_grant_s !== null && shown_s < first_grant_s});
  setText(element("floor-hint"), text);
  element("floor-hint").hidden = text === "";
}
setInterval(showHint, 300);

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

const kBreaches = ["contact", "crash", "violation", "firmware"];
element("lamp").addEventListener("click", () => {
  const breach = monitor.events.find((event) => event.severity === "error" && kBreaches.includes(event.kind));
  const at_s = breach ? breach.at_s : monitor.panels?.promise.smallest?.at_s;
  if (at_s) timeline.seek(at_s);
});

function bookmark() {
  if (floor.canCommand) controls.post("/api/bookmark", {text: `at ${element("clock").textContent}`}, "Bookmark");
}
async function record() {
  const button = element("record");
  const begins = button.getAttribute("aria-pressed") !== "true";
  const answer = await controls.post(`/api/recording/${begins ? "start" : "stop"}`, undefined, "Recording");
  if (!answer) return;
  button.setAttribute("aria-pressed", String(begins));
  button.textContent = begins ? "Stop recording" : "Record";
  if (answer.file) button.title = `${begins ? "Records into" : "Has recorded"} ${answer.file}`;
}
function copyLink() {
  const hash = new URLSearchParams(link);
  hash.set("t", timeline.shown_s.toFixed(3));
  history.replaceState(null, "", `#${hash}`);
  if (navigator.clipboard) navigator.clipboard.writeText(location.href).catch(() => {});
}
// The planning page leads back with the same right to command.
if (token) element("planning-link").hash = `token=${token}`;

for (const [id, act] of /** @type {[string, () => void][]} */ ([
       ["bookmark", bookmark], ["record", record], ["link", copyLink], ["theme", changeTheme],
       ["fit-floor", () => floor.fitFloor()], ["fit-robots", () => floor.fitRobots()]]))
  element(id).addEventListener("click", act);

startKeys([
  [" ", "play or pause", () => timeline.toggle()],
  [",", "one frame back", () => timeline.step(-1)],
  [".", "one frame forward", () => timeline.step(1)],
  ["[", "previous event", () => timeline.toEvent(-1)],
  ["]", "next event", () => timeline.toEvent(1)],
  ["l", "the newest moment", () => timeline.live()],
  ["b", "bookmark", bookmark],
  ["c", "copy a link to this moment", copyLink],
  ["f", "show the whole floor", () => floor.fitFloor()],
  ["z", "show all robots, as large as possible", () => floor.fitRobots()],
  ["+", "zoom in", () => floor.zoom(1.25)],
  ["-", "zoom out", () => floor.zoom(0.8)],
  ["k", "the menu of layers", () => (element("layer-list").open = !element("layer-list").open)],
  ["p", "open or close the side", () => dock.toggleSide()],
  ["t", "dark or light", changeTheme],
  ["h", "hold all robots", () => floor.canCommand && controls.holdAll()],
  ["?", "all keys", () => element("help").showModal()],
  ...buildLayerMenu(redraw),
]);
