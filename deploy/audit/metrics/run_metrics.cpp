// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/run_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/messaging/drop_codec.hpp"
#include "common/messaging/enumerator.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_notices.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

/// Tolerances for positions and velocities from vision. Its velocities are too noisy to distinguish a slow
/// robot from one at rest; agents can.
constexpr double kSeenTolerance_m = 0.01, kSeenAtRest_mps = 1;
/// More incarnations than a supervisor would ever start; incarnations beyond this number are assumed to be
/// forged.
constexpr std::size_t kMaxIncarnations = 1000;
/// Maximum number of incarnations of one process whose counters are kept separately.
constexpr std::size_t kMaxCounterIncarnations = 32;
/// An incarnation is assumed dead after this many statuses of other incarnations without one of its own.
constexpr int kSilentAfter = 5;

/// The slot for a message in the list of its sender's incarnations, which is sorted; nullptr if a newer
/// message of that incarnation is stored already, or there are too many incarnations.
template <typename Message>
Message* slot_for(std::vector<Message>& incarnations, const msg::Header& header) {
  const auto at = std::lower_bound(
      incarnations.begin(), incarnations.end(), header.incarnation(),
      [](const Message& latest, auto wanted) { return latest.header().incarnation() < wanted; });
  if (at != incarnations.end() && at->header().incarnation() == header.incarnation()) {
    return header.message_number() > at->header().message_number() ? &*at : nullptr;
  }
  return incarnations.size() < kMaxIncarnations ? &*incarnations.emplace(at) : nullptr;
}

bool is_sane(const msg::TrueRobotState& robot) {
  return std::isfinite(robot.x_m()) && std::isfinite(robot.y_m()) && std::isfinite(robot.vx_mps()) &&
         std::isfinite(robot.vy_mps()) && std::isfinite(robot.reference_error_m());
}

}  // namespace

RunMetrics::RunMetrics(const Scenario& scenario) : scenario_(scenario), floor_(scenario) {
  for (const RobotSpec& spec : scenario.robots) {
    RobotRecord robot;
    robot.spec = &spec;
    robot.position_m = spec.start_m;
    robots_.push_back(robot);
  }
}

RunMetrics::RobotRecord* RunMetrics::find(RobotId robot) {
  const auto found =
      std::lower_bound(robots_.begin(), robots_.end(), robot,
                       [](const RobotRecord& record, RobotId wanted) { return record.spec->id < wanted; });
  return found != robots_.end() && found->spec->id == robot ? &*found : nullptr;
}

const msg::AgentStatus* RunMetrics::RobotRecord::status() const {
  const auto found = std::ranges::find(incarnations, authoritative, [](const msg::AgentStatus& latest) {
    return latest.header().incarnation();
  });
  return found == incarnations.end() ? nullptr : &*found;
}

double RunMetrics::distance_to_go_m(const RobotRecord& robot) const {
  if (robot.spec->goals.empty()) return 0;
  return (robot.spec->goals.back().position_m - robot.position_m).norm();
}

bool RunMetrics::is_without_goal(const RobotRecord& robot) const {
  return is_done(robot) && robot.status()->agent_state() == msg::AgentState::AGENT_WITHOUT_ORDER;
}

bool RunMetrics::is_done(const RobotRecord& robot) const {
  if (!robot.settled_since || !robot.status()) return false;
  const msg::AgentState state = robot.status()->agent_state();
  return state == msg::AgentState::AGENT_ARRIVED ||
         (robot.spec->goals.empty() && state == msg::AgentState::AGENT_WITHOUT_ORDER);
}

