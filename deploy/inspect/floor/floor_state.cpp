// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/floor/floor_state.hpp"

#include <algorithm>
#include <utility>

#include "common/messaging/course_codec.hpp"
#include "common/messaging/enumerator.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxCameras = 64;
constexpr std::uint32_t kMaxLedgerPages = 256;

/// The candidate with this version number; nullptr if there is none.
const msg::Version* find_candidate(const msg::Proposal& proposal, VersionNumber number) {
  const std::size_t count = std::min<std::size_t>(proposal.candidate_count(), msg::MAX_CANDIDATES);
  for (std::size_t i = 0; i < count; ++i)
    if (proposal.candidates()[i].version_number() == number) return &proposal.candidates()[i];
  return nullptr;
}

}  // namespace

const DrivingCourse* present_course(const RobotView& robot, Time now) {
  const DrivingCourse* course = fresh(robot.course, now, DrivingCourse::kMaxSilence);
  return course && !course->is_empty() && course->end() > now ? course : nullptr;
}

RobotView* FloorState::robot(std::uint32_t id) { return id < kMaxRobots ? &robots_[id] : nullptr; }

void FloorState::on(const msg::GroundTruth& truth, Time now) {
  for (const msg::TrueRobotState& state : truth.robots())
    if (RobotView* view = robot(state.robot())) view->truth = {state, now};
}

void FloorState::on(const msg::WorldState& world, Time now) {
  for (const msg::TrackedRobot& tracked : world.robots())
    if (RobotView* view = robot(tracked.robot())) view->seen = {tracked, now};
  world_ = {world, now};
}

void FloorState::on(const msg::ObstacleList& list, Time now) { obstacles_ = {list, now}; }

void FloorState::on(const msg::DetectionFrame& frame, Time now) {
  if (detections_.contains(frame.camera()) || detections_.size() < kMaxCameras)
    detections_[frame.camera()] = {frame, now};
}

void FloorState::on(const msg::Feedback& feedback, Time now) {
  if (RobotView* view = robot(feedback.robot())) view->feedback = {feedback, now};
}

void FloorState::on(const msg::AgentStatus& status, Time now) {
  if (RobotView* view = robot(status.robot())) view->status = {status, now};
}

void FloorState::on(const msg::OrderStatus& status, Time now) {
  if (RobotView* view = robot(status.robot())) view->order = {status, now};
}

void FloorState::on(const msg::Proposal& proposal, Time now) {
  if (RobotView* view = robot(proposal.robot())) view->proposal = {proposal, now};
}

void FloorState::on(const msg::Verdict& verdict, Time now) {
  RobotView* view = robot(verdict.robot());
  if (view == nullptr || verdict.proposal_number() == 0) return;
  if (verdict.granted_version() != 0) {
    view->denial.reset();
    const msg::Version* granted =
        view->proposal ? find_candidate(view->proposal->value, verdict.granted_version()) : nullptr;
    if (granted) view->granted = {*granted, now};
  }
  const msg::Reason reason = verdict.reasons()[0];
  if (reason == msg::Reason::REASON_GRANTED || !is_enumerator(reason, msg::Reason::REASON_HELD)) return;
  ++view->denials[static_cast<std::uint32_t>(reason)];
  if (verdict.granted_version() == 0) view->denial = {{reason, verdict.blockers()[0]}, now};
}

void FloorState::on(const msg::LedgerPage& page, Time now) {
  if (page.page_index() >= std::min(page.page_count(), kMaxLedgerPages)) return;
  ledger_[page.page_index()] = {page, now};
  while (!ledger_.empty() && ledger_.rbegin()->first >= page.page_count())
    ledger_.erase(std::prev(ledger_.end()));
}

void FloorState::on(const msg::CoordinatorState& state, Time now) {
  if (state.coordinator() < kMaxCoordinators) coordinators_[state.coordinator()] = {state, now};
}

void FloorState::on(const msg::OrderMemory& memory, Time now) {
  const std::optional<OrderPage> page = decode(memory, now);
  if (!page) return;
  for (const RememberedOrder& order : page->orders) (void)orders_.merge(order);
}

void FloorState::on(const msg::LaserScan& scan, Time now) {
  if (RobotView* view = robot(scan.robot())) view->scan = {scan, now};
}

void FloorState::on(const msg::Course& message, Time now) {
  if (!is_coordinator(message.header().sender())) return;
  std::optional<DrivingCourse> course = decode(message, now);
  RobotView* view = course ? robot(course->robot) : nullptr;
  if (view == nullptr || (!course->is_empty() && !course->is_about(now))) return;
  const DrivingCourse* known = fresh(view->course, now, DrivingCourse::kMaxSilence);
  const bool is_late = known && course->planned_at < known->planned_at;
  if (!is_late) view->course = {*std::move(course), now};
}

}  // namespace sidestep
