// SPDX-License-Identifier: Apache-2.0
// The images of the cameras, with crosses where vision sees the robots.
import {create} from "./format.js";

const kPeriod_ms = 300;

export class Cameras {
  /** @param {() => boolean} isShown */
  constructor(isShown) {
    this.node = create("div", {});
    this.isShown = isShown;
    /** @type {HTMLImageElement[]} */
    this.images = [];
    this.hint = create("p", {class: "hint"}, "No camera image has been received yet.");
  }

  /** @param {number} count */
  start(count) {
    this.images = Array.from({length: count}, (_, i) => create("img", {class: "camera", alt: `Image of camera ${i}`}));
    this.node.replaceChildren(this.hint, ...this.images);
    setInterval(() => this.update(), kPeriod_ms);
  }

  /** Says that no more images will come. */
  end() {
    this.hint.textContent = "The run is over: images of cameras are not kept.";
    this.hint.hidden = false;
  }

  async update() {
    if (!this.isShown()) return;
    for (const [i, image] of this.images.entries()) {
      const response = await fetch(`/api/cameras/${i}.jpg`).catch(() => null);
      if (!response || !response.ok) continue;
      URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(await response.blob());
      this.hint.hidden = true;
    }
  }
}
