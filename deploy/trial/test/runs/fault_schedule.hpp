// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <fmt/format.h>
#include <stdexcept>
#include <vector>

#include "common/time/time.hpp"
#include "deploy/trial/test/judgement/test_result.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

/// Begins and ends the faults of a test at their times. The caller's effects carry them out:
/// `effects.begin(fault)` and, for faults with a duration, `effects.end(fault)` with the fault's index. Both
/// throw std::runtime_error if the fault cannot be applied.
class FaultSchedule {
 public:
  /// `zero` is the origin of the faults' times. The faults must outlive the schedule.
  FaultSchedule(const std::vector<PlannedFault>& faults, Time zero);

  /// When the next event is due; Time::max() if none is.
  Time next() const { return next_ < events_.size() ? events_[next_].at : Time::max(); }

  /// Carries out everything that is due.
  template <typename Effects>
  void apply_due(Time now, Effects& effects) {
    while (next() <= now) {
      const Event event = events_[next_++];
      try {
        if (event.is_end)
          effects.end(event.fault);
        else
          effects.begin(event.fault);
      } catch (const std::runtime_error& error) {
        problems_.push_back(
            {to_seconds(event.at - zero_),
             fmt::format("{}{}: {}", event.is_end ? "end " : "", faults_[event.fault].text, error.what())});
      }
    }
  }
  const std::vector<FaultProblem>& problems() const { return problems_; }

 private:
  struct Event {
    Time at;
    std::size_t fault;
    bool is_end;
  };

  const std::vector<PlannedFault>& faults_;
  Time zero_;
  std::vector<Event> events_;  // sorted by time
  std::size_t next_ = 0;
  std::vector<FaultProblem> problems_;
};

}  // namespace sidestep
