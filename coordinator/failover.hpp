// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/config/scenario.hpp"
#include "common/motion/version.hpp"
#include "idl/negotiation.h"

namespace sidestep {

/// Which of several coordinators that stand by for each other, 0 .. kMaxCoordinators - 1.
using CoordinatorNumber = std::uint32_t;

/// One coordinator process among others.
struct CoordinatorIdentity {
  CoordinatorNumber number = 0;
  Incarnation incarnation = 0;
};

/// Who of the coordinators is the active one, as one of them sees it. It stands by while it hears another,
/// takes over when it hears none any more, and stands by again when a higher epoch is heard of. The clock
/// that it is given decides when robots move again, never whether they are safe: two that think they are
/// active have different epochs, and robots obey the higher one.
class Failover {
 public:
  /// Signs of life of an active coordinator come this often.
  static constexpr Duration kSignOfLife{20'000'000};
  /// update() is due this often.
  static constexpr Duration kLook{5'000'000};

  /// An active one begins an epoch at once; a standby waits a second for others.
  Failover(const CoordinatorIdentity& self, bool is_standby, Time now);

  /// A sign of life of any coordinator, this one's own included.
  void on_coordinator_state(const msg::CoordinatorState& state, Time now);
  /// Some agent or robot obeys this epoch. `is_granting`: what this coordinator does meanwhile.
  void on_obeyed_epoch(Epoch epoch, bool is_granting, Time now);
  /// Takes over when it is time to.
  void update(Time now);
  /// Begins a new epoch, above every one heard of.
  void begin_epoch(Time now);

  bool is_active() const { return epoch_ != 0; }
  /// The epoch of this coordinator; 0 while it stands by.
  Epoch epoch() const { return epoch_; }
  /// How long no sign of life has to be heard until it takes over: longer where they come irregularly.
  Duration lapse() const;
  /// Epochs that nobody can have, and were ignored.
  std::uint64_t invalid() const { return invalid_; }

 private:
  void stand_by(Time now);
  void note_sign(Time now);

  CoordinatorIdentity self_;
  Epoch epoch_ = 0, highest_ = 0;  // its own, and the highest heard of
  Time last_sign_, last_update_;
  std::array<Duration, 32> gaps_{};  // between the latest signs of life
  std::size_t signs_ = 0;
  bool has_rhythm_ = false;  // last_sign_ is one
  bool is_new_;              // a standby that has heard nobody yet
  int hearsay_ = 0;          // times in a row that it was superseded by somebody whom it does not hear
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
