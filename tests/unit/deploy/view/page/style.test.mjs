// SPDX-License-Identifier: Apache-2.0
// The colours of both themes: contrast as WCAG 2 defines it. Texts need 4.5, what is drawn needs 3.
import assert from "node:assert/strict";
import test from "node:test";
import {coloursOf, pageFile} from "./fake_page.mjs";

function luminance(colour) {
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16) / 255)
                        .map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(a, b) {
  const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (light + 0.05) / (dark + 0.05);
}

test("contrast is computed as WCAG 2 says", () => {
  assert.equal(contrast("#000000", "#ffffff"), 21);
  assert.equal(contrast("#767676", "#ffffff").toFixed(2), "4.54");
});

for (const theme of ["dark", "light"]) {
  const colours = coloursOf(theme);
  const check = (front, back, least) => {
    assert.ok(colours[front] && colours[back], `${front} or ${back} is not in style.css`);
    const found = contrast(colours[front], colours[back]);
    assert.ok(found >= least, `${theme}: --${front} on --${back}: ${found.toFixed(2)}, expected at least ${least}`);
  };

  test(`texts of the ${theme} theme have a contrast of at least 4.5`, () => {
    for (const text of ["text", "dim", "accent", "error", "warning"])
      for (const ground of ["panel", "ground"]) check(text, ground, 4.5);
    for (const lamp of ["lamp-kept", "lamp-broken", "lamp-unknown"]) check("lamp-text", lamp, 4.5);
    // Plots name their lines in the colour of the line.
    for (const line of ["sky", "orange", "green", "purple", "yellow", "red"]) check(line, "panel", 4.5);
  });

  test(`what is drawn in the ${theme} theme has a contrast of at least 3 to the floor`, () => {
    for (const colour of ["grey", "blue", "sky", "yellow", "orange", "green", "red", "purple", "text"]) check(colour, "ground", 3);
    check("control", "panel", 3);
    // The mark of the selected robot is drawn on the floor, around robots of both teams.
    check("text", "ground", 7);
    // Robots differ from the floor by their colour or by their edge, and directions from robots.
    for (const team of ["team-blue", "team-yellow"]) {
      assert.ok(Math.max(contrast(colours[team], colours.ground), contrast(colours.edge, colours.ground)) >= 3, team);
      check("edge", team, 3);
    }
  });
}

test("the page has no colours but those of the style sheet, except for the league's ball and shadows", () => {
  const modules = pageFile("main.js").match(/"\.\/[a-z_]+\.js"/g).map((name) => name.slice(3, -1));
  for (const name of [...modules, "planning.js", "planning_scene.js", "course_layers.js", "labels.js", "robot_layers.js"]) {
    const found = (pageFile(name).match(/#[0-9a-f]{6}\b/gi) ?? []).filter((colour) => colour !== "#ff8c1a");
    assert.deepEqual(found, [], name);
  }
});

test("the legend of the planning page has the colours in which the page draws", () => {
  const style = pageFile("style.css"), scene = pageFile("planning_scene.js"), html = pageFile("planning.html");
  const drawn = {free: "green", blocked: "red", unchecked: "grey", path: "sky", start: "sky", goal: "purple", obstacle: "grey"};
  for (const [name, colour] of Object.entries(drawn)) {
    assert.match(html, new RegExp(`class="[a-z]+ ${name}"`));
    assert.match(style, new RegExp(`#legend \\.${name} \\{ color: var\\(--${colour}\\)`));
    assert.match(scene, new RegExp(`palette\\.${colour}\\b`));
  }
  for (const word of ["Grey", "grey", "green", "red dashes"]) assert.ok(!html.includes(word), word);
});

test("the planning page has both themes, and its legend is drawn with it", async () => {
  assert.match(pageFile("planning.html"), /id="theme"/);
  assert.match(pageFile("planning.js"), /startTheme\(\);/);
});