void RunMetrics::on_truth(const msg::GroundTruth& truth) {
  const bool is_sound = std::isfinite(truth.penetration_m_s()) && !std::isnan(truth.min_clearance_m()) &&
                        std::isfinite(truth.max_crash_speed_mps()) &&
                        std::isfinite(truth.max_robot_crash_speed_mps()) &&
                        is_valid_time(truth.valid_at_ns());
  msg::GroundTruth* latest = is_sound ? slot_for(simulators_, truth.header()) : nullptr;
  if (!latest) {
    ++dropped_messages_;
    return;
  }
  latest->header(truth.header());
  latest->contacts(truth.contacts());
  latest->penetration_m_s(truth.penetration_m_s());
  latest->min_clearance_m(truth.min_clearance_m());
  latest->firmware_violations(truth.firmware_violations());
  latest->crashes(truth.crashes());
  latest->crashes_while_moving(truth.crashes_while_moving());
  latest->max_crash_speed_mps(truth.max_crash_speed_mps());
  latest->max_robot_crash_speed_mps(truth.max_robot_crash_speed_mps());
  if (latest != &simulators_.back()) return;

  const Time at = time_from_ns(truth.valid_at_ns());
  truth_at_ = at;
  std::vector<const RobotRecord*> unsound;  // on the floor, but nobody knows where
  for (const msg::TrueRobotState& state : truth.robots()) {
    RobotRecord* robot = find(state.robot());
    if (!robot || !is_sane(state)) {
      if (robot) unsound.push_back(robot);
      ++dropped_messages_;
      continue;
    }
    max_reference_error_m_ = std::max(max_reference_error_m_, state.reference_error_m());
    const Vec2 position_m(state.x_m(), state.y_m());
    const double speed_mps = std::hypot(state.vx_mps(), state.vy_mps());
    place(*robot, position_m, speed_mps, {scenario_.goal_tolerance_m, kAtRest_mps}, at);
    robot->sighting = {state.robot(), at, position_m, speed_mps};
  }
  // Ground truth shows every robot on the floor.
  for (RobotRecord& robot : robots_) {
    const bool is_shown = robot.sighting && robot.sighting->at == at;
    if (!is_shown && std::ranges::find(unsound, &robot) == unsound.end()) robot.sighting.reset();
  }
  floor_.on_truth(truth);
}

void RunMetrics::on_world_state(const msg::WorldState& world) {
  if (truth_at_) return;
  const bool is_newer =
      is_valid_time(world.valid_at_ns()) && time_from_ns(world.valid_at_ns()) > seen_at_.value_or(Time{});
  if (!is_newer) {
    ++dropped_messages_;
    return;
  }
  const Time at = time_from_ns(world.valid_at_ns());
  for (const msg::TrackedRobot& state : world.robots()) {
    RobotRecord* robot = find(state.robot());
    const Vec2 position_m(state.x_m(), state.y_m());
    const double speed_mps = std::hypot(state.vx_mps(), state.vy_mps());
    if (!robot || !position_m.allFinite() || !std::isfinite(speed_mps)) {
      ++dropped_messages_;
      continue;
    }
    seen_at_ = at;
    place(*robot, position_m, speed_mps, {scenario_.goal_tolerance_m + kSeenTolerance_m, kSeenAtRest_mps},
          at);
    // Until vision drops it, a robot that is no longer seen is where the last observation leads.
    const Vec2 observed_m(state.observed_x_m(), state.observed_y_m());
    if (observed_m.allFinite() && is_valid_time(state.observed_at_ns()))
      robot->sighting = {state.robot(), time_from_ns(state.observed_at_ns()), observed_m, speed_mps};
  }
}

void RunMetrics::place(RobotRecord& robot, const Vec2& position_m, double speed_mps,
                       const SettledLimits& limits, Time at) {
  floor_.place(static_cast<std::size_t>(&robot - robots_.data()), {at, position_m, speed_mps});
  robot.position_m = position_m;
  robot.speed_mps = speed_mps;
  robot.is_at_rest = speed_mps < limits.speed_mps;
  const bool is_settled = distance_to_go_m(robot) <= limits.distance_m && robot.is_at_rest;
  if (!is_settled)
    robot.settled_since.reset();
  else if (!robot.settled_since)
    robot.settled_since = at;
}

