// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance_row.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/motion/safety_budget.hpp"

namespace sidestep {
namespace {

// A latency that is less certain than this is not judged.
constexpr Duration kMaxLatencyUncertainty = std::chrono::milliseconds(5);
// Errors of a measured latency that do not vary, and so are not part of its uncertainty.
constexpr Duration kLatencyBias = std::chrono::milliseconds(1);

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

ConformanceRow latency_row(const MeasuredLatency& measured, double max_error_m) {
  const Duration latency = measured.lead + measured.late;
  if (latency < -std::max(measured.uncertainty, kLatencyBias))
    return {"latency", Conformity::kNotJudged,
            "the robot seems to move before it is commanded: vision's frames are dated wrongly; see what "
            "vision says about the sender's clock"};
  const auto ms = [](Duration duration) { return to_seconds(duration) * 1e3; };
  std::string figures = fmt::format(
      "the motors obey after {:.0f} ms, probably between {:.1f} and {:.1f} ms; the robot assumes {:.0f} ms; "
      "each millisecond of difference takes it up to {:.1f} mm off",
      std::max(0.0, ms(latency)), std::max(0.0, ms(latency - measured.uncertainty)),
      std::max(0.0, ms(latency + measured.uncertainty)), ms(measured.lead), measured.speed_mps);
  const Duration late = std::chrono::abs(measured.late);
  const auto is_allowed = [&](Duration least) {
    return to_seconds(least) * measured.speed_mps <= max_error_m;
  };
  const bool is_certainly_wrong = !is_allowed(late - measured.uncertainty);
  if (measured.uncertainty > kMaxLatencyUncertainty && !is_certainly_wrong)
    return {"latency", Conformity::kNotJudged, figures + ": vision is too imprecise, or its dates vary"};
  return {"latency", is_allowed(late) ? Conformity::kPassed : Conformity::kFailed, figures};
}

std::string to_line(const ConformanceRow& row) {
  return fmt::format("{:<10}  {:<20}  {}", to_text(row.conformity), row.rule, row.figures);
}

std::string scenario_lines(const ConformanceReport& report) {
  if (!report.is_conformant()) {
    std::vector<std::string> rules;
    for (const ConformanceRow& row : report.rows) {
      if (row.conformity != Conformity::kPassed) rules.push_back(row.rule);
    }
    return fmt::format("no figures for the scenario, because not every row passed: {}\n",
                       fmt::join(rules, ", "));
  }
  const RobotFigures& figures = report.figures;
  if (!figures.tracking_bound_m || !figures.clock_bound_s || !figures.is_within_limits)
    return "no figures for the scenario: the robot was not examined completely\n";
  SafetyBudget budget;
  budget.tracking_bound_m = *figures.tracking_bound_m;
  budget.clock_bound_s = *figures.clock_bound_s;
  budget.speed_mps = figures.limits.speed_mps;
  const double margin_m = std::ceil(budget.required_margin_m() * 1e3 - 1e-6) * 1e-3;
  std::string lines = fmt::format(
      "for the scenario file:\n"
      "tracking_bound_m: {:.3f}\n"
      "margin_m: {:.3f}\n"
      "clock_bound_s: {:.4g}\n"
      "limits: {{acceleration_mps2: {:g}, deceleration_mps2: {:g}, speed_mps: {:g}}}\n",
      budget.tracking_bound_m, margin_m, budget.clock_bound_s, figures.limits.acceleration_mps2,
      figures.limits.deceleration_mps2, figures.limits.speed_mps);
  if (figures.silence_m)
    lines +=
        fmt::format("# If sidestep-robot is killed, a robot may stop up to {:.2f} m beyond its version.\n",
                    std::ceil(*figures.silence_m * 100) / 100);
  return lines;
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
  return text + scenario_lines(report);
}

}  // namespace sidestep
