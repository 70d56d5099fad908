// SPDX-License-Identifier: Apache-2.0
// Defines window.pageChecks: what tests ask about a page in a browser. Lists are empty if all is well.

/** Names an element for people. */
const nameOf = (node) => node.id || node.getAttribute("aria-label") || node.textContent.trim().slice(0, 40) || node.tagName;

/** Whether an element is drawn; what a closed menu folds away is not. */
const isDrawn = (node) => node.getClientRects().length > 0 && node.checkVisibility({visibilityProperty: true});

/** The colour of a CSS text as red, green, blue and opacity. */
function coloursOf(text) {
  const [r, g, b, a] = text.match(/[\d.]+/g).map(Number);
  return [r, g, b, a ?? 1];
}

/** What is behind an element: the first opaque ground, with the translucent ones over it. */
function groundOf(node) {
  if (!node) return [255, 255, 255];
  const [r, g, b, a] = coloursOf(getComputedStyle(node).backgroundColor);
  if (a === 1) return [r, g, b];
  return over([r, g, b, a], groundOf(node.parentElement));
}

/** A colour over another one. */
const over = ([r, g, b, a], behind) => [r, g, b].map((v, i) => a * v + (1 - a) * behind[i]);

/** The filling of a shape or text of a picture as red, green, blue and opacity; null if it has none. */
function fillingOf(node) {
  const style = getComputedStyle(node);
  if (!style.fill.startsWith("rgb")) return null;
  const [r, g, b, a] = coloursOf(style.fill);
  return [r, g, b, a * style.fillOpacity * style.opacity];
}

/** What is behind a text of a picture: its halo, or the filled shapes below its middle, or what is behind the picture. */
function groundInPicture(text) {
  const style = getComputedStyle(text);
  if (style.stroke.startsWith("rgb") && style.paintOrder.startsWith("stroke")) return coloursOf(style.stroke).slice(0, 3);
  const [x, y] = [scrollX, scrollY];
  text.scrollIntoView({block: "nearest", inline: "nearest"});
  const box = text.getBoundingClientRect();
  const nodes = document.elementsFromPoint(box.x + box.width / 2, box.y + box.height / 2);
  scrollTo(x, y);
  const fillings = [];
  for (const node of nodes.slice(nodes.indexOf(text) + 1)) {
    if (!(node instanceof SVGGeometryElement)) continue;
    const filling = fillingOf(node);
    if (filling) fillings.push(filling);
    if (filling && filling[3] === 1) break;
  }
  return fillings.reduceRight((behind, filling) => over(filling, behind), groundOf(text.closest("svg").parentElement));
}

/** The contrast of a text to what is behind it. */
function contrastOf(node) {
  if (!(node instanceof SVGElement)) return contrast(coloursOf(getComputedStyle(node).color).slice(0, 3), groundOf(node));
  const ground = groundInPicture(node);
  return contrast(over(fillingOf(node), ground), ground);
}

function luminance(colour) {
  const [r, g, b] = colour.map((v) => v / 255).map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(a, b) {
  const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (light + 0.05) / (dark + 0.05);
}

/** Controls whose middle a person cannot reach, by scrolling at most, or whose text is cut. */
function hiddenControls() {
  const problems = [];
  for (const node of document.querySelectorAll("button, a, select, input, summary, canvas[tabindex], [role=separator]")) {
    if (!isDrawn(node)) continue;
    node.scrollIntoView({block: "nearest", inline: "nearest"});
    const box = node.getBoundingClientRect();
    const isOnPage = box.left >= -0.5 && box.top >= -0.5 && box.right <= innerWidth + 0.5 && box.bottom <= innerHeight + 0.5;
    const top = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
    if (!isOnPage) problems.push(`${nameOf(node)}: outside of the page`);
    else if (!top || !(node.contains(top) || top.closest("label")?.contains(node)))
      problems.push(`${nameOf(node)}: behind ${top ? nameOf(top) : "nothing"}`);
    if (["BUTTON", "A", "SUMMARY"].includes(node.tagName) && node.scrollWidth > node.clientWidth + 1 && node.clientWidth > 0)
      problems.push(`${nameOf(node)}: its text is cut`);
  }
  scrollTo(0, 0);
  if (document.documentElement.scrollWidth > innerWidth) problems.push("the page is wider than the window");
  return problems;
}

/** Texts whose contrast to what is behind them is less than 4.5. */
function faintTexts() {
  const problems = [];
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const node = texts.currentNode.parentElement;
    if (!texts.currentNode.textContent.trim() || !isDrawn(node) || node.tagName === "OPTION") continue;
    const ratio = contrastOf(node);
    if (ratio < 4.5) problems.push(`${nameOf(node)}: ${ratio.toFixed(2)}`);
  }
  return problems;
}

