// SPDX-License-Identifier: Apache-2.0
// The tables of coordinators and of their epochs.
import {create, number, timeOfDay} from "./format.js";
import {Table} from "./table.js";

export const coordinatorTable = new Table("coordinators",
    [{id: "name", title: "Coordinator", text: true}, {id: "mode", title: "Mode", text: true}, {id: "epoch", title: "Epoch"},
     {id: "heard", title: "Heard s ago"}, {id: "granted", title: "Granted"}, {id: "denied", title: "Denied"},
     {id: "conflicts", title: "Conflicts"}, {id: "missing", title: "Not registered", wraps: true}],
    "Coordinators", "No coordinator has been heard up to this moment. Robots move only once one of them grants.");
export const epochTable = new Table("epochs",
    [{id: "epoch", title: "Epoch"}, {id: "begun", title: "Begun", text: true}, {id: "by", title: "By", text: true},
     {id: "why", title: "Why", wraps: true}],
    "Epochs", "No epoch has begun up to this moment, or the scenario is not known.");
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
