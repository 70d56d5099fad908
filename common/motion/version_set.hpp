// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "common/motion/version.hpp"

namespace sidestep {

/// The versions that a robot may be executing, now or later: R(i) in the coordinator's ledger, and the
/// content of an agent's registration. Only facts remove versions (coordinator/PROTOCOL.md, rule 2).
class VersionSet {
 public:
  static constexpr std::size_t kCapacity = 8;

  bool is_full() const { return count_ == kCapacity; }
  /// No effect if the set contains the version's number. Precondition: not full.
  void add(const Version& version);
  /// The version with this number, or nullptr.
  const Version* find(VersionNumber number) const;
  /// The fact "executing f at time t": removes all versions older than f, and all newer ones that start at or
  /// before t, because the firmware can no longer switch to them. False, without effect, if f is not in the
  /// set: the fact is late or false.
  bool forget(VersionNumber executing, Time at);
  /// The fact "executing nothing at time t": removes all versions that start at or before t.
  void forget_started(Time at);
  void clear() { count_ = 0; }

  std::span<const Version> versions() const { return {versions_.data(), count_}; }

 private:
  std::array<Version, kCapacity> versions_;
  std::size_t count_ = 0;
};

}  // namespace sidestep
