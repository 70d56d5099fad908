// SPDX-License-Identifier: Apache-2.0
// What the clock says about the moment shown.
import {number, timeOfDay} from "./format.js";

/**
 * @typedef {{mode: string, speed: number, shown_s: number, begin_s: number, end_s: number, first_grant_s: number | null,
 *            progress: number, isRecording: boolean, isConnected: boolean}} Moment
 */

const kNear_s = 0.15;  // the ends of the history are rounded to tenths of a second

/**
 * Whether nothing comes after the moment shown.
 * @param {Moment} m
 */
export const isAtEnd = (m) => m.mode === "live" || m.shown_s > m.end_s - kNear_s;

/** @param {Moment} m */
function place(m) {
  if (m.first_grant_s !== null && Math.abs(m.shown_s - m.first_grant_s) < 0.03) return " at the first granted motion";
  if (m.shown_s < m.begin_s + kNear_s) return " at the beginning";
  return m.isRecording && isAtEnd(m) ? " at the end" : "";
}

/** @param {Moment} m */
function state(m) {
  if (!m.isConnected) return "connection lost: this is the last moment received";
  if (m.mode === "playing") return m.speed === 1 ? "playing" : `playing at ${m.speed} times the speed`;
  if (m.mode === "live") return !m.isRecording ? "live" : m.progress < 1 ? "the last moment read so far" : "end of the recording";
  return `paused${place(m)}${m.isRecording ? "" : `, ${number(m.end_s - m.shown_s, 2)} s ago`}`;
}

/** @param {Moment} m */
export function momentText(m) {
  const position = m.isRecording ? ` · ${number(m.shown_s - m.begin_s, 2)} of ${number(m.end_s - m.begin_s, 1)} s` : "";
  const loading = m.progress < 1 ? ` · reading, ${Math.round(100 * m.progress)} %` : "";
  return `${timeOfDay(m.shown_s)}${position} · ${state(m)}${loading}`;
}
