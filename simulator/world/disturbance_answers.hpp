// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "common/messaging/bus.hpp"

namespace sidestep {

/// Answers disturbances, and recognises those that operators repeat because an answer was lost.
class DisturbanceAnswers {
 public:
  /// Maximum number of answers that are remembered.
  static constexpr std::size_t kMaxRemembered = 64;

  DisturbanceAnswers(Bus& bus, Incarnation incarnation);

  /// If the disturbance was answered before, answers it again and returns true. Such a disturbance must not
  /// be applied again.
  [[nodiscard]] bool repeat(const msg::Disturbance& disturbance);
  void answer(const msg::Disturbance& disturbance, msg::DisturbanceResult result);

 private:
  struct Answered {
    msg::Header header;  ///< of the disturbance
    msg::DisturbanceAnswer answer;
  };

  Bus& bus_;
  Incarnation incarnation_;
  Writer<msg::DisturbanceAnswer> writer_;
  std::deque<Answered> answered_;
};

}  // namespace sidestep
