// SPDX-License-Identifier: Apache-2.0
// The menu that switches layers: presets, and a box for each layer.
import {create, element} from "./format.js";
import {currentPreset, layers, presets} from "./layers.js";
import {recall, remember} from "./storage.js";

/**
 * Fills the menu. Returns the keys that switch layers.
 * @param {() => void} onChange @returns {[string, string, () => void][]}
 */
export function buildLayerMenu(onChange) {
  /** @type {Map<string, any>} */
  const boxes = new Map();
  const buttons = presets.map((preset) => {
    const button = create("button", {id: `preset-${preset.id}`}, preset.name);
    button.addEventListener("click", () => use(preset.layers));
    return {preset, button};
  });
  const show = () => {
    for (const layer of layers) boxes.get(layer.id).checked = layer.on;
    const current = currentPreset();
    for (const {preset, button} of buttons) button.setAttribute("aria-pressed", String(preset === current));
    onChange();
  };
  const use = (/** @type {string[]} */ ids) => {
    for (const layer of layers) layer.on = ids.includes(layer.id);
    save();
  };
  const save = () => {
    remember("layers", layers.filter((layer) => layer.on).map((layer) => layer.id));
    show();
  };
  element("presets").append(...buttons.map(({button}) => button));
  /** @type {[string, string, () => void][]} */
  const keys = [];
  for (const layer of layers) {
    const box = create("input", {type: "checkbox", id: `layer-${layer.id}`});
    boxes.set(layer.id, box);
    const set = (/** @type {boolean} */ on) => {
      layer.on = on;
      save();
    };
    box.addEventListener("change", () => set(box.checked));
    const key = create("kbd", {}, layer.key.toUpperCase());
    element("layers").append(create("label", {}, box, create("span", {}, layer.name), key));
    keys.push([layer.key, `layer: ${layer.name}`, () => set(!layer.on)]);
  }
  const remembered = recall("layers", /** @type {string[]} */ ([]));
  if (remembered.length > 0) for (const layer of layers) layer.on = remembered.includes(layer.id);
  show();
  return keys;
}
