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

/// The judgement of a step, with the reason added to `figures` if it is not the robot's fault.
Conformity judged(bool is_passed, const ConformanceContext& context, std::string& figures);

/// Keeps the largest error of all steps, for the scenario's tracking bound.
void keep_error(ConformanceContext& context, const MotionSample& sample);

/// The tracking bound within which the robot can stop from full speed without further observations
/// (coordinator/PROTOCOL.md, "Dead reckoning"): three standard deviations of its estimate, and four of the
/// error that grows with the distance driven, are within the drift bound.
double bound_for_dead_reckoning_m(const LocalisationUncertainty& uncertainty, const Scenario& scenario,
                                  Duration lead);

/// A policy that drives to a point and stops there.
VersionStream::Policy drive_to(const Vec2& goal_m, const MotionLimits& limits, double speed_mps);

bool is_at(const ConformanceContext& context, const Vec2& goal_m);

}  // namespace sidestep
