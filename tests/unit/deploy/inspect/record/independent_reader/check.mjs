// SPDX-License-Identifier: Apache-2.0
// Usage: node check.mjs RECORDING DESCRIPTIONS
// Decodes all messages of a recording by the recording's schemas, and compares every field with the output of
// `sidestep topic echo` (one line of JSON per message, in the same order). Prints the number of compared messages and
// fields; exit code 1 at the first difference.
import fs from "node:fs";
import { McapIndexedReader } from "@mcap/core";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { decompress } from "fzstd";

const [file, descriptions] = process.argv.slice(2);

class FileSource {
  constructor(path) {
    this.handle = fs.openSync(path, "r");
    this.bytes = BigInt(fs.fstatSync(this.handle).size);
  }
  async size() {
    return this.bytes;
  }
  async read(offset, length) {
    const buffer = new Uint8Array(Number(length));
    if (fs.readSync(this.handle, buffer, 0, buffer.length, Number(offset)) !== buffer.length)
      throw new Error("the file is shorter than its index says");
    return buffer;
  }
}

let fields = 0;
const words = new Map();  // by topic and path: the word for each number

function fail(path, ours, theirs) {
  const text = (value) => JSON.stringify(value, (key, v) => (typeof v === "bigint" ? String(v) : v));
  console.log(`${path}: Sidestep has ${text(ours)}, the independent reader ${text(theirs)}`);
  process.exit(1);
}

function compareText(path, ours, theirs) {
  if (theirs instanceof Uint8Array || Array.isArray(theirs)) {
    const bytes = Uint8Array.from(theirs);
    const decoder = new TextDecoder(), end = bytes.indexOf(0);
    // A name in an array of fixed length ends at the first zero.
    const isName = end >= 0 && ours === decoder.decode(bytes.subarray(0, end));
    return isName || ours === decoder.decode(bytes) || ours === `${bytes.length} bytes` || fail(path, ours, theirs);
  }
  if (ours === String(theirs) || ours === `unknown ${theirs}`) return true;
  if (/^[0-9a-f]{16}$/.test(ours) && BigInt("0x" + ours) === BigInt(theirs)) return true;
  // The word of an enumerator must be the same each time, and different for each number.
  if (!words.has(path)) words.set(path, new Map());
  const known = words.get(path);
  const [number] = [...known].find(([, word]) => word === ours) ?? [theirs];
  if (typeof theirs !== "number" || (known.get(theirs) ?? ours) !== ours || number !== theirs) fail(path, ours, theirs);
  known.set(theirs, ours);
  return true;
}

function compare(path, ours, theirs) {
  if (theirs === undefined) fail(path, ours, theirs);
  if (Array.isArray(ours)) {
    // Sidestep leaves out the unused elements of an array with a count.
    if (ours.length > theirs.length) fail(path, ours, theirs);
    ours.forEach((element, i) => compare(`${path}[]`, element, theirs[i]));
  } else if (ours !== null && typeof ours === "object") {
    if ("p50_us" in ours) return compareHistogram(path, ours, theirs);
    const extra = Object.keys(theirs).filter((name) => !(name in ours));
    if (extra.length > 0) fail(`${path}.${extra[0]}`, undefined, theirs[extra[0]]);
    for (const name in ours) compare(`${path}.${name}`, ours[name], theirs[name]);
  } else {
    ++fields;
    if (typeof ours === "string") return compareText(path, ours, theirs);
    const isSame = typeof ours === "bigint" ? ours === BigInt(theirs)
      : typeof theirs === "bigint" ? BigInt(ours) === theirs
      : Object.is(ours, theirs) || ours === theirs || (ours === null && !Number.isFinite(theirs));
    if (!isSame) fail(path, ours, theirs);
  }
}

/// Compares only the total count, because Sidestep prints quantiles instead of the counts.
function compareHistogram(path, ours, theirs) {
  ++fields;
  const counts = Object.values(theirs).find((value) => typeof value !== "number" && typeof value !== "bigint");
  const sum = Array.from(counts).reduce((total, count) => total + Number(count), 0);
  if (sum !== ours.count) fail(path, ours, theirs);
}

/// Parses JSON. Whole numbers that a double cannot hold become bigints.
function parse(line) {
  const marked = line.replace(/([:[,])(-?\d{16,})(?=[,}\]])/g, '$1"#number $2"');
  return JSON.parse(marked, (key, value) =>
    typeof value === "string" && value.startsWith("#number ") ? BigInt(value.slice(8)) : value);
}

const lines = fs.readFileSync(descriptions, "utf8").split("\n").filter((line) => line !== "");
const decompressHandlers = { zstd: (buffer, size) => decompress(buffer, new Uint8Array(Number(size))) };
const reader = await McapIndexedReader.Initialize({ readable: new FileSource(file), decompressHandlers });
const readers = new Map();
const topics = new Set();
let messages = 0;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  if (!readers.has(schema.name))
    readers.set(schema.name, new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data))));
  const theirs = readers.get(schema.name).readMessage(message.data);
  if (messages >= lines.length) fail(channel.topic, undefined, theirs);
  compare(channel.topic, parse(lines[messages]), theirs);
  if (message.sequence !== Number(theirs.header.message_number & 0xffffffffn)) fail("sequence", message.sequence, theirs);
  const stamp = theirs.header.stamp_ns > 0n ? theirs.header.stamp_ns : 0n;
  if (message.publishTime !== stamp) fail("publish time", message.publishTime, theirs.header.stamp_ns);
  topics.add(channel.topic.split("/")[0]);
  ++messages;
}
if (messages !== lines.length) fail("messages", lines.length, messages);
if (BigInt(messages) !== reader.statistics.messageCount) fail("statistics", reader.statistics, messages);
console.log(`${messages} messages of ${topics.size} topics, ${fields} fields agree`);
