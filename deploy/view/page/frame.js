// SPDX-License-Identifier: Apache-2.0
// A picture of the floor at one time, as the server sends it (deploy/view/monitor/floor_frame.hpp).

/** Where the columns of each section are. */
export class Layout {
  /** @param {{sections: {name: string, columns: string[]}[], flags: string[]}} json */
  constructor(json) {
    this.names = json.sections.map((section) => section.name);
    this.strides = json.sections.map((section) => section.columns.length);
    /** @type {Record<string, Record<string, number>>} */
    this.columns = {};
    for (const section of json.sections)
      this.columns[section.name] = Object.fromEntries(section.columns.map((name, index) => [name, index]));
    /** @type {Record<string, number>} */
    this.flags = Object.fromEntries(json.flags.map((name, index) => [name, 1 << index]));
  }
}

export class Frame {
  /** @param {ArrayBuffer} buffer @param {Layout} layout */
  constructor(buffer, layout) {
    const head = new DataView(buffer);
    this.time = head.getFloat64(0, true);
    const count = head.getUint32(8, true);
    /** @type {Record<string, {values: Float32Array, rows: number, stride: number}>} */
    this.sections = {};
    let offset = 12 + 4 * count;
    for (let i = 0; i < count; ++i) {
      const rows = head.getUint32(12 + 4 * i, true);
      const stride = layout.strides[i];
      this.sections[layout.names[i]] = {values: new Float32Array(buffer, offset, rows * stride), rows, stride};
      offset += 4 * rows * stride;
    }
  }
}

/**
 * Adds a version's path to a canvas path, from the time of the frame on. Each phase is a parabola, which a quadratic
 * curve draws exactly. Returns where it ends.
 * @param {Path2D} path @param {Float32Array} v values @param {number} at index of the version's first column
 * @param {{x: number, y: number}} end is filled in
 */
export function addVersion(path, v, at, end) {
  let t = v[at], x = v[at + 1], y = v[at + 2], vx = v[at + 3], vy = v[at + 4];
  if (Number.isNaN(t)) return false;
  const phases = v[at + 6];
  let begun = false;
  for (let i = 0; i < phases; ++i) {
    const p = at + 7 + 3 * i;
    let duration = v[p];
    const ax = v[p + 1], ay = v[p + 2];
    if (t < 0) {
      const past = Math.min(duration, -t);
      x += past * (vx + 0.5 * past * ax);
      y += past * (vy + 0.5 * past * ay);
      vx += past * ax;
      vy += past * ay;
      t += past;
      duration -= past;
    }
    if (duration <= 0) continue;
    if (!begun) {
      path.moveTo(x, y);
      begun = true;
    }
    const cx = x + 0.5 * duration * vx, cy = y + 0.5 * duration * vy;
    x += duration * (vx + 0.5 * duration * ax);
    y += duration * (vy + 0.5 * duration * ay);
    vx += duration * ax;
    vy += duration * ay;
    t += duration;
    path.quadraticCurveTo(cx, cy, x, y);
  }
  if (!begun) {
    path.moveTo(x, y);
    path.lineTo(x, y);
  }
  end.x = x;
  end.y = y;
  return true;
}
