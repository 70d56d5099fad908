// SPDX-License-Identifier: Apache-2.0
// What the steps that move the robot have in common.
#pragma once

#include <string>

#include "deploy/trial/conformance/conformance_step.hpp"

namespace sidestep {

constexpr Duration kSettlingTime = std::chrono::milliseconds(700), kDriveTimeout = std::chrono::seconds(20);
/// Distance from the field's edge, in addition to the robot's radius.
constexpr double kEdge_m = 0.35;
/// Errors up to this many standard deviations may be due to vision's noise.
constexpr double kNoiseDeviations = 4;

/// The judgement of a step, with the reason added to `figures` if it is not the robot's fault. A robot whose
/// motors respond later or earlier than it assumes cannot follow its reference; only the latency row then
/// fails.
Conformity judged(bool is_passed, const ConformanceContext& context, std::string& figures);

/// Raises the scenario's tracking bound to what this observation needs.
void keep_error(ConformanceContext& context, const MotionSample& sample);
/// Raises the scenario's tracking bound to what the robot's latest report needs. A robot makes its own stop
/// if the error that it reports, with twice its uncertainty, exceeds the drift bound for longer than its
/// control may take. Call once per cycle while the robot drives.
void keep_report(ConformanceContext& context);
/// Raises the scenario's tracking bound to that within which the robot can stop from full speed without
/// further observations (coordinator/PROTOCOL.md, "Dead reckoning"), with a reserve: with the bound itself,
/// agents would drive slowly whenever the robot's estimate is a little less certain.
void keep_uncertainty(ConformanceContext& context);

/// A policy that drives to a point and stops there.
VersionStream::Policy drive_to(const Vec2& goal_m, const MotionLimits& limits, double speed_mps);

bool is_at(const ConformanceContext& context, const Vec2& goal_m);

}  // namespace sidestep
