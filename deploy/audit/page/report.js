// SPDX-License-Identifier: Apache-2.0
// Plays and seeks in the picture of the run. Without scripts, the picture plays by itself.
"use strict";

/** @param {HTMLElement} player @param {SVGSVGElement} picture */
function control(player, picture) {
  const begin = Number(player.dataset.begin), end = Number(player.dataset.end), speed = Number(player.dataset.speed),
        round = Number(player.dataset.round);
  const button = /** @type {HTMLButtonElement} */ (player.querySelector("button"));
  const slider = /** @type {HTMLInputElement} */ (player.querySelector("input"));
  const clock = /** @type {HTMLOutputElement} */ (player.querySelector("output"));
  let plays = true;

  /** @param {boolean} value */
  const setPlays = value => {
    plays = value;
    if (plays) picture.unpauseAnimations(); else picture.pauseAnimations();
    button.textContent = plays ? "Pause" : "Play";
  };
  /** @param {number} seconds */
  const seek = seconds => {
    setPlays(false);
    picture.setCurrentTime((Math.max(begin, Math.min(end, seconds)) - begin) / speed);
  };
  const show = () => {
    const at = Math.min(end, begin + (picture.getCurrentTime() % round) * speed);
    if (plays) slider.value = String(at);
    clock.textContent = at.toFixed(2) + " s";
    requestAnimationFrame(show);
  };

  player.hidden = false;
  button.addEventListener("click", () => setPlays(!plays));
  slider.addEventListener("input", () => seek(Number(slider.value)));
  for (const time of eventTimes()) {
    time.addEventListener("click", () => {
      seek(Number(time.dataset.at));
      slider.value = time.dataset.at ?? "0";
      picture.scrollIntoView({block: "nearest"});
    });
  }
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) seek(end);
  show();
}

/** @returns {NodeListOf<HTMLButtonElement>} the times in the list of events */
function eventTimes() { return document.querySelectorAll("button[data-at]"); }

const foundPlayer = document.getElementById("player");
const foundPicture = /** @type {SVGSVGElement | null} */ (document.querySelector(".floor svg"));
if (foundPlayer && foundPicture) control(foundPlayer, foundPicture);
else for (const time of eventTimes()) time.disabled = true;
