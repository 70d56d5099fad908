// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/ledger_watch.hpp"

#include <algorithm>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

constexpr Duration kStep{10'000'000};
// Pairs farther apart than this do not meet within one version.
constexpr double kFar_m = 3;

}  // namespace

LedgerWatch::LedgerWatch(Bus& bus, const Scenario& scenario)
    : keep_m_(2 * scenario.radius_m + scenario.margin_m) {
  bus.subscribe(topics::kLedger, std::function([this](const msg::LedgerPage& page) {
                  if (pages_++ % 4 == 0) check(page);
                }));
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
  for (const Version& a : versions) {
    for (const Version& b : versions) {
      const Vec2 offset = a.trajectory.at_start().position_m - b.trajectory.at_start().position_m;
      if (a.robot >= b.robot || offset.norm() > kFar_m) continue;
      const Time from = std::max(a.trajectory.start(), b.trajectory.start());
      const Time to = std::max({a.trajectory.end(), b.trajectory.end(), from});
      bool near = false;
      for (Time t = from; t <= to + kStep; t += kStep) {
        const double distance =
            (a.trajectory.state_at(t).position_m - b.trajectory.state_at(t).position_m).norm();
        near = near || distance < keep_m_;
      }
      violations_ += near;
    }
  }
}

}  // namespace sidestep