/** Of these elements, those that are not wholly on the first screen. */
function belowFirstScreen(ids) {
  scrollTo(0, 0);
  return ids.filter((id) => {
    const box = document.getElementById(id).getBoundingClientRect();
    return !(box.height > 0 && box.top >= 0 && box.bottom <= innerHeight && box.right <= innerWidth);
  });
}

/** The part of the window that the floor has. */
function floorShare() {
  const box = document.getElementById("floor").getBoundingClientRect();
  return box.width * box.height / (innerWidth * innerHeight);
}

/** Numbers of robots that are not drawn, or that overlap each other or a robot, and marks that are too small. */
function illegibleRobots() {
  const {labels, marks} = monitor.drawn;
  const problems = marks.filter((mark) => !labels.some((label) => label.id === mark.id)).map((mark) => `${mark.id}: has no number`);
  for (const mark of marks) if (mark.r < 6) problems.push(`${mark.id}: its mark is ${2 * mark.r} pixels wide`);
  for (const label of labels) {
    if (label.height < 12) problems.push(`${label.id}: its number is ${label.height} pixels high`);
    const across = (other, width, height) => Math.abs(label.x - other.x) < (label.width + width) / 2 - 1 &&
        Math.abs(label.y - other.y) < (label.height + height) / 2 - 1;
    for (const other of labels)
      if (other.id > label.id && across(other, other.width, other.height)) problems.push(`${label.id} and ${other.id}: numbers overlap`);
    for (const mark of marks) {
      const beside = (distance, size) => Math.max(Math.abs(distance) - size / 2, 0);
      if (Math.hypot(beside(label.x - mark.x, label.width), beside(label.y - mark.y, label.height)) < mark.r - 1)
        problems.push(`${label.id}: its number covers robot ${mark.id}`);
    }
  }
  return problems;
}

/** How many pixels around a robot have about the colour of texts. */
function markedPixels(robot) {
  const {floor} = monitor;
  const place = floor.toPixels(floor.places().find((p) => p.id === robot));
  const size = 60, ratio = floor.ratio;
  const {data} = floor.context.getImageData((place.x - size / 2) * ratio, (place.y - size / 2) * ratio, size * ratio, size * ratio);
  const [r, g, b] = coloursOf(getComputedStyle(document.body).color);
  let found = 0;
  for (let i = 0; i < data.length; i += 4)
    if (data[i + 3] > 200 && Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 60) ++found;
  return found;
}

/** Seeks to a moment by the slider, as a person does. */
function seekTo(at_s) {
  const slider = document.getElementById("time");
  slider.value = at_s - Number(monitor.timeline.moment.begin_s);
  slider.dispatchEvent(new Event("input"));
  slider.dispatchEvent(new Event("change"));
}

/** Drags with the pointer from one place on the page to another. */
function dragPointer(node, from, to) {
  const canvas = document.getElementById("floor");
  canvas.setPointerCapture = () => {};
  const fire = (target, type, {x, y}) => target.dispatchEvent(
      new PointerEvent(type, {clientX: x, clientY: y, pointerId: 1, button: 0, bubbles: true}));
  fire(node, "pointerdown", from);
  for (const share of [0.1, 0.5, 1])
    fire(node, "pointermove", {x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y)});
  fire(node, "pointerup", to);
}

/** Where a place on the floor is on the page. */
function pagePlace(x, y) {
  const box = document.getElementById("floor").getBoundingClientRect(), pixel = monitor.floor.toPixels({x, y});
  return {x: box.x + pixel.x, y: box.y + pixel.y};
}

window.pageChecks = {hiddenControls, faintTexts, belowFirstScreen, floorShare, illegibleRobots, markedPixels, seekTo, dragPointer,
                     pagePlace};
