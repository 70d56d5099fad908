// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/coverage.hpp"

#include <algorithm>

namespace sidestep {

double Coverage::share() const { return std::min({messages, versions, pairs, time, reference}); }

double share_of(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 1;
}

}  // namespace sidestep
