// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "common/league/control_packet.hpp"

namespace sidestep {

/// Collects the answers to several command packets into one, as a simulator with a backlog does.
class AnswerBatch {
 public:
  /// Precondition: packets_per_answer > 0.
  explicit AnswerBatch(std::uint32_t packets_per_answer) : packets_per_answer_(packets_per_answer) {}

  /// Adds the answer to a packet. Returns the collected answer when it is complete.
  std::optional<league::TeamResponse> add(const league::TeamResponse& answer) {
    collected_.errors.insert(collected_.errors.end(), answer.errors.begin(), answer.errors.end());
    collected_.feedback.insert(collected_.feedback.end(), answer.feedback.begin(), answer.feedback.end());
    if (++packets_ < packets_per_answer_) return std::nullopt;
    packets_ = 0;
    return std::exchange(collected_, {});
  }

 private:
  std::uint32_t packets_per_answer_, packets_ = 0;
  league::TeamResponse collected_;
};

}  // namespace sidestep
