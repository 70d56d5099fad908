// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/time/time.hpp"

namespace sidestep {

/// Watches over a channel that only one process at a time may write (TopicInfo::is_sole), such as the facts
/// of a robot. Two that speak for the same robot contradict each other, and nothing tells which one is true.
/// Therefore no message of either counts as long as both are heard. To the protocol they are lost, which
/// stops robots and is safe.
class SoleSender {
 public:
  enum class Outcome : std::uint8_t { kCounts, kRefused, kNewlyContested };
  /// A process counts as gone, so that another one may follow it, after this silence, or after the longer one
  /// if the two have been heard at the same time.
  static constexpr Duration kGoneAfter{1'000'000'000};
  static constexpr Duration kGoneAfterContest{6'000'000'000};
  /// A process that starts among others listens for so long before it believes anybody. Otherwise it would
  /// take whomever it heard first for the only one.
  static constexpr Duration kListening{300'000'000};

  SoleSender() = default;
  /// Nothing counts in the time `listening` after the first message.
  explicit SoleSender(Duration listening) : listening_(listening) {}

  /// A robot whose clock is set back raises its incarnation by one: a little higher, it is the same process.
  /// Those of different processes are readings of clocks in nanoseconds.
  static constexpr std::uint64_t kMaxRaise = 1024;

  /// Processes a message of the process with this incarnation.
  [[nodiscard]] Outcome receive(std::uint64_t incarnation, Time now);

  /// Whether this is the process that was heard first of those that contradict each other.
  bool is_first(std::uint64_t incarnation) const { return has_sender_ && incarnation == sender_; }

 private:
  /// Times after now were read before this process's clock was set back: they count as now.
  void forget_future(Time now);
  /// Each process that is heard beside the first one proves a contest.
  Outcome listen(std::uint64_t incarnation, Time now);

  static constexpr std::uint32_t kEvidence = 2;  // messages of each, in turn

  bool has_sender_ = false, is_reported_ = false;
  std::uint64_t sender_ = 0;  // incarnation of the process that was heard first
  Duration listening_{0};
  Time heard_at_{}, other_heard_at_{}, believes_from_{};
  std::uint32_t others_ = 0;       // messages of other processes since the last silence of these
  std::uint32_t interleaved_ = 0;  // messages of the sender since then
  Duration gone_after_ = kGoneAfter;
};

}  // namespace sidestep
