// SPDX-License-Identifier: Apache-2.0
// The table of events, the newest first.
import {timeOfDay} from "./format.js";
import {Table} from "./table.js";

const kShownEvents = 300;
export const eventTable = new Table("events",
    [{id: "time", title: "Time", text: true}, {id: "what", title: "What", text: true}, {id: "text", title: "", wraps: true}],
    "Events",
    "Nothing has happened yet. Arrivals, denials that block a robot, takeovers, contacts, orders and faults appear here.");

/** @param {any[]} events */
export function updateEvents(events) {
  eventTable.update(events.slice(-kShownEvents).reverse().map((e) => ({
    key: e.at_s,
    cells: [timeOfDay(e.at_s), {text: e.kind, level: e.severity === "info" ? "" : e.severity},
            {text: e.text, level: e.severity === "error" ? "error" : ""}],
  })));
}
