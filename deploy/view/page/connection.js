// SPDX-License-Identifier: Apache-2.0
// The web socket to the monitor. Reconnects when the connection is lost.

export class Connection {
  /**
   * @param {string} protocol
   * @param {(message: any) => void} onMessage
   * @param {(frame: ArrayBuffer) => void} onFrame
   * @param {(state: "connected" | "lost") => void} onState
   */
  constructor(protocol, onMessage, onFrame, onState) {
    this.protocol = protocol;
    this.onMessage = onMessage;
    this.onFrame = onFrame;
    this.onState = onState;
    this.delay_ms = 250;
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/socket`, this.protocol);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.delay_ms = 250;
      this.onState("connected");
    };
    socket.onmessage = (event) => {
      if (event.data instanceof ArrayBuffer) this.onFrame(event.data);
      else this.onMessage(JSON.parse(event.data));
    };
    socket.onclose = () => {
      this.onState("lost");
      setTimeout(() => this.open(), this.delay_ms);
      this.delay_ms = Math.min(2 * this.delay_ms, 4000);
    };
    this.socket = socket;
  }

  /** @param {object} message */
  send(message) {
    if (this.socket && this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
