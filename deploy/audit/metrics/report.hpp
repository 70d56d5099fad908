// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/config/shared_rules.hpp"
#include "common/protocol/drop_reasons.hpp"
#include "common/time/histogram.hpp"
#include "deploy/audit/audit_totals.hpp"
#include "deploy/audit/metrics/arrivals.hpp"
#include "deploy/audit/metrics/floor_trace.hpp"
#include "deploy/audit/metrics/process_use.hpp"

namespace sidestep {

/// The unexpected end of a process.
struct Death {
  std::string process;
  std::string reason;
  double at_s = 0;  ///< in seconds since the first grant; zero before it
  bool restarted = false;
};

/// "ended" for the reason of a process that was asked to end, otherwise "died".
const char* verb_of_end(const std::string& reason);

/// An epoch that a coordinator began.
struct EpochRecord {
  std::string coordinator;  ///< for example "coordinator 1"
  Epoch epoch = 0;
  Time begun_at{};  ///< by the coordinator's clock
  /// Seconds since the first grant; may be negative; nullopt: nothing was granted.
  std::optional<double> at_s;
  std::string reason;
};

/// How a run of processes ended.
struct EndingRecord {
  std::string cause;           ///< for example "all robots arrived" or "interrupted"
  double duration_s = 0;       ///< time until all robots rested and the processes that drive them had ended
  std::uint64_t contacts = 0;  ///< number of contacts in this time
  std::string problem;         ///< why it is not known that all robots came to rest; empty: they did
};

/// The outcome of a run.
struct Report {
  std::string program;  ///< "run" or "simulate"
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string abort_reason;  ///< empty: the run was not aborted
  std::string
      recording_failure;  ///< why the recording lacks messages; empty: it is complete, or there is none
  int robots = 0;
  int arrived = 0;
  int without_goal = 0;     ///< number of robots at rest with nothing to arrive at
  bool must_arrive = true;  ///< whether the run passes only if all robots arrive
  std::uint64_t contacts = 0;
  double penetration_m_s = 0;
  std::optional<double> min_clearance_m;
  std::uint64_t crashes = 0;               ///< number of contacts between a robot and an opponent
  std::uint64_t crashes_while_moving = 0;  ///< number of crashes in which the robot was not at rest
  double max_crash_speed_mps = 0;          ///< maximum closing speed along the line of centres
  double max_robot_crash_speed_mps = 0;    ///< the robot's share of the closing speed
  /// Arrival time of the last robot; nullopt: not all have arrived.
  std::optional<double> makespan_s;
  std::optional<double> mean_arrival_s;            ///< mean over the robots that arrived
  std::optional<double> straight_line_time_ratio;  ///< see straight_line_time.hpp
  std::map<RobotId, std::optional<double>> arrival_s;
  std::map<RobotId, std::string>
      not_arrived;  ///< reason for each robot that has not arrived, unless it has no goal
  std::uint64_t proposals = 0;
  std::uint64_t grants = 0;
  std::uint64_t denials = 0;
  std::uint64_t cycles = 0;
  std::uint64_t missed_cycles = 0;
  std::uint64_t route_changes = 0;            ///< number of times that an agent changed its route
  std::optional<double> route_changes_per_s;  ///< route changes per agent per second of planning
  std::uint64_t firmware_violations = 0;
  std::set<std::pair<RobotId, RobotId>>
      conflicts;                  ///< pairs that were brought into conflict by a cause outside the protocol
  std::set<RobotId> quarantined;  ///< robots that executed a version that they were never granted
  std::set<RobotId> displaced;    ///< robots that vision saw where none of their versions led
  double max_reference_error_m = 0;
  /// Largest measured offset between a robot's clock and the coordinator's, and its uncertainty; nullopt: not
  /// measured.
  std::optional<double> max_clock_offset_s;
  std::optional<double> clock_uncertainty_s;
  double robot_time_s = 0;  ///< time from the first grant until the robots were last seen
  DurationHistogram negotiation;
  DurationHistogram plan;
  DurationHistogram search;
  std::vector<Death> deaths;
  /// Why each process that directed and observed the run died. The run before such a death is not judged.
  std::vector<std::string> director_deaths;
  std::optional<EndingRecord> ending;  ///< nullopt: not a run of processes
  std::vector<EpochRecord> epochs;     ///< in the order of their first heartbeats
  /// Processes with different rules, and the differences; empty if these are unknown.
  std::map<std::string, std::vector<RuleDifference>> mismatches;
  /// Numbers of dropped messages, by process and reason; only non-zero ones.
  std::map<std::string, std::map<DropReason, std::uint64_t>> counters;
  std::optional<AuditTotals> audit;  ///< nullopt: the run was not audited
  std::optional<FloorTrace> trace;   ///< nullopt: not recorded; the report then draws no picture
  double duration_s = 0;             ///< wall-clock time
  std::optional<double> startup_s;   ///< time until all processes ran and the coordinator granted
  std::string fast_dds;              ///< the launcher's version of Fast DDS; empty: not over DDS
  std::map<std::string, ProcessUse> processes;

  Arrivals arrivals() const { return {robots, arrived, without_goal}; }
  /// Number of contacts, except those excused by a disturbance and those for which the audit does not know
  /// the robots.
  std::uint64_t unexcused_contacts() const;
  /// Number of crashes of moving robots, except those excused by a disturbance.
  std::uint64_t unexcused_crashes() const;
  /// Why the run failed, in one line. Empty if it did not fail: it was not aborted, its recording was
  /// written, it had no unexcused contacts or crashes of moving robots, no rule was broken, and all robots
  /// that had to arrive did.
  [[nodiscard]] std::string failure_reason() const;
  /// The verdict. A run that did not fail has passed only if its audit covered enough (or there was no audit)
  /// and no process that observed it has died.
  [[nodiscard]] AuditVerdict verdict() const;
};

/// What counts as a contact and as a crash, for summaries and pages.
inline constexpr const char* kContactMeaning = "between robots or with obstacles";
inline constexpr const char* kCrashMeaning = "contacts of a robot with an opponent or a person";

/// The report as JSON with a fixed order of keys. Machine-dependent values are under "wall_clock".
[[nodiscard]] std::string to_json(const Report& report);
/// A summary in a few lines of text.
std::string summary(const Report& report);
/// Writes to_json() to a file and creates its folder. Throws std::runtime_error with the reason for a
/// failure.
void write_report(const Report& report, const std::string& path);
/// Like write_report(), but returns the reason for a failure; empty if the report was written.
[[nodiscard]] std::string try_write_report(const Report& report, const std::string& path);
/// reports/<scenario>-<seed>.json, or with the local time instead of the seed.
std::string default_report_path(const std::string& scenario, std::optional<std::uint64_t> seed);

}  // namespace sidestep
