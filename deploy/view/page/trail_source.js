// SPDX-License-Identifier: Apache-2.0
// Asks the monitor where robots were before a moment that was not shown yet.
import {trails} from "./trails.js";

let isAsking = false;
/**
 * The last moment that was wanted while another answer was on its way.
 * @type {number | null}
 */
let next = null;

/** @param {number} time @param {() => void} onChange */
export async function fetchTrails(time, onChange) {
  if (isAsking) {
    next = time;
    return;
  }
  isAsking = true;
  try {
    const response = await fetch(`/api/trails?at_s=${time}`);
    if (response.ok) {
      trails.addAll(await response.json());
      onChange();
    }
  } catch {
    // There is no connection, or it was lost before the whole answer had arrived: trails begin at this moment.
  } finally {
    isAsking = false;
  }
  if (next === null) return;
  const wanted = next;
  next = null;
  fetchTrails(wanted, onChange);
}
