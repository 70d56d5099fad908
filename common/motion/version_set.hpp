// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <utility>

#include "common/motion/version.hpp"

namespace sidestep {

/// All versions that a robot may execute, now or later. This is R(i) in the coordinator's ledger, and the
/// content of an agent's registration. Only robots' facts remove versions (coordinator/PROTOCOL.md, rule 2).
class VersionSet {
 public:
  static constexpr std::size_t kCapacity = 8;

  bool is_full() const { return count_ == kCapacity; }
  /// Adds a version. No effect if the set already contains the version's number. Precondition: not full.
  void add(const Version& version);
  /// The version with this number, or nullptr.
  const Version* find(VersionNumber number) const;
  /// Applies the fact "executing f at time t": removes all versions older than f, and all newer ones that
  /// start at or before t, because the firmware can no longer switch to them. Returns false, without effect,
  /// if f is not in the set; the fact is then outdated or false.
  bool forget(VersionNumber executing, Time at) {
    return forget(executing, at, [](const Version&) {});
  }
  /// Like the overload above, but calls back with every version before removing it.
  template <typename Callback>
  bool forget(VersionNumber executing, Time at, Callback on_removal) {
    if (!find(executing)) return false;
    remove_if(
        [executing, at](const Version& version) {
          return version.number < executing ||
                 (version.number > executing && version.trajectory.start() <= at);
        },
        on_removal);
    return true;
  }
  /// Applies the fact "executing nothing at time t": removes all versions that start at or before t.
  void forget_started(Time at) {
    forget_started(at, [](const Version&) {});
  }
  /// Like the overload above, but calls back with every version before removing it.
  template <typename Callback>
  void forget_started(Time at, Callback on_removal) {
    remove_if([at](const Version& version) { return version.trajectory.start() <= at; }, on_removal);
  }
  void clear() { count_ = 0; }

  std::span<const Version> versions() const { return {versions_.data(), count_}; }

 private:
  template <typename Predicate, typename Callback>
  void remove_if(Predicate is_removed, Callback on_removal) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (is_removed(versions_[i]))
        on_removal(std::as_const(versions_[i]));
      else if (kept++ != i)
        versions_[kept - 1] = versions_[i];
    }
    count_ = kept;
  }

  std::array<Version, kCapacity> versions_;
  std::size_t count_ = 0;
};

}  // namespace sidestep
