// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// Judges from vision's fixes whether a base rests. It rests if the fixes of kRestTime agree.
class BaseRest {
 public:
  static constexpr Duration kRestTime{100'000'000};
  /// Older fixes show nothing.
  static constexpr Duration kMaxFixAge{300'000'000};

  /// `tolerance_m`: maximum distance between fixes of a base at rest.
  explicit BaseRest(double tolerance_m) : tolerance_m_(tolerance_m) {}

  void on_fix(const PoseFix& fix) {
    if (last_ && fix.captured_at <= last_->captured_at) return;
    last_ = fix;
    const bool agrees = first_ && (fix.position_m - first_->position_m).norm() <= tolerance_m_;
    if (!agrees) first_ = fix;
  }
  /// Whether no recent fix contradicts that the base rests.
  bool is_at_rest(Time now) const {
    if (!last_ || now - last_->captured_at > kMaxFixAge) return true;
    return last_->captured_at - first_->captured_at >= kRestTime;
  }

 private:
  double tolerance_m_;
  std::optional<PoseFix> first_, last_;  ///< of the latest fixes that agree with the first of them
};

}  // namespace sidestep
