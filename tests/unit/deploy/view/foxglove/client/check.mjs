// SPDX-License-Identifier: Apache-2.0
// Usage: node check.mjs PORT
// Connects as Lichtblick does, subscribes to all channels for three seconds, decodes all messages by the advertised
// schemas, and prints a JSON object: per topic the number of messages and the last one.
import WebSocket from "ws";
import protocol from "@foxglove/ws-protocol";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";

const { FoxgloveClient } = protocol;
const client = new FoxgloveClient({ ws: new WebSocket(`ws://localhost:${process.argv[2]}`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const channels = new Map();  // by subscription
const arrived = {};

client.on("error", (error) => {
  console.log(String(error));
  process.exit(1);
});
client.on("advertise", (advertised) => {
  for (const channel of advertised) {
    const reader = channel.encoding === "cdr" ? new MessageReader(channel.schemaName, parseIDL(channel.schema)) : undefined;
    arrived[channel.topic] = { type: channel.schemaName, messages: 0 };
    channels.set(client.subscribe(channel.id), { topic: channel.topic, reader });
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const { topic, reader } = channels.get(subscriptionId);
  const entry = arrived[topic];
  entry.last = reader ? reader.readMessage(data) : JSON.parse(new TextDecoder().decode(data));
  entry.timestamp_s = Number(timestamp) * 1e-9;
  ++entry.messages;
});
setTimeout(() => {
  console.log(JSON.stringify(arrived, (key, value) => (typeof value === "bigint" ? Number(value) : value)));
  process.exit(0);
}, 3000);
