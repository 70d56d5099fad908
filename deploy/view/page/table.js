// SPDX-License-Identifier: Apache-2.0
// A table whose cells are changed in place, whose columns can be chosen, and that says why it is empty.
import {create, setText} from "./format.js";
import {recall, remember} from "./storage.js";

/** @typedef {{id: string, title: string, text?: boolean, wraps?: boolean, extra?: boolean}} Column extra: hidden at first */
/** @typedef {{text: string, level?: string}} Cell */
/** @typedef {{key: any, cells: (string | Cell)[], selected?: boolean}} Row */

/** @param {Column} column */
const classOf = (column) => (column.wraps ? "text wraps" : column.text ? "text" : "");
/** @param {string | Cell} cell */
const levelOf = (cell) => (typeof cell === "string" ? "" : cell.level || "");

/**
 * The titles of hidden columns in which a row has a warning or an error.
 * @param {Column[]} columns @param {boolean[]} shown @param {Row[]} rows
 */
export function hiddenWarnings(columns, shown, rows) {
  const isAlert = (/** @type {string | Cell} */ cell) => ["warning", "error"].includes(levelOf(cell));
  return columns.filter((_, k) => !shown[k] && rows.some((row) => isAlert(row.cells[k]))).map((column) => column.title);
}

export class Table {
  /** @param {string} id @param {Column[]} columns @param {string} label @param {string} hint what an empty table says */
  constructor(id, columns, label, hint) {
    this.id = id;
    this.columns = columns;
    const chosen = recall(`columns.${id}`, /** @type {Record<string, boolean>} */ ({}));
    this.shown = columns.map((column) => chosen[column.id] ?? !column.extra);
    this.heads = columns.map((c) => create("th", {scope: "col", class: classOf(c)}, c.title));
    this.body = create("tbody");
    this.table = create("table", {"aria-label": label}, create("thead", {}, create("tr", {}, ...this.heads)), this.body);
    this.hint = create("p", {class: "hint"}, hint);
    this.node = create("div", {}, this.hint, this.table);
    this.summary = create("summary", {}, "Columns");
    this.menu = create("details", {class: "menu", id: `columns-${id}`}, this.summary, create("div", {}, ...this.boxes()));
    /** @type {(key: any) => void} */
    this.onClick = () => {};
    /** @type {Row[]} */
    this.rows = [];
    this.update([]);
  }

  boxes() {
    return this.columns.map((column, k) => {
      const box = create("input", {type: "checkbox", id: `column-${this.id}-${column.id}`});
      box.checked = this.shown[k];
      box.addEventListener("change", () => {
        this.shown[k] = box.checked;
        remember(`columns.${this.id}`, Object.fromEntries(this.columns.map((c, i) => [c.id, this.shown[i]])));
        this.update(this.rows);
      });
      return create("label", {}, box, create("span", {}, column.title));
    });
  }

  /** @param {string} text */
  setHint(text) {
    this.hint.textContent = text;
  }

  /** @param {Row[]} rows */
  update(rows) {
    this.rows = rows;
    this.hint.hidden = rows.length > 0;
    this.table.hidden = rows.length === 0;
    this.heads.forEach((head, k) => (head.hidden = !this.shown[k]));
    while (this.body.rows.length > rows.length) this.body.deleteRow(-1);
    while (this.body.rows.length < rows.length) this.addRow();
    rows.forEach((row, i) => this.updateRow(this.body.rows[i], row));
    const warnings = hiddenWarnings(this.columns, this.shown, rows);
    setText(this.summary, warnings.length > 0 ? "Columns !" : "Columns");
    this.summary.title = warnings.length > 0 ? `Warnings in hidden columns: ${warnings.join(", ")}` : "Columns of this table";
  }

  addRow() {
    const row = this.body.insertRow();
    row.className = "clickable";
    row.tabIndex = 0;
    row.addEventListener("click", () => this.onClick(row.key));
    row.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => e.key === "Enter" && this.onClick(row.key));
    for (const column of this.columns) row.insertCell().className = classOf(column);
  }

  /** @param {any} node @param {Row} row */
  updateRow(node, row) {
    node.key = row.key;
    node.dataset.key = String(row.key);
    node.dataset.selected = String(Boolean(row.selected));
    row.cells.forEach((cell, k) => {
      const td = node.cells[k];
      setText(td, typeof cell === "string" ? cell : cell.text);
      const name = `${classOf(this.columns[k])} ${levelOf(cell)}`.trim();
      if (td.className !== name) td.className = name;
      if (td.hidden === this.shown[k]) td.hidden = !this.shown[k];
    });
  }

  /**
   * Scrolls the panel, and not the page, to a row.
   * @param {any} key
   */
  reveal(key) {
    const row = this.body.querySelector(`[data-key="${key}"]`), panel = row?.closest(".panel-body");
    if (!panel) return;
    const line = row.getBoundingClientRect(), box = panel.getBoundingClientRect();
    const above = box.top + row.offsetHeight - line.top, below = line.bottom - box.bottom;  // the head covers one row
    if (above > 0) panel.scrollTop -= above;
    else if (below > 0) panel.scrollTop += below;
  }
}
