// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "common/motion/version.hpp"

namespace sidestep {

/// The versions that one robot may be executing, now or later: R(i) in the coordinator's ledger, and what an
/// agent registers. A version leaves it by a fact and by nothing else (safety-protocol, rule 2).
class VersionSet {
 public:
  static constexpr std::size_t kCapacity = 8;

  bool is_full() const { return count_ == kCapacity; }
  /// Precondition: not full. A version that is there already is not added again.
  void add(const Version& version);
  /// The version with this number, or nullptr.
  const Version* find(VersionNumber number) const;
  /// "executing f at time t": drops every version older than f, and every newer one whose start is not after
  /// t, because the firmware can never take it any more. A fact about a version that is not in the set is
  /// left alone (late, or false): returns false.
  bool forget(VersionNumber executing, Time at);
  /// "Executing nothing at time t": drops every version whose start is not after t.
  void forget_started(Time at);
  void clear() { count_ = 0; }

  std::span<const Version> versions() const { return {versions_.data(), count_}; }

 private:
  std::array<Version, kCapacity> versions_;
  std::size_t count_ = 0;
};

}  // namespace sidestep
