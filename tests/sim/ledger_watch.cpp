// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/ledger_watch.hpp"

#include <algorithm>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

constexpr Duration kStep{10'000'000};
// Pairs farther apart than this do not meet within one version.
constexpr double kFar_m = 3;
// By then the ledger knows that a robot lost its reference, and by then that it found it again.
constexpr Duration kHeardOf{1'000'000'000};

}  // namespace

LedgerWatch::LedgerWatch(SimNetwork& network, const Scenario& scenario)
    : bus_(network), keep_m_(2 * scenario.radius_m + scenario.margin_m) {
  bus_.listen_aside();
  for (const RobotSpec& robot : scenario.robots) {
    bus_.subscribe(topics::kFeedback, robot.id, std::function([this](const msg::Feedback& feedback) {
                     if (feedback.is_off_reference()) off_reference_[feedback.robot()] = bus_.now();
                   }));
  }
  bus_.subscribe(topics::kLedger, std::function([this](const msg::LedgerPage& page) {
                   if (pages_++ % 4 == 0) check(page);
                 }));
}

bool LedgerWatch::are_near(const Version& a, const Version& b) const {
  const Vec2 offset = a.trajectory.at_start().position_m - b.trajectory.at_start().position_m;
  if (offset.norm() > kFar_m) return false;
  const Time from = std::max(a.trajectory.start(), b.trajectory.start());
  const Time to = std::max({a.trajectory.end(), b.trajectory.end(), from});
  for (Time t = from; t <= to + kStep; t += kStep) {
    const double distance =
        (a.trajectory.state_at(t).position_m - b.trajectory.state_at(t).position_m).norm();
    if (distance < keep_m_ + a.grown_m + b.grown_m) return true;
  }
  return false;
}

void LedgerWatch::check(const msg::LedgerPage& page) {
  std::vector<Version> versions;
  for (const msg::Version& message : page.versions()) {
    const auto version = decode(message);
    if (!version) {
      ++violations_;
      continue;
    }
    versions.push_back(*version);
  }
  std::set<RobotId> near;
  for (const Version& a : versions) {
    for (const Version& b : versions) {
      if (a.robot >= b.robot || !are_near(a, b)) continue;
      near.insert({a.robot, b.robot});
      violations_ += !off_reference_.count(a.robot) && !off_reference_.count(b.robot);
    }
  }
  std::erase_if(off_reference_, [&](const auto& lost) {
    return !near.count(lost.first) && bus_.now() - lost.second > kHeardOf;
  });
}

}  // namespace sidestep
