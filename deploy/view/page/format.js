// SPDX-License-Identifier: Apache-2.0
// Numbers and elements.

/** @param {number | null | undefined} value @param {number} digits */
export function number(value, digits = 0) {
  return value === undefined || value === null || Number.isNaN(value) ? "–" : value.toFixed(digits);
}

/**
 * A share in percent, rounded down, so that 100 % means all.
 * @param {number | undefined} share
 */
export function percent(share) {
  if (share === undefined || share === null) return "–";
  const shown = Math.floor(share * 1000) / 10;
  return `${shown.toFixed(1)} %`;
}

/**
 * The time of day in UTC, to a millisecond.
 * @param {number} seconds since 1970
 */
export function timeOfDay(seconds) {
  if (!Number.isFinite(seconds)) return "–";
  return new Date(seconds * 1000).toISOString().slice(11, 23);
}

/**
 * Changes a text only if it differs, because each change costs a layout.
 * @param {any} node @param {string} text
 */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** @param {string} id @returns {any} */
export const element = (id) => document.getElementById(id);

/** @param {string} tag @param {Record<string, string>} attributes @param {(Node | string)[]} children @returns {any} */
export function create(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}
