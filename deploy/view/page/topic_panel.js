// SPDX-License-Identifier: Apache-2.0
// The table of topics, and what DDS reports about hosts.
import {create, number} from "./format.js";
import {Table} from "./table.js";

export const topicTable = new Table("topics",
    [{id: "topic", title: "Topic", text: true}, {id: "hz", title: "Hz"}, {id: "rate", title: "kB/s"}, {id: "lost", title: "Lost"},
     {id: "delay", title: "Delay ms p50 / p99"}, {id: "last", title: "Last s ago", extra: true},
     {id: "repeated", title: "Repeated", extra: true}, {id: "reordered", title: "Out of order", extra: true},
     {id: "senders", title: "Senders", wraps: true, extra: true}],
    "Topics", "No message has been received up to this moment.");
const mismatchList = create("ul", {"aria-label": "Endpoints that do not match"});
const hostList = create("p", {class: "dim"});
export const topicPanel = create("div", {}, mismatchList, topicTable.node, hostList);

// Counts may be texts, if they have 64 bits.
/** @param {any[]} senders @param {string} key */
const sum = (senders, key) => senders.reduce((total, sender) => total + Number(sender[key]), 0);
/** @param {any[]} senders @param {string} key */
const most = (senders, key) => senders.reduce((worst, sender) => Math.max(worst, Number(sender[key])), 0);

/** @param {any} t */
function rowOf(t) {
  const lost = sum(t.senders, "lost"), received = sum(t.senders, "received");
  const worst = t.senders.slice().sort((/** @type {any} */ a, /** @type {any} */ b) => Number(b.lost) - Number(a.lost))[0];
  const who = t.senders.length === 1 ? t.senders[0].name
      : `${t.senders.length}${worst && worst.lost > 0 ? `; most lost: ${worst.name} ${worst.lost}` : ""}`;
  return {
    key: t.topic,
    cells: [t.topic, number(t.hz, 1), number(t.kB_per_s, 1),
            {text: lost === 0 ? "0" : `${lost} (${number(100 * lost / (lost + received), 2)} %)`,
             level: lost > 0.01 * (lost + received) ? "warning" : ""},
            `${number(most(t.senders, "delay_p50_ms"), 2)} / ${number(most(t.senders, "delay_p99_ms"), 2)}`,
            number(t.age_s, 1), String(sum(t.senders, "repeated")), String(sum(t.senders, "reordered")), who],
  };
}

/** @param {any} panels */
export function updateTopics(panels) {
  topicTable.update(panels.topics.map(rowOf));
}

/**
 * Shows what DDS reports about processes and hosts.
 * @param {{hosts: any[], mismatches: string[]}} network
 */
export function updateNetwork(network) {
  mismatchList.replaceChildren(...network.mismatches.map((/** @type {string} */ m) => create("li", {class: "error"}, m)));
  hostList.textContent = network.hosts.map((/** @type {any} */ h) => `${h.host}: ${h.participants.join(", ")}`).join(" · ");
}
