// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/time/time.hpp"

namespace sidestep {

/// Guards a channel that only one process at a time may write (TopicInfo::is_single_writer), such as a
/// robot's feedback. If two processes speak for the same robot, their messages contradict each other, and the
/// receiver cannot tell which is right. Therefore the messages of both processes are ignored while both are
/// heard. To the protocol these messages are lost; this stops robots and is safe.
class SingleWriterGuard {
 public:
  enum class Outcome : std::uint8_t { kCounts, kRefused, kNewConflict };
  /// Silence after which a process counts as gone and another process may take its place. The longer time
  /// applies if the two processes have been heard alternately.
  static constexpr Duration kGoneAfter{1'000'000'000};
  static constexpr Duration kConflictSilenceTimeout{6'000'000'000};
  /// A process that starts while others are running listens for this long before it trusts a sender.
  /// Otherwise it would assume that the first sender heard is the only one.
  static constexpr Duration kListening{300'000'000};

  SingleWriterGuard() = default;
  /// Messages within the time `listening` after the first one are ignored.
  explicit SingleWriterGuard(Duration listening) : listening_(listening) {}

  /// Maximum increase of the incarnation within one process: a robot whose clock is set back raises its
  /// incarnation by one. Incarnations of different processes are clock readings in nanoseconds.
  static constexpr std::uint64_t kMaxRaise = 1024;

  /// Processes a message from the process with this incarnation.
  [[nodiscard]] Outcome receive(std::uint64_t incarnation, Time now);

  /// Whether this process was heard before the other conflicting processes.
  bool is_first(std::uint64_t incarnation) const { return has_sender_ && incarnation == sender_; }

 private:
  /// Times later than `now` were read before this process's clock was set back; they are replaced by `now`.
  void clamp_future_times(Time now);
  /// Handles a message in the listening period: a message from any process except the first proves a
  /// conflict.
  Outcome listen(std::uint64_t incarnation, Time now);

  static constexpr std::uint32_t kEvidence = 2;  // alternating messages per process that prove a conflict

  bool has_sender_ = false, is_reported_ = false;
  std::uint64_t sender_ = 0;  // incarnation of the process that was heard first
  Duration listening_{0};
  Time heard_at_{}, other_heard_at_{}, trusts_from_{};
  std::uint32_t others_ = 0;       // messages from other processes since their last silence
  std::uint32_t interleaved_ = 0;  // messages from the sender in that time
  Duration gone_after_ = kGoneAfter;
};

}  // namespace sidestep
