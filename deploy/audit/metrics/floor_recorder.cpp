// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/floor_recorder.hpp"

#include <algorithm>

namespace sidestep {
namespace {

/// All paths together have at most about this many points, and each at most kMaxPoints.
constexpr std::size_t kTotalPoints = 200'000, kMinPoints = 100, kMaxPoints = 1200;

}  // namespace

FloorRecorder::FloorRecorder(const Scenario& scenario)
    : scenario_(scenario),
      paths_(scenario.robots.size(),
             PathRecorder(std::clamp(kTotalPoints / std::max<std::size_t>(1, scenario.robots.size()),
                                     kMinPoints, kMaxPoints))) {}

void FloorRecorder::add_incident(Time at, const char* kind, RobotId first, RobotId second) {
  const RobotSpec* robot = find_robot(scenario_, first);
  if (!robot || incidents_.size() >= kMaxIncidents) return;
  const auto path = paths_[static_cast<std::size_t>(robot - scenario_.robots.data())].latest();
  incidents_.push_back({at, kind, {first}, path ? path->position_m : robot->start_m});
  if (find_robot(scenario_, second)) incidents_.back().robots.push_back(second);
}

void FloorRecorder::on_truth(const msg::GroundTruth& truth) {
  const Time at = time_from_ns(truth.valid_at_ns());
  if (truth.header().incarnation() != simulator_) {
    simulator_ = truth.header().incarnation();
    contacts_ = crashes_ = 0;
  }
  constexpr std::uint64_t kListed = msg::MAX_CONTACTS;
  const auto first_listed = [](std::uint64_t known, std::uint64_t now) {
    return now > kListed ? std::max(known, now - kListed) : known;
  };
  for (std::uint64_t k = first_listed(contacts_, truth.contacts()); k < truth.contacts(); ++k) {
    const msg::ContactPair& pair = truth.recent_contacts()[k % kListed];
    add_incident(at, FloorTrace::kContact, pair.first(), pair.second());
  }
  for (std::uint64_t k = first_listed(crashes_, truth.crashes_while_moving());
       k < truth.crashes_while_moving(); ++k)
    add_incident(at, FloorTrace::kCrash, truth.recent_moving_crashes()[k % kListed], msg::NO_ROBOT);
  contacts_ = std::max(contacts_, truth.contacts());
  crashes_ = std::max(crashes_, truth.crashes_while_moving());
  const Numbered here{truth.header().incarnation(), truth.header().message_number(), at};
  if (!first_) first_ = here;
  if (here.incarnation == first_->incarnation) latest_ = here;
}

std::optional<Time> FloorRecorder::world_began() const {
  if (!first_ || latest_->number <= first_->number || first_->number == 0) return std::nullopt;
  const double period_s =
      to_seconds(latest_->at - first_->at) / static_cast<double>(latest_->number - first_->number);
  return first_->at - from_seconds(period_s * static_cast<double>(first_->number - 1));
}

FloorTrace FloorRecorder::trace(std::optional<Time> granting_since) const {
  std::vector<std::vector<PathRecorder::Point>> paths;
  std::optional<Time> zero = granting_since;
  for (const PathRecorder& recorder : paths_) {
    paths.push_back(recorder.points());
    if (!granting_since && !paths.back().empty())
      zero = std::min(zero.value_or(paths.back().front().at), paths.back().front().at);
  }
  FloorTrace trace;
  trace.zero = zero.value_or(Time{});
  const auto seconds = [&](Time at) { return to_seconds(at - trace.zero); };
  trace.field = scenario_.field;
  trace.radius_m = scenario_.radius_m;
  trace.speed_limit_mps = scenario_.limits.speed_mps;
  trace.obstacles = scenario_.obstacles;
  if (scenario_.map) trace.walls = scenario_.map->rectangles();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const RobotSpec& spec = scenario_.robots[i];
    FloorTrace::Robot& robot =
        trace.robots.emplace_back(FloorTrace::Robot{spec.id, spec.team, spec.start_m, {}, {}});
    for (const Goal& goal : spec.goals) robot.goals_m.push_back(goal.position_m);
    for (const PathRecorder::Point& point : paths[i])
      robot.path.push_back({seconds(point.at), point.position_m, point.speed_mps});
  }
  trace.opponents = scenario_.opponents;
  if (const auto began = world_began()) trace.opponents_since_s = seconds(*began);
  for (const Incident& incident : incidents_)
    trace.incidents.push_back({seconds(incident.at), incident.kind, incident.robots, incident.position_m});
  return trace;
}

}  // namespace sidestep
