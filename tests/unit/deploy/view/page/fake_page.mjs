// SPDX-License-Identifier: Apache-2.0
// As much of a browser as the page needs to run in Node.js: elements, events and a canvas that remembers what is drawn.
// It has no layout; tests/faults/monitor_layout_test.cpp looks at that in a real browser.
import {readFileSync} from "node:fs";
import {fileURLToPath} from "node:url";

export const pageFolder = new URL("../../../../../deploy/view/page/", import.meta.url);
export const pageFile = (name) => readFileSync(fileURLToPath(new URL(name, pageFolder)), "utf8");

class FakeEvents {
  constructor() {
    this.listeners = [];
  }
  addEventListener(type, listener) {
    this.listeners.push([type, listener]);
  }
  removeEventListener(type, listener) {
    this.listeners = this.listeners.filter(([t, l]) => t !== type || l !== listener);
  }
  /** Calls the listeners of this object; events do not bubble. */
  fire(type, properties = {}) {
    const event = {type, target: this, button: 0, preventDefault() {}, ...properties};
    for (const [wanted, listener] of this.listeners.slice()) if (wanted === type) listener(event);
  }
}

/** Draws nothing; remembers texts, and the fill and stroke styles that were used. */
class FakeCanvas {
  constructor() {
    this.texts = [];
    this.styles = new Set();
  }
  getTransform() {
    return {a: 1, d: -1, e: 0, f: 0};
  }
  measureText(text) {
    return {width: 7 * text.length};
  }
  createImageData(width, height) {
    return {data: new Uint8ClampedArray(4 * width * height)};
  }
  fillText(text, x, y) {
    this.texts.push({text, x, y, font: this.font, colour: this.fillStyle});
  }
  clearRect() {
    this.texts = [];
    this.styles.clear();
  }
  stroke() {
    this.styles.add(this.strokeStyle);
  }
  fill() {
    this.styles.add(this.fillStyle);
  }
}
for (const name of ["setTransform", "save", "restore", "beginPath", "moveTo", "lineTo", "arc", "fillRect", "strokeRect", "strokeText",
                    "setLineDash", "putImageData", "drawImage", "translate", "scale"])
  FakeCanvas.prototype[name] = function () {};

class FakeElement extends FakeEvents {
  constructor(tag) {
    super();
    Object.assign(this, {tagName: tag.toUpperCase(), children: [], parentNode: null, dataset: {}, style: {}, hidden: false, value: "",
                         checked: false, disabled: false, title: "", className: "", tabIndex: -1, scrollTop: 0, own: "", attributes: new Map()});
    this.clientWidth = this.offsetWidth = 900;
    this.clientHeight = this.offsetHeight = 600;
    this.classes = new Set();
    this.classList = {toggle: (name, on) => (on ? this.classes.add(name) : this.classes.delete(name)),
                      remove: (name) => this.classes.delete(name), contains: (name) => this.classes.has(name)};
  }
  setAttribute(name, value) {
    this.attributes.set(name, value);
    if (name === "id") this.id = value;
    if (name === "class") this.className = value;
    if (name === "title") this.title = value;
    if (name === "type") this.type = value;
    if (name === "value") this.value = value;
    if (name === "hidden") this.hidden = true;
    if (name.startsWith("data-")) this.dataset[name.slice(5)] = value;
  }
  getAttribute(name) {
    return this.attributes.get(name) ?? null;
  }
  hasAttribute(name) {
    return this.attributes.has(name);
  }
  get textContent() {
    return this.own + this.children.map((child) => child.textContent).join("");
  }
  set textContent(text) {
    this.children = [];
    this.own = text;
  }
  append(...nodes) {
    for (const node of nodes) this.insertBefore(typeof node === "string" ? textNode(node) : node, null);
  }
  insertBefore(node, before) {
    node.parentNode?.children.splice(node.parentNode.children.indexOf(node), 1);
    node.parentNode = this;
    this.children.splice(before ? this.children.indexOf(before) : this.children.length, 0, node);
  }
  replaceChildren(...nodes) {
    this.children = [];
    this.append(...nodes);
  }
  *[Symbol.iterator]() {
    yield this;
    for (const child of this.children) yield* child;
  }
  querySelector(selector) {
    const key = /^\[data-key="(.*)"\]$/.exec(selector)?.[1];
    return [...this].find((node) => key !== undefined && node.dataset.key === key) ?? null;
  }
  querySelectorAll() {
    return [];
  }
  /** Knows classes only. */
  closest(selector) {
    for (let node = this; node; node = node.parentNode) if (selector === `.${node.className}`) return node;
    return null;
  }
  click() {
    this.fire("click");
  }
  /** Changes a check box as a person does. */
  check(on) {
    this.checked = on;
    this.fire("change");
  }
  focus() {}
  setPointerCapture() {}
  getBoundingClientRect() {
    return {x: 0, y: 0, left: 0, top: 0, bottom: 0, width: this.offsetWidth, height: this.offsetHeight};
  }
  getContext() {
    return (this.context ??= new FakeCanvas());
  }
  // Tables
  get rows() {
    return this.children;
  }
  get cells() {
    return this.children;
  }
  insertRow() {
    const row = new FakeElement("tr");
    this.append(row);
    return row;
  }
  deleteRow() {
    this.children.pop();
  }
  insertCell() {
    const cell = new FakeElement("td");
    this.append(cell);
    return cell;
  }
}

