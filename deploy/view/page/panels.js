// SPDX-License-Identifier: Apache-2.0
// The tables beside the floor.
import {create, element, number, percent, timeOfDay} from "./format.js";

/** @typedef {{title: string, text?: boolean, wraps?: boolean}} Column */
/** @typedef {{text: string, level?: string}} Cell */

/** @param {Column} column */
const classOf = (column) => (column.wraps ? "text wraps" : column.text ? "text" : "");

/** A table whose cells are changed in place. */
export class Table {
  /** @param {Column[]} columns @param {string} label */
  constructor(columns, label) {
    this.columns = columns;
    const head = create("tr", {}, ...columns.map((c) => create("th", {scope: "col", class: classOf(c)}, c.title)));
    this.body = create("tbody");
    this.node = create("table", {"aria-label": label}, create("thead", {}, head), this.body);
    /** @type {(key: any) => void} */
    this.onClick = () => {};
  }

  /** @param {{key: any, cells: (string | Cell)[], selected?: boolean}[]} rows */
  update(rows) {
    while (this.body.rows.length > rows.length) this.body.deleteRow(-1);
    while (this.body.rows.length < rows.length) {
      const row = this.body.insertRow();
      row.className = "clickable";
      row.addEventListener("click", () => this.onClick(row.key));
      for (const column of this.columns) row.insertCell().className = classOf(column);
    }
    rows.forEach((row, i) => {
      const node = this.body.rows[i];
      node.key = row.key;
      node.dataset.key = String(row.key);
      node.dataset.selected = String(Boolean(row.selected));
      row.cells.forEach((cell, k) => {
        const text = typeof cell === "string" ? cell : cell.text;
        const level = typeof cell === "string" ? "" : cell.level || "";
        const td = node.cells[k];
        if (td.textContent !== text) td.textContent = text;
        const name = `${classOf(this.columns[k])} ${level}`.trim();
        if (td.className !== name) td.className = name;
      });
    });
  }
}

/** The tabs, of which one is shown. */
export class Tabs {
  constructor() {
    /** @type {Map<string, {button: any, node: any}>} */
    this.tabs = new Map();
    this.shown = "";
    /** @type {(name: string) => void} */
    this.onShow = () => {};
  }

  /** @param {string} id @param {string} title @param {Node} node */
  add(id, title, node) {
    const button = create("button", {role: "tab", id: `tab-${id}`, "aria-controls": `panel-${id}`}, title);
    const panel = create("div", {role: "tabpanel", id: `panel-${id}`, "aria-labelledby": `tab-${id}`}, node);
    button.addEventListener("click", () => this.show(id));
    element("tabs").append(button);
    element("panels").append(panel);
    this.tabs.set(id, {button, node: panel});
    if (!this.shown) this.show(id);
    else panel.hidden = true;
  }

  /** @param {string} id */
  show(id) {
    this.shown = id;
    for (const [name, tab] of this.tabs) {
      tab.node.hidden = name !== id;
      tab.button.setAttribute("aria-selected", String(name === id));
    }
    this.onShow(id);
  }
}

export const robotTable = new Table(
    [{title: "Robot"}, {title: "State", text: true}, {title: "Order", text: true}, {title: "To go m"}, {title: "m/s"},
     {title: "Verdict ms p50 / p99"}, {title: "Missed"}, {title: "Denied", text: true}, {title: "Clock ms"},
     {title: "Error mm"}],
    "Robots");

/**
 * The reasons of denials, most frequent first.
 * @param {Record<string, number>} reasons
 */
function reasonsText(reasons) {
  return Object.entries(reasons || {}).sort((a, b) => b[1] - a[1]).map(([reason, times]) => `${reason} ${times}`).join(", ");
}

