// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/messaging/bus.hpp"
#include "deploy/trial/test/judgement/run_history.hpp"

namespace sidestep {

/// Records the messages of a run. Times count from the moment when the observer first receives a message that
/// a coordinator grants, by the clock of its bus.
class RunObserver {
 public:
  /// The observer must outlive the bus's last callback. The bus must refuse messages from processes with
  /// different rules.
  explicit RunObserver(Bus& bus);
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;

  /// When the observer first learned that a coordinator grants. Everything earlier is ignored, except
  /// contacts.
  std::optional<Time> begin() const { return begin_; }
  /// Sets the beginning, for callers that know from another source that a coordinator grants.
  void begin_at(Time now) { begin_ = begin_.value_or(now); }
  /// The history; the caller must add the end.
  const RunHistory& history() const { return history_; }

 private:
  void on_truth(const msg::GroundTruth& truth);
  void on_coordinator(const msg::CoordinatorState& state);
  void on_status(const msg::AgentStatus& status);
  void add_contacts(const msg::GroundTruth& truth);
  void add_notices(const msg::CoordinatorState& state, double at_s);
  double now_s() const { return to_seconds(bus_.now() - *begin_); }

  Bus& bus_;
  std::optional<Time> begin_;
  RunHistory history_;
  std::uint64_t truth_number_ = 0;  // message number of the last ground truth
  std::uint64_t contacts_ = 0;      // number of contacts reported so far
  std::uint64_t highest_epoch_ = 0;
};

}  // namespace sidestep