function textNode(text) {
  const node = new FakeElement("#text");
  node.own = text;
  return node;
}

/** The elements of an HTML file, nested as there. */
function parsed(html) {
  const root = new FakeElement("body"), open = [root];
  for (const [, close, tag, attributes] of html.replace(/^[\s\S]*<body/, "<body").matchAll(/<(\/?)([a-z0-9]+)([^>]*)>/g)) {
    if (tag === "body") continue;
    if (close) {
      open.pop();
      continue;
    }
    const node = new FakeElement(tag);
    for (const [, name, value] of attributes.matchAll(/([a-z-]+)(?:="([^"]*)")?/g)) node.setAttribute(name, value ?? "");
    open.at(-1).append(node);
    if (!["input", "br"].includes(tag)) open.push(node);
  }
  return root;
}

/** The colours of a theme in the style sheet. */
export function coloursOf(theme) {
  const style = pageFile("style.css");
  const block = (selector) => style.slice(style.indexOf(selector) + selector.length).split("}")[0];
  const found = {};
  for (const text of theme === "dark" ? [block(":root {")] : [block(":root {"), block(":root[data-theme=\"light\"] {")])
    for (const [, name, value] of text.matchAll(/--([a-z-]+): (#[0-9a-f]{6})/g)) found[name] = value;
  return found;
}

/** Makes `html` the page of this process. Returns what tests do to it. */
export function openPage(html, {hash = "", storage = {}, prefersLight = false, isNarrow = false} = {}) {
  const body = parsed(pageFile(html));
  const page = {body, storage: {...storage}, sent: [], requests: [], answers: {}, windowEvents: new FakeEvents(), sockets: []};
  page.element = (id) => [...body].find((node) => node.id === id) ?? null;
  const root = new FakeElement("html");
  const define = (name, value) => Object.defineProperty(globalThis, name, {value, configurable: true, writable: true});
  define("window", globalThis);
  define("document", {documentElement: root, body, getElementById: page.element, createElement: (tag) => new FakeElement(tag),
                      addEventListener() {}, querySelectorAll: () => [], querySelector: () => null});
  define("location", {hash, host: "127.0.0.1:8080", href: "http://127.0.0.1:8080/" + hash});
  define("history", {replaceState: (_, __, url) => (page.url = url)});
  define("navigator", {});
  define("localStorage", {getItem: (key) => page.storage[key] ?? null, setItem: (key, value) => (page.storage[key] = value)});
  define("matchMedia", (query) => ({matches: query.includes("light") ? prefersLight : isNarrow, addEventListener() {}}));
  define("getComputedStyle", () => ({
           getPropertyValue: (name) => coloursOf(root.dataset.theme === "light" ? "light" : "dark")[name.slice(2)] ?? ""}));
  define("ResizeObserver", class {
    constructor(callback) {
      this.callback = callback;
    }
    observe() {
      this.callback();
    }
  });
  define("Path2D", FakeCanvas);
  FakeCanvas.prototype.rect = FakeCanvas.prototype.closePath = FakeCanvas.prototype.quadraticCurveTo =
      FakeCanvas.prototype.bezierCurveTo = () => {};
  define("Element", FakeElement);
  define("innerWidth", 1500);
  define("innerHeight", 900);
  define("devicePixelRatio", 1);
  define("addEventListener", (type, listener) => page.windowEvents.addEventListener(type, listener));
  define("removeEventListener", (type, listener) => page.windowEvents.removeEventListener(type, listener));
  let drawing = () => {};
  define("requestAnimationFrame", (callback) => (drawing = callback));
  page.draw = () => drawing();
  const timers = [];
  define("setInterval", (callback) => timers.push(callback));
  define("setTimeout", (callback) => timers.push(callback));
  /** Calls everything that waits for time to pass. */
  page.tick = () => timers.slice().forEach((callback) => callback());
  define("fetch", async (path, options = {method: "GET"}) => {
    page.requests.push({path, ...options});
    const answer = page.answers[path.split("?")[0]];
    if (typeof answer === "function") return answer();
    return {ok: Boolean(answer && !answer.error), text: async () => JSON.stringify(answer ?? {error: "there is no " + path}),
            json: async () => answer};
  });
  define("WebSocket", class {
    static OPEN = 1;
    constructor() {
      this.readyState = 1;
      page.sockets.push(this);
    }
    send(text) {
      page.sent.push(JSON.parse(text));
    }
  });
  page.socket = () => page.sockets.at(-1);
  page.receive = (message) => page.socket().onmessage({data: message instanceof ArrayBuffer ? message : JSON.stringify(message)});
  page.key = (key) => page.windowEvents.fire("keydown", {key, target: body});
  return page;
}

const kRobotColumns = ["id", "flags", "state", "true_x", "true_y", "true_heading", "seen_x", "seen_y", "seen_heading", "x", "y", "heading",
                       "denied", "blocker", "goal_x", "goal_y", "via_x", "via_y", "nearest_x", "nearest_y",
                       "waits_for"];
const kVersionColumns = ["start", "x", "y", "vx", "vy", "inflation", "phases", "duration0", "ax0", "ay0"];
const kRobots = [...kRobotColumns, ...["executing", "granted", "proposed"].flatMap((v) => kVersionColumns.map((c) => `${v}_${c}`))];
const kSections = [{name: "robots", columns: kRobots}, {name: "ledger", columns: ["id", ...kVersionColumns.map((c) => `version_${c}`)]},
                   {name: "obstacles", columns: ["id", "x", "y", "vx", "vy", "radius", "age"]}, {name: "balls", columns: ["x", "y", "vx", "vy"]},
                   {name: "detections", columns: ["camera", "kind", "x", "y", "heading", "radius"]}, {name: "beams", columns: ["robot", "x", "y"]},
                   {name: "courses", columns: ["robot", "ahead", "x", "y", "vx", "vy"]}];

/** A scene as the monitor sends it. */
export function sceneOf(robots, changes = {}) {
  return {type: "scene", name: "test", is_known: true, field: {length_m: 9, width_m: 6}, radius_m: 0.09, margin_m: 0.03, tracking_bound_m: 0.02,
          clock_bound_s: 0.005, speed_mps: 2, opponent_speed_mps: 2, cycle_s: 0.0167, cameras: 0, obstacles: [], robots,
          layout: {sections: kSections, flags: ["off_reference", "lifted", "held", "blocked"]}, is_recording: false, can_command: false, has_messages: true,
          channels: ["feedback/0"], ...changes};
}

/** A frame with robots at these places, and with these rows of courses, as the monitor sends it. */
export function frameOf(time, places, courses = []) {
  const head = 12 + 4 * kSections.length;
  const buffer = new ArrayBuffer(head + 4 * (places.length * kRobots.length + courses.flat().length));
  const view = new DataView(buffer);
  view.setFloat64(0, time, true);
  view.setUint32(8, kSections.length, true);
  view.setUint32(12, places.length, true);
  view.setUint32(head - 4, courses.length, true);
  const values = new Float32Array(buffer, head);
  values.fill(NaN);
  values.set(courses.flat(), places.length * kRobots.length);
  places.forEach(({id, x, y, ...others}, i) => {
    const row = {id, flags: 0, state: 3, true_x: x, true_y: y, true_heading: 0, ...others};
    for (const [name, value] of Object.entries(row)) values[i * kRobots.length + kRobots.indexOf(name)] = value;
  });
  return buffer;
}

export function panelsOf(robots, changes = {}) {
  return {type: "panels", at_s: 100, promise: {state: "kept", reason: "", closest: null, smallest: null, contacts: 0, violations: 0, coverage: 1,
                                              cycles: 100, missed_cycles: 0},
          robots: robots.map(({id}) => ({id, state: "driving", age_s: 0, speed_mps: 1, distance_to_go_m: 2, denials_by_reason: {}, goals: [],
                                         cycles: 100, missed_cycles: 0})),
          coordinators: [], epochs: [], zones: [], topics: [], ...changes};
}

export const timeOf = (changes = {}) => ({type: "time", mode: "live", speed: 1, begin_s: 100, end_s: 110, first_grant_s: 101, progress: 1,
                                           ...changes});
