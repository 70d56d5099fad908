// SPDX-License-Identifier: Apache-2.0
// Orders and faults, for viewers who have the token.
import {create} from "./format.js";

const kFaults = [["push", {kind: "push", vx_mps: 1, vy_mps: 0}], ["slip", {kind: "slip", grip: 0.3, seconds: 1}],
                 ["block", {kind: "block", seconds: 1}], ["lift", {kind: "lift"}], ["reboot", {kind: "reboot"}],
                 ["switch off", {kind: "switch off"}], ["switch on", {kind: "switch on"}]];
const kFollowPeriod_ms = 500;
const kFollowed = 240;  // looks at an order, two minutes in all
const kFinal = ["arrived", "replaced", "refused"];

/**
 * What has become of an order.
 * @param {string} what e.g. "Robot 3: order" @param {any} state the answer to GET /api/orders/17
 */
export function orderText(what, state) {
  return `${what} ${state.order} ${state.phase}${state.reason ? `: ${state.reason}` : ""}`;
}

/**
 * Why a request was not carried out, as far as is known.
 * @param {string} what e.g. "Robot 3: push" @param {number} status of HTTP @param {string} error
 */
export function failureText(what, status, error) {
  if (status === 504) return `${what}: no answer; it may have been applied`;
  return `${what} ${status >= 500 ? "failed" : "refused"}: ${error}`;
}

export class Controls {
  /** @param {string} token */
  constructor(token) {
    this.token = token;
    this.robot = -1;
    this.posts = 0;
    this.refusal = "";
    this.result = create("p", {role: "status", id: "command-result"});
    this.chosen = create("p", {class: "hint"});
    /** @type {any[]} */
    this.buttons = [];
    const button = (/** @type {string} */ name, /** @type {() => void} */ act) => {
      const node = create("button", {id: `command-${name.replace(/ /g, "-")}`}, name);
      node.addEventListener("click", act);
      this.buttons.push(node);
      return node;
    };
    this.node = create("div", {},
        this.chosen,
        create("div", {class: "buttons"}, button("hold all", () => this.holdAll()),
               button("resume all", () => this.post("/api/resume", undefined, "All robots: resume"))),
        create("div", {class: "buttons"},
               ...["hold", "resume", "cancel"].map((what) => button(what, () => this.toRobot(what)))),
        create("h2", {}, "Faults of this robot"),
        create("div", {class: "buttons"},
               ...kFaults.map(([name, body]) => button(String(name), () => this.toRobot("fault", body)))),
        this.result);
    this.select(-1);
  }

  /** @param {number} robot */
  select(robot) {
    this.robot = robot;
    this.chosen.textContent = this.refusal ? this.refusal : robot < 0
        ? "No robot is selected: click one on the floor or in the table. A robot that you drag on the floor drives there."
        : `Robot ${robot} is selected. Drag it on the floor to send it somewhere.`;
  }

  /**
   * Whether this page may command; if not, it says why.
   * @param {boolean} may @param {boolean} isOver
   */
  allow(may, isOver) {
    this.refusal = may ? "" : isOver ? "The run is over: nothing can be commanded."
        : "This page may not command. Open the link that the monitor printed: it ends with #token=.";
    for (const button of this.buttons) button.disabled = !may;
    this.select(this.robot);
  }

  holdAll() {
    return this.post("/api/hold", undefined, "All robots: hold");
  }

  /** @param {number} robot @param {number} x @param {number} y */
  go(robot, x, y) {
    return this.post(`/api/robots/${robot}/order`, {goals: [[x, y]]}, `Robot ${robot}: order`);
  }

  /** @param {string} what @param {any} [body] */
  toRobot(what, body) {
    if (this.robot < 0) {
      this.result.textContent = "Select a robot first: click one on the floor or in the table.";
      return;
    }
    this.post(`/api/robots/${this.robot}/${what}`, body, `Robot ${this.robot}: ${body ? body.kind : what}`);
  }

  /**
   * Sends a request, and shows what becomes of it, unless there was a later one. Returns the answer, or null if it was not
   * carried out.
   * @param {string} path @param {any} body @param {string} what for people, e.g. "Robot 3: hold" @returns {Promise<any>}
   */
  async post(path, body, what) {
    const number = ++this.posts;
    const show = (/** @type {string} */ result) => {
      if (number === this.posts) this.result.textContent = result;
    };
    try {
      const response = await fetch(path, {method: "POST", headers: {Authorization: `Bearer ${this.token}`},
                                          body: body ? JSON.stringify(body) : ""});
      const text = (await response.text()).trim();
      const answer = parsed(text);
      if (!response.ok) {
        show(failureText(what, response.status, answer.error || text));
        return null;
      }
      show(`${what} sent`);
      if (answer.order !== undefined) this.follow(answer.order, what, number);
      return answer;
    } catch (error) {
      show(`${what}: no answer; it may have been applied (${error})`);
      return null;
    }
  }

  /**
   * Shows the state of an order until it is final, or until the next request.
   * @param {any} order @param {string} what @param {number} number
   */
  async follow(order, what, number) {
    for (let i = 0; i < kFollowed; ++i) {
      await new Promise((resolve) => setTimeout(resolve, kFollowPeriod_ms));
      if (number !== this.posts) return;
      const response = await fetch(`/api/orders/${order}`).catch(() => null);
      const state = response && response.ok ? await response.json().catch(() => null) : null;
      if (!state || number !== this.posts) return;
      this.result.textContent = orderText(what, state);
      if (kFinal.includes(state.phase)) return;
    }
  }
}

/**
 * A JSON object; an empty one for another text.
 * @param {string} text
 */
function parsed(text) {
  try {
    return JSON.parse(text) || {};
  } catch {
    return {};
  }
}