void RunMetrics::on_status(const msg::AgentStatus& status) {
  RobotRecord* robot = find(status.robot());
  const bool is_state = is_enumerator(status.agent_state(), msg::AgentState::AGENT_WITHOUT_ORDER);
  msg::AgentStatus* latest = robot && is_state ? slot_for(robot->incarnations, status.header()) : nullptr;
  if (!latest) {
    ++dropped_messages_;
    return;
  }
  *latest = status;
  // While another incarnation reports, one that is still fencing does not count.
  const bool is_fencing = status.agent_state() == msg::AgentState::AGENT_FENCING;
  if (is_fencing && robot->status() && robot->authoritative != status.header().incarnation() &&
      ++robot->fencing_statuses < kSilentAfter)
    return;
  has_received_orders_ |=
      robot->spec->goals.empty() && (status.agent_state() == msg::AgentState::AGENT_DRIVING ||
                                     status.agent_state() == msg::AgentState::AGENT_ARRIVED);
  robot->authoritative = status.header().incarnation();
  robot->fencing_statuses = 0;
}

void RunMetrics::on_order_status(const msg::OrderStatus& status) {
  RobotRecord* const robot = find(status.robot());
  const auto report = decode(status);
  if (robot && report) robot->blockage = report->blockage;
}

void RunMetrics::on_coordinator(const msg::CoordinatorState& state) {
  if (!is_valid_time(state.header().stamp_ns())) {
    ++dropped_messages_;
    return;
  }
  const std::pair key(state.coordinator(), static_cast<Incarnation>(state.header().incarnation()));
  if (coordinators_.size() >= kMaxIncarnations && !coordinators_.count(key)) {
    const auto incarnation = [](const auto& known) { return known.first.second; };
    coordinators_.erase(std::ranges::min_element(coordinators_, {}, incarnation));
  }
  std::uint64_t& last = coordinators_[key];
  if (state.header().message_number() <= last) {
    ++dropped_messages_;
    return;
  }
  last = state.header().message_number();
  if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
  record_epoch(state);
  if (active_ && state.epoch() < active_->epoch()) return;
  active_ = state;
  for (const msg::RobotNotice& notice : state.notices()) {
    if (!find(notice.robot())) continue;
    if (notice.is_quarantined()) quarantined_.insert(notice.robot());
    if (notice.is_displaced()) displaced_.insert(notice.robot());
  }
  if (state.conflicts() > 0 && find(state.conflict_first()) && find(state.conflict_second()))
    conflicts_.emplace(state.conflict_first(), state.conflict_second());
  if (!granting_since_ && state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING) {
    granting_since_ = time_from_ns(state.header().stamp_ns());
  }
}

bool RunMetrics::has_process(std::uint32_t process) {
  return find(process) || is_coordinator(process) || process == static_cast<std::uint32_t>(Sender::kVision) ||
         process == static_cast<std::uint32_t>(Sender::kSimulator) ||
         process == static_cast<std::uint32_t>(Sender::kRobots);
}

RunMetrics::IncarnationCounters* RunMetrics::counters_of(ProcessCounters& counters, Incarnation incarnation) {
  std::vector<IncarnationCounters>& incarnations = counters.incarnations;
  const auto place = [&] {
    return std::ranges::lower_bound(incarnations, incarnation, {}, &IncarnationCounters::incarnation);
  };
  if (const auto latest = place(); latest != incarnations.end() && latest->incarnation == incarnation)
    return &*latest;
  if (incarnations.size() == kMaxCounterIncarnations && incarnation > incarnations.front().incarnation) {
    const IncarnationCounters& oldest = incarnations.front();
    for (std::size_t i = 0; i < kDropReasonCount; ++i) counters.earlier.counts[i] += oldest.counts[i];
    counters.earlier.incarnation = oldest.incarnation;
    incarnations.erase(incarnations.begin());
  }
  if (incarnations.size() == kMaxCounterIncarnations || incarnation <= counters.earlier.incarnation)
    return nullptr;
  return &*incarnations.insert(place(), {incarnation, 0, {}});
}

void RunMetrics::on_counters(const msg::Counters& message) {
  const auto counts = decode(message);
  if (!counts || !has_process(message.process())) {
    ++dropped_messages_;
    return;
  }
  IncarnationCounters* const latest =
      counters_of(counters_[message.process()], message.header().incarnation());
  if (!latest || message.header().message_number() <= latest->message_number) {
    ++dropped_messages_;
    return;
  }
  latest->message_number = message.header().message_number();
  latest->counts.fill(0);
  for (const DropCount& one : *counts) latest->counts[static_cast<std::size_t>(one.reason)] += one.count;
}

