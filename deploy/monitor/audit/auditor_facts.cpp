// SPDX-License-Identifier: Apache-2.0
// What robots report, and what truth says of them.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "deploy/monitor/audit/auditor.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kKept_ns = 1'500'000'000;
// Versions that were excluded longer ago than this were compared when they were not.
constexpr std::int64_t kRecent_ns = 50'000'000;
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62;
// Those that touch are not pressed together, and not seen at one instant.
constexpr double kTouching_m = 0.001;
constexpr std::size_t kMostLives = 16;
// A robot looks at its error once a millisecond, and reports where it is in between.
constexpr double kLookedLater_m = 0.0005;
// It may take so long to get back to its reference, or to look again after a fix has shown that it is far
// off.
constexpr std::int64_t kCure_ns = 26'000'000;

bool is_sane(const msg::Feedback& feedback) {
  return std::isfinite(feedback.x_m()) && std::isfinite(feedback.y_m()) && std::isfinite(feedback.vx_mps()) &&
         std::isfinite(feedback.vy_mps()) && std::isfinite(feedback.tracking_error_m()) &&
         feedback.at_ns() >= 0 && feedback.at_ns() < kLatest_ns;
}

const char* why(Excluded excluded) {
  switch (excluded) {
    case Excluded::kOlder:
      return "a newer one was executed before";
    case Excluded::kLate:
      return "its start had passed without it being executed";
    case Excluded::kFenced:
      return "the robot had obeyed a later incarnation and did not execute it then";
    default:
      return "the robot was lifted off the floor after it";
  }
}

}  // namespace

bool Auditor::clock_is_sound(const msg::Feedback& feedback, const Heard& heard) const {
  // A facts' time is the robot's when it sent them.
  return feedback.at_ns() - heard.latest_ns <= clock_bound_ns_ + 1000 &&
         heard.latest_ns - feedback.at_ns() <=
             clock_bound_ns_ + 1000 + (how_.is_complete ? 0 : how_.fastest.count());
}

void Auditor::on_feedback(const msg::Feedback& feedback, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(feedback.robot(), feedback.head());
  if (!robot) return;
  const Heard heard = note(kFeedbackKind, feedback.robot(), feedback.head());
  if (!is_sane(feedback)) {
    ++totals_.invalid;
    return;
  }
  const std::uint64_t life = feedback.head().incarnation();
  if (robot->fact && life > robot->fact->life) {
    robot->start_again();
    sights_[index_of(*robot)] = {};
  }
  if (!heard.is_newest || (robot->fact && life < robot->fact->life)) return;
  const bool executes_nothing = feedback.is_lifted() && feedback.executing().version_number() == 0;
  if (!executes_nothing) {
    Known* executing = learn(*robot, feedback.executing());
    if (!executing) return;
    if (feedback.is_off_reference() && !executing->was_executed && executing->sent_ns == kNever) {
      executing->is_own = true;
    }
  }
  AuditedRobot::Fact fact;
  fact.life = life;
  fact.at_ns = feedback.at_ns();
  fact.earliest_ns = heard.earliest_ns;
  fact.latest_ns = heard.latest_ns;
  fact.executing = feedback.executing().version_number();
  fact.obeyed = feedback.obeyed_incarnation();
  fact.epoch = feedback.obeyed_epoch();
  fact.epoch_since_ns =
      robot->fact && robot->fact->epoch == fact.epoch ? robot->fact->epoch_since_ns : heard.latest_ns;
  fact.is_off_reference = feedback.is_off_reference();
  fact.is_lifted = feedback.is_lifted();
  judge_order(*robot, feedback);

  robot->age(to_ns(now_) - kRecent_ns - (how_.is_complete ? 0 : 20 * how_.fastest.count()));
  before_.clear();
  for (std::size_t i = robot->first_recent; i < robot->versions.size(); ++i)
    before_.push_back(state_of(robot->versions[i]));
  if (!executes_nothing) {
    Known& executing = *robot->find(feedback.executing().version_number());
    judge_switch(*robot, executing, feedback);
    judge_origin(*robot, executing);
    judge_tracking(*robot, executing, feedback, heard);
    judge_epochs(*robot, executing, feedback, heard);
    if (executing.is_own && !executing.was_executed) judge_own(*robot, executing);
    Known* base = robot->find(executing.version.base());
    if (base && base->was_executed && robot->fact && robot->fact->executing == base->number)
      base->executed_until_ns = std::max(base->executed_until_ns, executing.path.start_ns());
    executing.was_executed = true;
    executing.executed_until_ns = std::max(executing.executed_until_ns, feedback.at_ns());
  }
  exclude(*robot, fact, heard, to_ns(now_));
  has_sound_clock_[index_of(*robot)] = clock_is_sound(feedback, heard);
  judge_place(*robot, feedback, heard);

  robot->fact = fact;

  judge_pairs_of(*robot, before_);
  robot->forget(to_ns(now_) - kKept_ns);
}

