// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance_row.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/motion/safety_budget.hpp"

namespace sidestep {
namespace {

const char* to_text(Conformity conformity) {
  switch (conformity) {
    case Conformity::kPassed:
      return "passed";
    case Conformity::kFailed:
      return "FAILED";
    case Conformity::kNotJudged:
      return "not judged";
  }
  return "?";
}

}  // namespace

ConformanceRow latency_row(Duration lead, Duration late, bool is_allowed) {
  if (!(lead + late > Duration{0}))
    return {"latency", Conformity::kNotJudged,
            "the robot seems to move before it is commanded: vision's frames are dated wrongly; see what "
            "vision says about the sender's clock"};
  return {"latency", is_allowed ? Conformity::kPassed : Conformity::kFailed,
          fmt::format("the motors obey after {:.0f} ms; the robot assumes {:.0f} ms",
                      to_seconds(lead + late) * 1e3, to_seconds(lead) * 1e3)};
}

std::string to_line(const ConformanceRow& row) {
  return fmt::format("{:<10}  {:<20}  {}", to_text(row.conformity), row.rule, row.figures);
}

std::string scenario_lines(const RobotFigures& figures) {
  if (!figures.tracking_bound_m || !figures.clock_bound_s || !figures.is_within_limits)
    return "no figures for the scenario: the robot failed a step on which they depend\n";
  SafetyBudget budget;
  budget.tracking_bound_m = *figures.tracking_bound_m;
  budget.clock_bound_s = *figures.clock_bound_s;
  budget.speed_mps = figures.limits.speed_mps;
  const double margin_m = std::ceil(budget.required_margin_m() * 1e3 - 1e-6) * 1e-3;
  return fmt::format(
      "for the scenario file:\n"
      "tracking_bound_m: {:.3f}\n"
      "margin_m: {:.3f}\n"
      "clock_bound_s: {:.4g}\n"
      "limits: {{acceleration_mps2: {:g}, deceleration_mps2: {:g}, speed_mps: {:g}}}\n",
      budget.tracking_bound_m, margin_m, budget.clock_bound_s, figures.limits.acceleration_mps2,
      figures.limits.deceleration_mps2, figures.limits.speed_mps);
}

bool ConformanceReport::is_conformant() const {
  return !rows.empty() && std::ranges::all_of(rows, [](const ConformanceRow& row) {
    return row.conformity == Conformity::kPassed;
  });
}

bool ConformanceReport::has_failed() const {
  return std::ranges::any_of(rows,
                             [](const ConformanceRow& row) { return row.conformity == Conformity::kFailed; });
}

std::string to_text(const ConformanceReport& report) {
  std::string text;
  for (const ConformanceRow& row : report.rows) text += to_line(row) + "\n";
  return text + scenario_lines(report.figures);
}

}  // namespace sidestep
