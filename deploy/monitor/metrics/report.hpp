// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/time/histogram.hpp"
#include "deploy/monitor/audit/audit_rules.hpp"

namespace sidestep {

/// A process that ended although nobody asked it to.
struct Death {
  std::string process;
  std::string reason;
  double at_s = 0;  ///< after the first grant; before it, negative or zero
  bool restarted = false;
};

/// How a run went.
struct Report {
  std::string program;  ///< "run" or "simulate"
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string failure;  ///< why the run ended early; empty: it did not
  int robots = 0;
  int arrived = 0;
  bool must_arrive = true;  ///< whether everybody has to, for the run to pass
  std::uint64_t contacts = 0;
  double penetration_m_s = 0;
  std::optional<double> min_clearance_m;
  std::uint64_t crashes = 0;             ///< touches of a robot and an opponent,
  std::uint64_t moving_crashes = 0;      ///< and those in which the robot was not at rest
  double crash_speed_mps = 0;            ///< largest closing speed along the centre line of a crash
  double robot_crash_speed_mps = 0;      ///< largest share of a robot in it
  std::optional<double> makespan_s;      ///< until the last arrived; none: not all have
  std::optional<double> mean_arrival_s;  ///< of those that arrived
  std::optional<double> arrival_over_straight;
  std::map<RobotId, std::optional<double>> arrival_s;
  std::uint64_t proposals = 0;
  std::uint64_t grants = 0;
  std::uint64_t denials = 0;
  std::uint64_t cycles = 0;
  std::uint64_t missed_cycles = 0;
  std::uint64_t plan_changes = 0;            ///< of ways round that agents had chosen
  std::optional<double> plan_changes_per_s;  ///< of each agent that had something to plan
  std::uint64_t invalid_messages = 0;
  std::uint64_t firmware_violations = 0;
  std::set<std::pair<RobotId, RobotId>> conflicts;  ///< pairs that something outside brought too near
  double max_reference_error_m = 0;
  /// The largest offset of a robot's clock against the coordinator's, as last measured, and give or take
  /// what; none: none has been measured.
  std::optional<double> clock_offset_max_s;
  std::optional<double> clock_uncertainty_s;
  double robot_time_s = 0;  ///< from the first grant to the latest ground truth
  DurationHistogram negotiation;
  DurationHistogram plan;
  DurationHistogram search;
  std::vector<Death> deaths;
  std::optional<AuditTotals> audit;  ///< none: nobody listened
  double duration_s = 0;             ///< wall clock

  /// Contacts but for those of robots that somebody had just pushed.
  std::uint64_t contacts_of_its_own() const;
  /// Why the run failed in one line; empty when everybody arrived, nobody touched, no robot moved when an
  /// opponent touched it, and no rule was broken.
  std::string verdict() const;
};

/// The report as JSON with a stable order of keys; what depends on the machine's speed is under "wall_clock".
std::string to_json(const Report& report);
/// A few lines for people.
std::string summary(const Report& report);
/// Writes to_json to a file, making its folder; throws std::runtime_error saying why it cannot.
void write_report(const Report& report, const std::string& path);
/// Writes a file, making its folder; throws std::runtime_error saying why it cannot.
void write_file(const std::string& path, const std::string& text);
/// reports/<scenario>-<seed, or the local time>.json
std::string default_report_path(const std::string& scenario, std::optional<std::uint64_t> seed);

}  // namespace sidestep