void RunMetrics::record_epoch(const msg::CoordinatorState& state) {
  const auto cause = decode_role_cause(state);
  if (!cause || state.coordinator() >= kMaxCoordinators || epochs_.size() >= kMaxEpochs) return;
  const std::string coordinator = coordinator_process(static_cast<int>(state.coordinator()));
  const auto is_same = [&](const EpochRecord& known) {
    return known.epoch == state.epoch() && known.coordinator == coordinator;
  };
  if (std::ranges::any_of(epochs_, is_same)) return;
  epochs_.push_back(
      {coordinator, state.epoch(), time_from_ns(state.header().stamp_ns()), {}, describe(*cause)});
}

void RunMetrics::on_death(const std::string& process, const std::string& reason, Time at, bool restarted) {
  const double at_s = granting_since_ ? to_seconds(at - *granting_since_) : 0;
  deaths_.push_back({process, reason, at_s, restarted});
}

void RunMetrics::on_mismatch(const RulesMismatch& mismatch) {
  auto& differences = mismatches_[process_name(mismatch.process)];
  if (!mismatch.differences.empty()) differences = mismatch.differences;
}

int RunMetrics::arrived() const {
  return static_cast<int>(std::count_if(robots_.begin(), robots_.end(),
                                        [this](const RobotRecord& robot) { return has_arrived(robot); }));
}

int RunMetrics::without_goal() const {
  return static_cast<int>(std::count_if(robots_.begin(), robots_.end(),
                                        [this](const RobotRecord& robot) { return is_without_goal(robot); }));
}

bool RunMetrics::awaits_orders() const {
  return std::ranges::all_of(robots_, [](const RobotRecord& robot) { return robot.spec->goals.empty(); });
}

bool RunMetrics::all_arrived() const {
  return std::ranges::all_of(robots_, [this](const RobotRecord& robot) { return is_done(robot); });
}

bool RunMetrics::all_at_rest() const {
  return std::all_of(robots_.begin(), robots_.end(),
                     [](const RobotRecord& robot) { return robot.is_at_rest; });
}

std::vector<RobotId> RunMetrics::silent_agents() const {
  std::vector<RobotId> silent;
  for (const RobotRecord& robot : robots_) {
    if (robot.incarnations.empty()) silent.push_back(robot.spec->id);
  }
  return silent;
}

std::string RunMetrics::named_robots() const {
  std::vector<std::string> named;
  if (active_) {
    for (const RobotId robot : displaced_robots(*active_))
      named.push_back(fmt::format("robot {} displaced", robot));
    for (const RobotId robot : quarantined_robots(*active_))
      named.push_back(fmt::format("robot {} quarantined", robot));
  }
  return fmt::format("{}", fmt::join(named, ", "));
}

std::vector<RobotId> RunMetrics::unregistered_robots() const {
  if (!active_) return {};
  return missing_robots(*active_);
}

void listen(Bus& bus, RunMetrics& metrics) {
  bus.subscribe<msg::GroundTruth>(topics::kTruth, [&metrics](const auto& truth) { metrics.on_truth(truth); });
  bus.subscribe<msg::WorldState>(topics::kWorld,
                                 [&metrics](const auto& world) { metrics.on_world_state(world); });
  bus.subscribe<msg::AgentStatus>(topics::kStatus,
                                  [&metrics](const auto& status) { metrics.on_status(status); });
  bus.subscribe<msg::OrderStatus>(topics::kOrderStatus,
                                  [&metrics](const auto& status) { metrics.on_order_status(status); });
  bus.subscribe<msg::CoordinatorState>(topics::kCoordinator,
                                       [&metrics](const auto& state) { metrics.on_coordinator(state); });
  bus.subscribe<msg::Counters>(topics::kCounters,
                               [&metrics](const auto& counters) { metrics.on_counters(counters); });
  metrics.set_bus(bus);
}

}  // namespace sidestep
