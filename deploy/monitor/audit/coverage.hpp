// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// The shares of a run that the audit covered, each between 0 and 1. A part is 1 if there was nothing to
/// cover.
struct Coverage {
  /// An audit that covers less does not judge the run.
  static constexpr double kMinimum = 0.95;

  double messages = 0;   ///< messages of robots, coordinators and the reference that were received
  double versions = 0;   ///< executed versions whose proposal, grant and command were all received
  double pairs = 0;      ///< compared pairs of versions that could be decided
  double time = 0;       ///< of the run time: what every robot executed is known
  double reference = 0;  ///< of the run time: ground truth or vision was received

  /// The smallest part.
  double share() const;
};

/// part / whole; 1 if there is no whole. Precondition: part <= whole.
[[nodiscard]] double share_of(std::uint64_t part, std::uint64_t whole);

}  // namespace sidestep
