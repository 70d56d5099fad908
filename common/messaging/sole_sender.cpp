// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sole_sender.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

SoleSender::Outcome SoleSender::receive(std::uint64_t incarnation, Time now) {
  forget_future(now);
  if (has_sender_ && incarnation > sender_ && incarnation - sender_ <= kMaxRaise) sender_ = incarnation;
  if (!has_sender_ || (incarnation != sender_ && now - heard_at_ >= gone_after_)) {
    *this = SoleSender(listening_);
    has_sender_ = true;
    sender_ = incarnation;
    believes_from_ = now + listening_;
  }
  if (now < believes_from_) return listen(incarnation, now);
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
  // One late message, overtaken by the first message of the restarted process, does not prove a conflict, and
  // neither does one forged message.
  if (std::min(others_, interleaved_) < kEvidence)
    return incarnation == sender_ ? Outcome::kCounts : Outcome::kRefused;
  gone_after_ = kGoneAfterContest;
  return std::exchange(is_reported_, true) ? Outcome::kRefused : Outcome::kNewlyContested;
}

void SoleSender::forget_future(Time now) {
  heard_at_ = std::min(heard_at_, now);
  other_heard_at_ = std::min(other_heard_at_, now);
  believes_from_ = std::min(believes_from_, now + listening_);
}

SoleSender::Outcome SoleSender::listen(std::uint64_t incarnation, Time now) {
  (incarnation == sender_ ? heard_at_ : other_heard_at_) = now;
  if (incarnation == sender_) return Outcome::kRefused;
  others_ = interleaved_ = kEvidence;
  gone_after_ = kGoneAfterContest;
  return std::exchange(is_reported_, true) ? Outcome::kRefused : Outcome::kNewlyContested;
}

}  // namespace sidestep
