// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/run_observer.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

std::optional<double> TruthSample::speed_of(RobotId robot) const {
  const auto found = std::ranges::lower_bound(robots, robot, {}, &TrueSpeed::robot);
  if (found == robots.end() || found->robot != robot) return std::nullopt;
  return found->speed_mps;
}

bool RunHistory::is_missing(RobotId robot) const {
  if (coordinators.empty()) return false;
  const auto last = std::find_if(notices.rbegin(), notices.rend(), [&](const NoticeSample& notice) {
    return notice.robot == robot && notice.kind == NoticeKind::kMissing;
  });
  return last != notices.rend() && last->at_s >= coordinators.back().at_s;
}

std::optional<int> RunHistory::granting_coordinator() const {
  const auto last = std::find_if(coordinators.rbegin(), coordinators.rend(),
                                 [](const CoordinatorSample& sample) { return sample.is_granting; });
  return last == coordinators.rend() ? std::nullopt : std::optional(last->number);
}

RunObserver::RunObserver(Bus& bus) : bus_(bus) {
  bus.subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) { on_truth(truth); });
  bus.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) { on_coordinator(state); });
  bus.subscribe(topics::kStatus, [this](const msg::AgentStatus& status) { on_status(status); });
}

void RunObserver::on_truth(const msg::GroundTruth& truth) {
  // Messages may arrive out of order.
  if (!begin_ || truth.header().message_number() <= truth_number_) return;
  truth_number_ = truth.header().message_number();
  add_contacts(truth);
  TruthSample sample{now_s(), {}, truth.min_clearance_m(), truth.crashes_while_moving()};
  for (const msg::TrueRobotState& robot : truth.robots()) {
    const double speed_mps = std::hypot(robot.vx_mps(), robot.vy_mps());
    if (std::isfinite(speed_mps)) sample.robots.push_back({robot.robot(), speed_mps});
  }
  std::ranges::sort(sample.robots, {}, &TrueSpeed::robot);
  history_.truths.push_back(std::move(sample));
}

void RunObserver::add_contacts(const msg::GroundTruth& truth) {
  const std::uint64_t added = truth.contacts() - std::min<std::uint64_t>(contacts_, truth.contacts());
  const std::uint64_t listed = std::min<std::uint64_t>(added, msg::MAX_CONTACTS);
  history_.unidentified_contacts += added - listed;
  for (std::uint64_t k = truth.contacts() - listed; k < truth.contacts(); ++k) {
    const msg::ContactPair& pair = truth.recent_contacts()[k % msg::MAX_CONTACTS];
    ContactSample contact{now_s(), pair.first(), std::nullopt};
    if (pair.second() != msg::NO_ROBOT) contact.second = pair.second();
    history_.contacts.push_back(contact);
  }
  contacts_ = truth.contacts();
}

void RunObserver::on_coordinator(const msg::CoordinatorState& state) {
  const bool is_granting = state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING;
  const bool is_active =
      is_granting || state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_REGISTERING;
  if (!is_active || state.epoch() < highest_epoch_) return;
  highest_epoch_ = state.epoch();
  if (!begin_ && is_granting) begin_ = bus_.now();
  if (!begin_) return;
  const double at_s = now_s();
  history_.coordinators.push_back({at_s, static_cast<int>(state.coordinator()), state.epoch(), is_granting});
  add_notices(state, at_s);
}

void RunObserver::add_notices(const msg::CoordinatorState& state, double at_s) {
  const auto add = [&](RobotId robot, NoticeKind kind, bool applies) {
    if (applies) history_.notices.push_back({at_s, robot, kind});
  };
  for (const msg::RobotNotice& notice : state.notices()) {
    add(notice.robot(), NoticeKind::kMissing, notice.is_missing());
    add(notice.robot(), NoticeKind::kQuarantined, notice.is_quarantined());
    add(notice.robot(), NoticeKind::kDisplaced, notice.is_displaced());
  }
  add(state.conflict_first(), NoticeKind::kConflict, state.conflicts() > 0);
  add(state.conflict_second(), NoticeKind::kConflict, state.conflicts() > 0);
}

void RunObserver::on_status(const msg::AgentStatus& status) {
  if (begin_ && status.agent_state() == msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND)
    history_.notices.push_back({now_s(), status.robot(), NoticeKind::kClockOutOfBound});
}

}  // namespace sidestep
