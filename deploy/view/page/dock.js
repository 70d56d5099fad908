// SPDX-License-Identifier: Apache-2.0
// Where the panels are: tabs at the side, of which one is shown; windows; closed ones, which the menu opens again.
import {create, element} from "./format.js";
import {Panel} from "./panel.js";
import {recall, remember} from "./storage.js";

/** @typedef {import("./panel.js").Place} Place */

const kDrag_px = 6;
const kNarrow = "(max-width: 800px)";  // as in style.css: below, there is no room for windows

export class Dock {
  constructor() {
    /** @type {Map<string, Panel>} */
    this.panels = new Map();
    /** @type {Map<string, any>} */
    this.boxes = new Map();
    const saved = recall("panels", /** @type {Record<string, any>} */ ({}));
    this.shown = String(saved.shown || "");
    this.isSideClosed = saved.isSideClosed === true;
    /** @type {Record<string, any>} */
    this.saved = saved.panels || {};
    /**
     * The tabs from left to right, as the person has put them.
     * @type {string[]}
     */
    this.order = Array.isArray(saved.order) ? saved.order : [];
    this.top = 1;
    this.narrow = matchMedia(kNarrow);
    this.narrow.addEventListener("change", () => this.layout());
    addEventListener("resize", () => this.layout());
    element("tabs").addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.arrow(e));
    this.sideBox = this.addBox("The side", "menu-side", () => this.toggleSide());
    const reset = create("button", {id: "reset-panels"}, "All to the side");
    reset.addEventListener("click", () => this.reset());
    element("panel-list").append(reset);
  }

  /** @param {string} title @param {string} id @param {() => void} onChange */
  addBox(title, id, onChange) {
    const box = create("input", {type: "checkbox", id});
    box.addEventListener("change", onChange);
    element("panel-list").insertBefore(create("label", {}, box, create("span", {}, title)), element("reset-panels"));
    return box;
  }

  /** @param {string} id @param {string} title @param {Node} content @param {Node[]} tools */
  add(id, title, content, tools = []) {
    const panel = new Panel(id, title, content, tools, this);
    const saved = this.saved[id];
    if (saved && ["side", "window", "closed"].includes(saved.place)) {
      panel.place = saved.place;
      if (saved.at) panel.at = saved.at;
      if (saved.size) panel.size = saved.size;
    }
    this.boxes.set(id, this.addBox(title, `menu-${id}`, () => this.put(id, panel.place === "closed" ? "side" : "closed")));
    element("tabs").insertBefore(panel.tab, this.tabAfter(id));
    this.panels.set(id, panel);
    panel.node.addEventListener("pointerdown", () => this.raise(panel));
    // The handle at a window's corner changes its size.
    new ResizeObserver(() => {
      if (this.placeOf(panel) !== "window" || !panel.node.style.width) return;
      panel.size = {width: panel.node.offsetWidth, height: panel.node.offsetHeight};
      this.save();
    }).observe(panel.node);
    this.layout();
  }

  /**
   * The tab before which a new tab belongs; null: at the end.
   * @param {string} id @returns {any}
   */
  tabAfter(id) {
    const rank = (/** @type {string} */ of) => this.order.indexOf(of);
    if (rank(id) < 0) return null;
    return [...this.panels.values()].map((panel) => panel.tab).filter((tab) => rank(tab.id.slice(4)) > rank(id))
        .sort((a, b) => rank(a.id.slice(4)) - rank(b.id.slice(4)))[0] || null;
  }

  /** @param {Panel} panel @returns {Place} */
  placeOf(panel) {
    return panel.place === "window" && this.narrow.matches ? "side" : panel.place;
  }

  /**
   * Whether a panel can be seen.
   * @param {string} id
   */
  isShown(id) {
    const panel = this.panels.get(id);
    if (!panel || panel.node.hidden) return false;
    return this.placeOf(panel) === "window" || !element("side").hidden;
  }

  /**
   * Opens a panel where it is, or at the side.
   * @param {string} id
   */
  show(id) {
    const panel = this.panels.get(id);
    if (!panel) return;
    if (panel.place === "closed") panel.place = "side";
    if (this.placeOf(panel) === "side") {
      this.shown = id;
      this.isSideClosed = false;
    }
    this.change();
  }

  /** @param {string} id @param {Place} place */
  put(id, place) {
    const panel = /** @type {Panel} */ (this.panels.get(id));
    panel.place = place;
    if (place === "side") return this.show(id);
    if (place === "window") this.raise(panel);
    this.change();
  }

  toggleSide() {
    this.isSideClosed = !this.isSideClosed;
    this.change();
  }

  reset() {
    for (const panel of this.panels.values()) panel.place = "side";
    this.isSideClosed = false;
    this.change();
  }

  /** @param {Panel} panel */
  raise(panel) {
    panel.node.style.zIndex = String(++this.top);
  }

  change() {
    this.layout();
    this.save();
  }

  save() {
    const panels = Object.fromEntries([...this.panels].map(([id, {place, at, size}]) => [id, {place, at, size}]));
    remember("panels", {shown: this.shown, isSideClosed: this.isSideClosed, order: this.order, panels});
  }

  layout() {
    const atSide = [...this.panels.values()].filter((panel) => this.placeOf(panel) === "side");
    // The panel that is to be shown may be closed, or not added yet.
    const shown = atSide.find((panel) => panel.id === this.shown) || atSide[0];
    for (const panel of this.panels.values()) {
      const place = this.placeOf(panel);
      const home = element(place === "window" ? "windows" : "panels");
      if (panel.node.parentNode !== home) home.append(panel.node);
      panel.show(place, place === "window" || panel === shown);
      this.boxes.get(panel.id).checked = place !== "closed";
    }
    const isHidden = this.isSideClosed || atSide.length === 0;
    element("side").hidden = element("splitter").hidden = isHidden;
    this.sideBox.checked = !isHidden;
    this.sideBox.disabled = atSide.length === 0;
  }

  /**
   * Left and right go from tab to tab.
   * @param {KeyboardEvent} e
   */
  arrow(e) {
    const step = e.key === "ArrowRight" ? 1 : e.key === "ArrowLeft" ? -1 : 0;
    const tabs = [...element("tabs").children].filter((tab) => !tab.hidden);
    const at = tabs.indexOf(e.target);
    if (!step || at < 0) return;
    const next = tabs[(at + step + tabs.length) % tabs.length];
    next.click();
    next.focus();
  }

  /**
   * Follows the pointer with a panel, from a tab or from a bar.
   * @param {Panel} panel @param {PointerEvent} begin
   */
  drag(panel, begin) {
    if (begin.button !== 0 || this.narrow.matches) return;
    const box = panel.node.getBoundingClientRect();
    const isWindow = panel.place === "window";
    const grip = isWindow ? {x: begin.clientX - box.x, y: begin.clientY - box.y} : {x: 60, y: 12};
    let isDragged = false;
    const isOverSide = (/** @type {PointerEvent} */ e) => {
      const side = element("side").getBoundingClientRect();
      return !element("side").hidden && e.clientX >= side.left;
    };
    const move = (/** @type {PointerEvent} */ e) => {
      isDragged = isDragged || Math.hypot(e.clientX - begin.clientX, e.clientY - begin.clientY) > kDrag_px;
      if (!isDragged) return;
      e.preventDefault();
      panel.at = {x: e.clientX - grip.x, y: e.clientY - grip.y};
      if (panel.place !== "window" && !isOverSide(e)) this.put(panel.id, "window");
      element("side").classList.toggle("target", isOverSide(e));
      this.layout();
    };
    const end = (/** @type {PointerEvent} */ e) => {
      for (const [type, listener] of listeners) removeEventListener(type, listener);
      element("side").classList.remove("target");
      if (!isDragged || e.type === "pointercancel") return this.layout();
      if (isOverSide(e)) {
        this.dropTab(panel, e.clientX);
        this.put(panel.id, "side");
      }
      this.save();
    };
    /** @type {[string, any][]} */
    const listeners = [["pointermove", move], ["pointerup", end], ["pointercancel", end]];
    for (const [type, listener] of listeners) addEventListener(type, listener);
  }

  /**
   * Puts a tab where it was dropped.
   * @param {Panel} panel @param {number} x
   */
  dropTab(panel, x) {
    const next = [...element("tabs").children].filter((tab) => tab !== panel.tab && !tab.hidden).find((tab) => {
      const box = tab.getBoundingClientRect();
      return x < box.x + box.width / 2;
    });
    element("tabs").insertBefore(panel.tab, next || null);
    this.order = [...element("tabs").children].map((tab) => tab.id.slice(4));
  }
}
