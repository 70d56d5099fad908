// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/single_writer_guard.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

SingleWriterGuard::Outcome SingleWriterGuard::receive(std::uint64_t incarnation, Time now) {
  clamp_future_times(now);
  if (has_sender_ && incarnation > sender_ && incarnation - sender_ <= kMaxRaise) sender_ = incarnation;
  if (!has_sender_ || (incarnation != sender_ && now - heard_at_ >= gone_after_)) {
    *this = SingleWriterGuard(listening_);
    has_sender_ = true;
    sender_ = incarnation;
    trusts_from_ = now + listening_;
  }
  if (now < trusts_from_) return listen(incarnation, now);
  if (incarnation == sender_) {
    heard_at_ = now;
    if (others_ == 0 || now - other_heard_at_ >= kGoneAfter) {
      others_ = interleaved_ = 0;
      is_reported_ = false;
      return Outcome::kCounts;
    }
    ++interleaved_;
  } else {
    other_heard_at_ = now;
    ++others_;
  }
  // A single message does not prove a conflict: it may be forged, or a late message of the process before its
  // restart.
  if (std::min(others_, interleaved_) < kEvidence)
    return incarnation == sender_ ? Outcome::kCounts : Outcome::kRefused;
  gone_after_ = kConflictSilenceTimeout;
  return std::exchange(is_reported_, true) ? Outcome::kRefused : Outcome::kNewConflict;
}

void SingleWriterGuard::clamp_future_times(Time now) {
  heard_at_ = std::min(heard_at_, now);
  other_heard_at_ = std::min(other_heard_at_, now);
  trusts_from_ = std::min(trusts_from_, now + listening_);
}

SingleWriterGuard::Outcome SingleWriterGuard::listen(std::uint64_t incarnation, Time now) {
  (incarnation == sender_ ? heard_at_ : other_heard_at_) = now;
  if (incarnation == sender_) return Outcome::kRefused;
  others_ = interleaved_ = kEvidence;
  gone_after_ = kConflictSilenceTimeout;
  return std::exchange(is_reported_, true) ? Outcome::kRefused : Outcome::kNewConflict;
}

}  // namespace sidestep