void Auditor::judge_order(const AuditedRobot& robot, const msg::Feedback& feedback) {
  if (!robot.fact) return;
  const AuditedRobot::Fact& last = *robot.fact;
  const VersionNumber number = feedback.executing().version_number();
  const auto broken = [&](const std::string& what) {
    report(AuditRule::kFacts, robot.id, robot.find(number), feedback.obeyed_epoch(), what);
  };
  // A clock that is wrong may be set.
  if (feedback.at_ns() < last.at_ns && has_sound_clock_[index_of(robot)])
    broken(fmt::format("at {} ns, after a fact at {} ns", feedback.at_ns(), last.at_ns));
  if (feedback.obeyed_incarnation() < last.obeyed)
    broken(fmt::format("obeys incarnation {}, after {}", feedback.obeyed_incarnation(), last.obeyed));
  if (feedback.obeyed_epoch() < last.epoch)
    broken(fmt::format("obeys epoch {}, after {}", feedback.obeyed_epoch(), last.epoch));
  if (number != 0 && feedback.executing().start_ns() > feedback.at_ns())
    broken(fmt::format("executes at {} ns what begins at {} ns", feedback.at_ns(),
                       feedback.executing().start_ns()));
  if (number == 0 && !feedback.is_lifted() && last.executing > 0)
    broken(fmt::format("stands where it began, after version {}", last.executing));
}

void Auditor::judge_switch(const AuditedRobot& robot, const Known& to, const msg::Feedback& feedback) {
  if (!robot.fact || to.number == robot.fact->executing || feedback.is_off_reference()) return;
  if (to.excluded != Excluded::kNo) {
    const AuditRule rule = to.excluded == Excluded::kLate     ? AuditRule::kLate
                           : to.excluded == Excluded::kFenced ? AuditRule::kFenced
                                                              : AuditRule::kFacts;
    report(rule, robot.id, &to, 0, fmt::format("is executed, although {}", why(to.excluded)));
    return;
  }
  // Between two facts it may have passed through several.
  const VersionNumber from = robot.fact->executing;
  const Known* step = &to;
  while (step && step->has_content && step->version.base() > from && step->version.base() < step->number)
    step = robot.find(step->version.base());
  if (!step || !step->has_content || step->version.base() == from) return;
  report(AuditRule::kSwitch, robot.id, &to, 0,
         fmt::format("continues version {}, and version {} was executed", step->version.base(), from));
}

void Auditor::judge_origin(AuditedRobot& robot, Known& executing) {
  if (!executing.was_executed && how_.is_complete && !executing.is_own &&
      executing.number > robot.given_up_version && executing.sent_ns == kNever &&
      !executing.is_reported_unsent) {
    executing.is_reported_unsent = true;
    report(AuditRule::kSent, robot.id, &executing, 0, "was in no command");
  }
}

void Auditor::judge_tracking(AuditedRobot& robot, const Known& executing, const msg::Feedback& feedback,
                             const Heard& heard) {
  const std::int64_t before_ns = std::exchange(robot.beyond_since_ns, kNever);
  // Whose clock is set finds itself far off all at once.
  if (!has_sound_clock_[index_of(robot)] || !clock_is_sound(feedback, heard)) return;
  if (feedback.is_off_reference() || feedback.is_lifted() || !robot.fact || robot.fact->is_off_reference)
    return;
  const double beyond_m =
      feedback.tracking_error_m() - tracking_bound_m_ - executing.version.inflation_m() - kLookedLater_m;
  if (!(beyond_m > 0)) return;
  // Between two facts that were not heard it may have been back.
  robot.beyond_since_ns = heard.is_next && before_ns != kNever ? before_ns : feedback.at_ns();
  if (feedback.at_ns() - robot.beyond_since_ns <= kCure_ns) return;
  report(
      AuditRule::kTracking, robot.id, &executing, 0,
      fmt::format("{:.6f} m off its reference by its own estimate, for {:.3f} s at least; {:.6f} m allowed",
                  feedback.tracking_error_m(),
                  static_cast<double>(feedback.at_ns() - robot.beyond_since_ns) * 1e-9, tracking_bound_m_));
}

