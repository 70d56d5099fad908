// SPDX-License-Identifier: Apache-2.0
// What the floor says when it has little to show.

/**
 * @typedef {{connection: string, hasScene: boolean, isRecording: boolean, mode: string, robots: number, wantsField: boolean,
 *            selected: number, beforeFirstGrant: boolean}} FloorState
 */

/**
 * The text over the floor; empty if the floor speaks for itself.
 * @param {FloorState} s
 */
export function floorHint(s) {
  if (s.connection === "lost")
    return "The connection to the monitor is lost, and tried again. The floor shows the last moment received.";
  if (!s.hasScene) return "Connecting to the monitor…";
  if (s.robots === 0 && s.isRecording)
    return s.beforeFirstGrant ? "No robot is known at this moment: the recording has just begun. Play, or drag the slider below."
                              : "No robot is known at this moment of the recording. Drag the slider below.";
  if (s.robots === 0)
    return "No robot has been heard. Start a run, or check that this monitor uses the same DDS domain and interface.";
  if (!s.wantsField) return "";
  if (s.isRecording || s.mode !== "live")
    return "The fields of the selected robot are computed live only: choose Live in a running system.";
  return s.selected < 0 ? "Select a robot to see its navigation function, band and local grid." : "";
}
