// SPDX-License-Identifier: Apache-2.0
// Menus are <details> elements: at most one is open, and a click elsewhere, a scroll or Escape closes it.

const kGap_px = 4;

/**
 * Where a menu opens: below its button, and wholly on the page.
 * @param {{left: number, bottom: number}} button @param {number} width of the menu @param {{width: number, height: number}} page
 */
export function menuPlace(button, width, page) {
  const left = Math.max(kGap_px, Math.min(button.left, page.width - width - kGap_px));
  const top = Math.min(button.bottom + kGap_px, page.height / 2);
  return {left, top, maxHeight: page.height - top - kGap_px};
}

/** @param {Element | null} except */
function closeMenus(except) {
  for (const menu of document.querySelectorAll("details.menu[open]"))
    if (menu !== except) menu.removeAttribute("open");
}

/** @param {Element} menu */
function place(menu) {
  const summary = /** @type {HTMLElement} */ (menu.querySelector("summary"));
  const body = /** @type {HTMLElement} */ (menu.querySelector(":scope > div"));
  const page = {width: innerWidth, height: innerHeight};
  const {left, top, maxHeight} = menuPlace(summary.getBoundingClientRect(), body.offsetWidth, page);
  Object.assign(body.style, {left: `${left}px`, top: `${top}px`, maxHeight: `${maxHeight}px`});
}

/**
 * The menu that holds what an event is about.
 * @param {Event} event
 */
const menuOf = (event) => (event.target instanceof Element ? event.target.closest("details.menu") : null);

export function startMenus() {
  // The event does not bubble, but it can be captured.
  document.addEventListener("toggle", (event) => {
    const menu = menuOf(event);
    if (menu && menu === event.target && menu.hasAttribute("open")) place(menu);
  }, true);
  addEventListener("pointerdown", (event) => closeMenus(menuOf(event)));
  document.addEventListener("scroll", (event) => closeMenus(menuOf(event)), true);
  addEventListener("resize", () => closeMenus(null));
  addEventListener("keydown", (event) => {
    const open = document.querySelector("details.menu[open]");
    if (event.key !== "Escape" || !open) return;
    closeMenus(null);
    /** @type {HTMLElement | null} */ (open.querySelector("summary"))?.focus();
  });
}
