// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// Measures when robots execute versions that a new coordinator granted.
class TakeoverWatch {
 public:
  TakeoverWatch(DdsBus& bus, int robots) {
    bus.subscribe(topics::kCoordinator, std::function([this](const msg::CoordinatorState& state) {
                    if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY) {
                      standbys_.insert(state.coordinator());
                    } else {
                      standbys_.erase(state.coordinator());
                      if (state.epoch() > epoch_) active_ = state.coordinator();
                      epoch_ = std::max<std::uint64_t>(epoch_, state.epoch());
                    }
                  }));
    for (std::uint32_t robot = 0; robot < static_cast<std::uint32_t>(robots); ++robot) {
      bus.subscribe(topics::kVerdict, robot, std::function([this, robot](const msg::Verdict& verdict) {
                      if (verdict.epoch() > killed_epoch_ && verdict.granted_version() != 0)
                        granted_.emplace(robot, verdict.granted_version());
                    }));
      bus.subscribe(
          topics::kFeedback, robot, std::function([this, robot](const msg::Feedback& feedback) {
            const auto granted = granted_.find(robot);
            if (granted == granted_.end() || feedback.executing().version_number() < granted->second) return;
            moving_.emplace(robot, time_from_ns(feedback.valid_at_ns()));
          }));
    }
  }

  std::uint32_t active() const { return active_; }
  bool is_ready() const { return epoch_ != 0 && standbys_.size() == 1 && !standbys_.count(active_); }
  void on_kill() {
    killed_epoch_ = epoch_;
    standbys_.clear();  // standbys announce themselves again
    granted_.clear();
    moving_.clear();
  }
  /// The time by which this many robots had executed versions granted by the new coordinator.
  std::optional<Time> moving(std::size_t robots) const {
    if (moving_.size() < robots) return std::nullopt;
    std::vector<Time> times;
    for (const auto& [robot, at] : moving_) times.push_back(at);
    std::sort(times.begin(), times.end());
    return times[robots - 1];
  }

 private:
  std::uint64_t epoch_ = 0, killed_epoch_ = ~std::uint64_t{0};
  std::uint32_t active_ = 0;
  std::set<std::uint32_t> standbys_;
  std::map<std::uint32_t, std::uint64_t> granted_;
  std::map<std::uint32_t, Time> moving_;
};

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace sidestep
