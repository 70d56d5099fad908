// SPDX-License-Identifier: Apache-2.0
// One panel: a tab at the side, or a window over the page, or closed.
import {create} from "./format.js";

/** @typedef {"side" | "window" | "closed"} Place */

const kBar_px = 34;  // at least so much of a window stays on the page

/**
 * A position at which a window can be reached.
 * @param {{x: number, y: number}} wanted @param {{width: number, height: number}} page
 */
export function reachable({x, y}, page) {
  const limited = (/** @type {number} */ value, /** @type {number} */ most) => Math.max(0, Math.min(value, most));
  return {x: limited(x, page.width - 4 * kBar_px), y: limited(y, page.height - kBar_px)};
}

export class Panel {
  /**
   * @param {string} id @param {string} title @param {Node} content @param {Node[]} tools that the bar shows
   * @param {{show: (id: string) => void, put: (id: string, place: Place) => void, drag: (panel: Panel, e: PointerEvent) => void}} dock
   */
  constructor(id, title, content, tools, dock) {
    this.id = id;
    this.title = title;
    /** @type {Place} */
    this.place = "side";
    this.at = {x: 80, y: 120};
    this.size = {width: 0, height: 0};  // of the window; 0: as large as its content wants
    this.tab = create("button", {role: "tab", id: `tab-${id}`, "aria-controls": `panel-${id}`,
                                 title: "Drag it over the floor to make it a window"}, title);
    this.tab.addEventListener("click", () => dock.show(id));
    this.tab.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => dock.drag(this, e));
    this.move = create("button", {id: `move-${id}`});
    this.move.addEventListener("click", () => dock.put(id, this.place === "window" ? "side" : "window"));
    const close = create("button", {id: `close-${id}`, "aria-label": `Close ${title}`, title: "Close; the menu Panels opens it again"}, "✕");
    close.addEventListener("click", () => dock.put(id, "closed"));
    const bar = create("div", {class: "panel-bar"}, create("h2", {}, title), ...tools, this.move, close);
    bar.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => {
      if (!(/** @type {Element} */ (e.target)).closest("button, details")) dock.drag(this, e);
    });
    this.body = create("div", {class: "panel-body"}, content);
    this.node = create("section", {class: "panel", role: "tabpanel", id: `panel-${id}`, "aria-labelledby": `tab-${id}`},
                       bar, this.body);
  }

  /** @param {Place} place where it is on this page, which may be too narrow for windows @param {boolean} isShown */
  show(place, isShown) {
    const isWindow = place === "window";
    this.tab.hidden = place !== "side";
    this.tab.setAttribute("aria-selected", String(place === "side" && isShown));
    this.node.hidden = !isShown;
    this.node.classList.toggle("window", isWindow);
    this.move.textContent = isWindow ? "To the side" : "Window";
    this.move.title = isWindow ? "Put it back among the tabs" : "Make it a window over the page";
    const {style} = this.node;
    const {x, y} = reachable(this.at, {width: innerWidth, height: innerHeight});
    style.left = isWindow ? `${x}px` : "";
    style.top = isWindow ? `${y}px` : "";
    style.width = isWindow && this.size.width ? `${this.size.width}px` : "";
    style.height = isWindow && this.size.height ? `${this.size.height}px` : "";
  }
}
