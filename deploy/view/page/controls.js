// SPDX-License-Identifier: Apache-2.0
// Orders and faults, for viewers who have the token.
import {create} from "./format.js";

const kFaults = [["push", {kind: "push", vx_mps: 1, vy_mps: 0}], ["slip", {kind: "slip", grip: 0.3, seconds: 1}],
                 ["block", {kind: "block", seconds: 1}], ["lift", {kind: "lift"}], ["reboot", {kind: "reboot"}],
                 ["switch off", {kind: "switch off"}], ["switch on", {kind: "switch on"}]];

export class Controls {
  /** @param {string} token */
  constructor(token) {
    this.token = token;
    this.robot = -1;
    this.result = create("p", {role: "status", id: "command-result"});
    this.chosen = create("strong", {}, "none");
    const button = (/** @type {string} */ name, /** @type {() => void} */ act) => {
      const node = create("button", {id: `command-${name.replace(/ /g, "-")}`}, name);
      node.addEventListener("click", act);
      return node;
    };
    this.node = create("div", {},
        create("p", {}, "Robot: ", this.chosen, ". Drag a robot to send it somewhere."),
        create("div", {class: "buttons"}, button("hold all", () => this.post("/api/hold")),
               button("resume all", () => this.post("/api/resume"))),
        create("div", {class: "buttons"}, ...["hold", "resume", "cancel"].map((what) => button(what, () => this.toRobot(what)))),
        create("h2", {}, "Faults of this robot"),
        create("div", {class: "buttons"}, ...kFaults.map(([name, body]) => button(String(name), () => this.toRobot("fault", body)))),
        this.result);
  }

  /** @param {number} robot */
  select(robot) {
    this.robot = robot;
    this.chosen.textContent = robot < 0 ? "none" : String(robot);
  }

  /** @param {string} what @param {any} [body] */
  toRobot(what, body) {
    if (this.robot < 0) {
      this.result.textContent = "Choose a robot first.";
      return;
    }
    this.post(`/api/robots/${this.robot}/${what}`, body);
  }

  /**
   * Sends a request. Returns whether it was accepted.
   * @param {string} path @param {any} [body] @returns {Promise<boolean>}
   */
  async post(path, body) {
    try {
      const response = await fetch(path, {method: "POST", headers: {Authorization: `Bearer ${this.token}`},
                                          body: body ? JSON.stringify(body) : ""});
      const answer = await response.text();
      let text = answer.trim();
      try {
        text = JSON.parse(answer).error || text;
      } catch {
        // Not JSON: shown as it is.
      }
      this.result.textContent = `${path}: ${response.ok ? "sent" : text}`;
      return response.ok;
    } catch (error) {
      this.result.textContent = `${path}: ${error}`;
      return false;
    }
  }
}
