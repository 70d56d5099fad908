// SPDX-License-Identifier: Apache-2.0
// The table of robots.
import {number} from "./format.js";
import {Table} from "./table.js";

export const robotTable = new Table("robots",
    [{id: "robot", title: "Robot"}, {id: "state", title: "State", text: true}, {id: "order", title: "Order", text: true},
     {id: "to-go", title: "To go m"}, {id: "speed", title: "m/s"}, {id: "waits-for", title: "Waits for"},
     {id: "denied", title: "Denied", wraps: true},
     {id: "verdict", title: "Verdict ms p50 / p99", extra: true}, {id: "missed", title: "Missed cycles", extra: true},
     {id: "clock", title: "Clock ms", extra: true}, {id: "error", title: "Error mm", extra: true}],
    "Robots", "No robot has been heard yet.");

/**
 * The reasons of denials, most frequent first.
 * @param {Record<string, number>} reasons
 */
function reasonsText(reasons) {
  return Object.entries(reasons || {}).sort((a, b) => Number(b[1]) - Number(a[1]))
      .map(([reason, times]) => `${reason} ${times}`).join(", ");
}

/** @param {any} r @param {any} scene @param {boolean} hasTeams @param {number} selected */
function rowOf(r, scene, hasTeams, selected) {
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
      {text: String(r.id), level: hasTeams ? `team ${scene.teams.get(r.id) || "blue"}` : ""},
      isSilent ? {text: "silent", level: "error"} : r.state,
      {text: r.order || "–", level: r.order === "blocked" ? "warning" : ""},
      number(r.distance_to_go_m, 2),
      number(r.speed_mps, 2),
      number(r.waits_for),
      {text: denied + reasonsText(r.denials_by_reason), level: r.denied ? "warning" : "dim"},
      `${number(r.negotiation_p50_ms, 1)} / ${number(r.negotiation_p99_ms, 1)}`,
      {text: `${r.missed_cycles ?? "–"} of ${r.cycles ?? "–"}`, level: r.missed_cycles > 0.01 * r.cycles ? "warning" : ""},
      {text: clock, level: Math.abs(r.clock_offset_ms) > scene.clock_bound_s * 1000 ? "error" : ""},
      {text: `${isOff ? (r.lifted ? "lifted " : "off ") : ""}${number(r.tracking_error_mm, 1)} of ${number(bound_mm, 1)}`,
       level: isOff || r.tracking_error_mm > bound_mm ? "error" : ""},
    ],
  };
}

/** @param {any} panels @param {any} scene @param {number} selected */
export function updateRobots(panels, scene, selected) {
  const hasTeams = new Set(scene.teams.values()).size > 1;
  robotTable.setHint(scene.is_recording ? "No robot has been heard up to this moment of the recording."
                     : "No robot has been heard yet. Does a run use the same DDS domain and interface as this monitor?");
  robotTable.update(panels.robots.map((/** @type {any} */ r) => rowOf(r, scene, hasTeams, selected)));
}