/** @param {any} panels @param {any} scene @param {number} selected */
export function updateRobots(panels, scene, selected) {
  robotTable.update(panels.robots.map((/** @type {any} */ r) => {
    const isSilent = r.state === "silent" || r.age_s > 1;
    const isOff = r.off_reference || r.lifted;
    const bound_mm = scene.tracking_bound_m * 1000;
    const clock = r.clock_offset_ms === undefined
        ? "–" : `${number(r.clock_offset_ms, 2)} ± ${number(r.clock_uncertainty_ms, 2)}`;
    const denied = r.denied ? `${r.denied}${r.blocker === undefined ? "" : ` with ${r.blocker}`} · ` : "";
    return {
      key: r.id,
      selected: r.id === selected,
      cells: [
        String(r.id),
        isSilent ? {text: "silent", level: "error"} : r.state,
        {text: r.order || "–", level: r.order === "blocked" ? "warning" : ""},
        number(r.distance_to_go_m, 2),
        number(r.speed_mps, 2),
        `${number(r.negotiation_p50_ms, 1)} / ${number(r.negotiation_p99_ms, 1)}`,
        {text: `${r.missed_cycles ?? "–"} of ${r.cycles ?? "–"}`, level: r.missed_cycles > 0.01 * r.cycles ? "warning" : ""},
        {text: denied + reasonsText(r.denials_by_reason), level: r.denied ? "warning" : "dim"},
        {text: clock, level: Math.abs(r.clock_offset_ms) > scene.clock_bound_s * 1000 ? "error" : ""},
        {text: `${isOff ? (r.lifted ? "lifted " : "off ") : ""}${number(r.tracking_error_mm, 1)} of ${number(bound_mm, 1)}`,
         level: isOff || r.tracking_error_mm > bound_mm ? "error" : ""},
      ],
    };
  }));
}

const coordinatorTable = new Table(
    [{title: "Coordinator", text: true}, {title: "Mode", text: true}, {title: "Epoch"}, {title: "Heard s ago"},
     {title: "Granted"}, {title: "Denied"}, {title: "Conflicts"}, {title: "Not registered", wraps: true}],
    "Coordinators");
const epochTable = new Table(
    [{title: "Epoch"}, {title: "Begun", text: true}, {title: "By", text: true}, {title: "Why", wraps: true}], "Epochs");
export const coordinatorPanel = create("div", {}, coordinatorTable.node, create("h2", {}, "Epochs"), epochTable.node);

/** @param {any} panels */
export function updateCoordinators(panels) {
  coordinatorTable.update(panels.coordinators.map((/** @type {any} */ c) => ({
    key: c.number,
    cells: [c.name, c.mode, String(c.epoch), {text: number(c.age_s, 2), level: c.age_s > 1 ? "error" : ""},
            String(c.grants), String(c.denials), {text: String(c.conflicts), level: c.conflicts > 0 ? "error" : ""},
            c.missing.join(", ") || "none"],
  })));
  epochTable.update(panels.epochs.slice().reverse().map((/** @type {any} */ e) => ({
    key: e.begun_s, cells: [String(e.epoch), timeOfDay(e.begun_s), e.coordinator, e.reason]})));
}
epochTable.onClick = (/** @type {number} */ at) => seekTo(at);

/**
 * Goes to a moment. Replaced by main.js.
 * @type {(at_s: number) => void}
 */
let seekTo = () => {};
/** @param {(at_s: number) => void} seek */
export function onSeek(seek) {
  seekTo = seek;
}

const topicTable = new Table(
    [{title: "Topic", text: true}, {title: "Hz"}, {title: "kB/s"}, {title: "Last s ago"}, {title: "Lost"},
     {title: "Repeated"}, {title: "Out of order"}, {title: "Delay ms p50 / p99"}, {title: "Senders", text: true}],
    "Topics");
const mismatchList = create("ul", {"aria-label": "Endpoints that do not match"});
const hostList = create("p", {class: "dim"});
export const topicPanel = create("div", {}, mismatchList, topicTable.node, hostList);

