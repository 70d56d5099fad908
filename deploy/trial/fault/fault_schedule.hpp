// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// When a fault begins and ends, since the origin of its plan; nullopt: it has no end.
struct FaultSpan {
  Duration begin{0};
  std::optional<Duration> end;
};

/// A fault that could not be applied.
struct FaultProblem {
  double at_s = 0;   ///< in seconds since the origin of the plan
  std::string text;  ///< the fault and the reason
};

/// Begins and ends the faults of a plan at their times; each fault states its `span()`. The caller's effects
/// carry them out: `effects.begin(fault)` and, for faults with an end, `effects.end(fault)`, with the fault's
/// index.
template <typename Fault>
class FaultSchedule {
 public:
  /// `zero` is the origin of the faults' times. The faults must outlive the schedule.
  FaultSchedule(const std::vector<Fault>& faults, Time zero) : faults_(faults), zero_(zero) {
    for (std::size_t i = 0; i < faults.size(); ++i) {
      const FaultSpan span = faults[i].span();
      events_.push_back({zero + span.begin, i, false});
      if (span.end) events_.push_back({zero + *span.end, i, true});
    }
    // Faults of the same time begin in the plan's order.
    std::ranges::stable_sort(events_, {}, &Event::at);
  }

  /// When the next event is due; Time::max() if none is.
  Time next() const { return next_ < events_.size() ? events_[next_].at : Time::max(); }

  /// Carries out the next event. Precondition: there is one.
  template <typename Effects>
  void apply_next(Effects& effects) {
    const Event& event = events_[next_++];
    if (event.is_end)
      effects.end(event.fault);
    else
      effects.begin(event.fault);
  }
  /// Carries out everything that is due. Effects that throw std::runtime_error become problems, with the
  /// fault's `text`.
  template <typename Effects>
  void apply_due(Time now, Effects& effects) {
    while (next() <= now) {
      const Event& event = events_[next_];
      try {
        apply_next(effects);
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

  const std::vector<Fault>& faults_;
  Time zero_;
  std::vector<Event> events_;  // sorted by time
  std::size_t next_ = 0;
  std::vector<FaultProblem> problems_;
};

}  // namespace sidestep
