// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// Checks what the safety protocol promises, by what coordinators and robots say: versions in the ledger are
/// clear of each other, what robots execute is clear of each other, and what a robot executes is in the
/// ledger of the coordinator that it obeys. Two robots of which one was off its reference may be too near
/// until they are clear once more. The bus has to hear everything at once, in order.
class PromiseWatch {
 public:
  PromiseWatch(Bus& bus, const Scenario& scenario);

  std::uint64_t violations() const { return violations_; }
  /// What was wrong first, in words; empty: nothing.
  const std::string& first() const { return first_; }
  /// Pages of the ledger that were checked.
  std::uint64_t pages() const { return pages_; }
  /// Checks every so many-th page only; what robots execute is checked always.
  void check_every(std::uint64_t pages) { every_ = pages; }

 private:
  struct Robot {
    Version executing;
    Epoch obeyed_epoch = 0;
    bool is_known = false;
  };
  void on_page(const msg::LedgerPage& page);
  void on_feedback(const msg::Feedback& feedback);
  void check_ledger(const std::vector<Version>& versions, Time now);
  void check_executed(const std::vector<Version>& versions, Epoch epoch, Time now);
  bool are_clear(const Version& a, const Version& b) const;
  void violated(Time at, const std::string& what);

  double keep_m_;
  std::map<RobotId, Robot> robots_;
  std::set<std::pair<RobotId, RobotId>> excused_;         // by what they execute,
  std::set<std::pair<RobotId, RobotId>> ledger_excused_;  // and in the ledger
  std::vector<Version> versions_;                         // of the page at hand
  std::uint64_t every_ = 4, pages_ = 0, violations_ = 0;
  std::string first_;
};

}  // namespace sidestep