void Auditor::judge_own(const AuditedRobot& robot, const Known& own) {
  const auto broken = [&](const std::string& what) {
    report(AuditRule::kOffReference, robot.id, &own, 0, what);
  };
  if (robot.fact && own.number <= robot.fact->executing)
    broken(fmt::format("is not above version {} that it replaces", robot.fact->executing));
  const AuditPath::Node& end = own.path.last();
  if (std::hypot(end.vx, end.vy) > 1e-5)
    broken(fmt::format("ends with {:.6f} m/s", std::hypot(end.vx, end.vy)));
  // From its measured speed at D to rest, and no farther.
  const double speed = std::hypot(own.version.vx_mps(), own.version.vy_mps());
  const double longest = speed / scenario_.limits.deceleration_mps2 + 1e-6;
  if (own.path.duration_s() > 1.01 * longest + 0.001)
    broken(fmt::format("takes {:.4f} s to stop from {:.4f} m/s", own.path.duration_s(), speed));
}

void Auditor::judge_epochs(AuditedRobot& robot, const Known& executing, const msg::Feedback& feedback,
                           const Heard& heard) {
  const bool is_switch = robot.fact && robot.fact->executing != executing.number;
  if (is_switch && executing.sent_ns != kNever && how_.is_complete && robot.fact->epoch_since_ns != kNever &&
      executing.sent_ns > robot.fact->epoch_since_ns && executing.sent_epoch < robot.fact->epoch) {
    report(AuditRule::kOldEpoch, robot.id, &executing, executing.sent_epoch,
           fmt::format("was sent after the robot had obeyed epoch {}", robot.fact->epoch));
  }
  for (auto& [epoch, record] : epochs_) {
    if (record.is_reported || feedback.is_lifted() || feedback.obeyed_epoch() >= epoch) continue;
    if (record.first_grant_ns >= heard.earliest_ns) continue;
    record.is_reported = true;
    report(AuditRule::kAllRegistered, robot.id, nullptr, epoch,
           fmt::format("obeys epoch {} still, so it cannot have registered when the first grant was made",
                       feedback.obeyed_epoch()));
  }
  if (!robot.registered || robot.registered->is_reported || robot.registered->latest_ns >= heard.earliest_ns)
    return;
  AuditedRobot::Registered& registered = *robot.registered;
  if (feedback.obeyed_epoch() < registered.epoch || feedback.obeyed_incarnation() < registered.incarnation) {
    registered.is_reported = true;
    report(AuditRule::kAcknowledged, robot.id, nullptr, registered.epoch,
           fmt::format("registered by incarnation {}; afterwards the robot obeys incarnation {} and epoch {}",
                       registered.incarnation, feedback.obeyed_incarnation(), feedback.obeyed_epoch()));
    return;
  }
  const bool is_known_older =
      executing.number == 0 || (executing.granted_in != 0 && executing.granted_in < registered.epoch);
  const bool is_registered =
      std::ranges::find(registered.versions, executing.number) != registered.versions.end();
  if (!is_known_older || is_registered || executing.is_own || feedback.is_lifted()) return;
  registered.is_reported = true;
  report(AuditRule::kRegistration, robot.id, &executing, registered.epoch,
         fmt::format("is executed after the registration, which does not hold it; granted in epoch {}",
                     executing.granted_in));
}

void Auditor::exclude(AuditedRobot& robot, const AuditedRobot::Fact& fact, const Heard& heard,
                      std::int64_t now_ns) {
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
    Known& known = robot.versions[i];
    if (known.excluded != Excluded::kNo) continue;
    known.excluded = excluded_by(fact, known);
    if (known.excluded != Excluded::kNo) known.excluded_ns = now_ns;
    if (!known.has_content) continue;
    // Until just before the first fact that excludes it nobody can have known.
    if (known.excluded == Excluded::kNo || heard.is_next)
      known.alive_until_ns = std::max(known.alive_until_ns, heard.earliest_ns);
  }
}

