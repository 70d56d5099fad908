// SPDX-License-Identifier: Apache-2.0
#include "deploy/search/promise_watch.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/messaging/codec.hpp"
#include "deploy/search/sampled_distance.hpp"

namespace sidestep {
namespace {

Time later_start(const Version& a, const Version& b) {
  return std::max(a.trajectory.start(), b.trajectory.start());
}

std::string named(const Version& version) {
  const auto& begin = version.trajectory.at_start();
  return fmt::format(
      "robot {} version {} (on {}, from {:.6f} s at ({:.4f}, {:.4f}) with ({:.3f}, {:.3f}) m/s)",
      version.robot, version.number, version.base, to_seconds(version.trajectory.start().time_since_epoch()),
      begin.position_m.x(), begin.position_m.y(), begin.velocity_mps.x(), begin.velocity_mps.y());
}

}  // namespace

PromiseWatch::PromiseWatch(Bus& bus, const Scenario& scenario)
    : keep_m_(2 * scenario.radius_m + scenario.margin_m) {
  bus.subscribe(topics::kLedger, std::function([this](const msg::LedgerPage& page) { on_page(page); }));
  for (const RobotSpec& spec : scenario.robots) {
    robots_[spec.id];
    bus.subscribe(topics::kFeedback, spec.id,
                  std::function([this](const msg::Feedback& feedback) { on_feedback(feedback); }));
  }
}

void PromiseWatch::violated(Time at, const std::string& what) {
  if (violations_++ == 0) first_ = fmt::format("at {:.6f} s {}", to_seconds(at.time_since_epoch()), what);
}

void PromiseWatch::on_page(const msg::LedgerPage& page) {
  if (pages_++ % every_ != 0) return;
  const Time now = time_from_ns(page.head().stamp_ns());
  versions_.clear();
  for (const msg::Version& message : page.versions()) {
    if (const auto version = decode(message))
      versions_.push_back(*version);
    else
      violated(now, "the ledger holds a version that makes no sense");
  }
  check_ledger(versions_, now);
  if (page.page_count() == 1) check_executed(versions_, page.epoch(), now);
}

bool PromiseWatch::are_clear(const Version& a, const Version& b) const {
  return !come_nearer(a.trajectory, b.trajectory, keep_m_ + a.grown_m + b.grown_m, later_start(a, b));
}

void PromiseWatch::check_ledger(const std::vector<Version>& versions, Time now) {
  std::set<std::pair<RobotId, RobotId>> too_near;
  for (const Version& a : versions) {
    for (const Version& b : versions) {
      if (a.robot >= b.robot || are_clear(a, b)) continue;
      const auto pair = std::pair(a.robot, b.robot);
      too_near.insert(pair);
      if (a.grown_m > 0 || b.grown_m > 0) ledger_excused_.insert(pair);
      if (!ledger_excused_.contains(pair))
        violated(now, fmt::format("the ledger holds {} and {}", named(a), named(b)));
    }
  }
  std::erase_if(ledger_excused_, [&](const auto& pair) { return !too_near.contains(pair); });
}

void PromiseWatch::check_executed(const std::vector<Version>& versions, Epoch epoch, Time now) {
  for (const auto& [id, robot] : robots_) {
    // The news that a robot has made its own version is still on its way.
    if (!robot.is_known || robot.obeyed_epoch != epoch || robot.executing.grown_m > 0) continue;
    const auto is_it = [&](const Version& v) { return v.robot == id && v.number == robot.executing.number; };
    if (!std::ranges::any_of(versions, is_it))
      violated(now, "the ledger lacks what is executed: " + named(robot.executing));
  }
}

void PromiseWatch::on_feedback(const msg::Feedback& feedback) {
  Robot& robot = robots_.at(feedback.robot());
  robot.obeyed_epoch = feedback.obeyed_epoch();
  if (feedback.is_lifted() && feedback.executing().version_number() == 0) {
    robot.is_known = false;
    return;
  }
  if (robot.is_known && robot.executing.number == feedback.executing().version_number()) return;
  const Time now = time_from_ns(feedback.at_ns());
  const auto executing = decode(feedback.executing());
  if (!executing || executing->robot != feedback.robot()) {
    violated(now, "a robot executes what makes no sense");
    return;
  }
  robot.executing = *executing;
  robot.is_known = true;
  for (const auto& [id, other] : robots_) {
    if (id == feedback.robot() || !other.is_known) continue;
    const auto pair = std::minmax(id, executing->robot);
    if (are_clear(*executing, other.executing)) {
      excused_.erase(pair);
      continue;
    }
    if (executing->grown_m > 0 || other.executing.grown_m > 0) excused_.insert(pair);
    if (!excused_.contains(pair)) {
      violated(now,
               fmt::format("{} executes what is not clear of {}", named(*executing), named(other.executing)));
    }
  }
}

}  // namespace sidestep
