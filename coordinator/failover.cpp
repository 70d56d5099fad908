// SPDX-License-Identifier: Apache-2.0
#include "coordinator/failover.hpp"

#include <algorithm>

#include "common/messaging/senders.hpp"

namespace sidestep {
namespace {

// Beyond the longest gap between signs of life that was seen lately.
constexpr Duration kLapse{100'000'000};
// So that not all standbys take over at once.
constexpr Duration kStagger{25'000'000};
// At its own start a standby may not have been discovered by others yet.
constexpr Duration kStartLapse{1'000'000'000};
constexpr Duration kStartStagger{200'000'000};
// A process that was not run for so long has signs of life waiting for it.
constexpr Duration kPaused{60'000'000};
constexpr int kMostHearsay = 5;
// So that two lives of one number which begin above the same epoch do not get the same one.
constexpr Epoch kSpread = 1'000'003;

}  // namespace

Failover::Failover(const CoordinatorIdentity& self, bool is_standby, Time now)
    : self_(self), last_sign_(now), last_update_(now), is_new_(is_standby) {
  if (!is_standby) begin_epoch(now);
}

void Failover::begin_epoch(Time now) {
  const Epoch above = highest_ == 0 ? 0 : highest_ + 1 + self_.incarnation % kSpread;
  const Epoch least = std::max<Epoch>({above, static_cast<Epoch>(std::max<std::int64_t>(to_ns(now), 0)), 1});
  // Coordinators of different numbers never have the same epoch.
  epoch_ = least + (kMaxCoordinators + self_.number - least % kMaxCoordinators) % kMaxCoordinators;
  highest_ = epoch_;
  is_new_ = false;
}

void Failover::stand_by(Time now) {
  epoch_ = 0;
  last_sign_ = now;
  has_rhythm_ = false;
}

void Failover::note_sign(Time now) {
  if (has_rhythm_) gaps_[signs_++ % gaps_.size()] = now - last_sign_;
  has_rhythm_ = true;
  last_sign_ = now;
  is_new_ = false;
  hearsay_ = 0;
}

void Failover::on_coordinator_state(const msg::CoordinatorState& state, Time now) {
  const msg::Header& head = state.head();
  const auto own_sender = static_cast<std::uint32_t>(Sender::kCoordinator) + self_.number;
  const bool is_own = head.sender() == own_sender && head.incarnation() == self_.incarnation;
  if (is_own || state.epoch() == 0 || state.coordinator_mode() == msg::COORDINATOR_STANDBY) return;
  if (!is_believable(state.epoch(), now)) {
    ++invalid_;
    return;
  }
  if (state.epoch() < highest_) return;
  if (is_active() && state.epoch() == epoch_) {
    // Somebody was started twice, with one number at one time: what either has granted is not to be trusted.
    if (head.incarnation() < self_.incarnation) return begin_epoch(now);
    return stand_by(now);
  }
  highest_ = state.epoch();
  if (is_active()) {
    stand_by(now);
  } else {
    note_sign(now);
  }
}

void Failover::on_obeyed_epoch(Epoch epoch, bool is_granting, Time now) {
  if (epoch <= highest_) return;
  if (!is_believable(epoch, now)) {
    ++invalid_;
    return;
  }
  highest_ = epoch;
  // While it has granted nothing it may as well begin again above whoever that was. Later somebody has taken
  // over whom it does not hear: it lets that one work, for longer each time.
  if (is_active() && !is_granting) return begin_epoch(now);
  if (is_active()) hearsay_ = std::min(hearsay_ + 1, kMostHearsay);
  stand_by(now);
}

Duration Failover::lapse() const {
  if (is_new_) return kStartLapse + kStartStagger * self_.number;
  const Duration longest_gap = *std::max_element(gaps_.begin(), gaps_.end());
  return (kLapse + kStagger * self_.number + std::min(std::max(longest_gap, kSignOfLife), kStartLapse)) *
         (1 << hearsay_);
}

void Failover::update(Time now) {
  if (now - last_update_ > kPaused) {
    last_sign_ = now;
    has_rhythm_ = false;
  }
  last_update_ = now;
  if (!is_active() && now - last_sign_ > lapse()) begin_epoch(now);
}

}  // namespace sidestep
