// SPDX-License-Identifier: Apache-2.0
// The keyboard, and the list of all keys.
import {create, element} from "./format.js";

/** @typedef {[string, string, () => void]} Key the key, what it does, and how */

/** @param {string} key */
const nameOf = (key) => (key === " " ? "space" : key.toUpperCase());
const kPointer = [["drag the floor", "move it"], ["wheel, two fingers", "zoom"], ["click a robot", "select it"],
                  ["drag a robot", "send it there, if this page may command"],
                  ["drag a tab", "make it a window, or change its place"]];

/** @param {Key[]} keys */
export function startKeys(keys) {
  for (const [key, what] of keys)
    element("keys").append(create("dt", {}, create("kbd", {}, nameOf(key))), create("dd", {}, what));
  for (const [gesture, what] of kPointer) element("keys").append(create("dt", {}, gesture), create("dd", {}, what));
  element("help-button").addEventListener("click", () => element("help").showModal());
  addEventListener("keydown", (event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    const isText = ["SELECT", "TEXTAREA"].includes(target.tagName) ||
        target.tagName === "INPUT" && !["checkbox", "range"].includes(/** @type {HTMLInputElement} */ (target).type);
    if (event.ctrlKey || event.metaKey || event.altKey || isText) return;
    // Space presses what has the focus.
    if (event.key === " " && ["BUTTON", "SUMMARY", "INPUT"].includes(target.tagName)) return;
    const found = keys.find(([key]) => key === event.key.toLowerCase());
    if (!found) return;
    event.preventDefault();
    found[2]();
  });
}
