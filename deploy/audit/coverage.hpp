// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// The fractions of a run that the audit covered, from 0 to 1. A fraction is 1 if there was nothing to cover.
struct Coverage {
  /// An audit that covered less than this does not judge the run.
  static constexpr double kMinimum = 0.95;

  double messages = 0;  ///< received fraction of the messages of robots, coordinators and the reference
  /// Fraction of executed versions whose proposal, grant and command were all received.
  double versions = 0;
  double pairs = 0;      ///< fraction of compared pairs of versions that could be decided
  double time = 0;       ///< fraction of the run time in which every robot's executed version is known
  double reference = 0;  ///< fraction of the run time in which ground truth or vision was received

  /// The smallest fraction.
  double share() const;
};

/// Returns part / whole, or 1 if `whole` is 0. Precondition: part <= whole.
[[nodiscard]] double share_of(std::uint64_t part, std::uint64_t whole);

}  // namespace sidestep