void Auditor::judge_place(AuditedRobot& robot, const msg::Feedback& feedback, const Heard& heard) {
  Sight& sight = sights_[index_of(robot)];
  if (!how_.is_complete || sight.at_ns == kNever) return;
  const std::int64_t ahead_ns = feedback.at_ns() - heard.latest_ns;
  const std::int64_t at_ns = sight.at_ns + ahead_ns;  // by the robot's clock
  if (feedback.at_ns() < at_ns) return;
  const Sight seen = sight;
  sight = {};
  const bool is_off = feedback.is_off_reference() || feedback.is_lifted() || !robot.fact ||
                      robot.fact->is_off_reference || robot.fact->is_lifted;
  const Known* then = robot.find(feedback.executing().version_number());
  while (then && then->has_content && then->path.start_ns() > at_ns && then->number != 0)
    then = robot.find(then->version.base());
  if (is_off || !then || !then->has_content) return;
  const AuditPath::Node reference = then->path.at_ns(at_ns);
  const double error = std::hypot(seen.x - reference.x, seen.y - reference.y);
  totals_.farthest_m = std::max(totals_.farthest_m, error);
  totals_.beyond += error > tracking_bound_m_ + then->version.inflation_m();
  if (error <= tracking_bound_m_ + then->version.inflation_m()) hands_.see_in_place(index_of(robot));
  if (error <= scenario_.margin_m + then->version.inflation_m()) return;
  if (hands_.are_on(index_of(robot))) {
    ++totals_.places_by_hand;
    return;
  }
  report(AuditRule::kPlace, robot.id, then, 0,
         fmt::format("is {:.6f} m from where it ought to be at {} ns, the margin is {:.6f} m", error, at_ns,
                     scenario_.margin_m));
}

void Auditor::judge_contacts(const msg::GroundTruth& truth, std::uint64_t before) {
  const std::uint64_t more = truth.contacts() - before,
                      told = std::min<std::uint64_t>(more, msg::MAX_TOUCHES);
  bool are_all_by_hand = true;
  for (std::uint64_t k = truth.contacts() - told; k < truth.contacts(); ++k) {
    const msg::Touch& touch = truth.touches()[k % msg::MAX_TOUCHES];
    if (hands_.touch(place_of(touch.first()), place_of(touch.second()))) {
      ++totals_.contacts_by_hand;
      continue;
    }
    are_all_by_hand = false;
    report(
        AuditRule::kContact, touch.first(), nullptr, 0,
        fmt::format("touches {}; {} contacts so far, {:.9f} m s of penetration, least clearance {:.6f} m",
                    touch.second() == msg::NO_ROBOT ? "an obstacle" : fmt::format("robot {}", touch.second()),
                    truth.contacts(), truth.penetration_m_s(), truth.min_clearance_m()));
  }
  // Of more than it tells of, the last ones stand for the earlier ones.
  if (are_all_by_hand) totals_.contacts_by_hand += more - told;
}

std::optional<std::size_t> Auditor::place_of(RobotId robot) const {
  if (robot >= index_.size() || index_[robot] == robots_.size()) return std::nullopt;
  return index_[robot];
}

void Auditor::on_truth(const msg::GroundTruth& truth, Time now) {
  now_ = now;
  const Heard heard = note(kTruthKind, truth.simulator(), truth.head());
  if (truth.at_ns() < 0 || truth.at_ns() >= kLatest_ns || truth.robots().size() > 1024) {
    ++totals_.invalid;
    return;
  }
  if (!heard.is_newest) return;
  if (truths_.size() >= kMostLives && !truths_.contains(truth.head().incarnation()))
    truths_.erase(truths_.begin());
  see(truth);
  msg::GroundTruth& last = truths_[truth.head().incarnation()];
  const RobotId nobody = robots_.empty() ? 0 : robots_.front().id;
  if (truth.contacts() > last.contacts()) judge_contacts(truth, last.contacts());
  if (truth.firmware_violations() > last.firmware_violations())
    report(AuditRule::kFirmwareMonitor, nobody, nullptr, 0,
           fmt::format("{} so far", truth.firmware_violations()));
  if (truth.moving_crashes() > last.moving_crashes()) {
    report(AuditRule::kCrash, nobody, nullptr, 0,
           fmt::format("{} so far, the robot at {:.3f} m/s at most", truth.moving_crashes(),
                       truth.robot_crash_speed_mps()));
  }
  last.contacts(truth.contacts());
  last.firmware_violations(truth.firmware_violations());
  last.moving_crashes(truth.moving_crashes());
}

void Auditor::see(const msg::GroundTruth& truth) {
  const Time at = time_from_ns(truth.at_ns());
  std::ranges::fill(places_m_, std::nullopt);
  for (const msg::TruthRobot& seen : truth.robots()) {
    const auto place = place_of(seen.robot());
    if (!place || !std::isfinite(seen.x_m()) || !std::isfinite(seen.y_m())) continue;
    sights_[*place] = {truth.at_ns(), seen.x_m(), seen.y_m()};
    places_m_[*place] = Vec2(seen.x_m(), seen.y_m());
    if (seen.disturbance_end_ns() >= 0) hands_.move(*place, time_from_ns(seen.disturbance_end_ns()), at);
  }
  hands_.step(at, places_m_, 2 * scenario_.radius_m + kTouching_m);
}

}  // namespace sidestep
