// SPDX-License-Identifier: Apache-2.0
// What the page remembers in this browser: the theme, the layers, the places of panels, the columns of tables.

/**
 * The remembered value, or `otherwise` if there is none of the same type.
 * @template T @param {string} key @param {T} otherwise @returns {T}
 */
export function recall(key, otherwise) {
  try {
    const value = JSON.parse(localStorage.getItem(`sidestep.${key}`) || "null");
    return value !== null && typeof value === typeof otherwise && Array.isArray(value) === Array.isArray(otherwise)
        ? value : otherwise;
  } catch {
    return otherwise;  // no storage, or not JSON
  }
}

/** @param {string} key @param {any} value */
export function remember(key, value) {
  try {
    localStorage.setItem(`sidestep.${key}`, JSON.stringify(value));
  } catch {
    // The browser has no storage, or it is full: the page works without.
  }
}
