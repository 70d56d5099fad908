// SPDX-License-Identifier: Apache-2.0
// The lamp: whether the promise is kept up to the moment shown, and in a whole recording.
import {element, number, percent, setText} from "./format.js";

/** @type {Record<string, string>} */
const kShapes = {"kept": "✓", "broken": "✕", "not judged": "?"};
/** @type {Record<string, string>} */
const kTexts = {"kept": "promise kept", "broken": "promise broken"};

/** @param {string} state */
const textOf = (state) => kTexts[state] || "not judged";
/** @param {string} state */
const shapeOf = (state) => kShapes[state] || "?";

/**
 * What the second lamp says: the verdict on the whole recording. Null while nothing is known, and for a run that
 * continues, whose lamp says all.
 * @param {{is_over: boolean, promise: any} | null} whole @param {boolean} isRecording @param {number} progress
 */
export function wholeVerdict(whole, isRecording, progress) {
  if (!isRecording || !whole) return null;
  if (!whole.is_over) return {state: "not judged", text: `whole recording: reading, ${Math.round(100 * progress)} %`};
  const {state} = whole.promise;
  return {state, text: `whole recording: ${shapeOf(state)} ${textOf(state)}`};
}

/** @param {any} promise @returns {string[]} */
export function promiseFigures(promise) {
  const figures = [];
  if (promise.contacts !== undefined)
    figures.push(`${promise.contacts} contacts`, `${promise.violations} violations`, `coverage ${percent(promise.coverage)}`,
                 `${promise.missed_cycles} of ${promise.cycles} cycles missed`);
  const smallest = promise.smallest;
  if (smallest)
    figures.push(`smallest clearance ${number(smallest.clearance_m * 1000, 1)} mm (robots ${smallest.robots.join(" and ")})`);
  if (promise.reason) figures.push(promise.reason);
  return figures;
}

/** @param {any} promise up to the moment shown @param {boolean} isRecording */
export function updateLamp(promise, isRecording) {
  element("lamp").dataset.state = promise.state;
  setText(element("lamp-shape"), shapeOf(promise.state));
  setText(element("lamp-scope"), isRecording ? "up to this moment: " : "");
  setText(element("lamp-text"), textOf(promise.state));
  setText(element("promise-figures"), promiseFigures(promise).join(" · "));
}

/** @param {any} whole @param {boolean} isRecording @param {number} progress */
export function updateWhole(whole, isRecording, progress) {
  const verdict = wholeVerdict(whole, isRecording, progress);
  const lamp = element("lamp-whole");
  lamp.hidden = !verdict;
  if (!verdict) return;
  lamp.dataset.state = verdict.state;
  setText(lamp, verdict.text);
  lamp.title = whole.promise.reason || "Whether the promise was kept from the beginning to the end of the recording";
}
