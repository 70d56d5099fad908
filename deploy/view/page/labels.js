// SPDX-License-Identifier: Apache-2.0
// Numbers beside robots: where they fit without covering a robot or each other. Places are in CSS pixels; those of marks
// and of labels are their centres.
import {eachRobot, placeOf} from "./shapes.js";
import {palette} from "./theme.js";

/** @typedef {import("./shapes.js").View} View */
/** @typedef {{id: number, text: string, x: number, y: number, r: number, width: number, height: number}} Mark */
/** @typedef {{id: number, text: string, x: number, y: number, width: number, height: number, slot: number}} Label */

const kHeight_px = 13, kGap_px = 2;
const kFont = `600 ${kHeight_px}px system-ui, sans-serif`;
// Up to so many robots on the canvas have all their numbers; of more, those that fit; of even more, only the selected
// one has, until a person zooms in.
const kAllLabelled = 60, kFittingLabelled = 300;
const kCell_px = 32;
// Directions from a robot to its number, the preferred ones first.
const kSlots = [[1, -1], [1, 0], [1, 1], [-1, -1], [-1, 0], [-1, 1], [0, -1], [0, 1]];

/** Boxes, found quickly by place. */
class Boxes {
  constructor() {
    /** @type {Map<string, {x: number, y: number, w: number, h: number}[]>} */
    this.cells = new Map();
  }

  /** @param {number} x @param {number} y @param {number} w half of the width @param {number} h @param {(key: string) => void} use */
  eachCell(x, y, w, h, use) {
    for (let i = Math.floor((x - w) / kCell_px); i <= Math.floor((x + w) / kCell_px); ++i)
      for (let k = Math.floor((y - h) / kCell_px); k <= Math.floor((y + h) / kCell_px); ++k) use(`${i} ${k}`);
  }

  /** @param {number} x @param {number} y @param {number} w @param {number} h */
  add(x, y, w, h) {
    this.eachCell(x, y, w, h, (key) => {
      const cell = this.cells.get(key);
      cell ? cell.push({x, y, w, h}) : this.cells.set(key, [{x, y, w, h}]);
    });
  }

  /**
   * The area that a box would share with the others.
   * @param {number} x @param {number} y @param {number} w @param {number} h
   */
  overlap(x, y, w, h) {
    let area = 0;
    this.eachCell(x, y, w, h, (key) => {
      for (const box of this.cells.get(key) || []) {
        const across = w + box.w - Math.abs(x - box.x), down = h + box.h - Math.abs(y - box.y);
        if (across > 0 && down > 0) area += across * down;
      }
    });
    return area;
  }
}

/**
 * Chooses a place beside its robot for each number. A number stays in its slot while that is free, so that it does not
 * jump. Those that must appear come first.
 * @param {Mark[]} marks @param {Map<number, number>} slots of the previous picture, by robot; updated
 * @param {(id: number) => boolean} must @returns {Label[]}
 */
export function placeLabels(marks, slots, must) {
  const boxes = new Boxes();
  for (const mark of marks) boxes.add(mark.x, mark.y, mark.r, mark.r);
  /** @type {Label[]} */
  const labels = [];
  const wanted = marks.length > kFittingLabelled ? marks.filter((mark) => must(mark.id)) : marks.slice();
  const ordered = wanted.sort((a, b) => Number(must(b.id)) - Number(must(a.id)) || a.id - b.id);
  for (const mark of ordered) {
    const w = mark.width / 2, h = mark.height / 2;
    const known = slots.get(mark.id) ?? 0;
    let best = -1, least = Infinity;
    for (let i = 0; i < kSlots.length && least > 0; ++i) {
      const slot = i === 0 ? known : i <= known ? i - 1 : i;
      const {x, y} = centreOf(mark, slot);
      const area = boxes.overlap(x, y, w, h);
      if (area < least) [least, best] = [area, slot];
    }
    if (least > 0 && marks.length > kAllLabelled && !must(mark.id)) continue;
    const {x, y} = centreOf(mark, best);
    boxes.add(x, y, w, h);
    slots.set(mark.id, best);
    labels.push({id: mark.id, text: mark.text, x, y, width: mark.width, height: mark.height, slot: best});
  }
  return labels;
}

/** @param {Mark} mark @param {number} slot */
function centreOf(mark, slot) {
  const [dx, dy] = kSlots[slot];
  // At a corner, the number may be nearer than beside or above: the disc is round.
  const r = dx && dy ? 0.75 * mark.r : mark.r;
  return {x: mark.x + dx * (r + kGap_px + mark.width / 2), y: mark.y + dy * (r + kGap_px + mark.height / 2)};
}

/** @type {Map<number, number>} */
const slots = new Map();
/** @type {Map<string, number>} */
const widths = new Map();
/**
 * What was drawn last, for tests.
 * @type {{labels: Label[], marks: Mark[]}}
 */
export const drawn = {labels: [], marks: []};

/** @param {CanvasRenderingContext2D} c @param {View} view */
export function drawLabels(c, view) {
  const {ratio, canvas} = view.floor;
  c.save();
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.font = kFont;
  c.textAlign = "center";
  c.textBaseline = "middle";
  /** @type {Mark[]} */
  const marks = [];
  eachRobot(view, (v, at, columns) => {
    const place = placeOf(v, at, columns);
    const {x, y} = view.floor.toPixels(place);
    if (!(x > 0 && y > 0 && x < canvas.clientWidth && y < canvas.clientHeight)) return;
    const text = String(v[at]);
    if (!widths.has(text)) widths.set(text, c.measureText(text).width);
    marks.push({id: v[at], text, x, y, r: view.mark_m / view.pixel, width: Number(widths.get(text)), height: kHeight_px});
  });
  drawn.marks = marks;
  drawn.labels = placeLabels(marks, slots, (id) => id === view.selected);
  c.lineJoin = "round";
  c.lineWidth = 3;
  c.strokeStyle = palette.ground;
  for (const label of drawn.labels) c.strokeText(label.text, label.x, label.y);
  c.fillStyle = palette.text;
  for (const label of drawn.labels) c.fillText(label.text, label.x, label.y);
  c.restore();
}