/** @param {any[]} senders @param {string} key */
const sum = (senders, key) => senders.reduce((total, sender) => total + sender[key], 0);
/** @param {any[]} senders @param {string} key */
const most = (senders, key) => senders.reduce((worst, sender) => Math.max(worst, sender[key]), 0);

/** @param {any} panels */
export function updateTopics(panels) {
  topicTable.update(panels.topics.map((/** @type {any} */ t) => {
    const lost = sum(t.senders, "lost"), received = sum(t.senders, "received");
    const worst = t.senders.slice().sort((/** @type {any} */ a, /** @type {any} */ b) => b.lost - a.lost)[0];
    const who = t.senders.length === 1 ? t.senders[0].name
        : `${t.senders.length}${worst && worst.lost > 0 ? `; most lost: ${worst.name} ${worst.lost}` : ""}`;
    return {
      key: t.topic,
      cells: [t.topic, number(t.hz, 1), number(t.kB_per_s, 1), number(t.age_s, 1),
              {text: lost === 0 ? "0" : `${lost} (${number(100 * lost / (lost + received), 2)} %)`,
               level: lost > 0.01 * (lost + received) ? "warning" : ""},
              String(sum(t.senders, "repeated")), String(sum(t.senders, "reordered")),
              `${number(most(t.senders, "delay_p50_ms"), 2)} / ${number(most(t.senders, "delay_p99_ms"), 2)}`, who],
    };
  }));
}

/**
 * Shows what DDS reports about processes and hosts.
 * @param {{hosts: any[], mismatches: string[]}} network
 */
export function updateNetwork(network) {
  mismatchList.replaceChildren(...network.mismatches.map((/** @type {string} */ m) => create("li", {class: "error"}, m)));
  hostList.textContent = network.hosts.map((/** @type {any} */ h) => `${h.host}: ${h.participants.join(", ")}`).join(" · ");
}

const eventTable = new Table([{title: "Time", text: true}, {title: "What", text: true}, {title: "", wraps: true}], "Events");
export const eventPanel = eventTable.node;
const kShownEvents = 300;
eventTable.onClick = (/** @type {number} */ at) => seekTo(at);

/** @param {any[]} events */
export function updateEvents(events) {
  eventTable.update(events.slice(-kShownEvents).reverse().map((e) => ({
    key: e.at_s,
    cells: [timeOfDay(e.at_s), {text: e.kind, level: e.severity === "info" ? "" : e.severity},
            {text: e.text, level: e.severity === "error" ? "error" : ""}],
  })));
}

/** @type {Record<string, string>} */
const kShapes = {"kept": "✓", "broken": "✕", "not judged": "?"};

/** @param {any} promise */
const verdictText = (promise) =>
    (promise.state === "kept" ? "promise kept" : promise.state === "broken" ? "promise broken" : "not judged");

/**
 * The verdict on the whole recording, beside that on the moment shown.
 * @param {any} whole @param {any} scene
 */
export function updateWhole(whole, scene) {
  const {promise} = whole;
  const text = !whole.is_over ? "reading" : `${kShapes[promise.state] || "?"} ${verdictText(promise)}`;
  element("lamp-whole").textContent = scene.is_recording ? `whole recording: ${text}` : "";
}

/** @param {any} promise */
export function updateLamp(promise) {
  const lamp = element("lamp");
  lamp.dataset.state = promise.state;
  element("lamp-shape").textContent = kShapes[promise.state] || "?";
  element("lamp-text").textContent = verdictText(promise);
  const smallest = promise.smallest;
  const figures = [];
  if (promise.contacts !== undefined)
    figures.push(`${promise.contacts} contacts`, `${promise.violations} violations`, `coverage ${percent(promise.coverage)}`,
                 `${promise.missed_cycles} of ${promise.cycles} cycles missed`);
  if (smallest)
    figures.push(`smallest clearance ${number(smallest.clearance_m * 1000, 1)} mm (robots ${smallest.robots.join(" and ")})`);
  if (promise.reason) figures.push(promise.reason);
  element("promise-figures").textContent = figures.join(" · ");
}
