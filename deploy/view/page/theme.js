// SPDX-License-Identifier: Apache-2.0
// Dark or light. The style sheet holds all colours; what is drawn on a canvas reads them here.
import {recall, remember} from "./storage.js";

const kColours = ["ground", "panel", "text", "dim", "grey", "blue", "sky", "yellow", "orange", "green", "red", "purple",
                  "team-blue", "team-yellow", "edge"];

/**
 * The colours of the current theme, as #rrggbb.
 * @type {Record<string, string>}
 */
export const palette = {};

/** @type {(() => void)[]} */
const listeners = [];

/**
 * Calls back after each change, so that canvases are drawn again.
 * @param {() => void} callback
 */
export function onThemeChange(callback) {
  listeners.push(callback);
}

/** @param {string} theme */
function apply(theme) {
  document.documentElement.dataset.theme = theme;
  const style = getComputedStyle(document.documentElement);
  for (const name of kColours) palette[name] = style.getPropertyValue(`--${name}`).trim();
  for (const listener of listeners) listener();
}

export function changeTheme() {
  const theme = document.documentElement.dataset.theme === "light" ? "dark" : "light";
  remember("theme", theme);
  apply(theme);
}

/** Uses the theme that the person chose, else that of the system. */
export function startTheme() {
  const light = matchMedia("(prefers-color-scheme: light)");
  const wanted = () => recall("theme", light.matches ? "light" : "dark");
  apply(wanted());
  light.addEventListener("change", () => apply(wanted()));
}
