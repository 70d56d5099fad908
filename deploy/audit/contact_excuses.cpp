// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/contact_excuses.hpp"

#include <algorithm>
#include <limits>

namespace sidestep {

ContactExcuses::ContactExcuses(const AuditedRun& run, const RobotRecords& robots, const RunCoverage& coverage,
                               const PositionAudit& positions, Disturbances& disturbances,
                               AuditFindings& findings)
    : run_(run),
      robots_(robots),
      coverage_(coverage),
      positions_(positions),
      disturbances_(disturbances),
      findings_(findings),
      obstacles_(run.scenario.obstacles.begin(), run.scenario.obstacles.end()),
      observed_(robots.all().size()) {}

bool ContactExcuses::excuses(RobotId first, std::optional<RobotId> second, Time at, std::int64_t apart_ns) {
  const auto first_index = robots_.index_of(first),
             second_index = second ? robots_.index_of(*second) : std::optional<std::size_t>();
  const auto cause = disturbances_.on_contact(first_index, second_index, at);
  if (!cause) {
    if (are_known(first_index, apart_ns) && (!second || are_known(second_index, apart_ns))) return false;
    ++findings_.totals.undecided_contacts;
    return true;
  }
  ++findings_.totals.excused_contacts;
  ++excused_[{*cause, first, second}];
  return true;
}

bool ContactExcuses::are_known(std::optional<std::size_t> robot, std::int64_t apart_ns) const {
  if (run_.is_complete()) return true;
  // A robot that is not seen now may have been disturbed since it was last seen.
  if (!robot || !observed_[*robot] || are_contacts_unknown_ || disturbances_.is_uncertain(*robot))
    return false;
  // With vision as the reference, two robots may have touched since one of them left its place.
  return !coverage_.is_vision() || positions_.in_place_since_ns(*robot) <= apart_ns;
}

void ContactExcuses::observe(const AuditedRobot& robot, const Vec2& position_m, double speed_mps,
                             double error_m, double allowance_m) {
  const std::size_t index = robots_.index_of(robot);
  ObservedRobot& observed = observed_[index].emplace(position_m, speed_mps, 0, false);
  if (disturbances_.has_excuse(index))
    observed.from_obstacles_m = distance_from_obstacles_m(position_m) - run_.scenario.radius_m;
  const bool is_executing = robot.last_report && !robot.last_report->is_lifted;
  const KnownVersion* const version = is_executing ? robot.find(robot.last_report->executing) : nullptr;
  if (!version || !version->has_content) return;
  observed.inflation_m = version->version.inflation_m();
  // If the last report is old, the robot may execute another version by now.
  const bool is_recent = run_.is_complete() || findings_.now - robot.heard_at <= 2 * run_.scenario.cycle;
  observed.is_in_place = is_recent && version->was_in_ledger() &&
                         error_m <= run_.scenario.tracking_bound_m + observed.inflation_m + allowance_m;
}

double ContactExcuses::distance_from_obstacles_m(const Vec2& position_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const AuditShape& obstacle : obstacles_)
    nearest_m = std::min(nearest_m, obstacle.distance_m(position_m.x(), position_m.y()));
  if (!run_.scenario.map) return nearest_m;
  constexpr double kNear_m = 1.5;  // more than any robot's inflation, beyond its radius and margin
  const Vec2 reach = Vec2::Constant(run_.scenario.radius_m + run_.scenario.margin_m + kNear_m);
  run_.scenario.map->cells().for_each_box({position_m - reach, position_m + reach}, [&](const Box& cells) {
    nearest_m = std::min(nearest_m, AuditShape(cells).distance_m(position_m.x(), position_m.y()));
    return true;
  });
  return nearest_m;
}

void ContactExcuses::add_to(AuditTotals& totals) const {
  for (const auto& [key, contacts] : excused_) {
    const auto& [cause, first, second] = key;
    totals.excused.push_back({std::string(cause), first, second, contacts});
  }
  totals.pair_s = disturbances_.pair_s();
  totals.excused_pair_s = disturbances_.excused_pair_s();
}

}  // namespace sidestep
