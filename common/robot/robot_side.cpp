// SPDX-License-Identifier: Apache-2.0
#include "common/robot/robot_side.hpp"

namespace sidestep::robot {
namespace {

constexpr double kMaxInflation_m = 1;
constexpr double kAtRest_mps = 1e-12;

template <typename Number>
constexpr Number larger(Number a, Number b) {
  return a < b ? b : a;
}

template <typename Number>
constexpr Number smaller(Number a, Number b) {
  return b < a ? b : a;
}

template <typename Real>
bool is_finite(const Vec<Real>& v) {
  // For infinities and NaN, the difference is NaN.
  return v.x - v.x == 0 && v.y - v.y == 0;
}

bool is_later(const Version& a, const Version& b) {
  return a.start_ns != b.start_ns ? a.start_ns > b.start_ns : a.number > b.number;
}

void append_phase(Version& version, std::int64_t duration_ns, double ax_mps2, double ay_mps2) {
  version.phases[version.phase_count++] = {duration_ns, ax_mps2, ay_mps2};
}

// Like append_stop() in common/motion/trajectory.hpp: the duration is rounded up to whole nanoseconds and the
// deceleration reduced to match, so that the version ends exactly at rest.
template <typename Real>
void append_braking(Version& version, const Vec<Real>& velocity_mps, Real deceleration_mps2) {
  const auto speed = static_cast<double>(norm(velocity_mps));
  if (speed < kAtRest_mps) return;
  const double exact_ns = speed / static_cast<double>(deceleration_mps2) * 1e9;
  auto duration_ns = static_cast<std::int64_t>(exact_ns);
  if (static_cast<double>(duration_ns) < exact_ns) ++duration_ns;
  const double seconds = seconds_of(duration_ns);
  append_phase(version, duration_ns, -static_cast<double>(velocity_mps.x) / seconds,
               -static_cast<double>(velocity_mps.y) / seconds);
}

}  // namespace

template <typename Real>
RobotSide<Real>::RobotSide(const Settings<Real>& settings, const DurableState& remembered)
    : settings_(settings), durable_(remembered) {
  restart();
}

template <typename Real>
void RobotSide<Real>::begin_at_rest(double x_m, double y_m) {
  executing_ = {};
  executing_.x_m = x_m;
  executing_.y_m = y_m;
  has_pose_ = true;
}

template <typename Real>
void RobotSide<Real>::find_pose() {
  has_pose_ = true;
  has_found_pose_ = true;
  is_rebooting_ = true;
}

template <typename Real>
void RobotSide<Real>::lose_pose() {
  pending_count_ = 0;
  is_rebooting_ = false;
  has_pose_ = false;
  has_found_pose_ = false;
}

template <typename Real>
void RobotSide<Real>::switch_on() {
  pending_count_ = 0;
  is_rebooting_ = !is_lifted_ && has_pose_;
}

template <typename Real>
void RobotSide<Real>::set_clock_back(std::int64_t now_ns) {
  pending_count_ = 0;
  has_command_ = false;
  last_report_ns_ = INT64_MIN;
  drifted_since_ns_ = kNever_ns;
  if (is_lifted_)
    lift(now_ns, executing_.x_m, executing_.y_m);
  else
    is_clock_set_back_ = true;
}

template <typename Real>
bool RobotSide<Real>::store(const DurableState& next, StableMemory& memory) {
  if (next == durable_) return true;
  if (!memory.store(next)) return false;
  durable_ = next;
  is_memory_broken_ = false;
  return true;
}

template <typename Real>
bool RobotSide<Real>::on_command(const Command& command, std::int64_t now_ns, StableMemory& memory) {
  while (switch_next(now_ns)) {
  }
  highest_seen_ = larger(highest_seen_, command.incarnation);
  if (command.version) highest_seen_ = larger(highest_seen_, command.version->number);
  if (command.incarnation < durable_.incarnation) {
    ++counts_.refused_fenced;
    return false;
  }
  // A new agent may not know the latest epoch, which the robot learned from an earlier agent. The agent's
  // versions are refused until the agent learns that epoch from a fact.
  const bool is_old_epoch = command.epoch < durable_.epoch;
  DurableState next = durable_;
  next.incarnation = command.incarnation;
  next.epoch = larger(next.epoch, command.epoch);
  if (highest_seen_ + kStoredNumberReserve / 2 > next.number_bound)
    next.number_bound = highest_seen_ + kStoredNumberReserve;
  if (!store(next, memory)) {
    ++counts_.refused_unstored;
    return false;
  }
  discard_fenced(now_ns);
  acknowledge();
  has_command_ = true;
  command_sent_at_ns_ = command.sent_at_ns;
  command_received_at_ns_ = now_ns;
  if (command.version && is_old_epoch)
    ++counts_.refused_fenced;
  else if (command.version)
    take(*command.version, now_ns, memory);
  return true;
}

template <typename Real>
void RobotSide<Real>::on_malformed_command(std::int64_t now_ns) {
  while (switch_next(now_ns)) {
  }
  ++counts_.refused_malformed;
}

// Discards versions of earlier agents, except those that were already sent to the motors: they start within
// the lead, and each continues the one before it. Versions of the new agent start later.
template <typename Real>
void RobotSide<Real>::discard_fenced(std::int64_t now_ns) {
  std::uint64_t planned = executing_.number, highest = highest_executed_;
  int kept = 0;
  for (int i = 0; i < pending_count_; ++i) {
    const Version& version = pending_[i];
    const bool is_planned = version.base == planned && version.number > highest;
    const bool is_fenced = version.incarnation < durable_.incarnation;
    if (is_fenced && !(is_planned && is_irrevocable(version, now_ns))) {
      ++counts_.refused_fenced;
      continue;
    }
    if (is_planned) planned = highest = version.number;
    if (kept != i) pending_[kept] = version;
    ++kept;
  }
  pending_count_ = kept;
}

template <typename Real>
void RobotSide<Real>::acknowledge() {
  for (int i = 0; i < pending_count_; ++i) {
    if (pending_[i].incarnation < durable_.incarnation) return;
  }
  acknowledged_incarnation_ = durable_.incarnation;
}

template <typename Real>
void RobotSide<Real>::take(const Version& version, std::int64_t now_ns, StableMemory& memory) {
  if (holds(version.number)) return;
  DurableState moved = durable_;
  moved.has_moved = true;
  const bool is_acknowledged = acknowledged_incarnation_ == durable_.incarnation;
  if (version.incarnation < durable_.incarnation || !is_acknowledged) {
    ++counts_.refused_fenced;
  } else if (is_irrevocable(version, now_ns)) {
    ++counts_.refused_late;
  } else if (!may_take(version)) {
    ++counts_.refused_base;  // the version's base is older than the version being executed
  } else if (!store(moved, memory)) {
    ++counts_.refused_unstored;
  } else {
    insert(version);
  }
}

template <typename Real>
bool RobotSide<Real>::holds(std::uint64_t number) const {
  if (number == executing_.number) return true;
  for (int i = 0; i < pending_count_; ++i) {
    if (pending_[i].number == number) return true;
  }
  return false;
}

template <typename Real>
bool RobotSide<Real>::may_take(const Version& version) const {
  if (!has_pose_ || is_clock_set_back_ || version.number <= highest_executed_) return false;
  return !is_lifted_ || (version.base == 0 && version.is_rest());
}

template <typename Real>
void RobotSide<Real>::insert(const Version& version) {
  if (pending_count_ == kMaxPending) {
    ++counts_.refused_base;
    if (!is_later(pending_[kMaxPending - 1], version)) return;
    --pending_count_;
  }
  int place = pending_count_;
  for (; place > 0 && is_later(pending_[place - 1], version); --place) pending_[place] = pending_[place - 1];
  pending_[place] = version;
  ++pending_count_;
}

template <typename Real>
void RobotSide<Real>::remove_pending(int index) {
  --pending_count_;
  for (int i = index; i < pending_count_; ++i) pending_[i] = pending_[i + 1];
}

template <typename Real>
bool RobotSide<Real>::switch_next(std::int64_t now_ns) {
  while (pending_count_ > 0 && pending_[0].start_ns <= now_ns) {
    const Version due = pending_[0];
    remove_pending(0);
    if (due.base == executing_.number && due.number > highest_executed_) {
      executing_ = due;
      highest_executed_ = due.number;
      has_moved_ = true;
      is_off_reference_ = false;
      ++counts_.activated;
      return true;
    }
    ++counts_.refused_base;
  }
  return false;
}

template <typename Real>
const Version& RobotSide<Real>::planned(std::int64_t t_ns) const {
  const Version* planned = &executing_;
  std::uint64_t highest = highest_executed_;
  for (int i = 0; i < pending_count_; ++i) {
    if (pending_[i].start_ns > t_ns) break;
    if (pending_[i].base != planned->number || pending_[i].number <= highest) continue;
    planned = &pending_[i];
    highest = planned->number;
  }
  return *planned;
}

// Comparisons of numbers below are written so that they are true only for values known to be within a bound,
// and thus false for NaN.
template <typename Real>
Real RobotSide<Real>::error_m(std::int64_t now_ns, const Vec<Real>& position_m) const {
  const Vec<Real> reference_m = motion_at<Real>(executing_, now_ns).position_m;
  return norm(Vec<Real>{position_m.x - reference_m.x, position_m.y - reference_m.y});
}

template <typename Real>
bool RobotSide<Real>::needs_uncertainty(std::int64_t now_ns, const Vec<Real>& position_m) const {
  return is_rebooting_ || is_clock_set_back_ ||
         !(error_m(now_ns, position_m) < Real(0.5) * settings_.drift_bound_m);
}

// The uncertainty counts for at most half of the bound, so a robot is not off its reference only because no
// camera sees it.
template <typename Real>
bool RobotSide<Real>::is_within(Real bound_m, Real error_m, const Estimate<Real>& estimate) const {
  const Real half_m = Real(0.5) * bound_m, uncertainty_m = 2 * estimate.position_error_rms_m;
  if (error_m < half_m) return true;
  return error_m + (uncertainty_m <= half_m ? uncertainty_m : half_m) <=
         bound_m + static_cast<Real>(executing_.inflation_m);
}

template <typename Real>
std::int64_t RobotSide<Real>::drifted_since_ns(std::int64_t now_ns, const Estimate<Real>& estimate) const {
  const bool is_near = is_within(settings_.drift_bound_m, error_m(now_ns, estimate.position_m), estimate);
  return is_near ? kNever_ns : smaller(drifted_since_ns_, now_ns);
}

// A fix may reveal all drift since the previous fix in one step. The control corrects this drift before a
// message could reach the other robots, and an unexpected stop would endanger them. So the robot stops only
// for an error that the control cannot correct in time or that the margin does not cover.
template <typename Real>
bool RobotSide<Real>::must_stop(std::int64_t now_ns, const Estimate<Real>& estimate,
                                OwnStopReason& reason) const {
  const Real error = error_m(now_ns, estimate.position_m);
  const bool has_jumped = !(estimate.jump_m <= 0);
  // Inflation covers the uncertainty of where the robot is, but not its way back to the reference.
  if (has_jumped && !(error <= settings_.drift_bound_m)) {
    reason = OwnStopReason::kDisplaced;
    return true;
  }
  const std::int64_t since_ns = drifted_since_ns(now_ns, estimate);
  if (since_ns == kNever_ns) return false;
  if (!is_within(settings_.tracking_bound_m, error, estimate)) {
    reason = OwnStopReason::kOffReference;
    return true;
  }
  if (has_jumped) {
    reason = OwnStopReason::kDisplaced;
    return true;
  }
  reason = OwnStopReason::kDrifted;
  return now_ns - since_ns >= kMaxRecovery_ns;
}

template <typename Real>
bool RobotSide<Real>::is_stop_due(std::int64_t now_ns, const Estimate<Real>& estimate) const {
  OwnStopReason reason{};
  return may_stop(now_ns) && (is_rebooting_ || is_clock_set_back_ || must_stop(now_ns, estimate, reason));
}

template <typename Real>
void RobotSide<Real>::check_reference(std::int64_t now_ns, const Estimate<Real>& estimate,
                                      StableMemory& memory) {
  while (switch_next(now_ns)) {
  }
  if (is_lifted_ || !has_pose_) return;
  if (!is_finite(estimate.position_m) || !is_finite(estimate.velocity_mps)) return lose_pose();
  if ((is_rebooting_ || is_clock_set_back_) && may_stop(now_ns)) {
    const auto reason = is_clock_set_back_ ? OwnStopReason::kClockSetBack : OwnStopReason::kRestart;
    restart();
    return start_own_stop(reason, estimate, now_ns, memory);
  }
  OwnStopReason reason{};
  const bool must = must_stop(now_ns, estimate, reason);
  drifted_since_ns_ = drifted_since_ns(now_ns, estimate);
  if (must && may_stop(now_ns)) start_own_stop(reason, estimate, now_ns, memory);
}

template <typename Real>
void RobotSide<Real>::start_own_stop(OwnStopReason reason, const Estimate<Real>& estimate,
                                     std::int64_t now_ns, StableMemory& memory) {
  Version stop;
  if (!begin_with_commanded_motion(stop, estimate)) return lose_pose();
  own_stop_reason_ = reason;
  has_found_pose_ = false;
  drifted_since_ns_ = kNever_ns;
  stop.incarnation = durable_.incarnation;
  highest_seen_ = larger(highest_seen_, highest_executed_) + kOwnNumberGap;
  stop.number = highest_seen_;
  stop.base = executing_.number;
  stop.start_ns = now_ns;
  executing_ = stop;
  highest_executed_ = stop.number;
  is_off_reference_ = true;
  pending_count_ = 0;
  ++own_stops_;
  if (highest_seen_ <= durable_.number_bound) return;
  DurableState next = durable_;
  next.number_bound = highest_seen_ + kStoredNumberReserve;
  // The stop must not wait for the memory. If storing fails, the robot still stops but reports nothing.
  is_memory_broken_ = !store(next, memory);
}

// Computes the place, the motion and the inflation of a stop from the estimate. False if they cannot be
// determined.
template <typename Real>
bool RobotSide<Real>::begin_with_commanded_motion(Version& stop, const Estimate<Real>& estimate) const {
  const MotionUnderWay<Real>& under_way = estimate.under_way;
  const bool is_late = settings_.actuation_lead_ns > 0;
  Vec<Real> velocity_mps = is_late ? under_way.from_mps : estimate.velocity_mps;
  stop.x_m = static_cast<double>(estimate.position_m.x);
  stop.y_m = static_cast<double>(estimate.position_m.y);
  stop.vx_mps = static_cast<double>(velocity_mps.x);
  stop.vy_mps = static_cast<double>(velocity_mps.y);
  for (int i = 0; is_late && i < under_way.part_count; ++i) {
    const auto& [duration_ns, end_mps] = under_way.parts[i];
    const double seconds = seconds_of(duration_ns);
    append_phase(stop, duration_ns, static_cast<double>(end_mps.x - velocity_mps.x) / seconds,
                 static_cast<double>(end_mps.y - velocity_mps.y) / seconds);
    velocity_mps = end_mps;
  }
  if (!is_finite(velocity_mps) || !is_finite(motion_at<Real>(stop, stop.end_ns()).position_m)) return false;
  append_braking(stop, velocity_mps, settings_.deceleration_mps2);
  // Includes the last jump, because its cause may act again before the next fix.
  const Real error_m = is_late ? under_way.error_m : Real(0);
  const auto inflation_m = static_cast<double>(2 * estimate.position_error_rms_m + estimate.jump_m + error_m);
  stop.inflation_m = inflation_m <= kMaxInflation_m ? inflation_m : kMaxInflation_m;
  return true;
}

template <typename Real>
void RobotSide<Real>::lift(std::int64_t now_ns, double x_m, double y_m) {
  is_lifted_ = true;
  is_rebooting_ = is_clock_set_back_ = false;
  has_pose_ = true;  // a lifted robot needs no own stop until it is put down
  has_found_pose_ = false;
  is_off_reference_ = false;
  pending_count_ = 0;
  executing_ = {};
  executing_.base = highest_executed_;
  executing_.start_ns = now_ns;
  executing_.x_m = x_m;
  executing_.y_m = y_m;
}

template <typename Real>
void RobotSide<Real>::restart() {
  highest_seen_ = highest_executed_ = durable_.number_bound;
  has_moved_ = durable_.has_moved;
  is_off_reference_ = false;
  is_rebooting_ = is_clock_set_back_ = false;
  has_command_ = false;
  drifted_since_ns_ = kNever_ns;
  pending_count_ = 0;
  acknowledged_incarnation_ = durable_.incarnation;
  counts_.activated = 0;
  own_stops_ = 0;
}

template <typename Real>
RobotReport RobotSide<Real>::robot_report(std::int64_t now_ns) {
  while (switch_next(now_ns)) {
  }
  acknowledge();
  last_report_ns_ = larger(last_report_ns_, now_ns);
  RobotReport robot_report;
  robot_report.obeyed_incarnation = acknowledged_incarnation_;
  robot_report.obeyed_epoch = durable_.epoch;
  robot_report.valid_at_ns = now_ns;
  robot_report.executing = &executing_;
  robot_report.is_off_reference = is_off_reference_;
  robot_report.is_lifted = is_lifted_;
  robot_report.has_moved = has_moved_;
  // Otherwise the acknowledged agent would mistake another agent's command for its own.
  robot_report.has_command = has_command_ && acknowledged_incarnation_ == durable_.incarnation;
  robot_report.command_sent_at_ns = command_sent_at_ns_;
  robot_report.command_received_at_ns = command_received_at_ns_;
  robot_report.activated = counts_.activated;
  robot_report.lead_ns = settings_.actuation_lead_ns;
  return robot_report;
}

template class RobotSide<float>;
template class RobotSide<double>;

}  // namespace sidestep::robot
