// SPDX-License-Identifier: Apache-2.0
// The border between floor and side, which can be dragged, or moved with the arrow keys.
import {element} from "./format.js";
import {recall, remember} from "./storage.js";

const kMin_px = 240, kStep_px = 24;
const kMinFloor = 0.35;  // of the page's width

/**
 * A width of the side that leaves room for the floor.
 * @param {number} wanted @param {number} page widths in pixels
 */
export const sideWidth = (wanted, page) => Math.max(kMin_px, Math.min(wanted, (1 - kMinFloor) * page));

export function startSplitter() {
  const splitter = element("splitter"), side = element("side");
  const set = (/** @type {number} */ wanted) => {
    const width = Math.round(sideWidth(wanted, innerWidth));
    side.style.width = `${width}px`;
    splitter.setAttribute("aria-valuenow", String(width));
    remember("side", width);
  };
  const remembered = recall("side", 0);
  if (remembered > 0) set(remembered);
  splitter.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => {
    e.preventDefault();
    splitter.setPointerCapture(e.pointerId);
  });
  splitter.addEventListener("pointermove", (/** @type {PointerEvent} */ e) => {
    if (splitter.hasPointerCapture(e.pointerId)) set(innerWidth - e.clientX);
  });
  splitter.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => {
    const step = e.key === "ArrowLeft" ? kStep_px : e.key === "ArrowRight" ? -kStep_px : 0;
    if (step) set(side.offsetWidth + step);
  });
}
